"""A small plan that several tests run and change."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from grids.plan import Plan, parse_plan


def plan_text(
    *,
    name: str = "small",
    aspect: str = "linspace = [0.1, 0.4, 7]",
    pga: str = "linspace = [0.1, 0.8, 8], unit = 'g'",
    mass: str = "800 kg",
    motion: str = 'files = ["ridgecrest_2019_clc"]',
    outputs: str = '"peak_rotation", "onset_time", "overturned", "impacts"',
    tail: str = "2 s",
    block_seconds: float = 5.0,
) -> str:
    """A plan of 7 x 3 x 8 cells of one block under a shipped record."""
    return f"""
[study]
name = "{name}"
model = "housner"
[motion]
{motion}
[parameters]
height = "1.8 m"
mass = "{mass}"
[axes]
aspect_ratio = {{ {aspect} }}
top_mass = {{ values = [0, 1, 3], unit = "t" }}
pga = {{ {pga} }}
[outputs]
names = [{outputs}]
[run]
tail = "{tail}"
block_seconds = {block_seconds}
"""


def small_plan(**changes: Any) -> Plan:
    return parse_plan(plan_text(**changes), Path.cwd())
