"""Units: what a user writes becomes SI once, where it is read.

A number is already in SI; a string carries its unit: "1.8 m", "4.5 MPa", "5 deg", "2 t".
`g` is the standard gravity where an acceleration is wanted and the
gram elsewhere. Units are written as CF does ("m s-2") or with / * ^ ("m/s^2").
A frequency in Hz is also read from an angular rate ("120 rpm", "12.57 rad/s": 2 Hz); an angular rate needs an angle.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

from models.errors import InputError

if TYPE_CHECKING:
    import pint

_NUMBER = re.compile(
    r"\s*([+-]?(?:(?:inf(?:inity)?|nan)\b|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?))\s*(.*?)\s*"
)
STANDARD_GRAVITY = 9.80665
"""m s-2 (3rd CGPM, 1901)."""
SMALLEST, LARGEST = 1e-30, 1e30
"""Sizes (SI) beyond which a number is a mistake, and powers and products of several would leave floating point."""
_EXPONENT = re.compile(r"(?<=[A-Za-zµμ])\s*(?:\^|\*\*)?\s*\(?([+-]?\d+)\)?")
_PRODUCT = re.compile(r"(?<=[\w)])\s+(?=[A-Za-zµμ(])")
_TON = re.compile(r"\b(?:kilo|mega|giga|milli|[A-Za-zµμ])?tons?(?:_force)?\b|\bforce_tons?\b")
"""The word of three masses: 907 kg in the US, 1016 kg in Britain, 1000 kg elsewhere."""
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+(?![0-9])")
"""A number whose commas may part its thousands."""
_ONE = ("", "1", "-")


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint

    return pint.UnitRegistry()


@cache
def _quantity(text: str, gravity: bool) -> Any:
    """One of the unit as a pint quantity; raises ValueError for words pint does not know."""
    if text.strip() in _ONE:
        return _registry().Quantity(1.0)
    plain = text.strip().replace("·", " ").replace("²", "2").replace("³", "3").replace("°", "deg")
    product = _PRODUCT.sub(" * ", _EXPONENT.sub(r"**(\1)", plain.replace("%", "percent")))
    if gravity:
        product = re.sub(r"(?i)\bgal\b", "Gal", re.sub(r"\bg\b", "standard_gravity", product))  # else the gallon
    try:
        return _registry().Quantity(1.0, _registry().parse_units(product))
    except Exception as error:  # pint lets attribute, tokenizer and type errors through
        raise ValueError(text) from error


@cache
def _factor(unit: str, si_unit: str) -> float | None:
    """How many ``si_unit`` one ``unit`` is; None where the dimensions differ."""
    wanted = _quantity(si_unit, False)
    given = _quantity(unit, bool(wanted.check("[acceleration]")))
    if not getattr(given, "_is_multiplicative", False) or given.dimensionality != wanted.dimensionality:
        return None
    # A radian is dimensionless for pint; a slope written as an angle, or a rate of turning without, is a mistake.
    angles = _angles(given)
    if (si_unit in _ONE and angles) or (si_unit.startswith("rad") and angles != _angles(wanted)):
        return None
    turns = math.tau if si_unit == "Hz" and angles == 1 else 1.0
    return float(given.to(wanted.units).magnitude) / turns


def _angles(quantity: Any) -> int:
    """The power of the angle in a unit: 1 of rad, deg/s and rpm, 0 of Hz."""
    return int({str(name): power for name, power in quantity.to_root_units().unit_items()}.get("radian", 0))


def factor_to_si(unit: str, si_unit: str, where: str) -> float:
    """How many ``si_unit`` one ``unit`` is, for arrays in one unit: "g", "cm/s2", also with a factor, "1e-4 g".

    Raises InputError, whose sentence opens with ``where``, for an unknown unit or one of another dimension.
    """
    if unit == si_unit:  # that of the project's own files, without starting the unit library
        return 1.0
    if _TON.search(unit):
        raise InputError(
            f"{where}: unit '{unit}' is 907 kg in the US and 1016 kg in Britain; write 't' for 1000 kg, or kg."
        )
    with_factor = _NUMBER.fullmatch(unit)
    if with_factor is not None and with_factor[2][:1].isalpha():
        return to_si(unit, si_unit, f"{where}: unit")
    try:
        factor = _factor(unit, si_unit)
    except (ValueError, OverflowError):  # the latter from a number of hundreds of digits inside the unit
        raise InputError(f"{where}: unit '{unit}' is not known; write for example '{_example(si_unit)}'.") from None
    if factor is None:
        wanted = "a pure number is needed" if si_unit in _ONE else f"'{si_unit}' is needed"
        turning = " (1 Hz is 360 deg/s)" if si_unit == "rad s-1" else ""
        raise InputError(f"{where}: unit '{unit}' where {wanted}; write for example '{_example(si_unit)}'{turning}.")
    return factor


def to_si(value: object, si_unit: str, where: str) -> float:
    """A number (taken as SI) or a string with its unit, as a number in ``si_unit``.

    Infinity passes (some effects are null there), NaN does not. Raises InputError.

    >>> to_si("0.3 g", "m s-2", "pga")
    2.941995
    >>> to_si("2 t", "kg", "mass")
    2000.0
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError(f"{where} = {value!r}: give a number{_in(si_unit)} or a string with its unit.")
    if isinstance(value, str):
        match = _NUMBER.fullmatch(value)
        if match is None:
            raise InputError(f"{where} = '{value}': give a number and its unit, for example '{_sample(si_unit)}'.")
        number, unit = float(match[1]), match[2]
        if unit.startswith(","):
            raise InputError(f"{where} = '{value}': {_without_commas(value.strip())}.")
        if not unit and si_unit not in _ONE:
            raise InputError(
                f"{where} = '{value}' has no unit; write '{match[1]} {si_unit}' "
                f"(in a file also {match[1]} without quotes)."
            )
        number *= factor_to_si(unit, si_unit, f"{where} = '{value}'")
    else:
        try:
            number = float(value)
        except OverflowError:
            raise InputError(f"{where} is a whole number of hundreds of digits; give a value{_in(si_unit)}.") from None
    if math.isnan(number):
        raise InputError(f"{where} = {value} is not a number; give a value{_in(si_unit)} or leave it out.")
    infinite = math.isinf(number) and "inf" in str(value)
    if not infinite and number and not SMALLEST < abs(number) < LARGEST:
        raise InputError(f"{where} = {value!s:.40} is beyond any size; give a value{_in(si_unit)} within {LARGEST:g}.")
    return number


def _without_commas(text: str) -> str:
    decimal = f"a decimal point, '{text.replace(',', '.', 1)}'"
    thousands = _THOUSANDS.match(text)
    if thousands is None:
        return f"write {decimal}"
    whole = f"'{text.replace(',', '')}'"
    one_reading = text.count(",") > 1 or text[thousands.end() :].startswith(".")
    return f"write {whole}" if one_reading else f"write {whole} if the comma parts thousands, else {decimal}"


def with_unit(value: float, si_unit: str) -> str:
    """A value with its unit, for a sentence."""
    return f"{value:.6g}" if si_unit in _ONE else f"{value:.6g} {si_unit}"


def _in(si_unit: str) -> str:
    return "" if si_unit in _ONE else f" in {si_unit}"


def _example(si_unit: str) -> str:
    return {"m s-2": "g", "N m-2": "MPa", "rad": "deg", "rad s-1": "deg/s", "1": "%"}.get(si_unit, si_unit)


def _sample(si_unit: str) -> str:
    return "0.5" if si_unit in _ONE else f"0.5 {_example(si_unit)}"
