"""Where something must be added, without a name for it: phase and side said of single effects against the truth's.

Only the base model is calibrated; `diagnosis.forces.scan` then says what must be added and in which phase of the
motion. The truth's words are those that the effect itself has along the motion fitted at the hidden values, the
windows' states alone free. An error of the channels is found where one must be added, a force or an impulse where the
phase is one of its own, an error of the measured base motion where either is so: it acts as a force, and is none. The
side is right where both name the same one, or both none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.diagnosis import laboratory, suite
from benchmarks.diagnosis.runner import made
from diagnosis.answer.acts import acts
from diagnosis.answer.located import located
from diagnosis.data.measured import Measured
from diagnosis.errors.model import calibrated
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import Fitted, fit
from diagnosis.forces.action import action
from diagnosis.prove.answers import read_json, write_json
from diagnosis.prove.pool import processes
from diagnosis.prove.scores import Share
from diagnosis.search.refit import Explanation
from grids.instruments import INSTRUMENTS
from grids.recordings import read_recording
from grids.specimen import read_specimen
from models.identification import Identification


@one_thread
def place_of(folder: Path, key: Mapping[str, Any]) -> dict[str, Any]:
    """Phase and side that are said without a name, those of the hidden effect, and whether they agree."""
    specimen = read_specimen(folder / "specimen.toml")
    measured = measure(specimen, [read_recording(folder / f"train_{k}.nc") for k in (1, 2)])
    base, errors = calibrated(specimen, measured)
    said = {word for place in located(Explanation((), base), None, errors)[0] for word in place.where}
    effect = key["effects"][0]
    kind, true = _truth(base, effect, key)
    declared = measured.identification
    row = {"case": folder.name, "effect": effect["name"], "kind": kind, "true": sorted(true), "said": sorted(said)}
    return row | agreement(declared, kind, true, said)


def agreement(declared: Identification, kind: str, true: set[str], said: set[str]) -> dict[str, bool]:
    """Whether phase and side agree; nothing said agrees with nothing."""
    events = {declared.separation.event, declared.separation.between} if declared.separation else set()
    sides = {word for one in declared.dependences if one.name == "side" for word in one.phases}
    found = said & events
    at = {"error": not found, "force": bool(found & true), "base": not found or bool(found & true)}
    phase = bool(said) and at[kind]
    return {"phase": phase, "side": bool(said) and said & sides == true & sides}


def _truth(base: Fitted, effect: Mapping[str, Any], key: Mapping[str, Any]) -> tuple[str, set[str]]:
    """Kind of action (force, error of the channels, of the base) and phase words of the hidden effect.

    Along the motion fitted at the hidden values.
    """
    predictor = Predictor(base.measured.undisturbed, base.misfit.predictor.options)
    given = effect["parameters"].items()
    hidden = {f"{effect['name']}.{name}": _over(predictor.measured, name, value, key) for name, value in given}
    values = {**base.point.values, **key["true_parameters"], **hidden}
    misfit = replace(base.misfit, predictor=predictor, unknowns=(), fixed=values, smooth=None)
    fitted = fit(misfit, np.zeros(0), base.states)
    acting = action(predictor, fitted.point, effect["name"])
    kind = "base" if acting.kind == "force" and effect["name"] in INSTRUMENTS else acting.kind
    return kind, {word for place in acts(predictor.measured, acting) for word in place.where}


def _over(measured: Measured, name: str, value: float, key: Mapping[str, Any]) -> float:
    """A hidden value as it is given here: levels over the peak are over that of the measurement."""
    return value * key["over_peak"] / measured.reference_peak if name.endswith("_over_peak") else value


def _row(design: suite.CaseDesign, seed: int, here: Path) -> dict[str, Any] | None:
    """The row of a case, made if it is not there; None of one too weak to count."""
    folder, key = made(design, seed, here / "cases")
    known = read_json(key)
    return None if known["weak"] else place_of(folder, known)


def nameless(folder: Path, *, seed: int, cases: int | None, jobs: int, say: Callable[[str], None]) -> dict[str, Any]:
    """The single effects among the first ``cases`` with a laboratory's errors; writes ``folder``/places.json."""
    designs = [design for design in laboratory.suite(seed)[:cases] if design.kind == "single"]
    here = suite.place(folder, seed, "laboratory")
    rows: list[dict[str, Any]] = []
    with processes(jobs) as pool:
        for done in as_completed([pool.submit(_row, design, seed, here) for design in designs]):
            if (row := done.result()) is not None:
                rows.append(row)
                say(f"{row['case']} {row['effect']}: {' '.join(row['said']) or 'nothing'} / {' '.join(row['true'])}")
    figures = {"seed": seed, **summary(rows), "rows": sorted(rows, key=lambda row: str(row["case"]))}
    write_json(folder / "places.json", figures)
    for name in ("phase", "side", "both"):
        one = figures[name]
        say(f"{name}: {one['count']} of {one['of']}, {one['value']:.3f} [{one['low95']:.3f}, {one['high95']:.3f}]")
    return figures


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of the rows in which phase, side, and both agree."""
    return {
        "phase": asdict(Share.of_flags(row["phase"] for row in rows)),
        "side": asdict(Share.of_flags(row["side"] for row in rows)),
        "both": asdict(Share.of_flags(row["phase"] and row["side"] for row in rows)),
    }
