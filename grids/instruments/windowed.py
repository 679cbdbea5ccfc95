"""Instruments in windows: the clock of the responses is carried by the base, and memories are advanced.

A lag or clock error of the responses is a change of the base's clock, recorded(t) = true((1 + rate) t - lag): the
base is read at (1 + rate) t - lag and a window starts where it started, so nothing is read across its start.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grids.instruments.base import Channels, Surroundings, Switched
from grids.instruments.catalogue import switched_on
from models.base import FloatArray
from models.shaking import Shaking


def samples_ahead(mechanisms: Switched, time_step: float) -> int:
    """Samples beyond a window's end for which the instruments need the motion: it then is the same in any company."""
    on = switched_on(mechanisms)
    lag = sum(one.acts[how](values) for one, values in on for how in ("lag", "ahead") if how in one.acts)
    reach = max((one.acts["reach"](values) for one, values in on if "reach" in one.acts), default=0)
    return int(np.ceil(lag / time_step)) + int(reach)


def same_base(mechanisms: Switched) -> tuple[object, ...]:
    """What two settings of the instruments must share for one motion of the base."""
    found: list[tuple[object, ...]] = []
    for one, values in switched_on(mechanisms):
        if "base" in one.acts:
            found.append((one.name, *sorted(mechanisms[one.name].items())))
        found += [(one.name, one.acts[how](values)) for how in ("clock", "lag") if how in one.acts]
    return tuple(found)


def moved_in_windows(shaking: Shaking, mechanisms: Switched) -> Shaking:
    """The motion that the base makes, on the clock of the responses."""
    rate, lag = 0.0, 0.0
    for one, values in switched_on(mechanisms):
        if "base" in one.acts:
            shaking = one.acts["base"](shaking, values)
        if "clock" in one.acts:
            more_rate, more_lag = one.acts["clock"](values)
            rate, lag = rate + more_rate, lag + more_lag
        if "lag" in one.acts:
            lag += one.acts["lag"](values)
    return read_at(shaking, rate, lag) if rate or lag else shaking


def read_at(shaking: Shaking, rate: float, lag: float) -> Shaking:
    """The shaking with sample k read at (1 + rate) t_k - lag, on a step (1 + rate) times as long."""
    end = shaking.duration
    at = (1.0 + rate) * shaking.time - lag
    inside = (at >= 0.0) & (at <= end)
    held = np.clip(at, 0.0, end)

    def read(spline: Callable[[FloatArray], FloatArray]) -> FloatArray:
        return np.where(inside, spline(held), 0.0)

    horizontal, vertical = shaking.splines
    step = (1.0 + rate) * shaking.time_step
    vertically = None if vertical is None else read(vertical)
    return replace(shaking, time_step=step, horizontal=read(horizontal), vertical=vertically)


def recorded_in_windows(channels: Channels, mechanisms: Switched, around: Surroundings) -> Channels:
    """Channels (windows, samples) as the instruments record them, clocks apart (see `moved_in_windows`)."""
    for one, values in switched_on(mechanisms):
        if "response" in one.acts:
            channels = one.acts.get("windowed", one.acts["response"])(channels, values, around)
    return channels


def remembering(mechanisms: Switched) -> Switched:
    """Those of the instruments that are on and whose output depends on what came before a window."""
    return {one.name: mechanisms[one.name] for one, _ in switched_on(mechanisms) if "windowed" in one.acts}
