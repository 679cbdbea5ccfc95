"""A building on rubber in shear: one level against the closed form, and a uniform chain."""

from __future__ import annotations

from functools import partial

import numpy as np

import models
from models.shaking import Shaking
from study.verify.base import Oracle

MODEL = models.get("isolated")
BODY = {"levels": 1.0, "total_mass": 3e5, "bearing_stiffness": 3e6, "rubber_thickness": 0.15}
RATIO = 0.05


def peak_under_a_step() -> float:
    """Peak displacement under a constant acceleration of 1 m s-2."""
    omega = np.sqrt(BODY["bearing_stiffness"] / BODY["total_mass"])
    values = {**BODY, "bearing_damping": 2.0 * RATIO * omega * BODY["total_mass"]}
    half = np.pi / (omega * np.sqrt(1.0 - RATIO**2))
    run = MODEL.simulate(values, Shaking(half / 200, np.ones(401)))
    return float(np.max(np.abs(run.channels["bearing_displacement"])))


def closed_peak() -> float:
    """(1 + exp(-pi xi/sqrt(1 - xi^2)))/omega^2, half a damped period after the start."""
    square = BODY["bearing_stiffness"] / BODY["total_mass"]
    return float((1.0 + np.exp(-np.pi * RATIO / np.sqrt(1.0 - RATIO**2))) / square)


def chain(mode: int) -> float:
    values = {"levels": 6, "total_mass": 12.0, "bearing_stiffness": 50.0, "storey_stiffness": 50.0}
    return float(MODEL.derive({**values, "bearing_damping": 1.5, "storey_damping": 1.5})[f"frequency_{mode}"][0])


def oracles() -> list[Oracle]:
    of = partial(Oracle, MODEL.name)
    modes = [
        of(f"frequency {k} of a uniform chain of six", "closed form",
           2.0 * 5.0 * np.sin((2 * k - 1) * np.pi / 26.0) / (2.0 * np.pi), 11.0, partial(chain, k))
        for k in (1, 4)
    ]  # fmt: skip
    return [of("peak of one level under a step", "closed form", closed_peak(), 10.0, peak_under_a_step), *modes]
