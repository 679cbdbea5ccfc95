"""What estimating the errors costs in power: how much larger an effect must be to leave the same evidence.

On recordings with white noise in which nothing is missing, each mechanism of the library is the column d that its
parameter leaves in the residuals, off the states and the base parameters. A small effect of size s has the evidence
s^2 d'd, whitened by the errors; I_white with the white noise known that the recordings have, I with the errors
estimated from them, scatter of impacts, colour and drift included. The same evidence takes an effect
sqrt(I_white / I) times as large.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.diagnosis import cases as blocks
from benchmarks.diagnosis import suite
from benchmarks.diagnosis.files import write_case
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.one_thread import one_thread
from diagnosis.fit.setup import measure
from diagnosis.prove.answers import write_json
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
    return {name: float(np.sqrt(white[name] / estimated[name])) for name in estimated if name in white}


def _information(screen: Linearisation, known: Sequence[Candidate]) -> dict[str, float]:
    """d'd of every mechanism with a slope at its null."""
    found = {one.candidate.name: screen.product(one.column, one.column) for one in score(screen, known) if one.slope}
    return {name: information for name, information in found.items() if information > 0.0}


def _row(design: suite.CaseDesign, seed: int, here: Path) -> dict[str, float]:
    folder, key = here / "cases" / design.label, here / "cases" / "keys" / f"{design.label}.json"
    if not key.is_file():
        write_case(blocks.make(design, seed), folder, key)
    return larger(folder)


def power(folder: Path, *, seed: int, cases: int | None, jobs: int, say: Callable[[str], None]) -> dict[str, Any]:
    """The first ``cases`` with white noise of 1 % and nothing missing; writes ``folder``/power.json."""
    nulls = [design for design in suite.suite(seed) if design.kind == "null" and design.noise == 0.01][:cases]
    here = suite.place(folder, seed)
    rows: list[dict[str, float]] = []
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
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
