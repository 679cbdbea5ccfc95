"""What estimating the errors costs in power: how much larger an effect must be to leave the same evidence.

On recordings with white noise in which nothing is missing, each mechanism of the library is the column d that its
parameter leaves in the residuals, off the states and the base parameters. A small effect of size s has the evidence
s^2 d'd, whitened by the errors; I_white with the white noise known that the recordings have, I with the errors
estimated from them, scatter of impacts, colour and drift included. The same evidence takes an effect
sqrt(I_white / I) times as large.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import as_completed
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.diagnosis import suite
from benchmarks.diagnosis.runner import made
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.setup import measure
from diagnosis.prove.answers import write_json
from diagnosis.prove.pool import processes
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.screen import score
from diagnosis.search.weighing import as_white_noise
from grids.recordings import read_recording
from grids.specimen import read_specimen

QUANTILES = (0.25, 0.5, 0.75, 0.95)


@one_thread
def larger(folder: Path) -> dict[str, float]:
    """By mechanism: sqrt(I_white / I), where both have a slope."""
    specimen = read_specimen(folder / "specimen.toml")
    measured = measure(specimen, [read_recording(folder / f"train_{k}.nc") for k in (1, 2)])
    fitted, errors = calibrated(specimen, measured)
    known = candidates(measured, specimen)
    estimated = _information(linearise_about(fitted), known)
    white = _information(linearise_about(as_white_noise(fitted, errors)), known)
    both = {one: np.sqrt(white[one] / estimated[one]) for one in estimated if one in white}
    # a mechanism with a whole number, as the order of a filter, is one for each that is tried
    return {
        name: float(np.median([x for one, x in both.items() if one.name == name])) for name in {c.name for c in both}
    }


def _information(screen: Linearisation, known: Sequence[Candidate]) -> dict[Candidate, float]:
    """d'd of everything with a slope at its null."""
    found = {one.candidate: screen.product(one.column, one.column) for one in score(screen, known) if one.slope}
    return {one: information for one, information in found.items() if information > 0.0}


def _row(design: suite.CaseDesign, seed: int, here: Path) -> dict[str, float]:
    return larger(made(design, seed, here / "cases")[0])


def power(folder: Path, *, seed: int, cases: int | None, jobs: int, say: Callable[[str], None]) -> dict[str, Any]:
    """The first ``cases`` with white noise of 1 % and nothing missing; writes ``folder``/power.json."""
    nulls = [design for design in suite.suite(seed) if design.kind == "null" and design.noise == 0.01][:cases]
    here = suite.place(folder, seed)
    rows: list[dict[str, float]] = []
    with processes(jobs) as pool:
        for done in as_completed([pool.submit(_row, design, seed, here) for design in nulls]):
            rows.append(done.result())
    figures = {"seed": seed, "cases": len(rows), **summary(rows)}
    write_json(folder / "power.json", figures)
    for name, quantiles in [("all", figures["all"]), *figures["by_mechanism"].items()]:
        say(f"{name}: " + ", ".join(f"{value:.2f}" for value in quantiles))
    return figures


def summary(rows: Sequence[Mapping[str, float]]) -> dict[str, Any]:
    """Quantiles (`QUANTILES`) over the cases, of all mechanisms together and of each."""
    names = sorted({name for row in rows for name in row})
    by = {name: [row[name] for row in rows if name in row] for name in names}
    whole = [value for values in by.values() for value in values]
    return {
        "quantiles": list(QUANTILES),
        "all": np.quantile(whole, QUANTILES).tolist(),
        "by_mechanism": {name: np.quantile(values, QUANTILES).tolist() for name, values in by.items()},
    }
