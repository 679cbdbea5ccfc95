"""A model with mechanisms that no real one has, so that every rule of plans can be broken."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import Mechanism, MechanismParameter, Parameter, Values
from models.housner.block import Block
from models.housner.model import MODEL as HOUSNER
from models.housner.model import Housner
from models.mechanisms import acting_on


def _mechanism(name: str, *parameters: MechanismParameter) -> Mechanism:
    return Mechanism(name, name, parameters, "", "", "")


STOP = _mechanism(
    "stop",
    MechanismParameter("stiffness", "k", "N m", "stiffness of the stop", 0.0, 1e6),
    MechanismParameter("gap", "g", "rad", "rotation at which the stop acts", 0.0, 0.1, shape=True),
)
SLIP = _mechanism(
    "slip",
    MechanismParameter("friction", "mu", "1", "friction", 0.03, 1.5, null=np.inf, fit_inverse=True),
)
KAPPA = _mechanism(
    "vertical_acceleration", MechanismParameter("kappa", "k", "1", "share of the vertical motion", 0.0, 1.5)
)


class FakeWall(Housner):
    """Housner's block with a stop, a slipping base and one number that has no default."""

    name = "fake_wall"
    parameters = (
        *Housner.parameters,
        Parameter("cover", "c", "m", "thickness of the cover", 0.0, 0.1),
    )

    @property
    def mechanisms(self) -> Mapping[str, Mechanism]:
        known = acting_on("housner")
        kept = {name: known[name] for name in ("pivot_inset", "restitution")}
        return {**kept, "stop": STOP, "slip": SLIP, "vertical_acceleration": KAPPA}

    def build(
        self, values: Values, options: Mapping[str, str] | None = None, *, vertical: bool = False, size: int = 1
    ) -> Block:
        own = ("cover", "stop", "slip")
        real = {name: value for name, value in values.items() if name.partition(".")[0] not in own}
        return HOUSNER.build(real, options, vertical=vertical, size=size)
