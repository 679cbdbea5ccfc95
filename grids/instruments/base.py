"""What an instrument does to a signal, declared as a `Mechanism` of the recording, not of the wall.

``acts`` holds, by the place where the instrument enters:

* ``base``: (shaking, values) -> shaking; the motion the base really makes, from the measured one;
* ``clock``: values -> (rate, lag); recorded(t) = true((1 + rate) t - lag) for every response;
* ``response``: (channels, values, surroundings) -> channels as the instrument records them;
* ``lag`` and ``windowed``, for an instrument with a memory: values -> s by which it lags, and its
  response advanced by this lag, as windows use it (they then need the motion for ``lag`` longer); ``ahead``: values
  -> s after a sample that its response there depends on; ``reach``: values -> samples beyond these;
* ``whole`` in place of ``response``: the same of an instrument that looks at all of a recording, and cannot be
  applied to a window.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.kinematics import Place

Channels = Mapping[str, FloatArray]
"""Response channels ``(..., samples)`` by name."""


Switched = Mapping[str, Mapping[str, float]]
"""Parameter values by mechanism, as in `Specimen.mechanisms`; other mechanisms are passed over."""


@dataclass(frozen=True)
class Surroundings:
    """What an instrument may need beside its own signal.

    ``base_acceleration`` (..., samples): the horizontal one that the base makes, at the samples of the channels and on
    their clock, in m s-2.
    ``reference_peak``: the rotation (rad) over which levels are given; None: the largest of the run itself.
    ``start`` (..., 1): time (s) of the first sample since the start of the recording. ``began``: the time (s) at which
    an instrument by its name began to act, where that is within the recording. ``places``: what channels measure that
    are no standard ones.
    """

    time_step: float
    base_acceleration: FloatArray
    reference_peak: float | None = None
    start: FloatArray | float = 0.0
    began: Mapping[str, float] = field(default_factory=dict)
    places: Mapping[str, Place] = field(default_factory=dict)

    @property
    def time(self) -> FloatArray:
        """Times (..., samples) since the start of the recording, in s."""
        return np.asarray(self.start + self.time_step * np.arange(self.base_acceleration.shape[-1]))

    def time_of(self, instrument: str) -> FloatArray:
        """Times (..., samples) since an instrument acts, in s, 0 before."""
        return np.maximum(self.time - self.began.get(instrument, 0.0), 0.0)

    def peak(self, channels: Channels) -> float:
        """The rotation (rad) over which levels are given; without one, the largest of the first rotation channel."""
        if self.reference_peak is not None:
            return self.reference_peak
        return next((float(abs(x).max()) for name, x in channels.items() if self.is_rotation(name)), 0.0)

    def is_rotation(self, channel: str) -> bool:
        """Whether a channel is a rotation (not its rate)."""
        if channel in self.places:
            return self.places[channel].quantity == "rotation"
        return channel.startswith("rotation_") and "rate" not in channel

    def is_displacement(self, channel: str) -> bool:
        """Whether a channel is a displacement of a body or a level as a laboratory records it, and not its state.

        One at a position, which has another name, is what an instrument reads there.
        """
        return channel.startswith(("displacement_", "level_displacement_")) and "_z" not in channel


class Level(MechanismParameter):
    """A parameter given over the reference peak of the recordings (`Surroundings.reference_peak`)."""


class Whole(MechanismParameter):
    """A parameter that is a whole number, from ``low`` to ``high``."""
