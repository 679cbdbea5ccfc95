"""The same block under the same motion with the programs people use now."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks import opensees
from models.housner.block import Block
from models.shaking import Shaking


def solve_ivp_seconds(block: Block, shaking: Shaking, scale: float, step: float, tail: float) -> float:
    """Processor time of one run with scipy's solve_ivp, a terminal event at each impact, steps not over ``step``."""
    p2 = float(block.frequency_parameter[0] ** 2)
    alpha, g = float(block.slenderness[0]), float(block.gravity[0])
    e = float(block.momentum_restitution[0])
    grid = np.arange(shaking.horizontal.size) * shaking.time_step
    across = scale * shaking.horizontal
    up = scale * shaking.vertical if shaking.vertical is not None else np.zeros_like(across)
    end = shaking.duration + tail
    began = time.thread_time()
    t, theta, omega = 0.0, 0.0, 0.0
    exceeded = np.abs(across) > (g + up) * math.tan(alpha)

    def rotation(_t: float, y: NDArray[np.float64]) -> float:
        return float(y[0])

    rotation.terminal = True  # type: ignore[attr-defined]
    while t < end:
        if omega == 0.0:
            later = np.flatnonzero(exceeded & (grid >= t))
            if later.size == 0:
                break
            t = max(t, float(grid[later[0]]))
            side = -math.copysign(1.0, float(across[later[0]]))
            theta = side * 1e-12
        else:
            side = math.copysign(1.0, omega)
            theta = side * 1e-12

        def motion(time_: float, y: NDArray[np.float64], s: float = side) -> list[float]:
            a = np.interp(time_, grid, across, right=0.0)
            v = np.interp(time_, grid, up, right=0.0)
            turn = alpha * s - y[0]
            return [y[1], -p2 * ((1.0 + v / g) * math.sin(turn) + a / g * math.cos(turn))]

        found = solve_ivp(motion, (t, end), [theta, omega], events=rotation, max_step=step, rtol=1e-8, atol=1e-10)
        t, omega = float(found.t[-1]), float(found.y[1, -1])
        if found.status != 1 or abs(found.y[0, -1]) > 1.5:
            break
        omega *= e
        if abs(omega) < 4.5e-3 * math.sqrt(p2) * alpha:
            omega = 0.0
            t += 1e-9
    return time.thread_time() - began


def opensees_steps_per_second(block: Block, shaking: Shaking, scale: float, step: float, steps: int) -> float | None:
    """Steps per second of OpenSeesPy: a rigid block on two no-tension springs; None without it."""
    if not opensees.available():
        return None
    import openseespy.opensees as ops

    b, h = float(block.right[0]), float(block.height[0])
    mass, inertia = float(block.mass[0]), float(block.inertia[0])
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, x, z in ((1, -b, 0.0), (2, b, 0.0), (3, -b, 0.0), (4, b, 0.0), (5, 0.0, 0.0), (6, 0.0, h)):
        ops.node(tag, x, z)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 1, 1, 1)
    ops.mass(6, mass, mass, inertia)
    ops.geomTransf("Corotational", 1)
    for tag, (i, j) in enumerate(((5, 3), (5, 4), (5, 6)), start=1):
        ops.element("elasticBeamColumn", tag, i, j, 1.0, 1e12, 1e2, 1)
    stiff = 1e9
    ops.uniaxialMaterial("ENT", 1, stiff)
    ops.uniaxialMaterial("Elastic", 2, stiff)
    for tag, (i, j) in ((11, (1, 3)), (12, (2, 4))):
        ops.element("zeroLength", tag, i, j, "-mat", 1, 2, "-dir", 2, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(6, 0.0, -mass * float(block.gravity[0]), 0.0)
    opensees.static(ops)
    opensees.shake(ops, Shaking(shaking.time_step, shaking.horizontal), scale)
    began = time.thread_time()
    ops.analyze(steps, step)
    seconds = time.thread_time() - began
    ops.wipe()
    return steps / seconds
