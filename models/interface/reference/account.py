"""What a run of the reference gathers, sample by sample, and the declared outputs made of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from models.base import STATUS, Event, FloatArray

JOINTS = ("base", "top")
Pair = tuple[float, float]


class Reading(NamedTuple):
    """What the account takes from a state; pairs are of the bodies, or of base and top."""

    rotations: Pair
    heights: Pair
    """By which each joint's freer end is from pressing; negative: full contact."""
    friction: Pair
    shares: Pair
    edges: Pair
    """Compression (m) of each joint's more compressed end."""
    stored: Pair
    """Energy (J) in the springs of each layer."""
    kinetic: float


class Account:
    """Peaks, times, energies of one run; `sample` in the order of time, then `close` or `fall`.

    ``wall``: the run's, with plain floats. ``work``: of each joint's strip on the bodies so far, in J;
    whoever integrates the motion sets it.
    """

    def __init__(self, wall: Any) -> None:
        self.wall = wall
        self.time = math.nan
        self.kinetic = 0.0
        self.peak, self.friction, self.contact, self.edge = [0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [0.0, 0.0]
        self.height = [math.nan, math.nan]
        self.up, self.onset, self.closings = [0.0, 0.0], [math.nan, math.nan], [0, 0]
        self.work, self.first, self.last = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]
        self.over = [math.nan, math.nan]
        self.moved = self.failed = False
        self.events: list[Event] = []

    @property
    def fallen(self) -> bool:
        return not all(math.isnan(t) for t in self.over)

    def sample(self, time: float, reading: Reading) -> None:
        """A state at ``time`` (s)."""
        step = 0.0 if math.isnan(self.time) else time - self.time
        self.kinetic = reading.kinetic
        for k in (0, 1):
            self.peak[k] = max(self.peak[k], abs(reading.rotations[k]))
            self.friction[k] = max(self.friction[k], reading.friction[k])
            self.contact[k] = min(self.contact[k], reading.shares[k])
            self.edge[k] = max(self.edge[k], reading.edges[k])
            if math.isnan(self.time):
                self.first[k], self.height[k] = reading.stored[k], reading.heights[k]
                if reading.heights[k] > 0.0:
                    self.onset[k] = time
            self._lift(k, time, step, reading.heights[k])
            self.last[k] = reading.stored[k]
        self.time = time

    def _lift(self, k: int, time: float, step: float, height: float) -> None:
        before = self.height[k]
        self.height[k] = height
        if before <= 0.0 and height <= 0.0:
            return
        crossing = time - step * (height / (height - before) if height * before < 0.0 else 1.0)
        if before <= 0.0 < height:
            self.up[k] += time - crossing
            self.events.append(Event(crossing, "uplift", k + 1))
            if math.isnan(self.onset[k]):
                self.onset[k] = crossing
        elif height <= 0.0:
            self.up[k] += crossing - (time - step)
            self.closings[k] += 1
            self.events.append(Event(crossing, "closing", k + 1))
        else:
            self.up[k] += step

    def fall(self, time: float, q: FloatArray) -> None:
        """A body has reached pi/2; with the wall goes what stands on it."""
        wall_down = abs(q[0]) >= math.pi / 2.0 - 1e-9
        self.over = [time if wall_down else math.nan, time]
        self.events.append(Event(time, "overturned", 1 if wall_down else 2))

    def rest(self, time: float) -> None:
        if not self.events or self.events[-1].kind != "rest":
            self.events.append(Event(time, "rest"))

    def close(self, time: float, toppled: tuple[bool, bool]) -> None:
        """The end of the run: a body past its toe and moving outwards (base, top) counts as overturned."""
        base, top = toppled
        if base or top:
            self.over = [time if base else math.nan, time]
            self.events.append(Event(time, "overturned", 1 if base else 2))

    def outputs(self, end: FloatArray) -> dict[str, float]:
        """The declared outputs."""
        half, wall = math.pi / 2.0, self.wall
        over = [not math.isnan(t) for t in self.over]
        peak = [half if o else p for o, p in zip(over, self.peak, strict=True)]
        ratio = [peak[0] / wall.slenderness, peak[1] / wall.slenderness_2]
        left = [math.copysign(half, e) if o else e for o, e in zip(over, end[:2].tolist(), strict=True)]
        lost = [s - e - w for s, e, w in zip(self.first, self.last, self.work, strict=True)]
        rubber = [wall.joints in ("both", joint) for joint in JOINTS]
        needed = [f if r else math.nan for f, r in zip(self.friction, rubber, strict=True)]
        thickness = (wall.base_thickness, wall.top_thickness)
        strain = [u / e if r else math.nan for u, e, r in zip(self.edge, thickness, rubber, strict=True)]
        found = {
            **_both("peak_rotation", "12", peak, max(peak)),
            **_both("peak_rotation_ratio", "12", ratio, max(ratio)),
            **_both("uplift_duration", "bt", self.up, max(self.up)),
            **_both("onset_time", "bt", self.onset, _earlier(self.onset)),
            **_both("minimum_contact", "bt", self.contact, min(self.contact)),
            **_both("overturned", "12", [float(o) for o in over], float(any(over))),
            **_both("overturning_time", "12", self.over, _earlier(self.over)),
            **_both("impacts", "bt", [float(n) for n in self.closings], float(max(self.closings))),
            **_both("residual_rotation", "12", left, max(left, key=abs)),
            **_both("dissipated_energy", "bt", lost, sum(lost)),
            **_both("peak_strain", "bt", strain, float(np.nanmax(strain))),
            **_both("friction_demand", "bt", needed, float(np.nanmax(needed))),
        }
        lifted = not all(math.isnan(t) for t in self.onset)
        word = "not_converged" if self.failed else "overturned" if any(over) else "rocking" if lifted else "rest"
        return {**found, "status": float(STATUS.index(word))}


def _both(name: str, ends: str, pair: Sequence[float], plain: float) -> dict[str, float]:
    first, second = ("_1", "_2") if ends == "12" else ("_base", "_top")
    return {name: plain, f"{name}{first}": pair[0], f"{name}{second}": pair[1]}


def _earlier(times: Sequence[float]) -> float:
    return min((t for t in times if not math.isnan(t)), default=math.nan)
