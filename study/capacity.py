"""What a study needs of memory and disk, held against what there is before it starts."""

from __future__ import annotations

import shutil
from pathlib import Path

from grids.plan import Plan
from models.errors import InputError
from study.timing import Sample

BYTES_PER_POINT = 1500
"""Memory that a point of an axis takes, with its label, its place and its line in the manifest."""
BYTES_PER_COORDINATE = 120
"""Memory that a coordinate of a block takes, in the manifest and its text."""
COPIES = 2
"""A cell is stored in its block and in the cube."""


def check_axes(plan: Plan) -> None:
    """Raise InputError when the points of the axes alone would not fit in memory."""
    longest = max(plan.axes, key=lambda axis: axis.size, default=None)
    if longest is not None:
        _check_memory(
            BYTES_PER_POINT * sum(axis.size for axis in plan.axes), f"{longest.size} points of {longest.name}"
        )


def check_capacity(plan: Plan, folder: Path, sample: Sample, most_cells: int) -> None:
    """Raise InputError when the blocks' coordinates do not fit in memory, or the results on the disk."""
    blocks, coordinates = plan.grid.count_blocks(most_cells)
    _check_memory(BYTES_PER_COORDINATE * coordinates, f"{blocks} blocks of {plan.grid.size} cells")
    needed = COPIES * sample.stored_bytes_per_cell * plan.grid.size
    place = next(path for path in (folder, *folder.parents) if path.exists())
    free = shutil.disk_usage(place).free
    if needed > free:
        raise InputError(
            f"{plan.grid.size} cells need about {needed / 1e9:.3g} GB on the disk of {place}, {free / 1e9:.3g} GB are "
            "free: name another folder for the results, or make the grid coarser"
        )


def _check_memory(needed: float, what: str) -> None:
    import psutil

    free = psutil.virtual_memory().available
    if needed > free:
        raise InputError(
            f"{what} need about {needed / 1e9:.3g} GB of memory, {free / 1e9:.3g} GB are free: make the grid coarser, "
            "or split the study"
        )
