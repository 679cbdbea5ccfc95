"""What an earlier answer in the same folder left and the next one may not write."""

from __future__ import annotations

from pathlib import Path

from grids.law_table import LAW_FILE


def remove_earlier(folder: Path) -> None:
    """Remove tables and curves of an earlier answer, and no others: a folder may hold a user's own of these names."""
    extended, runs = folder / "extended.toml", folder / "runs.csv"
    if extended.is_file() and f'"{LAW_FILE}"' in extended.read_text("utf-8", "replace"):
        (folder / LAW_FILE).unlink(missing_ok=True)
    if (folder / "diagnosis.json").is_file():
        (folder / "fit.nc").unlink(missing_ok=True)
        if runs.is_file() and runs.read_text("utf-8", "replace").startswith("run,group,overturned,"):
            runs.unlink()
