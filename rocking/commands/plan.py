"""``rocking plan F``: what a plan asks for and what it costs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.base import STRICT, console, human_bytes, human_time, warn, whole


def plan(
    plan: Annotated[Path, typer.Argument(help="Plan file (TOML).")],
    workers: Annotated[int | None, typer.Option(help="Blocks at once (default: one a core).", parser=whole)] = None,
    strict: Annotated[bool, typer.Option("--strict", help=STRICT)] = False,
) -> None:
    """Check a plan and print its axes, every value of its cells, blocks, bytes, memory a task and the time."""
    from rich.table import Table

    from grids.entering import entering
    from grids.plan import read_plan
    from grids.plausibility import suspicions_of_plan
    from study.capacity import check_axes
    from study.keys import Setting
    from study.schedulers import check_scheduler, count_workers
    from study.timing import bytes_per_cell, cells_per_block, output_bytes, time_sample

    check_scheduler("threads", workers)
    checked = read_plan(plan)
    warn(suspicions_of_plan(checked), strict)
    check_axes(checked)
    setting = Setting.of(checked)
    sample = time_sample(checked, setting)
    n = count_workers("threads", workers)
    most = cells_per_block(checked, sample, n)
    blocks, _ = checked.grid.count_blocks(most)
    table = Table("axis", "points", "from", "to", "unit", title=f"{checked.name}: model {checked.model}")
    for axis in checked.axes:
        ends = [f"{v:.6g}" if isinstance(v, float) else str(v) for v in axis.values[[0, -1]].tolist()]
        table.add_row(axis.name, str(axis.size), *ends, axis.unit)
    show = console()
    show.print(table)
    total = sample.seconds_per_cell * checked.grid.size
    rows = {
        "motions": ", ".join(motion.name for motion in checked.motions),
        "cells": f"{checked.grid.size:,}",
        "blocks": f"{blocks:,} of at most {most:,} cells",
        "cube": f"{human_bytes(checked.grid.size * output_bytes(setting))} before compression",
        "memory a task": human_bytes(min(most, checked.grid.size) * bytes_per_cell(checked, setting)),
        "time": f"{human_time(total)} on one core, {human_time(total / n)} on {n} "
        f"({sample.cells} cells in {sample.seconds:.3f} s; compiling {human_time(sample.compile_seconds)})",
    }
    for name, text in rows.items():
        show.print(f"{name:<14} {text}", highlight=False, soft_wrap=True)
    values = Table("value of all cells", "", "unit", "from", "meaning")
    for entry in entering(checked):
        value = entry.value if isinstance(entry.value, str) else f"{entry.value:.6g}"
        values.add_row(entry.name, value, entry.unit, entry.source, entry.meaning)
    show.print(values)
    for note in checked.notes:
        show.print(f"note: {note}", highlight=False, soft_wrap=True)
