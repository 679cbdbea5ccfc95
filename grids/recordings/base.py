"""A recording of a shake-table test: the measured base motion and responses, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError, nearest
from models.kinematics import Place
from models.shaking import Shaking

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Channel:
    """A standard channel: ``response`` to the base, or the base itself; ``by_level`` (level, time)."""

    unit: str
    meaning: str
    response: bool = True
    by_level: bool = False


CHANNELS: Mapping[str, Channel] = {
    "base_acceleration_x": Channel("m s-2", "horizontal acceleration of the base, to the right", False),
    "base_acceleration_z": Channel("m s-2", "vertical acceleration of the base, positive up", False),
    "base_displacement_x": Channel("m", "horizontal displacement of the base", False),
    "rotation_1": Channel("rad", "rotation of the block (of two: the lower) against the base, clockwise positive"),
    "rotation_2": Channel("rad", "rotation of the upper block against the base, clockwise positive"),
    "rotation_rate_1": Channel("rad s-1", "angular velocity of the block (of two: the lower)"),
    "rotation_rate_2": Channel("rad s-1", "angular velocity of the upper block"),
    "displacement_1_x": Channel("m", "horizontal displacement of the centre of the block (of two: the lower)"),
    "displacement_2_x": Channel("m", "horizontal displacement of the upper block's centre"),
    "contact_1": Channel("1", "share of the base joint in contact"),
    "contact_2": Channel("1", "share of the top joint in contact"),
    "level_acceleration_x": Channel("m s-2", "absolute horizontal acceleration of a level", by_level=True),
    "level_displacement_x": Channel("m", "horizontal displacement of a level", by_level=True),
}
REQUIRED = "base_acceleration_x"
SHARE = "1"
"""Unit of a share of contact, which a simulation writes and no instrument measures."""


@dataclass(frozen=True, eq=False)
class Recording:
    """Channels ``(n_times,)``, or ``(n_levels, n_times)`` over ``levels``, at a uniform ``time_step``.

    ``levels``: the number of each row's level. ``places``: what channels measure that are no standard ones.
    ``estimated``: channels that were not recorded but follow from those that were. ``band_limited``: the base motion is
    smooth between samples, as a logger's is; else linear, as a simulation's (`models.shaking.Shaking`). ``time``
    (n_times,) starts at 0 s. ``lost``: samples of channels that hold no measurement and are not compared. ``notes``
    say what was done while reading, ``suspicions`` what looks wrong with the data but may be right; ``source``: the
    file and what it says of itself.
    """

    name: str
    time_step: float
    time: FloatArray
    channels: Mapping[str, FloatArray]
    levels: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    suspicions: tuple[str, ...] = ()
    source: Mapping[str, str] = field(default_factory=dict)
    places: Mapping[str, Place] = field(default_factory=dict)
    estimated: frozenset[str] = frozenset()
    band_limited: bool = False
    lost: Mapping[str, NDArray[np.intp]] = field(default_factory=dict)

    def __repr__(self) -> str:
        lines = [
            f"Recording {self.name}: {self.time.size} samples at {self.time_step:g} s "
            f"({self.time[-1]:.4g} s), {', '.join(self.channels)}"
        ]
        lines += [f"  note: {note}" for note in self.notes]
        lines += [f"  suspicion: {suspicion}" for suspicion in self.suspicions]
        return "\n".join(lines)

    @property
    def responses(self) -> tuple[str, ...]:
        """The channels that a model is compared with."""
        return tuple(name for name in self.channels if self.channel(name).response and name not in self.estimated)

    def channel(self, name: str) -> Channel:
        """What a channel is, by its name or by its place."""
        place = self.places.get(name)
        return CHANNELS[name] if place is None else Channel(place.unit, place.meaning)

    def shaking(self, vertical: bool, *, vertical_acts: bool = True) -> Shaking:
        """The measured motion of the base, with its vertical component or without; see `Shaking`.

        Raises InputError when the vertical one is asked for and was not recorded.
        """
        if vertical and "base_acceleration_z" not in self.channels:
            raise InputError(
                f"{self.name}: base_acceleration_z was not recorded; set [motion] vertical = false or add it."
            )
        return Shaking(
            self.time_step,
            self.channels[REQUIRED],
            self.channels["base_acceleration_z"] if vertical else None,
            vertical_acts,
            self.band_limited,
        )


@dataclass(frozen=True)
class Raw:
    """What a file holds before it is checked: channels in SI as they stand in the file."""

    time_step: float
    start: float
    channels: Mapping[str, FloatArray]
    levels: tuple[str, ...]
    notes: tuple[str, ...]
    source: Mapping[str, str]
    places: Mapping[str, Place]
    band_limited: bool = True
    suspicions: tuple[str, ...] = ()


def unknown_channel(name: str) -> str:
    """End of a sentence about a name that is no standard channel."""
    return f"'{name}' is no standard channel and does not say its quantity; {nearest(name, CHANNELS)}"
