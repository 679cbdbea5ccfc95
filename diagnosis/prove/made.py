"""A folder of concealed cases made by seed from one specimen (`diagnosis.prove.drawn`), in the form that is proved.

The settings lie in made.json, the key in answers.json, which grows case by case: what was begun goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from diagnosis.prove.answers import read_json, write_json
from diagnosis.prove.chain import KEY
from diagnosis.prove.drawn import Scene, draw
from grids.law_table import LAW_FILE
from grids.motions import Motion
from grids.specimen import Specimen
from grids.write_specimen import law_beside, specimen_text
from models.errors import InputError
from study.history import write_history

SETTINGS = "made.json"
KINDS = ("single", "null", "single", "single", "null", "pair")
"""Of the cases in turn."""
RUNS = ("train_1", "train_2", "test_1")
"""Recordings of a case."""
RESTORE = "take the folder away and make it anew."


def make(
    folder: Path,
    specimen: Specimen,
    motions: Sequence[Motion],
    *,
    cases: int,
    seed: int,
    noise: float,
    say: Callable[[str], None],
) -> None:
    """Make ``cases`` in ``folder``, but those that are there; the same for the same settings.

    ``noise``: standard deviation of white noise, over the peak of each channel. Raises InputError for a folder of other
    settings, and where the specimen does not move under the ``motions``.
    """
    settings = {
        "specimen": specimen_text(specimen),
        "motions": [[motion.name, motion.fingerprint] for motion in motions],
        "seed": seed,
        "noise": noise,
    }
    _check(folder, settings)
    key: dict[str, Any] = {"cases": {}}
    if (folder / KEY).is_file():
        key = read_json(folder / KEY, RESTORE)
    names = [f"case_{k + 1:02d}" for k in range(cases)]
    left = [(k, name) for k, name in enumerate(names) if name not in key["cases"]]
    if not left:
        return
    say(f"making {len(left)} of {cases} cases")
    scene = Scene.of(specimen, motions, noise)
    write_json(folder / SETTINGS, settings)
    for k, name in left:
        drawn = draw(scene, KINDS[k % len(KINDS)], RUNS, np.random.default_rng([seed, k]))
        for run, history in drawn.recordings.items():
            write_history(history, folder / name / f"{run}.nc")
        (folder / name / "specimen.toml").write_text(specimen_text(drawn.specimen), encoding="utf-8")
        if (law := law_beside(drawn.specimen)) is not None:
            (folder / name / LAW_FILE).write_text(law, encoding="utf-8")
        key["cases"][name] = drawn.entry
        write_json(folder / KEY, key)


def _check(folder: Path, settings: dict[str, Any]) -> None:
    if not folder.exists() or not any(folder.iterdir()):
        return
    if not (folder / SETTINGS).is_file():
        raise InputError(f"{folder} holds other files than cases made here: name a new folder.")
    known = read_json(folder / SETTINGS, RESTORE)
    other = [name for name, value in settings.items() if known.get(name) != value]
    if other:
        raise InputError(f"the cases of {folder} were made with another {other[0]}: name a new folder, or as before.")
