"""What the model leaves out: calibrating, locating, naming, extending, proving.

    from diagnosis import calibrate, diagnose
    answer = diagnose(specimen, [train_1, train_2], [test_1])
    print(answer.statement)

A name is imported when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diagnosis.answer.calibration import calibrate
    from diagnosis.answer.diagnose import diagnose

_WHERE = {"calibrate": "diagnosis.answer.calibration", "diagnose": "diagnosis.answer.diagnose"}

__all__ = ["calibrate", "diagnose"]


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'diagnosis' has no attribute '{name}'; it has {', '.join(__all__)}")
    return getattr(importlib.import_module(_WHERE[name]), name)
