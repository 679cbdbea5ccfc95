"""Names of blocks: a hash of everything its outputs depend on.

The key holds the block's own coordinates, the fixed parameters, the motions it uses, the model and
its version, the outputs, options, integrator and tail. Not in it: the other blocks, the size of
the study, file names and labels; so extending an axis leaves the keys of finished blocks alone.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import models
from grids.grid import Rectangle
from grids.motions import Motion
from grids.plan import Plan
from grids.targets import MOTION
from study.provenance import as_json


@dataclass(frozen=True)
class Setting:
    """What all blocks of a study share."""

    model: str
    version: str
    fixed: Mapping[str, float]
    options: Mapping[str, str]
    outputs: tuple[str, ...]
    integrator: str
    tail: float

    @classmethod
    def of(cls, plan: Plan) -> Setting:
        """The setting of a plan; ``status`` is always among the outputs."""
        outputs = tuple(dict.fromkeys((*plan.outputs, "status")))
        fixed = {name: float(value) for name, value in sorted(plan.fixed.items())}
        options = dict(sorted(plan.options.items()))
        version = models.get(plan.model).version
        return cls(plan.model, version, fixed, options, outputs, plan.integrator, float(plan.tail))

    def record(self) -> dict[str, Any]:
        """The setting as JSON keeps it."""
        return {
            "model": self.model,
            "version": self.version,
            "fixed": dict(self.fixed),
            "options": dict(self.options),
            "outputs": sorted(self.outputs),
            "integrator": self.integrator,
            "tail": self.tail,
        }


def motions_by_name(plan: Plan) -> dict[str, Motion]:
    """The plan's motions by the values of the coordinate `motion`."""
    return {motion.name: motion for motion in plan.motions}


def block_key(plan: Plan, setting: Setting, block: Rectangle) -> str:
    """Key of a block of the plan's grid.

    Numbers enter with all their digits, motions by the fingerprint of their samples.
    """
    points = plan.grid.points(block)
    records = motions_by_name(plan)
    used = points.pop(MOTION, list(records))
    record = {
        **setting.record(),
        "shape": [len(values) for values in block.coordinates.values()],
        "points": list(points.items()),
        "motions": [records[name].fingerprint for name in used],
    }
    return hashlib.sha256(as_json(record, sort_keys=True).encode()).hexdigest()[:32]
