"""Rigid blocks: this program against MuJoCo, what both can say."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipk, ellipkinc

import models
from benchmarks.independent.mujoco_blocks import Body, run
from benchmarks.independent.table import Row
from models.shaking import Shaking

G = 9.81
BLOCK = Body(0.25, 1.0, 1000.0)
ALPHA = math.atan2(BLOCK.half_width, BLOCK.half_height)
RADIUS = math.hypot(BLOCK.half_width, BLOCK.half_height)
P = math.sqrt(BLOCK.mass * G * RADIUS / (BLOCK.inertia + BLOCK.mass * RADIUS**2))
STACK_A = (Body(0.5, 1.5, 1000.0), Body(0.3, 0.6, 500.0))
STACK_B = (Body(0.5, 1.5, 1000.0), Body(0.3, 1.6, 500.0))
MOVED = 2e-6
"""rad: beyond the elastic rotation of the contacts, far below what rocking reaches in the time given."""
Signal = NDArray[np.float64]


def swings(theta: Signal) -> list[tuple[int, float]]:
    """Index of the end and peak |theta| of each stretch between changes of sign."""
    cuts = np.flatnonzero(np.diff(np.sign(theta)) != 0.0)
    edges = [0, *(cuts + 1).tolist()]
    return [(end, float(np.max(np.abs(theta[start:end])))) for start, end in pairwise(edges)]


def impact(theta: Signal, rate: Signal, step: float) -> tuple[float, float]:
    """Time at which theta first changes its sign, and the speed there, both from the last samples before."""
    end = next(end for end, peak in swings(theta) if peak > MOVED)
    past = theta[end - 1] / (theta[end - 1] - theta[end])
    return (end - 1 + past) * step, float(abs(rate[end - 1] + past * (rate[end - 1] - rate[end - 2])))


def restitution(before: float, after: float) -> float:
    """e of the impact between two peaks: e^2 = [cos(alpha - after) - cos alpha]/[cos(alpha - before) - cos alpha]."""
    return math.sqrt((math.cos(ALPHA - after) - math.cos(ALPHA)) / (math.cos(ALPHA - before) - math.cos(ALPHA)))


def free_rocking(steps: tuple[float, ...] = (4e-4, 1e-4, 2.5e-5)) -> list[Row]:
    """One block let go at .6 alpha: quarter period and velocity at the impact in closed form (Housner)."""
    start = 0.6 * ALPHA
    k = math.cos((ALPHA - start) / 2.0)
    phi = math.asin(math.cos(ALPHA / 2.0) / k)
    quarter = float(ellipk(k * k) - ellipkinc(phi, k * k))
    speed = math.sqrt(2.0 * (math.cos(ALPHA - start) - math.cos(ALPHA)))
    rows = []
    for step in steps:
        theta, rate = run((BLOCK,), np.zeros(round(1.0 / step)), step, G, rotation=start)[:, 0]
        time, fastest = impact(theta, rate, step)
        setting = f"step {step * 1e3:g} ms"
        rows += [
            Row("quarter period from .6 alpha", "1/p", setting, quarter, time * P),
            Row("velocity before that impact", "p", setting, speed, fastest / P),
        ]
    return rows


def impacts(
    contacts: tuple[tuple[float, float], ...] = ((1e-4, 1.0), (1e-3, 1.0), (1e-2, 1.0), (1e-3, 0.2), (1e-3, 0.05)),
) -> list[Row]:
    """Restitution of the first two impacts of one block, by the peaks between them."""
    start, step, housner = 0.6 * ALPHA, 5e-5, 1.0 - 1.5 * math.sin(ALPHA) ** 2
    rows = []
    for contact, damping in contacts:
        theta = run((BLOCK,), np.zeros(round(3.5 / step)), step, G, rotation=start, contact=contact, damping=damping)
        peaks = [peak for _, peak in swings(theta[0, 0])]
        setting = f"contact {contact * 1e3:g} ms, damping ratio {damping:g}"
        rows += [
            Row(f"restitution of impact {k + 1}", "1", setting, housner, restitution(peaks[k], peaks[k + 1]))
            for k in range(2)
        ]
    return rows


def values_of(stack: tuple[Body, Body]) -> dict[str, float]:
    wall, top = stack
    return {
        "wall_length": 2.0 * wall.half_width, "wall_height": 2.0 * wall.half_height, "wall_mass": wall.mass,
        "top_length": 2.0 * top.half_width, "top_height": 2.0 * top.half_height, "top_mass": top.mass, "gravity": G,
    }  # fmt: skip


def ours_pushed(stack: tuple[Body, Body], push: float, duration: float) -> Signal:
    """Rotations of both blocks after ``duration`` of the base acceleration ``push`` g."""
    shaking = Shaking(0.01, np.full(round(duration / 0.01) + 1, push * G))
    found = models.get("stacked").simulate(values_of(stack), shaking, duration=duration).channels
    return np.array([found["rotation_1"][-1], found["rotation_2"][-1]])


def pushed(stack: tuple[Body, Body], push: float, duration: float, step: float) -> Signal:
    """The same in MuJoCo."""
    return run(stack, np.full(round(duration / step), push * G), step, G, settle=0.1)[0, :, -1]


def patterns(step: float = 5e-5, duration: float = 0.15) -> list[Row]:
    """Rotations of both blocks under a constant base acceleration: the pattern that starts, and its pace."""
    rows = []
    for name, stack, pushes in (
        ("A", STACK_A, (0.22, 0.24, 0.5, 2.0, 3.2)),
        ("B", STACK_B, (0.18, 0.195, 0.215, 0.25, 1.45)),
    ):
        for push in pushes:
            ours = ours_pushed(stack, push, duration)
            theirs = pushed(stack, push, duration, step)
            setting = f"step {step * 1e3:g} ms"
            rows += [
                Row(
                    f"stack {name}, {push:g} g for {duration:g} s: rotation of block {body + 1}", "rad", setting,
                    float(ours[body]), _quiet(float(theirs[body])),
                )
                for body in range(2)
            ]  # fmt: skip
    return rows


def _quiet(rotation: float) -> float:
    """Elastic rotations of contacts at rest count as none."""
    return rotation if abs(rotation) > 2e-7 else 0.0


def thresholds(step: float = 5e-5, halvings: int = 13) -> list[Row]:
    """Base accelerations at which another pattern is found after a while, by bisection in both programs.

    Not the pattern that starts: once the upper block leans, the wall under it needs another push than at rest.
    """

    def wall_up(theta: Signal) -> bool:
        return bool(abs(theta[0]) > MOVED)

    def top_up(theta: Signal) -> bool:
        return bool(abs(theta[1]) > MOVED)

    def as_one(theta: Signal) -> bool:
        return bool(abs(theta[1] - theta[0]) < MOVED)

    def opposed(theta: Signal) -> bool:
        return bool((theta[1] - theta[0]) * theta[0] < 0.0 and abs(theta[1] - theta[0]) > MOVED)

    rows = []
    for name, stack, becomes, low, high, time in (
        ("stack A: rocks as one body", STACK_A, wall_up, 0.2, 0.25, 0.3),
        ("stack B: the upper block rocks", STACK_B, top_up, 0.17, 0.2, 0.3),
        ("stack B: both rock", STACK_B, wall_up, 0.195, 0.215, 0.1),
        ("stack B: rocks as one body", STACK_B, as_one, 0.215, 0.24, 0.1),
        ("stack B: opposed signs", STACK_B, opposed, 1.2, 1.5, 0.03),
    ):
        found = []
        for rotations in (ours_pushed, partial(pushed, step=step)):
            least, most = low, high
            for _ in range(halvings):
                middle = 0.5 * (least + most)
                reached = becomes(rotations(stack, middle, duration=time))
                least, most = (least, middle) if reached else (middle, most)
            found.append(0.5 * (least + most))
        rows.append(Row(f"{name} after {time:g} s", "g", f"step {step * 1e3:g} ms", found[0], found[1]))
    return rows


def pulses(step: float = 5e-5, fine: float = 1e-4) -> list[Row]:
    """One full sine of .8 s: up to the first impact, and the largest rotation of all (pi/2: overturned)."""
    period, duration = 0.8, 3.0

    def sine(time: Signal, amplitude: float) -> Signal:
        return np.where(time < period, amplitude * np.sin(2.0 * np.pi * time / period), 0.0)

    ours_time: Signal = fine * np.arange(round(period / fine) + 1, dtype=np.float64)
    theirs_time: Signal = (np.arange(round(duration / step), dtype=np.float64) + 0.5) * step
    rows = []
    block = {"width": 2 * BLOCK.half_width, "height": 2 * BLOCK.half_height, "mass": BLOCK.mass, "gravity": G}
    for name, model, values, bodies, amplitude in (
        ("block, 1.2 g tan alpha", "housner", block, (BLOCK,), 1.2 * G * math.tan(ALPHA)),
        ("block, 1.8 g tan alpha", "housner", block, (BLOCK,), 1.8 * G * math.tan(ALPHA)),
        ("stack A, .35 g", "stacked", values_of(STACK_A), STACK_A, 0.35 * G),
    ):
        shaking = Shaking(fine, sine(ours_time, amplitude))
        ours = models.get(model).simulate(values, shaking, duration=duration)
        theirs = run(bodies, sine(theirs_time, amplitude), step, G, settle=0.1)
        mine = {"theta": ours.channels["rotation_1"], "rate": ours.channels["rotation_rate_1"]}
        setting = f"step {step * 1e3:g} ms"
        first = [_first(mine["theta"], mine["rate"], fine), _first(theirs[0, 0], theirs[1, 0], step)]
        for what, unit, k in (
            ("peak before the first impact", "rad", 0), ("time of the first impact", "s", 1),
            ("velocity before it", "rad/s", 2), ("largest rotation", "rad", 3),
        ):  # fmt: skip
            rows.append(Row(f"{name}: {what}", unit, setting, first[0][k], first[1][k]))
    return rows


def _first(theta: Signal, rate: Signal, step: float) -> tuple[float, float, float, float]:
    peak = next(peak for _, peak in swings(theta) if peak > MOVED)
    return peak, *impact(theta, rate, step), min(float(np.max(np.abs(theta))), math.pi / 2.0)
