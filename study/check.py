"""Recompute random cells of a finished study and compare them with its cube bit for bit."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from grids.files import read_text
from grids.plan import Plan, parse_plan
from models.base import MISSING
from models.errors import InputError
from study.evaluate import evaluate
from study.keys import Setting, motions_by_name
from study.manifest import Manifest
from study.open import open_study
from study.recovery import damaged_blocks
from study.status import FAILED, NOT_RUN
from study.store import BlockStore


@dataclass(frozen=True)
class CheckReport:
    """``cells`` compared in every output; ``differing`` says which value differs where."""

    cells: int
    outputs: int
    differing: tuple[str, ...]

    def __str__(self) -> str:
        if not self.differing:
            return f"{self.cells} cells recomputed: {self.outputs} outputs equal bit for bit"
        first = "\n".join(self.differing[:10])
        return f"{self.cells} cells recomputed: {len(self.differing)} values differ\n{first}"


def check(
    folder: str | Path,
    *,
    cells: int = 100,
    seed: int | None = None,
) -> CheckReport:
    """Recompute ``cells`` random cells (``seed`` None: others every time) and compare every output.

    Raises InputError when the folder has no cube, or when the plan's motions or the model are no
    longer those of the study.
    """
    if cells < 1:
        raise InputError(f"cells is {cells}: give 1 or more")
    if seed is not None and seed < 0:
        raise InputError(f"seed is {seed}: give 0 or more")
    folder = Path(folder)
    cube = open_study(folder)
    plan = load_plan(folder)
    for axis in plan.grid.axes:
        if cube.sizes.get(axis.name) != len(axis.values) or not np.all(cube[axis.name].values == axis.values):
            raise InputError(f"cube.nc is older than study.toml (axis '{axis.name}'): run the plan again, then check")
    there = ~cube["status"].isin([NOT_RUN, FAILED]).values
    known = np.flatnonzero(there & (cube["computed"].values == 1) if "computed" in cube else there)
    chosen = np.random.default_rng(seed).choice(known, min(cells, known.size), replace=False)
    setting = Setting.of(plan)
    computed = evaluate(setting, motions_by_name(plan), plan.grid.coordinates(chosen)) if chosen.size else {}
    differing = []
    for name in computed:
        stored = cube[name].values.ravel()[chosen]
        values = computed[name].astype(stored.dtype)
        if computed[name].dtype.kind != "f" and stored.dtype.kind == "f":  # read back with nan where a cube has none
            values = np.where(computed[name] == MISSING, np.nan, values).astype(stored.dtype)
        bits = f"i{stored.itemsize}"
        both_nan = (stored != stored) & (values != values)
        for k in np.flatnonzero((stored.view(bits) != values.view(bits)) & ~both_nan):
            at = plan.grid.coordinates(chosen[k : k + 1])
            place = ", ".join(f"{axis} = {value[0]}" for axis, value in at.items())
            differing.append(f"{name} at {place}: {stored[k]!r} stored, {values[k]!r} recomputed")
    return CheckReport(int(chosen.size), len(computed), tuple(differing))


def load_plan(folder: Path) -> Plan:
    """The plan of a study's folder, with the motions it was started with.

    Raises InputError when there is no study, or when motions, model or declarations have changed.
    """
    manifest = Manifest.of(folder)
    damaged = damaged_blocks(manifest, BlockStore(folder))
    if damaged:
        raise InputError(f"{folder} has damaged blocks: {len(damaged)}; run the plan again, they are computed anew")
    frozen = folder / "study.toml"
    try:
        plan = parse_plan(read_text(frozen, "the plan"), Path(manifest.plan_folder))
    except InputError as error:
        raise InputError(f"{frozen}: {error} Run the plan again, it is kept anew.") from None
    differences = manifest.differences(plan)
    if differences:
        raise InputError(f"{folder} was computed with something else: " + "; ".join(differences))
    return plan
