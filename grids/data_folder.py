"""Where data lies that does not ship with the project."""

from __future__ import annotations

import os
from pathlib import Path


def data_folder() -> Path | None:
    """The folder that ``ROCKING_DATA`` names, else ``../shared/data`` beside the checkout, else None."""
    named = os.environ.get("ROCKING_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    return folder if folder.is_dir() else None
