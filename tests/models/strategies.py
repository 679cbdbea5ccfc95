"""Random blocks and ground motions for property tests."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from models.shaking import Shaking

SEEDS = st.integers(0, 2**32 - 1)


def random_block(rng: np.random.Generator) -> dict[str, float]:
    """A wall or block of .4 to 6 m, aspect .08 to .6, now and then with a mass on top or a given e."""
    values = {
        "height": float(rng.uniform(0.4, 6.0)),
        "aspect_ratio": float(rng.uniform(0.08, 0.6)),
        "mass": float(rng.uniform(100.0, 5000.0)),
    }
    if rng.random() < 0.4:
        values["top_mass"] = values["mass"] * float(rng.uniform(0.1, 5.0))
        values["top_mass_height"] = values["height"] * float(rng.uniform(0.0, 0.2))
    if rng.random() < 0.4:
        values["restitution"] = float(rng.uniform(0.6, 0.98))
    return values


def random_motion(
    rng: np.random.Generator, *, duration: float = 12.0, time_step: float = 0.01, vertical: bool = True
) -> Shaking:
    """Noise of a random band between .3 and 12 Hz under an envelope, PGA 1 m s-2 (vertical .5)."""
    time = np.arange(round(duration / time_step) + 1) * time_step
    low = float(np.exp(rng.uniform(np.log(0.3), np.log(2.0))))
    high = low * float(rng.uniform(2.0, 6.0))
    envelope = (time / duration) ** 1.5 * np.exp(-4.0 * time / duration)

    def component(start: float, stop: float) -> np.ndarray:
        lines = np.linspace(start, stop, 40)
        angles = 2 * np.pi * lines[:, None] * time + rng.uniform(0, 2 * np.pi, 40)[:, None]
        signal = envelope * np.sum(rng.standard_normal(40)[:, None] * np.sin(angles), axis=0)
        return signal / np.max(np.abs(signal))

    across = component(low, high)
    return Shaking(time_step, across, 0.5 * component(2 * low, 2 * high) if vertical else None)


@st.composite
def cases(draw: st.DrawFn, vertical: bool = True) -> tuple[dict[str, float], Shaking, float]:
    """A block, a motion and a scale between one and six times the block's onset."""
    rng = np.random.default_rng(draw(SEEDS))
    values = random_block(rng)
    shaking = random_motion(rng, duration=6.0, vertical=vertical)
    rise = values["height"] / 2
    if "top_mass" in values:
        top, mass = values["top_mass"], values["mass"]
        centre = values["height"] + values["top_mass_height"]
        rise = (mass * rise + top * centre) / (mass + top)
    onset = 9.80665 * values["aspect_ratio"] * values["height"] / 2 / rise
    return values, shaking, onset * float(rng.uniform(1.0, 6.0))
