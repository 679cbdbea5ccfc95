"""A base motion and the rotation of a block that rocks under it, as a sound recording holds them."""

from __future__ import annotations

import numpy as np

STEP, COUNT, GRAVITY = 0.005, 3000, 9.80665
P2, ALPHA = 7.0, 0.14
TIME = np.arange(COUNT) * STEP


def rocking(seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Base acceleration and rotation of a block, by the linearised equation and small steps; 1 % noise."""
    rng = np.random.default_rng(seed)
    base = 2.0 * np.sin(2 * np.pi * 1.3 * TIME) + 1.5 * np.sin(2 * np.pi * 3.1 * TIME)
    base *= np.exp(-(((TIME - 5) / 3) ** 2))
    fine = 10
    theta, rate, rotation = 0.0, 0.0, np.zeros(COUNT)
    for i in range((COUNT - 1) * fine):
        a = float(np.interp(i * STEP / fine, TIME, base))
        if theta == 0.0 and rate == 0.0 and abs(a) < GRAVITY * ALPHA:
            continue
        side = np.sign(theta) or -np.sign(a)
        rate += STEP / fine * -P2 * (ALPHA * side - theta + a / GRAVITY)
        moved = theta + STEP / fine * rate
        if moved * side < 0.0:
            rate *= 0.9
            if abs(rate) < 2e-3:
                moved, rate = 0.0, 0.0
        theta = moved
        rotation[(i + 1) // fine] = theta
    peak = np.abs(rotation).max()
    assert 0.01 < peak < ALPHA
    return base + rng.normal(0, 0.01, COUNT), rotation + rng.normal(0, 0.01 * peak, COUNT)


BASE, ROTATION = rocking()
