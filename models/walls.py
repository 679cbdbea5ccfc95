"""A wall with a block on top: the parameters and the geometry that the models of two bodies share."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from models.base import FloatArray, OverParts, Parameter, Quantity, Values
from models.errors import InputError
from models.peaks import AT_SAMPLES

PARAMETERS = (
    Parameter("wall_length", "2b_1", "m", "length of the wall", 0.0, low_open=True),
    Parameter("wall_height", "2h_1", "m", "height of the wall", 0.0, low_open=True),
    Parameter("aspect_ratio", "b_1/h_1", "1", "length over height of the wall", 0.0, low_open=True),
    Parameter(
        "wall_thickness", "t", "m", "thickness of the wall, needed with a density or a modulus", 0.0,
        default=np.nan, low_open=True,
    ),
    Parameter("wall_density", "rho", "kg m-3", "density of the wall", 0.0, low_open=True),
    Parameter("wall_mass", "m_1", "kg", "mass of the wall", 0.0, low_open=True),
    Parameter("top_mass", "m_2", "kg", "mass of the block on top", 0.0, low_open=True),
    Parameter(
        "top_length", "2b_2", "m",
        "length of the block on top; the joint is as long as the shorter of block and wall", 0.0, low_open=True,
    ),
    Parameter("top_height", "2h_2", "m", "height of the block on top", 0.0, low_open=True),
    Parameter("gravity", "g", "m s-2", "acceleration of gravity", 0.0, default=9.80665, low_open=True),
)  # fmt: skip

ALTERNATIVES = (
    (("wall_length", "wall_height"), ("wall_height", "aspect_ratio")),
    (("wall_density",), ("wall_mass",)),
)


@dataclass(frozen=True)
class Bodies:
    """Solid rectangles, arrays ``(n,)``, SI: masses, inertias about the centres, half lengths and heights.

    ``half_joint``: half the length of the top joint, that of the shorter of both bodies.
    """

    mass_1: FloatArray
    inertia_1: FloatArray
    half_length_1: FloatArray
    half_height_1: FloatArray
    mass_2: FloatArray
    inertia_2: FloatArray
    half_height_2: FloatArray
    half_joint: FloatArray
    gravity: FloatArray


def lanes_shape(values: Values, size: int | None) -> tuple[int, ...]:
    """Shape of the lanes to which all values broadcast."""
    return np.broadcast_shapes(*(np.shape(v) for v in values.values()), (size or 1,))


def bodies(values: Values, size: int | None = None) -> Bodies:
    """The two rectangles of the parameters: I = m (length^2 + height^2)/12. Raises InputError for a density alone."""
    shape = lanes_shape(values, size)

    def value(name: str, default: float = np.nan) -> FloatArray:
        return np.broadcast_to(np.asarray(values.get(name, default), dtype=np.float64), shape).copy()

    height, top_length, top_height = value("wall_height"), value("top_length"), value("top_height")
    length = value("wall_length") if "wall_length" in values else value("aspect_ratio") * height
    dense = "wall_density" in values
    if dense and np.any(np.isnan(value("wall_thickness"))):
        raise InputError("wall_density gives a mass only with wall_thickness: give both, or wall_mass")
    mass = value("wall_density") * length * height * value("wall_thickness") if dense else value("wall_mass")
    top = value("top_mass")
    return Bodies(
        mass_1=mass,
        inertia_1=mass * (length**2 + height**2) / 12.0,
        half_length_1=length / 2.0,
        half_height_1=height / 2.0,
        mass_2=top,
        inertia_2=top * (top_length**2 + top_height**2) / 12.0,
        half_height_2=top_height / 2.0,
        half_joint=np.minimum(length, top_length) / 2.0,
        gravity=value("gravity", 9.80665),
    )


def by_body(
    name: str, symbol: str, unit: str, meaning: str, rule: str, plain: str, over: OverParts, kind: str = "float64"
) -> list[Quantity]:
    """The plain quantity and one for each body; ``over``: `Quantity.over_parts`."""
    return [
        Quantity(name, symbol, unit, f"{meaning}, {plain}", rule, kind, over_parts=over),
        Quantity(f"{name}_1", f"{symbol}_1", unit, f"{meaning}, of the wall", rule, kind, over_parts=over),
        Quantity(f"{name}_2", f"{symbol}_2", unit, f"{meaning}, of the upper block", rule, kind, over_parts=over),
    ]


def peaks_by_body(name: str, symbol: str, unit: str, meaning: str, channel: str) -> list[Quantity]:
    """The peaks of ``channel_1`` and ``channel_2``, and the larger of both."""
    each = [f"{channel}_{body}" for body in (1, 2)]
    channels = [tuple(each), *((one,) for one in each)]
    given = by_body(name, symbol, unit, meaning, AT_SAMPLES, "the larger of both", "largest")
    return [replace(quantity, peak_of=of) for quantity, of in zip(given, channels, strict=True)]


def by_joint(
    name: str, symbol: str, unit: str, meaning: str, rule: str, plain: str, over: OverParts, kind: str = "float64"
) -> list[Quantity]:
    """The plain quantity and one for each joint; ``over``: `Quantity.over_parts`."""
    return [
        Quantity(name, symbol, unit, f"{meaning}, {plain}", rule, kind, over_parts=over),
        Quantity(f"{name}_base", f"{symbol}_b", unit, f"{meaning}, at the base", rule, kind, over_parts=over),
        Quantity(f"{name}_top", f"{symbol}_t", unit, f"{meaning}, at the top joint", rule, kind, over_parts=over),
    ]
