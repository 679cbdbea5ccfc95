"""The answer of a diagnosis in files: JSON, page, figures, specimen, curves."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import models
from diagnosis.answer.result import Diagnosis
from diagnosis.report.earlier import remove_earlier
from diagnosis.report.extended import extend
from diagnosis.report.fit_file import write_fit
from diagnosis.report.json_file import as_mapping, diagnosis_json
from diagnosis.report.posterior_file import write_posterior
from grids.recordings import Recording
from grids.specimen import Specimen

POSTERIOR = "posterior.nc"
__all__ = ["as_mapping", "diagnosis_json", "extend", "write_answer"]


def write_answer(
    diagnosis: Diagnosis,
    specimen: Specimen,
    train: Sequence[Recording],
    holdout: Sequence[Recording],
    folder: str | Path,
) -> list[Path]:
    """Write ``diagnosis.json``, ``extended.toml``, ``fit.nc``, ``report.html`` and ``figures/`` to ``folder``.

    ``law.csv`` is written too where a law in a table is part of the answer, ``posterior.nc`` where something was fitted
    that a study can vary.

    ``specimen``, ``train`` and ``holdout`` are those the diagnosis was made of. Returns the paths,
    the figures as their folder. The small files come first, so that a full disk leaves the answer.
    """
    from diagnosis.report.page import report_page
    from diagnosis.report.pictures import pictures, write_figures
    from grids.law_table import LAW_FILE
    from grids.write_specimen import law_beside, specimen_text
    from study.store import write_text

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    remove_earlier(folder)
    paths = [folder / name for name in ("diagnosis.json", "extended.toml", "report.html")]
    write_text(paths[0], diagnosis_json(diagnosis))
    extended = extend(specimen, diagnosis)
    law = law_beside(extended)
    if law is not None:
        write_text(folder / LAW_FILE, law)
        paths.append(folder / LAW_FILE)
    write_text(paths[1], specimen_text(extended))
    fit = write_fit(diagnosis, folder / "fit.nc")
    if diagnosis.posterior:
        model = models.get(specimen.model)
        paths.append(write_posterior(diagnosis.posterior, model, specimen.title, folder / POSTERIOR))
    else:  # that of an earlier answer
        (folder / POSTERIOR).unlink(missing_ok=True)
    drawn = pictures(diagnosis, specimen, (*train, *holdout))
    write_text(paths[2], report_page(diagnosis, specimen, train, holdout, drawn))
    write_figures(drawn, folder / "figures")
    return [*paths, fit, folder / "figures"]
