"""Units of ground motion, on top of `grids.units`."""

from __future__ import annotations

from grids.units import factor_to_si, to_si

STANDARD_GRAVITY = 9.80665
"""m s-2 (3rd CGPM, 1901)."""


def acceleration_factor(unit: str, where: str) -> float:
    """How many m s-2 one ``unit`` is: g, m/s2, cm/s2, gal, mm/s2 ..., also with a factor: "1e-4 g".

    Raises InputError whose sentence opens with ``where``.
    """
    text = str(unit).strip()
    if text == "m s-2":  # the unit of the project's own files, without starting the unit library
        return 1.0
    if text.lower() == "gal":  # lower case is the gallon elsewhere
        text = "Gal"
    if text[:1].isdigit() or text[:1] in "+-.":
        return to_si(text, "m s-2", f"{where}: unit")
    return factor_to_si(text, "m s-2", where)
