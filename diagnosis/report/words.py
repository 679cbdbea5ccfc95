"""Numbers and names as a laboratory engineer reads them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from diagnosis.fit.intervals import Estimate
from diagnosis.search.null import LEAST_P

SMALL_UNITS = {"rad": ("mrad", 1e3), "s": ("ms", 1e3), "m": ("mm", 1e3)}
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
UNSURE = 0.05
GRAVITY = 9.80665
"""m s-2, the g that accelerations are printed in."""


def plain(name: str) -> str:
    """A name of the catalogue as words."""
    return name.replace("_", " ").replace(".", ": ")


def unit_text(unit: str) -> str:
    """``m s-2`` as printed, m s⁻²; nothing for a pure number."""
    if unit in ("1", ""):
        return ""
    parts = []
    for part in unit.split():
        letters = part.rstrip("-0123456789")
        parts.append(letters + part[len(letters) :].translate(SUPERSCRIPTS))
    return " ".join(parts)


def number(value: float, digits: int = 3) -> str:
    """Three digits, thousands apart, a true minus; no exponent between 0.001 and a million."""
    if not math.isfinite(value):
        return "∞" if value > 0 else "−∞" if value < 0 else "–"
    if value == 0.0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if not -4 <= size < 6:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        return f"{mantissa.replace('-', '−')} × 10{str(int(exponent)).translate(SUPERSCRIPTS)}"
    decimals = max(0, digits - 1 - size)
    return f"{value:,.{decimals}f}".replace(",", " ").replace("-", "−")


def quantity(value: float, unit: str, digits: int = 3) -> str:
    """A value with its unit: accelerations in g, small angles, lengths and times in milli."""
    if unit == "m s-2":
        return f"{number(value / GRAVITY, digits)} g"
    if unit in SMALL_UNITS and 0.0 < abs(value) < 0.1:
        unit, factor = SMALL_UNITS[unit]
        value *= factor
    return f"{number(value, digits)} {unit_text(unit)}".rstrip()


def stated(value: float, unit: str) -> str:
    """A value that was given, with the digits it was given with."""
    text = f"{value:.6g}" if 1e-4 <= abs(value) < 1e6 or value == 0.0 else number(value, 6)
    return f"{text.replace('-', '−')} {unit_text(unit)}".rstrip()


def estimate_texts(value: Estimate) -> tuple[str, str, str]:
    """Estimate, interval and unit, all to the digits that the interval allows, in a handy unit."""
    unit, factor = value.unit, 1.0
    if value.unit in SMALL_UNITS and 0.0 < abs(value.estimate) < 0.1:
        unit, factor = SMALL_UNITS[value.unit]
    width = factor * (value.high95 - value.low95)
    middle, low, high = (factor * v for v in (value.estimate, value.low95, value.high95))
    if not (math.isfinite(width) and width > 0.0) or abs(math.log10(width)) > 5:
        return number(middle), f"{number(low)} to {number(high)}", unit_text(unit)
    decimals = max(0, 1 - math.floor(math.log10(width)))
    texts = [f"{v:,.{decimals}f}".replace(",", " ").replace("-", "−") for v in (middle, low, high)]
    return texts[0], f"{texts[1]} to {texts[2]}", unit_text(unit)


def percent(share: float) -> str:
    """A share in percent."""
    return f"{number(100 * share, 2)} %"


def chance(p_value: float | None) -> str:
    """A p-value as odds: "1 in 2 000"."""
    if p_value is None:
        return "not tested"
    if not 0.0 < p_value < 1.0:
        return "under one in a million" if p_value <= 0.0 else "certain"
    if p_value > UNSURE:
        return percent(p_value)
    if p_value <= LEAST_P:
        return "under one in a million"
    return f"1 in {number(1.0 / p_value, 2)}"


def listed(words: Iterable[str]) -> str:
    """``a, b and c``."""
    *head, tail = [*words] or [""]
    return f"{', '.join(head)} and {tail}" if head else tail


def named(keys: Iterable[str], names: Mapping[str, str]) -> list[str]:
    """The name of each key."""
    return [names[key] for key in keys]
