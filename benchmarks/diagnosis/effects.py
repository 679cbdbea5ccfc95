"""What may be hidden in a case: rows of the catalogue, with how a case draws them; here those of one block.

The ranges are those of the catalogue (see `docs`), written down a second time on purpose: the benchmark
does not read what the diagnosis declares, and a test holds one against the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

Shapes = Callable[[np.random.Generator, float], dict[str, float]]


def _none(rng: np.random.Generator, peak: float) -> dict[str, float]:
    return {}


@dataclass(frozen=True)
class Hidden:
    """One row: ``ends`` are the limits of ``parameter`` on either side of its null (one or two).

    ``inverse``: the effect grows with 1/parameter, from an infinite null. ``shapes`` draws the
    remaining parameters, given the largest rotation (rad) without the effect. ``sensor``: it belongs to an
    instrument, not to the block. ``smallest``: size under which the parameter is beyond the catalogue's range.
    """

    name: str
    effect_class: str
    parameter: str
    ends: tuple[float, ...]
    null: float = 0.0
    inverse: bool = False
    sensor: bool = False
    shapes: Shapes = field(default=_none)
    smallest: float = 0.0

    def at(self, size: float, end: float) -> float:
        """The parameter at ``size`` (0: null, 1: at ``end``) of the way, in its inverse if need be."""
        if self.inverse:
            return math.inf if size == 0.0 else end / size
        return self.null + size * (end - self.null)

    def half(self, value: float) -> float:
        """Half the distance from the null, of the inverse where the null is infinite."""
        return 2.0 * value if self.inverse else 0.5 * (self.null + value)


def _gap(rng: np.random.Generator, peak: float) -> dict[str, float]:
    return {"gap": float(rng.choice([0.0, rng.uniform(0.1, 0.4) * peak]))}


def _pitch(rng: np.random.Generator, peak: float) -> dict[str, float]:
    return {"low_pass_hz": float(rng.uniform(4.0, 20.0))}


def _floor(rng: np.random.Generator, peak: float) -> dict[str, float]:
    return {"floor": float(rng.uniform(0.5, 0.9))}


def _order(rng: np.random.Generator, peak: float) -> dict[str, float]:
    return {"order": float(rng.integers(1, 5)), "zero_phase": float(rng.integers(2))}


_GEOMETRY = "contact_geometry"

ROWS = (
    Hidden("vertical_acceleration", "vertical_acceleration", "kappa", (1.5,)),
    Hidden("sliding", "sliding", "friction", (0.03,), math.inf, inverse=True),
    Hidden("pivot_inset", _GEOMETRY, "inset_over_half_width", (0.35,)),
    Hidden("rounded_corner", _GEOMETRY, "radius_over_half_width", (0.3,)),
    Hidden("crushing", _GEOMETRY, "inset_per_rotation", (5.0,)),
    Hidden("tilt", "tilt", "tilt", (-0.05, 0.05)),
    Hidden("eccentricity", "eccentricity", "offset_over_half_width", (-0.2, 0.2)),
    Hidden("flexible_joint", "flexible_joint", "angle", (0.03,)),
    Hidden("added_stiffness", "added_stiffness", "over_m_g_R", (-0.5, 0.5), shapes=_gap),
    Hidden("table_pitch", "table_pitch", "pitch_per_acceleration", (-0.003, 0.003), shapes=_pitch),
    Hidden("restitution", "restitution", "factor_on_housner", (0.5, 1.1), 1.0),
    Hidden("velocity_restitution", "velocity_restitution", "beta", (-0.2, 0.5)),
    Hidden("bounce", "bounce", "contact_restitution", (0.6,)),
    Hidden("viscous_damping", "viscous_damping", "rate", (1.0,)),
    Hidden("coulomb_damping", "coulomb_damping", "over_m_g_b", (0.1,)),
    Hidden("quadratic_damping", "quadratic_damping", "coefficient", (5.0,)),
    Hidden("degradation", "degradation", "loss_of_restitution_per_impact", (0.03,), shapes=_floor),
    Hidden("wall_flexibility", "wall_flexibility", "first_frequency", (3.0,), math.inf, inverse=True, smallest=0.03),
    Hidden("accelerometer_offset", "tilt", "offset", (-0.5, 0.5), sensor=True),
    Hidden("gain", "gain", "gain", (-0.12, 0.12), sensor=True),
    Hidden("offset", "offset", "offset_over_peak", (-0.15, 0.15), sensor=True),
    Hidden("delay", "delay", "delay", (-0.04, 0.04), sensor=True),
    Hidden("clock", "clock", "rate", (-0.02, 0.02), sensor=True),
    Hidden("filter", "filter", "corner_hz", (0.5,), math.inf, inverse=True, sensor=True, shapes=_order),
    Hidden("base_gain", "base_gain", "gain", (-0.15, 0.15), sensor=True),
    Hidden("base_filter", "base_filter", "high_pass_hz", (1.0,), sensor=True),
    Hidden("drift", "drift", "rate", (-0.005, 0.005), sensor=True),
    Hidden("saturation", "saturation", "level_over_peak", (0.3,), 1.0, sensor=True),
    Hidden("cross_axis", "cross_axis", "rotation_per_acceleration", (-0.01, 0.01), sensor=True),
)
CATALOGUE = {row.name: row for row in ROWS}
