"""The answer about outcomes in files, and read back for further predictions."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from diagnosis.outcomes.answer import OutcomeDiagnosis, Posterior, Prediction
from diagnosis.report.earlier import remove_earlier
from diagnosis.report.json_file import entry, finite
from diagnosis.report.posterior_file import LEFT_OUT, write_samples
from grids.netcdf_file import read_netcdf
from grids.specimen import Specimen, read_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from study.provenance import as_json
from study.store import write_text

JSON, EXTENDED, POSTERIOR, PAGE, RUNS = "diagnosis.json", "extended.toml", "posterior.nc", "report.html", "runs.csv"
SCATTER = "scatter"


def write_answer(answer: OutcomeDiagnosis, specimen: Specimen, folder: str | Path) -> list[Path]:
    """Write `JSON`, `EXTENDED`, `POSTERIOR`, `RUNS`, `PAGE` and ``figures/`` to ``folder``; the paths."""
    from diagnosis.outcomes.figures import drawings
    from diagnosis.outcomes.page import report_page
    from diagnosis.report.pictures import write_figures
    from diagnosis.report.svg import picture

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    remove_earlier(folder)
    write_text(folder / JSON, as_json(finite(as_mapping(answer)), indent=2, allow_nan=False) + "\n")
    write_text(folder / EXTENDED, specimen_text(answer.extended))
    write_posterior(answer.posterior, folder / POSTERIOR)
    write_text(folder / RUNS, runs_text(answer))
    drawn = {name: picture(draw, name) for name, draw in drawings(answer).items()}
    write_text(folder / PAGE, report_page(answer, specimen, drawn))
    write_figures(drawn, folder / "figures")
    return [*(folder / name for name in (JSON, EXTENDED, POSTERIOR, RUNS, PAGE)), folder / "figures"]


def as_mapping(answer: OutcomeDiagnosis) -> dict[str, Any]:
    """The answer as plain mappings: keys of ``diagnosis.json`` where they mean the same, and those of outcomes."""
    crossed = [one for one in answer.compared if one.cross_validated]
    return {
        "verdict": answer.verdict,
        "effects": [entry(asdict(one)) for one in answer.effects],
        "rivals": [entry(asdict(one)) for one in answer.rivals],
        "located": [asdict(one) for one in answer.wrong],
        "left": [asdict(one) for one in answer.left],
        "base": {name: entry(asdict(one)) for name, one in answer.base.items()},
        "at_bound": list(answer.at_bound),
        "scatter": entry(asdict(answer.scatter)),
        "p_value": answer.p_value,
        "misfit_p_value": answer.misfit_p_value,
        "slope_p_value": answer.slope_p_value,
        "scores": {
            one.by: {**asdict(one.scores), "reliability": [asdict(b) for b in one.reliability]} for one in crossed
        },
        "statement": answer.statement,
        "not_tried": [{"name": name, "why": why} for name, why in answer.not_tried.items()],
        "provenance": {**answer.provenance, "finished": answer.finished},
    }


def runs_text(answer: OutcomeDiagnosis) -> str:
    """CSV with a line a run: group, outcome, measures, and the chance by every predictor from the other groups."""
    crossed = [one for one in answer.compared if one.cross_validated]
    names = ["run", "group", "overturned", *answer.measures, *(f"chance by {one.by}" for one in crossed)]
    rows = [
        [
            run, answer.groups[k], int(answer.overturned[k]), *(f"{m[k]:.6g}" for m in answer.measures.values()),
            *(f"{one.chance[k]:.4f}" for one in crossed),
        ]
        for k, run in enumerate(answer.runs)
    ]  # fmt: skip
    return _csv([names, *rows])


def prediction_text(prediction: Prediction) -> str:
    """CSV with a line a run: chance of overturning with its interval, and the likelier outcome."""
    rows = [
        [run, f"{prediction.chance[k]:.4f}", f"{prediction.low95[k]:.4f}", f"{prediction.high95[k]:.4f}",
         int(prediction.chance[k] > 0.5)]
        for k, run in enumerate(prediction.runs)
    ]  # fmt: skip
    return _csv([["run", "chance_of_overturning", "low95", "high95", "overturned"], *rows])


def _csv(rows: Sequence[Sequence[object]]) -> str:
    written = io.StringIO()
    csv.writer(written, lineterminator="\n").writerows(rows)
    return written.getvalue()


def write_posterior(posterior: Posterior, path: Path) -> None:
    """Samples over ``sample``, one variable a parameter with its unit, and `SCATTER`."""
    variables: dict[str, Any] = {n: (v, {"units": posterior.units[n]}) for n, v in posterior.values.items()}
    meaning = "standard deviation of the logarithm of a run's scale"
    variables[SCATTER] = posterior.scatter, {"units": "1", "long_name": meaning, **LEFT_OUT}
    write_samples(variables, {"title": "equally likely samples of what outcomes say of a specimen"}, path)


def read_answer(folder: str | Path) -> tuple[Specimen, Posterior]:
    """The extended specimen and the samples of a folder that `write_answer` made; raises InputError."""
    folder = Path(folder)
    for name in (EXTENDED, POSTERIOR):
        if not (folder / name).is_file():
            raise InputError(f"{folder} holds no {name}: name a folder that rocking diagnose --outcomes wrote")
    contents = read_netcdf(folder / POSTERIOR)
    values = {name: np.asarray(one.values, np.float64) for name, one in contents.variables.items()}
    units = {name: str(one.attributes.get("units", "1")) for name, one in contents.variables.items()}
    if SCATTER not in values:
        raise InputError(f"{folder / POSTERIOR} holds no {SCATTER}: run rocking diagnose --outcomes again")
    scatter = values.pop(SCATTER)
    return read_specimen(folder / EXTENDED), Posterior(values, units, scatter)
