"""The numbers of the rubber laws as the fibres of the lane kernel take them."""

from __future__ import annotations

from typing import Any

import numpy as np

from models.base import FloatArray
from models.interface import modes
from models.interface.lanes import rows as r
from models.interface.layered import LayeredWall
from models.rubber import LAWS, bouc_wen


def laws_in_use(wall: LayeredWall) -> Any:
    """None without laws; else one entry for each law of the family, True if it acts at a joint, else None."""
    if not wall.laws:
        return None
    return tuple(True if any(key.startswith(f"{name}.") for key in wall.laws) else None for name in LAWS)


def fill_laws(table: FloatArray, wall: LayeredWall, step: FloatArray) -> None:
    """Write the laws' columns of ``given`` for steps of ``step`` (n,) seconds; nulls where a law is absent."""
    if not wall.laws:
        return
    rest = modes.static_state(wall)
    for index, joint in enumerate(("base", "top")):
        columns = r.Q_LAWS + index * r.N_LAW
        u = -rest[:, 2 + index]
        table[:, r.Q_RELAXED + 2 * index] = table[:, r.Q_RELAXED + 2 * index + 1] = u
        # harmless where a law does not act: zeta follows u, no arm, no loss
        table[:, columns + r.P_ORDER] = 1.0
        if joint not in wall.rubber_joints:
            continue
        for law, p in wall.laws_at(joint):
            k, e = p["stiffness"], p["thickness"]
            found: dict[int, Any] = {}
            if law.name == "hardening":
                found = {r.P_HARDENING: p["beta2"] / e**2}
            elif law.name == "maxwell":
                tau = p["relaxation_time"]
                found = {
                    r.P_ARM: p["arm_stiffness_ratio"] * k,
                    r.P_ARM_DECAY: np.exp(-step / tau),
                    r.P_ARM_GAIN: -np.expm1(-step / tau) * tau / step,
                }
            elif law.name == "bouc_wen":
                found = {
                    r.P_HYSTERETIC: (1.0 - p["post_yield_ratio"]) * k,
                    r.P_YIELD: 1.0 / p["yield_compression"],
                    r.P_ORDER: p["exponent"],
                }
                table[:, r.Q_RELAXED + 2 * index + 1] = bouc_wen.relaxed(u, p)
            elif law.name == "mullins":
                found = {r.P_SOFTENING: p["softening"], r.P_PER_STRAIN: 1.0 / (p["strain"] * e)}
            else:
                found = {r.P_SET: -np.expm1(-p["rate"] * step), r.P_LIMIT: p["strain_limit"] * e}
            for row, values in found.items():
                table[:, columns + row] = values
