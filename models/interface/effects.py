"""What mechanisms add to a wall between two layers beyond other numbers of the plain one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from models.base import FloatArray

NULLS = {
    "top_offset": 0.0,
    "couple_stiffness": 0.0,
    "couple_gap": 0.0,
    "couple_damping": 0.0,
    "dry_couple": 0.0,
    "pitch": 0.0,
    "pitch_low_pass": np.inf,
    "left": 1.0,
    "right": 1.0,
    "frozen_base": 0.0,
    "frozen_top": 0.0,
    "final_loss": 0.0,
    "loss_cycles": 1.0,
    "tearing": 0.0,
    "shear_base": np.inf,
    "shear_top": np.inf,
    "friction": np.inf,
    "bending": np.inf,
}
STATES = (
    "displacement_x_1", "displacement_x_2", "bend", "displacement_z_upper",
    "velocity_x_1", "velocity_x_2", "bend_rate", "velocity_z_upper",
)  # fmt: skip
"""Coordinates beyond those of the plain wall, and their rates, as handed over; see `models.interface.chain`."""
BENDS = {"bend": "rotation_1", "bend_rate": "rotation_rate_1"}
"""Handed over as what the upper half of the wall has more than the lower one, so that a wall that is turned stays
straight: the coordinates of the chain are the sums."""
MEMORIES = ("closings", "opened", "torn_left", "torn_right")
"""Uplifts of the base closed again and whether one is under way (1 or 0); ends of what is bonded still (m)."""
CELLS = 16
"""Parts of equal length of a joint whose slips at landing are remembered."""
LANDED = tuple(f"landed_{joint}_{k}" for joint in ("base", "top") for k in range(CELLS))
"""Slip (m) at which what touches of each part of a joint has landed."""
OPENED, CLOSED = 0.9, 0.98
"""Shares of the base in contact under which an uplift counts, and over which it has closed again."""
FROZEN_OVER = 0.05
"""Share of the static compression over which a joint's opening takes the frozen contact from all to half of it."""


@dataclass(frozen=True)
class Effects:
    """One array ``(n,)`` a field, at its null (`NULLS`) where it does not act; SI units.

    ``top_offset``: of the block's mass centre towards +x. On the wall's rotation against the base:
    ``couple_stiffness`` (N m) beyond ``couple_gap`` (rad), ``couple_damping`` (N m s), ``dry_couple`` (N m).
    ``pitch`` (rad s2 m-1) of the base, below ``pitch_low_pass`` (Hz). ``left``, ``right``: factors on the
    stiffness of the base at x < 0, x > 0. ``frozen_base``, ``frozen_top``: share of frozen contact.
    ``final_loss``, ``loss_cycles``: of the base's stiffness by closings. ``tearing``: extension (m) at which the
    base tears. ``shear_base``, ``shear_top``: stiffness and dashpot along a joint over those across it.
    ``friction``: coefficient at the base. ``bending``: stiffness of the wall over that of the base layer.

    ``law``: values of a law in a table by name (`models.interface.table`), none without one.
    ``parts``: the mechanisms given, at whatever value: they alone decide how many coordinates move.
    """

    top_offset: FloatArray
    couple_stiffness: FloatArray
    couple_gap: FloatArray
    couple_damping: FloatArray
    dry_couple: FloatArray
    pitch: FloatArray
    pitch_low_pass: FloatArray
    left: FloatArray
    right: FloatArray
    frozen_base: FloatArray
    frozen_top: FloatArray
    final_loss: FloatArray
    loss_cycles: FloatArray
    tearing: FloatArray
    shear_base: FloatArray
    shear_top: FloatArray
    friction: FloatArray
    bending: FloatArray
    parts: frozenset[str] = frozenset()
    law: Mapping[str, FloatArray] = field(default_factory=dict)

    @classmethod
    def none(cls, size: int) -> Effects:
        """Of ``size`` walls, every one at its null."""
        nulls: dict[str, Any] = {name: np.full(size, null) for name, null in NULLS.items()}
        return cls(**nulls)

    def given(self, part: str, **changes: Any) -> Effects:
        """With the mechanism ``part``; values broadcast to ``(n,)``."""
        arrays: dict[str, Any] = {
            k: np.broadcast_to(np.asarray(v, float), self.left.shape).copy() for k, v in changes.items()
        }
        return replace(self, **arrays, parts=self.parts | {part})

    def with_law(self, values: Mapping[str, Any]) -> Effects:
        """With a law in a table; values broadcast to ``(n,)``."""
        law = {k: np.broadcast_to(np.asarray(v, float), self.left.shape).copy() for k, v in values.items()}
        return replace(self, law=law, parts=self.parts | {"table_force"})

    def map(self, function: Callable[[FloatArray], Any]) -> Effects:
        """With ``function`` of every array."""
        own: dict[str, Any] = {name: function(getattr(self, name)) for name in NULLS}
        return replace(self, **own, law={name: function(values) for name, values in self.law.items()})

    @property
    def arrays(self) -> dict[str, Any]:
        """Everything with an array (n,), by name."""
        return {**{name: getattr(self, name) for name in NULLS}, **self.law}

    @property
    def coordinates(self) -> int:
        """4, those of the plain wall, 6 with slips of the joints, or 8 with a wall that bends."""
        if "wall_flexibility" in self.parts:
            return 8
        return 6 if self.parts & {"interface_shear", "sliding"} else 4

    def wear(self, closings: FloatArray) -> FloatArray:
        """Factor on the stiffness of the base after so many closings."""
        return np.asarray(1.0 + self.final_loss * np.expm1(-closings / self.loss_cycles))
