"""Walls on no-tension layers: this program against OpenSeesPy with fibres, springs or sections."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from benchmarks import opensees
from benchmarks.independent.table import Row
from grids.motions import read_motion
from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.layered import LayeredWall
from models.interface.model import MODEL
from models.interface.reference import run as reference
from models.interface.strip import strip
from models.runs import Request
from models.shaking import Shaking

G = 9.81
WORDS = MODEL.resolve_options({"kinematics": "midpoint_held", "dashpot": "A"})
"""What OpenSees can do: the midpoint held, the dashpot of fibres in contact."""
WALL = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_thickness": 0.138, "wall_density": 900.0, "top_mass": 5000.0,
    "top_length": 2.0, "top_height": 0.6, "gravity": G,
}  # fmt: skip
TWO_LAYERS = {**WALL, "layer_thickness": 0.01, "layer_modulus": 4.5e6, "damping_ratio": 0.0544}
ONE_LAYER = {**WALL, "base_layer_thickness": 0.01, "base_layer_modulus": 4.5e6, "base_damping_ratio": 0.0544}
"""The illustrative short wall: between two layers, and on one with the top block bonded."""
WALLS = (("one layer", ONE_LAYER, "base"), ("two layers", TWO_LAYERS, "both"))
STIFFNESS = 1e7
"""Of the strip under the block of 1000 kg, N/m2."""


def wall(values: dict[str, float], joints: str, vertical: bool) -> LayeredWall:
    return MODEL.build(values, {**WORDS, "joints": joints}, vertical=vertical)


def block() -> LayeredWall:
    """1000 kg, half height 1 m, b/h = 1/4, on an undamped strip (a slice of the block is the top body)."""
    low, high = 1.98, 0.02
    values = {
        "wall_length": 0.5, "wall_height": low, "wall_mass": 500.0 * low, "top_mass": 500.0 * high,
        "top_length": 0.5, "top_height": high, "base_layer_thickness": 0.01, "base_stiffness": STIFFNESS,
        "base_damping": 0.0, "gravity": G,
    }  # fmt: skip
    return wall(values, "base", False)


def record(seconds: float) -> Shaking:
    """The strongest part of the shipped record, both components."""
    motion = read_motion("ridgecrest_2019_clc").shaking()
    peak = int(np.argmax(np.abs(motion.horizontal)))
    first = max(0, peak - round(0.55 * seconds / motion.time_step))
    span = slice(first, first + round(seconds / motion.time_step))
    return Shaking(
        motion.time_step, motion.horizontal[span], None if motion.vertical is None else motion.vertical[span]
    )


def uplift_curve(fibres: tuple[int, ...] = (10, 20, 40, 80)) -> list[Row]:
    """Restoring moment of one strip under a constant weight W, over W b, against the closed form."""
    b, k, weight = 0.36, 6.21e7, 5.0e4
    uplift = weight / (2.0 * k * b * b)
    shares = (0.5, 2.0, 10.0)
    rows = []
    for way in opensees.WAYS:
        for count in fibres:
            found = opensees.moments(b, k, weight, [share * uplift for share in shares], count, way)
            for share, moment in zip(shares, found, strict=True):
                lean = share * uplift
                z = -weight / (2.0 * k * b) if share <= 1.0 else lean * (b - math.sqrt(2.0 * weight / (k * lean)))
                exact = strip(b, k, 0.0, z, math.sin(lean)).moment
                what = f"moment at {share:g} theta_u, over W b"
                rows.append(Row(what, "1", f"{count} {way}", exact / (weight * b), moment / (weight * b)))
    return rows


def frequencies(fibres: tuple[int, ...] = (20, 80), ways: tuple[str, ...] = opensees.WAYS) -> list[Row]:
    """Natural frequencies of the illustrative short wall at rest, gravity included."""
    rows = []
    for name, values, joints in WALLS:
        body = wall(values, joints, False)
        ours = np.sqrt(modes.at_rest(body).squares[0]) / (2.0 * math.pi)
        for way in ways:
            for count in fibres:
                theirs = opensees.frequencies(body, count, way)
                rows += [
                    Row(f"{name}, frequency {k}", "Hz", f"{count} {way}", float(mine), float(other))
                    for k, (mine, other) in enumerate(zip(ours, theirs, strict=True), start=1)
                ]
    return rows


def free_rocking(
    settings: tuple[tuple[str, int, float], ...] = (
        ("springs", 20, 2e-3),
        ("springs", 20, 1e-3),
        ("springs", 40, 1e-3),
        ("springs", 80, 1e-3),
        ("section", 20, 1e-3),
        ("section", 40, 1e-3),
        ("section", 80, 1e-3),
        ("section", 80, 5e-4),
    ),
    shares: tuple[float, ...] = (0.3, 0.6),
) -> list[Row]:
    """A block on an undamped strip let go at a share of alpha: quarter period and the peak on the other side."""
    body = block()
    half, weight, alpha = float(body.base_half_width[0]), 1000.0 * G, float(body.slenderness[0])
    rows = []
    for share in shares:
        start = share * alpha
        lean = math.sin(start)
        z = lean * (half - math.sqrt(2.0 * weight / (STIFFNESS * lean)))
        begun = {"rotation_1": start, "rotation_2": start, "displacement_z_1": z}
        still = Shaking.silence(2.0, 1e-3)
        request = Request(
            still, np.ones(1), initial={k: np.array([v]) for k, v in begun.items()}, samples=still.horizontal.size
        )
        ours = reference.run(body, request).samples[0, :, 0]
        exact = _crossing(ours, 1e-3), float(np.min(ours))
        for way, fibres, step in settings:
            still = Shaking.silence(2.0, step)
            theirs, _ = opensees.history(
                body, still, 1.0, step=step, steps=round(2.0 / step), fibres=fibres, way=way, rotation=start
            )
            setting = f"{fibres} {way}, step {step * 1e3:g} ms"
            rows += [
                Row(f"quarter period from {share:g} alpha", "s", setting, exact[0], _crossing(theirs[0], step)),
                Row(f"peak after, from {share:g} alpha", "rad", setting, -exact[1], -float(np.min(theirs[0]))),
            ]
    return rows


def _crossing(theta: NDArray[np.float64], step: float) -> float:
    k = int(np.argmax(theta < 0.0))
    return float((k - 1 + theta[k - 1] / (theta[k - 1] - theta[k])) * step)


def shaken(
    settings: tuple[tuple[str, int, int], ...] = (
        ("section", 20, 1),
        ("section", 80, 1),
        ("section", 80, 4),
        ("section", 320, 8),
    ),
    levels: tuple[float, ...] = (0.1, 0.2, 0.3),
    seconds: float = 10.0,
) -> list[Row]:
    """The short wall under the record: peak rotation of the wall, and the rms difference of its history.

    Against this program at a sixteenth of its step; ``lanes`` is this program at its own step.
    """
    shaking = record(seconds)
    rows = []
    for name, values, joints in WALLS:
        body = wall(values, joints, True)
        per = int(lanes.substeps(body, modes.at_rest(body).squares, shaking.time_step)[0])
        for level in levels:
            scale = level * G / shaking.pga
            exact = rotations(body, shaking, scale, 16)
            found = {f"lanes, step {shaking.time_step / per * 1e3:g} ms": rotations(body, shaking, scale)}
            for way, fibres, finer in settings:
                theirs = opensees_rotations(body, shaking, scale, per * finer, fibres, way)
                found[f"{fibres} {way}, step {shaking.time_step / per / finer * 1e3:g} ms"] = theirs
            for setting, theirs in found.items():
                peaks = float(np.max(np.abs(exact))), float(np.max(np.abs(theirs)))
                rows += [
                    Row(f"{name}, {level:g} g: peak rotation of the wall", "rad", setting, *peaks),
                    Row(f"{name}, {level:g} g: rms difference over rms", "1", setting, 0.0, apart(theirs, exact)),
                ]
    return rows


def rotations(body: LayeredWall, shaking: Shaking, scale: float, refinement: int = 1) -> NDArray[np.float64]:
    """The wall's rotation by this program, at the samples of the shaking."""
    request = Request(shaking, np.array([scale]), samples=shaking.horizontal.size)
    return np.asarray(lanes.run(body, request, refinement).samples[0, :, 0])


def opensees_rotations(
    body: LayeredWall, shaking: Shaking, scale: float, per: int, fibres: int, way: str
) -> NDArray[np.float64]:
    """The same by OpenSees, in ``per`` steps a sample."""
    steps = (shaking.horizontal.size - 1) * per
    found, _ = opensees.history(body, shaking, scale, step=shaking.time_step / per, steps=steps, fibres=fibres, way=way)
    return found[0, ::per]


def apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Root mean square of the difference over that of ``other``."""
    return float(np.sqrt(np.mean((one - other) ** 2) / np.mean(other**2)))
