"""One rigid block: free rocking, and pulses that just overturn it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from scipy.linalg import solveh_banded

import models
from models.shaking import Shaking
from study.verify.base import Oracle

MODEL = models.get("housner")
GRAVITY = 9.80665
P = 2.0
LANES = 32
HOUSNER = "Housner 1963, closed form"
ZHANG = "Zhang, Makris 2001; derived"


def rectangle(alpha: float, p: float = P, **more: float) -> dict[str, float]:
    """Solid rectangle of slenderness ``alpha`` (rad) and p (s-1): R = 3 g/(4 p^2)."""
    radius = 3.0 * GRAVITY / (4.0 * p**2)
    size = {"width": 2.0 * radius * np.sin(alpha), "height": 2.0 * radius * np.cos(alpha)}
    return {**size, "mass": 1000.0, "gravity": GRAVITY, **more}


def wave(omega: float, cycles: float, shift: float = 0.0, steps: int = 3000) -> Shaking:
    """sin(omega t + shift) for some cycles, as the piecewise linear record nearest to it in the mean square."""
    h = 2.0 * np.pi * cycles / omega / steps
    points, weights = np.polynomial.legendre.leggauss(6)
    x = (points + 1.0) / 2.0
    values = np.sin(omega * (np.arange(steps)[:, None] + x) * h + shift) * weights / 2.0 * h
    load = np.zeros(steps + 1)
    load[:-1] += values @ (1.0 - x)
    load[1:] += values @ x
    bands = np.full((2, steps + 1), 2.0 * h / 3.0)
    bands[0], bands[1, [0, -1]] = h / 6.0, h / 3.0
    return Shaking(h, solveh_banded(bands, load))


def constant(duration: float, steps: int = 200) -> Shaking:
    return Shaking(duration / steps, np.ones(steps + 1))


def threshold(
    block: Mapping[str, float], shaking: Shaking, low: float, high: float, unit: float, *, linear: bool = False,
    above: bool = True, digits: float = 1e-10,
) -> float:  # fmt: skip
    """Amplitude in ``unit``, between ``low`` and ``high``, from which on (``above``) or up to which it overturns."""
    p = float(MODEL.derive(block)["frequency_parameter"][0])
    low, high = low * unit, high * unit
    while high - low > digits * high:
        scale = np.linspace(low, high, LANES)
        # near the threshold the block lingers at its unstable equilibrium for ln(1/distance)/p
        tail = (np.log(LANES * high / (high - low)) + 8.0) / p
        options = {"formulation": "linear" if linear else "nonlinear"}
        over = MODEL.evaluate(block, shaking, scale, outputs=["overturned"], tail=tail, options=options)["overturned"]
        first = int(np.argmax(over == above))
        if first == 0:
            raise ArithmeticError(f"no threshold between {low / unit:g} and {high / unit:g}")
        low, high = float(scale[first - 1]), float(scale[first])
    return 0.5 * (low + high) / unit


def quarter_period(linear: bool) -> float:
    """p t of the first impact of a block of alpha = .25 that is let go at .15."""
    options = {"formulation": "linear" if linear else "nonlinear"}
    run = MODEL.simulate(rectangle(0.25), Shaking.silence(1.0, 0.0025), initial={"rotation_1": 0.15}, options=options)
    return P * run.events[0].time


def impact_velocity() -> float:
    """theta'/p there, from the energy the impact takes: (1 - e^2) I_O theta'^2/2."""
    block = rectangle(0.25, restitution=0.8)
    run = MODEL.simulate(block, Shaking.silence(0.9, 0.0025), initial={"rotation_1": 0.15})
    corner = block["mass"] * (block["width"] ** 2 + block["height"] ** 2) / 3.0
    return float(np.sqrt(2.0 * run.outputs["dissipated_energy"] / (corner * (1.0 - 0.8**2))) / P)


def peak_after(impacts: int) -> float:
    """theta_n/alpha of alpha = .2 let go at .8 alpha."""
    run = MODEL.simulate(rectangle(0.2), Shaking.silence(9.0, 0.001), initial={"rotation_1": 0.16})
    size = np.abs(run.channels["rotation_1"]) / 0.2
    top = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    return float(size[top][impacts - 1])


def oracles() -> list[Oracle]:
    linear = rectangle(0.2, restitution=0.9)
    thick = rectangle(0.25, restitution=0.9)
    sine = wave(5.0 * P, 1.0)
    cosine = wave(np.pi, 1.0, np.pi / 2.0, 2000)
    tilted = rectangle(np.radians(15.0), restitution=0.9)
    small, large = 0.2 * GRAVITY, 0.25 * GRAVITY
    of = partial(Oracle, MODEL.name)
    return [
        of("quarter period, alpha = .25", "elliptic integrals", 1.568974874250, 10.5, partial(quarter_period, False)),
        of("quarter period, linearised", HOUSNER, 1.566799236972, 10.5, partial(quarter_period, True)),
        of("velocity at the impact", "energy", 0.228437052894, 10.0, impact_velocity),
        of("peak after 1 impact, e = 1 - 1.5 sin^2(.2)", "energy", 0.612708, 5.4, partial(peak_after, 1)),
        of("peak after 4 impacts", "energy", 0.359602, 5.1, partial(peak_after, 4)),
        of("rectangular pulse that overturns, p t = 1", HOUSNER, 1.581976707, 9.0,
           partial(threshold, linear, constant(1.0 / P), 1.0, 4.0, small, linear=True)),
        of("half sine that overturns, omega = 2 p", "closed form", 1.800723931, 9.0,
           partial(threshold, linear, wave(2.0 * P, 0.5), 1.05, 8.0, small, linear=True)),
        of("sine, omega = 5 p: overturns after one impact from", ZHANG, 3.0323392, 7.3,
           partial(threshold, thick, sine, 1.5, 4.0, large)),
        of("sine, omega = 5 p: stands again from", ZHANG, 6.7430192, 7.3,
           partial(threshold, thick, sine, 4.0, 7.1, large, above=False)),
        of("cosine of 2 s, alpha = 15 deg, in g: overturns from", "derived", 0.3150057, 6.5,
           partial(threshold, tilted, cosine, 0.27, 0.32, GRAVITY, digits=1e-8)),
    ]  # fmt: skip
