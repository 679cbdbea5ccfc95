"""Whether the five packages are ours: their names are plain words that another package may take."""

from __future__ import annotations

import importlib.util
from pathlib import Path

ROOMS = ("models", "grids", "study", "diagnosis", "rocking")


def find_intruder() -> str | None:
    """A sentence about the package that is not beside this one; None when all five lie together."""
    home = Path(__file__).resolve().parent.parent
    for room in ROOMS:
        spec = importlib.util.find_spec(room)
        found = [Path(place).resolve() for place in (spec and spec.submodule_search_locations) or []]
        if spec is not None and not found and spec.origin:
            found = [Path(spec.origin).resolve()]
        if home / room not in found:
            where = f"from {found[0]}" if found else "nowhere"
            return (
                f"package '{room}' comes {where} instead of {home / room}: "
                "remove or rename the other one, or start from another folder"
            )
    return None
