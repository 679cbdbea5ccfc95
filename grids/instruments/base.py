"""What an instrument does to a signal, declared as a `Mechanism` of the recording, not of the wall.

``acts`` holds, by the place where the instrument enters:

* ``base``: (shaking, values) -> shaking; the motion the base really makes, from the measured one;
* ``clock``: values -> (rate, lag); recorded(t) = true((1 + rate) t - lag) for every response;
* ``response``: (channels, values, surroundings) -> channels as the instrument records them;
* ``lag`` and ``windowed``, for an instrument with a memory: values -> s by which it lags, and its
  response advanced by this lag, as windows use it (they then need the motion for ``lag`` longer).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from models.base import FloatArray, Values
from models.shaking import Shaking

Channels = Mapping[str, FloatArray]
"""Response channels ``(..., samples)`` by standard name."""


@dataclass(frozen=True)
class Surroundings:
    """What an instrument may need beside its own signal.

    ``base_acceleration`` (..., samples): the measured horizontal one, at the samples of the channels.
    """

    time_step: float
    base_acceleration: FloatArray


BaseAct = Callable[[Shaking, Values], Shaking]
ClockAct = Callable[[Values], tuple[float, float]]
ResponseAct = Callable[[Channels, Values, Surroundings], Channels]

REFERENCE_MEANING = "rotation that the level refers to; 0: the largest of the run itself"


def is_rotation(channel: str) -> bool:
    """Whether a channel is a rotation (not its rate)."""
    return channel.startswith("rotation_") and "rate" not in channel


def reference_peak(channels: Channels, values: Values) -> float:
    """The rotation (rad) that a level or offset is given over."""
    given = float(values["reference_peak"])
    if given > 0.0:
        return given
    return float(abs(channels["rotation_1"]).max())
