"""Units: what a user writes against the definitions of SI."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grids.units import factor_to_si, to_si
from models.errors import InputError


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("0.3 g", "m s-2", 0.3 * 9.80665),
        ("300 g", "kg", 0.3),
        ("2 t", "kg", 2000.0),
        ("4.5 MPa", "N m-2", 4.5e6),
        ("1e7 N/m^2", "N m-2", 1e7),
        ("5 deg", "rad", math.radians(5)),
        ("1.2 mrad", "rad", 1.2e-3),
        ("1.67 %", "1", 0.0167),
        ("981 cm/s2", "m s-2", 9.81),
        ("981 cm s**-2", "m s-2", 9.81),
        ("9.81 m/s²", "m s-2", 9.81),
        ("10 kN s m-2", "N s m-2", 1e4),
        ("3 Hz", "s-1", 3.0),
        ("120 rpm", "Hz", 2.0),
        ("4 rad/s", "Hz", 4.0 / math.tau),
        ("720 deg/s", "Hz", 2.0),
        ("2 1/s", "Hz", 2.0),
        ("2 kHz", "Hz", 2000.0),
        ("60 rpm", "rad s-1", math.tau),
        ("90 deg/s", "rad s-1", math.pi / 2),
        ("180 deg/s2", "rad s-2", math.pi),
        ("0.5 1/deg", "rad-1", 90.0 / math.pi),
        ("0.5 deg-1", "rad-1", 90.0 / math.pi),
        ("0.5 1/rad", "rad-1", 0.5),
        ("5 short_ton", "kg", 4535.9237),
        ("2 newton", "N", 2.0),
        ("2 knewtons", "N", 2000.0),
        ("3 tonne", "kg", 3000.0),
        ("2 kN", "N", 2000.0),
        ("5 nanoseconds", "s", 5e-9),
        ("7 nanometer", "m", 7e-9),
        ("2 kN m/rad", "N m", 2000.0),
        ("3 kg m2", "kg m2", 3.0),
        ("250 ms", "s", 0.25),
        ("0.8", "1", 0.8),
        (".5 m", "m", 0.5),
        ("inf", "1", math.inf),
        ("infinity m", "m", math.inf),
        (1.8, "m", 1.8),
        (2, "kg", 2.0),
    ],
)
def test_value_in_si(text: object, unit: str, expected: float) -> None:
    assert to_si(text, unit, "x") == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        ("1.8 kg", "m", ("width", "1.8 kg", "'m' is needed")),
        ("1.8", "m", ("width", "no unit", "1.8 m")),
        ("5 deg", "1", ("5 deg", "pure number")),
        ("5 %", "rad", ("5 %", "'rad'", "deg")),
        ("1 Hz", "rad s-1", ("'Hz'", "'rad s-1'", "deg/s")),
        ("1 1/s", "rad s-1", ("'1/s'", "'rad s-1'", "deg/s")),
        ("1 1/s2", "rad s-2", ("'1/s2'", "'rad s-2'")),
        ("0.5 1", "rad-1", ("'1'", "'rad-1'")),
        ("5 ton", "kg", ("'ton'", "907 kg", "'t'")),
        ("5 Mton", "kg", ("'Mton'", "907 kg", "'t'")),
        ("5 megatons", "kg", ("'megatons'", "907 kg")),
        ("1,2 kg", "kg", ("1,2 kg': write a decimal point, '1.2 kg'.",)),
        ("0,125 kg", "kg", ("0,125 kg': write a decimal point, '0.125 kg'.",)),
        ("1,200 kg", "kg", ("write '1200 kg' if the comma parts thousands, else a decimal point, '1.200 kg'.",)),
        ("1,200,000 kg", "kg", ("write '1200000 kg'.",)),
        ("1,200.5 kg", "kg", ("write '1200.5 kg'.",)),
        ("5 tons", "kg", ("'tons'", "907 kg", "'t'")),
        ("2 ton/m^3", "kg m-3", ("'ton/m^3'", "'t'")),
        ("5 ton_force", "N", ("'ton_force'", "907 kg")),
        ("nano", "m", ("nano", "0.5 m")),
        ("wide", "m", ("wide", "0.5 m")),
        ("1 foo", "m", ("foo", "not known")),
        ("1 m/", "m", ("m/", "not known")),
        ("20 degC", "kg", ("degC", "'kg'")),
        (True, "m", ("True", "in m")),
        ([1.0], "m", ("[1.0]", "in m")),
        (math.nan, "m", ("nan", "not a number")),
        ("nan m", "m", ("nan", "not a number")),
        ("1 m; import os", "m", ("not known",)),
    ],
)
def test_what_is_no_value(value: object, unit: str, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as error:
        to_si(value, unit, "width")
    assert all(word in str(error.value) for word in ("width", *words)), str(error.value)


def test_a_unit_that_begins_like_a_number() -> None:
    assert factor_to_si("nanoseconds", "s", "time") == pytest.approx(1e-9, rel=1e-14)
    with pytest.raises(InputError, match="'infinitesimals' is not known"):
        factor_to_si("infinitesimals", "m", "x")


UNITS = st.sampled_from(
    [("mm", "m"), ("t", "kg"), ("MPa", "N m-2"), ("deg", "rad"), ("g", "m s-2"), ("kN s/m^2", "N s m-2")]
)


SIZES = st.floats(1e-24, 1e12)


@given(st.one_of(st.just(0.0), SIZES, SIZES.map(lambda x: -x)), UNITS)
def test_there_and_back(number: float, units: tuple[str, str]) -> None:
    unit, si = units
    factor = factor_to_si(unit, si, "x")
    assert to_si(f"{number!r} {unit}", si, "x") / factor == pytest.approx(number, rel=1e-14, abs=0.0)
    assert to_si(f"{number!r} {si}", si, "x") == number
