"""What may repair predictions of outcomes: mechanisms of the wall and what the base's accelerometer does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from diagnosis.fit.setup import vertical_acts
from diagnosis.fit.unknowns import Unknown, library, of_parameter
from grids.instruments import INSTRUMENTS
from grids.instruments.base import Level
from grids.motions import Motion
from grids.specimen import Specimen
from models.base import Mechanism
from models.model import Model


@dataclass(frozen=True)
class Repair:
    """A mechanism with the unknowns that switch it on."""

    mechanism: Mechanism
    unknowns: tuple[Unknown, ...]

    @property
    def name(self) -> str:
        return self.mechanism.name


def repairs(model: Model, specimen: Specimen, motions: Sequence[Motion]) -> tuple[tuple[Repair, ...], dict[str, str]]:
    """Every mechanism that can change an outcome and is not switched on; and why others were not tried."""
    found, refused = [], {}
    for name, mechanism in library(model).items():
        if name in specimen.mechanisms or mechanism.tabulated:
            continue
        if why := _why_not(name, mechanism, motions, vertical_acts(specimen, model, ())):
            refused[name] = why
            continue
        found.append(Repair(mechanism, tuple(of_parameter(mechanism, p) for p in mechanism.parameters)))
    return tuple(found), refused


def _why_not(name: str, mechanism: Mechanism, motions: Sequence[Motion], vertical: bool) -> str:
    if name in INSTRUMENTS and "base" not in mechanism.acts:
        return "an instrument of the response changes no outcome"
    if any(p.stiff for p in mechanism.parameters):
        return "its equations are stiff: too costly for so many runs"
    if any(isinstance(p, Level) for p in mechanism.parameters):
        return "its level is given over a peak that was not recorded"
    if name == "vertical_acceleration" and vertical:
        return "the vertical motion of the base acts in the base model already"
    if name == "vertical_acceleration" and any(motion.vertical is None for motion in motions):
        return "not all motions have a vertical component"
    return ""
