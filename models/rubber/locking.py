"""A layer that cannot be compressed beyond a strain: s = k u/(1 - |u|/L) + c u', L = lock_strain e.

Energy k L^2 (-ln(1 - |u|/L) - |u|/L). Beyond `TANGENT_FROM` L, which a trial step may pass though the layer hardly
can, the stress goes on along its tangent there: force and slope stay finite.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism

TANGENT_FROM = 0.99


def limit(p: Numbers) -> FloatArray:
    """L."""
    return np.asarray(p["lock_strain"] * p["thickness"])


def _scaled(u: FloatArray, p: Numbers) -> tuple[FloatArray, FloatArray, FloatArray]:
    """L, |u|/L, and the same up to `TANGENT_FROM`."""
    length = limit(p)
    x = np.abs(u) / length
    return length, np.asarray(x), np.minimum(x, TANGENT_FROM)


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """Beyond k u: k u x/(1 - x), x = |u|/L."""
    _, x, inside = _scaled(u, p)
    steeper = inside / (1.0 - inside)
    beyond = np.divide(x - inside, x, out=np.zeros_like(x), where=x > inside)
    return np.asarray(p["stiffness"] * u * (steeper + beyond * steeper / (1.0 - inside)))


def slope(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    inside = _scaled(u, p)[2]
    return np.asarray(p["stiffness"] * (1.0 / (1.0 - inside) ** 2 - 1.0))


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """k L^2 (-ln(1 - x) - x - x^2/2), and the trapezium under the tangent beyond."""
    length, x, inside = _scaled(u, p)
    stretch = np.where(np.isinf(length), 0.0, p["stiffness"] * length**2)
    more = x - inside
    under = inside**2 / (1.0 - inside) + 0.5 * more * (1.0 / (1.0 - inside) ** 2 - 1.0)
    return np.asarray(stretch * (-np.log1p(-inside) - inside - 0.5 * inside**2 + more * under))


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """k (N m-2) and 1/L (m-1)."""
    return {"stiffness": p["stiffness"], "per_length": 1.0 / (p["lock_strain"] * p["thickness"])}


def update(u: float, _: float, h: float, stiffness: float, per_length: float) -> tuple[float, float, float]:
    x = abs(u) * per_length
    inside = min(x, TANGENT_FROM)
    opening = 1.0 / (1.0 - inside)
    steeper = inside * opening
    # x > inside only where x is near 1: no division by zero counts
    beyond = (x - inside) / max(x, TANGENT_FROM)
    return h, stiffness * u * (steeper + beyond * steeper * opening), stiffness * (opening * opening - 1.0)


LAW = RubberLaw(
    rubber_mechanism(
        "locking",
        (
            MechanismParameter(
                "lock_strain", "eps_L", "1", "strain that the layer cannot reach", 0.2, 3.0, null=np.inf,
                fit_inverse=True,
            ),
        ),
        equation="s = k u/(1 - u/(lock_strain e)) + c u'",
        signature="at large rotations, while a joint presses on a short length; strains end below a limit",
        sentence="the rubber locks at a strain of {lock_strain:.2f}",
        static_test="load the rubber slowly and read force over deformation",
        source="form of this project: models/rubber/locking.py",
    ),
    "adds", effect, numbers, update, slope, energy, hidden=False, limit=limit,
    of_strain=True,
)  # fmt: skip
