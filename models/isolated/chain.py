"""The coefficients of a chain of levels on bearings: what every integrator of the model starts from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.isolated.declaration import IN_SHEAR
from models.rubber import ELEMENTS
from models.rubber.base import Numbers, RubberLaw, in_sum
from models.rubber.layer import Layer


@dataclass(frozen=True)
class Chain:
    """Masses, storeys and bearings of n buildings, one array ``(n,)`` a field, SI units.

    ``masses`` (n, most levels) holds the levels' masses from the slab up, 0 beyond ``levels``. Every
    storey has ``storey_stiffness`` (N m-1) and ``storey_damping`` (N s m-1). ``thickness`` of the
    rubber (m) turns displacements into strains. ``laws``: parameters of what acts in the bearings
    beside the linear spring and dashpot, by ``mechanism.parameter``.
    """

    levels: NDArray[np.int64]
    masses: FloatArray
    storey_stiffness: FloatArray
    storey_damping: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    thickness: FloatArray
    laws: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def size(self) -> int:
        return int(self.levels.size)

    def take(self, index: Any) -> Chain:
        """The buildings selected by an index array, slice or mask."""
        chosen = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "laws"}
        changes: dict[str, Any] = {name: values[index] for name, values in chosen.items()}
        return replace(self, **changes, laws={name: values[index] for name, values in self.laws.items()})

    def with_law(self, name: str, values: Values) -> Chain:
        """With the parameters of the mechanism ``name`` in the bearings."""
        given = {
            f"{name}.{parameter}": np.broadcast_to(np.asarray(value, dtype=np.float64), self.levels.shape).copy()
            for parameter, value in values.items()
        }
        return replace(self, laws={**self.laws, **given})

    def without_laws(self, but: str) -> Chain:
        """With no rubber law beside the linear one but the elements of the kind ``but``; other mechanisms stay."""
        dropped = {name for name in IN_SHEAR if ELEMENTS[name].kind != but}
        return replace(self, laws={k: v for k, v in self.laws.items() if k.partition(".")[0] not in dropped})

    def numbers(self, name: str) -> dict[str, FloatArray] | None:
        """The parameters of one mechanism of the bearings, and k and e; None where it is not given."""
        own = {key.partition(".")[2]: values for key, values in self.laws.items() if key.startswith(f"{name}.")}
        return {**own, "stiffness": self.stiffness, "thickness": self.thickness} if own else None

    @property
    def rubber_laws(self) -> list[tuple[RubberLaw, Numbers]]:
        """The rubber laws beside the linear one with their numbers, in the order of the family."""
        given = {name: own for name in IN_SHEAR if (own := self.numbers(name)) is not None}
        return in_sum(ELEMENTS, given)

    @property
    def layer(self) -> Layer:
        """The rubber of all bearings together: k and the laws beside it."""
        return Layer(self.stiffness, self.rubber_laws)

    @property
    def mass(self) -> FloatArray:
        """Mass of all levels in kg."""
        return np.asarray(self.masses.sum(axis=1))
