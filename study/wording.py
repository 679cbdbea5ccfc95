"""Names and units as engineers read them: accelerations in g, moduli in MPa, the rest in SI."""

from __future__ import annotations

GRAVITY = 9.80665

_FACTORS = {"m s-2": (1.0 / GRAVITY, "g"), "Pa": (1e-6, "MPa")}
_TEXT = {
    "s-1": "s⁻¹", "m s-1": "m s⁻¹", "rad s-1": "rad s⁻¹", "kg m-3": "kg m⁻³", "N m-2": "N m⁻²", "N s m-2": "N s m⁻²",
    "N m-1": "N m⁻¹", "N s m-1": "N s m⁻¹",
}  # fmt: skip

_ENDINGS = {"rest": "at rest", "rocking": "rocked", "outside_model": "outside the model"}


def spoken(status: str) -> str:
    """A word of `models.base.STATUS` as a sentence has it."""
    return _ENDINGS.get(status, status.replace("_", " "))


def title(name: str) -> str:
    """A parameter's or output's name in words."""
    words = name.replace("_", " ").replace(".", ": ").split(" ")
    return " ".join(word.upper() if word == "pga" else word for word in words)


def unit_shown(unit: str) -> tuple[float, str]:
    """The factor from an SI ``unit`` of a cube to the unit that is shown, and that unit's name."""
    return _FACTORS.get(unit, (1.0, _TEXT.get(unit, unit)))
