"""Parameter studies, maps and diagnosis of rocking walls: the names a notebook uses.

    import rocking
    report = rocking.run("studies/first_map.toml")
    cube = rocking.open_study(report.folder)
    cube.rocking.overturning_map(x="aspect_ratio", y="pga")

A name is imported when it is first used, so that ``import rocking`` is quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diagnosis import calibrate, diagnose
    from grids.motions import Motion, read_motion
    from grids.recordings import read_recording
    from grids.specimen import read_specimen
    from rocking.catalogue import mechanisms, models
    from rocking.simulation import simulate
    from study.open import open_study
    from study.run import run

_WHERE = {
    "Motion": "grids.motions",
    "calibrate": "diagnosis",
    "diagnose": "diagnosis",
    "mechanisms": "rocking.catalogue",
    "models": "rocking.catalogue",
    "open_study": "study.open",
    "read_motion": "grids.motions",
    "read_recording": "grids.recordings",
    "read_specimen": "grids.specimen",
    "run": "study.run",
    "simulate": "rocking.simulation",
}
"""Module of every public name: a new name is one line here and one above."""

__all__ = [
    "Motion",
    "calibrate",
    "diagnose",
    "mechanisms",
    "models",
    "open_study",
    "read_motion",
    "read_recording",
    "read_specimen",
    "run",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'rocking' has no attribute '{name}'; it has {', '.join(__all__)}")
    return getattr(importlib.import_module(_WHERE[name]), name)


def __dir__() -> list[str]:
    return [*globals(), *__all__]
