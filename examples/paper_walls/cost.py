"""What each model costs: processor time for one short wall under one motion that rocks it."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from walls import TAIL, WALLS, cell, shaking, specimens

import models
from models.model import Model
from models.shaking import Shaking

PGA = 0.35
"""g: well above every onset, so that every model rocks the wall."""


def seconds(model: Model, values: dict[str, float], motion: Shaking, lanes: int, integrator: str) -> float:
    """Processor seconds for one wall, of ``lanes`` with intensities within 5 %."""
    scale = np.linspace(0.95, 1.05, lanes) if lanes > 1 else np.ones(1)
    began = time.process_time()
    model.evaluate(values, motion, scale, outputs=("peak_rotation",), tail=TAIL, integrator=integrator)
    return (time.process_time() - began) / lanes


def cost(seed: int, lanes: int = 256, repeats: int = 5) -> dict[str, tuple[float, float]]:
    """Of each model: in compiled lanes (the quickest of ``repeats``), and once alone by its plain reference."""
    wall = replace(WALLS["short"], pga=PGA)
    motion = shaking(wall, seed).shaking()
    found = {}
    for label, specimen in specimens(wall).items():
        model, values = models.get(specimen.model), cell(specimen)
        seconds(model, values, motion, lanes, "lanes")  # compiles
        fast = min(seconds(model, values, motion, lanes, "lanes") for _ in range(repeats))
        found[label] = fast, seconds(model, values, motion, 1, "reference")
    return found
