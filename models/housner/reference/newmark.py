"""The paper's integrator: Newmark's constant-average-acceleration rule (gamma = 1/2, beta = 1/4).

    theta_1 = theta_0 + h theta'_0 + h^2/4 (theta''_0 + theta''_1)
    theta'_1 = theta'_0 + h/2 (theta''_0 + theta''_1),   theta''_1 = f(theta_1, t_1)

The nonlinear equation is solved by fixed-point iteration in every step. An impact lies where a
shorter step of the same rule ends at theta = 0; the rest of the step follows on the other pivot.
Second order in the time step. A named reference method, not the default: plain blocks only (sharp
corners, no couples, no pitch, sliding, flight or flexure). Lanes are advanced together with numpy.

Source: N. M. Newmark (J. Eng. Mech. Div. ASCE 85, 1959); Mordant, Denoel, Degee (COMPDYN 2015), Eq 2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from models.base import STATUS, Event, FloatArray
from models.housner.block import Block
from models.housner.declaration import MOST_IMPACTS_PER_STEP, REST_VELOCITY
from models.housner.reference.impact import restitution
from models.runs import Request, Run

Index = NDArray[np.intp]
ITERATIONS = 50


def run(block: Block, request: Request, substeps: int = 1) -> Run:
    """n blocks as requested, ``substeps`` equal steps a sample; samples as those of `models.housner.reference.run`."""
    shaking = request.shaking
    lanes = _Lanes(block, request.scale, request.linear, request.history)
    lanes.begin(request.initial)
    step, count = shaking.time_step, request.times.size - 1
    history = np.zeros((block.size, count + 1, 3))
    history[:, 0, 0], history[:, 0, 1] = lanes.theta, lanes.rate
    vertical = np.zeros_like(shaking.horizontal) if shaking.vertical is None else shaking.vertical
    last = shaking.horizontal.size - 1
    for i in range(count):
        shaken = i < last
        ends = [(shaking.horizontal[j], vertical[j]) if shaken else (0.0, 0.0) for j in (i, min(i + 1, last))]
        (a0, v0), (a1, v1) = ends
        for k in range(substeps):
            low, high = k / substeps, (k + 1) / substeps
            lanes.step(
                (i + low) * step,
                step / substeps,
                (a0 + low * (a1 - a0), a0 + high * (a1 - a0)),
                (v0 + low * (v1 - v0), v0 + high * (v1 - v0)),
                shaken,
            )
        history[:, i + 1, 0], history[:, i + 1, 1] = lanes.theta, lanes.rate
        if lanes.over(shaken):
            history[:, i + 2 :] = history[:, i + 1, None]
            break
    return Run(lanes.outputs(), history, tuple(tuple(events) for events in lanes.events))


class _Lanes:
    """State of n blocks; ``up`` rocks, ``done`` has overturned (and fallen, when followed)."""

    def __init__(self, block: Block, scale: FloatArray, linear: bool, follow: bool) -> None:
        self.block, self.scale, self.linear, self.follow = block, scale, linear, follow
        n = block.size
        self.alpha = block.slenderness
        self.slow = REST_VELOCITY * block.frequency_parameter * self.alpha
        self.theta, self.rate, self.side = np.zeros(n), np.zeros(n), np.ones(n)
        self.largest, self.arc, self.impacts, self.earlier = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
        self.lost, self.uplift, self.friction = np.zeros(n), np.zeros(n), np.zeros(n)
        self.onset, self.fall = np.full(n, np.nan), np.full(n, np.nan)
        self.up, self.done, self.failed = np.zeros(n, bool), np.zeros(n, bool), np.zeros(n, bool)
        self.events: list[list[Event]] = [[] for _ in range(n)]

    def begin(self, initial: Mapping[str, FloatArray]) -> None:
        self.theta[:] = initial.get("rotation_1", 0.0)
        self.rate[:] = initial.get("rotation_rate_1", 0.0)
        self.up = (self.theta != 0.0) | (self.rate != 0.0)
        self.side = np.where(np.where(self.theta != 0.0, self.theta, self.rate) < 0.0, -1.0, 1.0)
        self.largest = np.maximum(np.abs(self.theta), initial.get("peak_rotation_1", 0.0))
        self.arc = np.maximum(np.abs(self.theta), initial.get("swing_peak_1", 0.0))
        self.earlier[:] = initial.get("impacts", 0.0)

    def over(self, shaken: bool) -> bool:
        """Whether nothing can happen any more."""
        resting = ~self.up & (np.abs(self.block.offset) <= self._threshold(self.block.gravity))
        return bool(np.all(self.done | self.failed | (resting & (not shaken))))

    def _pivot(self, k: Index, side: FloatArray) -> FloatArray:
        return np.where(side > 0.0, self.block.right[k], self.block.left[k])

    def _corner_inertia(self, k: Index, side: FloatArray) -> FloatArray:
        block = self.block
        return block.inertia[k] + block.mass[k] * (block.height[k] ** 2 + self._pivot(k, side) ** 2)

    def _threshold(self, gravity: FloatArray) -> FloatArray:
        return gravity * (self.alpha if self.linear else self.block.half_width / self.block.height)

    def _arms(self, k: Index, theta: FloatArray, side: FloatArray) -> tuple[FloatArray, FloatArray]:
        """X_theta and Z_theta in m."""
        h, b = self.block.height[k], self._pivot(k, side)
        if self.linear:
            radius = np.hypot(b, h)
            return radius, radius * (side * np.arctan2(b, h) - theta)
        sine, cosine = np.sin(theta), np.cos(theta)
        return side * b * sine + h * cosine, side * b * cosine - h * sine

    def _acceleration(
        self, k: Index, theta: FloatArray, side: FloatArray, a: FloatArray, gravity: FloatArray
    ) -> FloatArray:
        sway, lift = self._arms(k, theta, side)
        return -self.block.mass[k] / self._corner_inertia(k, side) * (gravity * lift + a * sway)

    def step(
        self,
        time: float,
        h: float,
        a: tuple[float, float],
        v: tuple[float, float],
        shaken: bool,
    ) -> None:
        """From ``time`` over ``h`` seconds, the base acceleration linear between the ends in ``a``, ``v``."""
        block = self.block

        def ground(k: Index, past: FloatArray) -> tuple[FloatArray, FloatArray]:
            f = past / h
            vertical = block.vertical_factor[k] * self.scale[k] * (v[0] + f * (v[1] - v[0]))
            return block.offset[k] + self.scale[k] * (a[0] + f * (a[1] - a[0])), block.gravity[k] + vertical

        past = np.where(self.done | self.failed, h, 0.0)
        for _ in range(MOST_IMPACTS_PER_STEP):
            resting = np.flatnonzero((past < h) & ~self.up)
            if resting.size:
                past[resting] = self._wait(resting, time, past[resting], h, ground)
            k = np.flatnonzero((past < h) & self.up)
            if not k.size:
                break
            past[k] = self._rock(k, time, past[k], h, ground)
        else:
            self.failed[past < h] = True
        self._overturn(time, h, ground, shaken)

    def _wait(
        self,
        k: Index,
        time: float,
        past: FloatArray,
        h: float,
        ground: Callable[..., tuple[FloatArray, FloatArray]],
    ) -> FloatArray:
        """Time into the step at which resting lanes start to rock, ``h`` where they do not."""
        first, which = np.full(k.size, np.inf), np.ones(k.size)
        for side in (1.0, -1.0):
            s = np.full(k.size, side)
            zero = np.zeros(k.size)
            ends = [self._acceleration(k, zero, s, *ground(k, t)) * side for t in (past, np.full(k.size, h))]
            rise = np.where(ends[1] > ends[0], ends[1] - ends[0], 1.0)
            later = np.where(ends[1] > 0.0, -ends[0] / rise, np.inf)
            share = np.where(ends[0] > 0.0, 0.0, later)
            which = np.where(share < first, side, which)
            first = np.minimum(first, share)
        starts = first < 1.0
        at = np.where(starts, past + np.where(starts, first, 0.0) * (h - past), h)
        for lane, t in zip(k[starts].tolist(), at[starts].tolist(), strict=True):
            self.events[lane].append(Event(time + t, "onset"))
        moving = k[starts]
        self.up[moving], self.side[moving], self.arc[moving] = True, which[starts], 0.0
        self.onset[moving] = np.where(np.isnan(self.onset[moving]), time + at[starts], self.onset[moving])
        return at

    def _rock(
        self,
        k: Index,
        time: float,
        past: FloatArray,
        h: float,
        ground: Callable[..., tuple[FloatArray, FloatArray]],
    ) -> FloatArray:
        """One Newmark step of rocking lanes to the end of the step or the next impact."""
        theta, rate, side = self.theta[k], self.rate[k], self.side[k]
        first = self._acceleration(k, theta, side, *ground(k, past))
        span = h - past
        end = ground(k, np.full(k.size, h))
        second = first.copy()
        for _ in range(ITERATIONS):
            new = theta + span * rate + span**2 / 4.0 * (first + second)
            update = self._acceleration(k, new, side, *end)
            change = np.abs(update - second) * span**2
            second = update
            if np.all(change <= 1e-15 * self.alpha[k]):
                break
        else:
            self.failed[k[change > 1e-15 * self.alpha[k]]] = True
        new = theta + span * rate + span**2 / 4.0 * (first + second)
        hits = side * new < 0.0
        if np.any(hits):
            span[hits] = self._crossing(k[hits], past[hits], span[hits], first[hits], ground)
            new[hits] = 0.0
            second[hits] = self._acceleration(k[hits], new[hits], side[hits], *ground(k[hits], past[hits] + span[hits]))
        after = rate + span / 2.0 * (first + second)
        mean = (first + second) / 2.0
        turns = rate * after < 0.0
        top = np.where(turns, np.abs(theta - rate**2 / (2.0 * np.where(turns, mean, 1.0))), np.abs(new))
        self.arc[k] = np.maximum(self.arc[k], top)
        self.largest[k] = np.maximum(self.largest[k], self.arc[k])
        self.uplift[k] += np.where(np.isnan(self.fall[k]), span, 0.0)
        self._demand(k, theta, rate, side, first, ground(k, past))
        self._demand(k, new, after, side, second, ground(k, past + span))
        self.theta[k], self.rate[k] = new, after
        now = np.where(hits, past + span, h)
        if np.any(hits):
            self._impact(k[hits], time + now[hits], ground(k[hits], now[hits]))
        return now

    def _crossing(
        self,
        k: Index,
        past: FloatArray,
        span: FloatArray,
        first: FloatArray,
        ground: Callable[..., tuple[FloatArray, FloatArray]],
    ) -> FloatArray:
        """Length of the step that ends at theta = 0, by bisection; a start at theta = 0 is divided out."""
        theta, rate, side = self.theta[k], self.rate[k], self.side[k]
        grounded = theta == 0.0
        low, high = np.zeros(k.size), span.copy()
        for _ in range(60):
            middle = (low + high) / 2.0
            second = self._acceleration(k, np.zeros(k.size), side, *ground(k, past + middle))
            chord = rate + middle / 4.0 * (first + second)
            above = side * np.where(grounded, chord, theta + middle * chord) > 0.0
            low, high = np.where(above, middle, low), np.where(above, high, middle)
        return high

    def _impact(self, k: Index, time: FloatArray, ground: tuple[FloatArray, FloatArray]) -> None:
        side, before = self.side[k], self.rate[k]
        ratio = restitution(
            self.block.take(k),
            self._pivot(k, side),
            self._pivot(k, -side),
            rate=before,
            previous_peak=self.arc[k],
            largest_peak=self.largest[k],
            impacts=self.earlier[k] + self.impacts[k],
        )
        after = ratio * before
        a, gravity = ground
        zero = np.zeros(k.size)
        stays = np.ones(k.size, bool)
        for s in (side, -side):
            stays &= s * self._acceleration(k, zero, s, a, gravity) <= 0.0
        rests = (after == 0.0) | ((np.abs(after) < self.slow[k]) & stays)
        kept = np.where(rests, 0.0, after)
        self.lost[k] += 0.5 * (self._corner_inertia(k, side) * before**2 - self._corner_inertia(k, -side) * kept**2)
        self.impacts[k] += 1.0
        self.rate[k], self.side[k], self.arc[k], self.up[k] = kept, -side, 0.0, ~rests
        for lane, t, rest in zip(k.tolist(), time.tolist(), rests.tolist(), strict=True):
            self.events[lane].append(Event(t, "impact"))
            if rest:
                self.events[lane].append(Event(t, "rest"))

    def _demand(
        self,
        k: Index,
        theta: FloatArray,
        rate: FloatArray,
        side: FloatArray,
        second: FloatArray,
        ground: tuple[FloatArray, FloatArray],
    ) -> None:
        """Largest |H|/N so far: H/M = a + X'', N/M = G + Z''; infinite where N <= 0."""
        a, gravity = ground
        sway, lift = self._arms(k, theta, side)
        across = np.abs(a + sway * second + lift * rate**2)
        up = gravity + lift * second - sway * rate**2
        demand = np.where(up > 0.0, across / np.where(up > 0.0, up, 1.0), np.inf)
        live = np.isnan(self.fall[k])
        self.friction[k] = np.where(live, np.maximum(self.friction[k], demand), self.friction[k])

    def _overturn(
        self, time: float, h: float, ground: Callable[..., tuple[FloatArray, FloatArray]], shaken: bool
    ) -> None:
        k = np.flatnonzero(self.up & ~self.done & ~self.failed)
        theta, rate, side = self.theta[k], self.rate[k], self.side[k]
        fallen = np.abs(theta) >= np.pi / 2.0
        at = np.where(fallen, time + h - (np.abs(theta) - np.pi / 2.0) / np.maximum(np.abs(rate), 1e-300), time + h)
        certain = fallen.copy()
        if not shaken:
            second = self._acceleration(k, theta, side, *ground(k, np.full(k.size, h)))
            outwards = (side * rate > 0.0) & (side * second > 0.0)
            certain |= (np.abs(theta) > self.alpha[k]) & outwards
        fresh = certain & np.isnan(self.fall[k])
        for lane, t in zip(k[fresh].tolist(), at[fresh].tolist(), strict=True):
            self.fall[lane] = t
            self.events[lane].append(Event(t, "overturned"))
        ended = fallen if self.follow else certain
        self.done[k[ended]] = True
        self.theta[k[ended]] = side[ended] * np.pi / 2.0
        self.rate[k[ended]] = 0.0

    def outputs(self) -> dict[str, FloatArray]:
        over = ~np.isnan(self.fall)
        peak = np.where(over, np.pi / 2.0, self.largest)
        moved = (self.largest > 0.0) | ~np.isnan(self.onset)
        words = np.where(self.failed, "not_converged", np.where(over, "overturned", np.where(moved, "rocking", "rest")))
        return {
            "peak_rotation": peak,
            "peak_rotation_ratio": peak / self.alpha,
            "uplift_duration": self.uplift,
            "onset_time": self.onset,
            "overturned": over.astype(float),
            "overturning_time": self.fall,
            "impacts": self.impacts,
            "residual_rotation": np.where(over, np.copysign(np.pi / 2.0, self.theta), self.theta),
            "dissipated_energy": self.lost,
            "friction_demand": self.friction,
            "status": np.array([float(STATUS.index(word)) for word in words.tolist()]),
            "swing_peak": self.arc,
        }
