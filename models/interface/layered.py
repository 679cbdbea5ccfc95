"""The coefficients of a wall between two layers: what every integrator of the model starts from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from threading import Lock
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.interface.effects import Effects
from models.rubber import LAWS
from models.rubber.base import Numbers, RubberLaw
from models.rubber.layer import Layer

T = TypeVar("T")
MOST_KEPT, LAST = 256, 16
"""Of so many different walls at most, those of the last calls are kept with what was found for them."""
_LAST: dict[Any, LayeredWall] = {}
_LOCK = Lock()
FREE = {
    "both": np.eye(4),
    "base": np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]),
    "top": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]),
}
"""q = P p by the joints that have rubber: the other joint is bonded (theta2 = theta1, or the wall fixed)."""


@dataclass(frozen=True)
class LayeredWall:
    """Geometry, inertia and layers of n walls, one array ``(n,)`` a field, SI units.

    Body 1 (the wall): ``mass_1``, ``inertia_1`` about its centre at ``centre_1`` (h1), top at
    ``height_1`` (2 h1). Body 2: its centre at ``centre_2`` (h2) over its underside. The top layer's
    unstressed thickness ``top_thickness_in_height`` (e_t) is part of the height. The strips have half widths
    ``base_half_width`` (b1) and ``top_half_width`` (bt), stiffness (N m-2) and dashpot (N s m-2) per
    metre of contact; ``*_thickness`` turns compression into strain.

    The base acceleration is ``offset + scale a(t)``, the apparent gravity
    G = ``gravity + vertical_factor scale a_z(t)``.

    ``laws``: parameters of rubber laws beside the linear one, by ``law.parameter_joint``.
    ``joints`` (both, base, top): where the rubber is. ``toe_held``: the toe, not the midpoint of an
    uplifted underside is held laterally. ``clip``: dashpot law B. ``effects``: what mechanisms add, if any does.
    """

    mass_1: FloatArray
    inertia_1: FloatArray
    centre_1: FloatArray
    height_1: FloatArray
    mass_2: FloatArray
    inertia_2: FloatArray
    centre_2: FloatArray
    top_thickness_in_height: FloatArray
    base_half_width: FloatArray
    top_half_width: FloatArray
    base_stiffness: FloatArray
    top_stiffness: FloatArray
    base_damping: FloatArray
    top_damping: FloatArray
    base_thickness: FloatArray
    top_thickness: FloatArray
    gravity: FloatArray
    offset: FloatArray
    vertical_factor: FloatArray
    laws: Mapping[str, FloatArray] = field(default_factory=dict)
    joints: str = "both"
    toe_held: bool = True
    clip: bool = True
    effects: Effects | None = None

    @property
    def size(self) -> int:
        return int(self.mass_1.size)

    def replace(self, **changes: Any) -> LayeredWall:
        """A copy with array fields replaced; values broadcast to ``(n,)``."""
        arrays = {k: np.broadcast_to(np.asarray(v, float), self.mass_1.shape) for k, v in changes.items()}
        return self._with(arrays)

    def with_effect(self, part: str, **changes: Any) -> LayeredWall:
        """With the mechanism ``part``, which acts through fields of `Effects`."""
        return self._with({"effects": (self.effects or Effects.none(self.size)).given(part, **changes)})

    def with_law_in_table(self, values: Values) -> LayeredWall:
        """With a law in a table, see `models.interface.table`."""
        return self._with({"effects": (self.effects or Effects.none(self.size)).with_law(values)})

    def with_effects(self, effects: Effects) -> LayeredWall:
        return self._with({"effects": effects})

    def _with(self, changes: dict[str, Any]) -> LayeredWall:
        return replace(self, **changes)

    def _map(self, function: Any) -> LayeredWall:
        chosen = {f.name: getattr(self, f.name) for f in fields(self)}
        changes: dict[str, Any] = {k: function(v) for k, v in chosen.items() if isinstance(v, np.ndarray)}
        effects = None if self.effects is None else self.effects.map(function)
        return self._with({**changes, "laws": {k: function(v) for k, v in self.laws.items()}, "effects": effects})

    def take(self, index: Any) -> LayeredWall:
        """The walls selected by an index array or mask."""
        return self._map(lambda values: values[index])

    def one(self, lane: int = 0) -> Any:
        """One wall with plain floats in its fields, for code that runs a wall at a time."""
        return self._map(lambda values: float(values[lane]))

    def once(self, make: Callable[[LayeredWall], T]) -> T:
        """What ``make`` finds, arrays (n, ...), lane by lane: found once for lanes that follow one another alike."""
        if make not in self._kept:
            one, lanes = self.distinct
            self._kept[make] = make(self) if one is self else _of_lanes(one.once(make), lanes)
        return cast(T, self._kept[make])

    def of_distinct(self, make: Callable[[LayeredWall], T]) -> tuple[T, NDArray[np.intp]]:
        """What ``make`` finds for the `distinct` walls, found once, and where each of the n lies among them (n,)."""
        one, lanes = self.distinct
        if make not in one._kept:
            one._kept[make] = make(one)
        return cast(T, one._kept[make]), lanes

    @cached_property
    def distinct(self) -> tuple[LayeredWall, NDArray[np.intp]]:
        """The walls without those that are as the one before, and where each of the n lies among them (n,).

        The same as in an earlier call where they are equal: what was found for them is known.
        """
        new = np.ones(self.size, bool)
        new[1:] = False
        for values in self._arrays:
            new[1:] |= values[1:] != values[:-1]
        one = self if new.all() else self.take(np.flatnonzero(new))
        return (one if one.size > MOST_KEPT else one._known()), np.cumsum(new) - 1

    @property
    def _arrays(self) -> list[FloatArray]:
        own = [x for x in (getattr(self, f.name) for f in fields(self)) if isinstance(x, np.ndarray)]
        return [*own, *self.laws.values(), *(() if self.effects is None else self.effects.arrays.values())]

    def _known(self) -> LayeredWall:
        """The wall of the last ones that is equal to this one, if any is."""
        parts = () if self.effects is None else tuple(sorted(self.effects.parts))
        words = (self.joints, self.toe_held, self.clip, tuple(self.laws), self.effects is None, parts)
        key = words, b"".join(x.tobytes() for x in self._arrays)
        with _LOCK:
            found = _LAST.pop(key, self)
            _LAST[key] = found
            while len(_LAST) > LAST:
                _LAST.pop(next(iter(_LAST)))
        return found

    @cached_property
    def _kept(self) -> dict[Callable[[LayeredWall], Any], Any]:
        return {}

    @property
    def coordinates(self) -> int:
        """Numbers in q: theta1, theta2, z1, z2, and those of `Effects.coordinates`."""
        return 4 if self.effects is None else self.effects.coordinates

    @property
    def rubber_joints(self) -> tuple[str, ...]:
        """The joints that have a layer."""
        return ("base", "top") if self.joints == "both" else (self.joints,)

    def with_law(self, name: str, values: Values) -> LayeredWall:
        """With the law's parameters at every joint that has rubber; ``parameter_joint`` goes before ``parameter``."""
        given = {
            f"{name}.{parameter}_{joint}": np.broadcast_to(
                np.asarray(values.get(f"{parameter}_{joint}", values[parameter]), dtype=np.float64), self.mass_1.shape
            ).copy()
            for parameter in LAWS[name].parameters
            for joint in self.rubber_joints
        }
        return self._with({"laws": {**self.laws, **given}})

    def only_law(self, joint: str, name: str) -> LayeredWall:
        """With no law beside the linear one at ``joint`` but ``name``."""
        kept = {k: v for k, v in self.laws.items() if not k.endswith(f"_{joint}") or k.startswith(f"{name}.")}
        return self._with({"laws": kept})

    def laws_at(self, joint: str) -> Sequence[tuple[RubberLaw, Numbers]]:
        """The laws at ``joint`` with their numbers, in the order of the family; none where it is bonded."""
        return self.layer(joint).laws

    def layer(self, joint: str) -> Layer:
        """The rubber at ``joint``: k and the laws beside it."""
        shared = {
            "stiffness": self.base_stiffness if joint == "base" else self.top_stiffness,
            "thickness": self.base_thickness if joint == "base" else self.top_thickness,
        }
        found = []
        for name, law in LAWS.items():
            own = {p: self.laws[key] for p in law.parameters if (key := f"{name}.{p}_{joint}") in self.laws}
            if own:
                found.append((law, {**shared, **own}))
        return Layer(shared["stiffness"], found)

    @property
    def mass(self) -> FloatArray:
        """m1 + m2 in kg."""
        return self.mass_1 + self.mass_2

    @property
    def slenderness(self) -> FloatArray:
        """alpha = atan(b/h) in rad of both bodies as one on the wall's corners (layers uncompressed)."""
        centre = self.mass_1 * self.centre_1 + self.mass_2 * (
            self.height_1 + self.top_thickness_in_height + self.centre_2
        )
        return np.arctan2(self.base_half_width, centre / self.mass)

    @property
    def slenderness_2(self) -> FloatArray:
        """alpha in rad of the upper body on the top joint's ends."""
        return np.arctan2(self.top_half_width, self.centre_2)


def _of_lanes(found: Any, lanes: NDArray[np.intp]) -> Any:
    """An array (k, ...), or a dataclass of them, for every lane."""
    if isinstance(found, np.ndarray):
        return found[lanes]
    return replace(found, **{f.name: getattr(found, f.name)[lanes] for f in fields(found)})
