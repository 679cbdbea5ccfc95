"""Sparse regression on the equation error in weak form (as in weak-form SINDy).

Within a swing (between two impacts) Housner's equation theta'' = F(theta, a) may lack sum c_i f_i. With a
test function phi = (1 - x^2)^4 on a piece of the swing, integration by parts spares the noisy derivative:

    int phi'' theta - int phi F = sum c_i int phi f_i

Rows are divided by the standard deviation that white noise of theta gives them. Width and height join as
two more columns with the laboratory's priors. Terms enter one by one, the one with the least
BIC = n log(SSR/n) + k log(n), while it falls by 10 or more, at most two. Impacts are cut out: impact laws
cannot be seen. (Messenger, Bortz: Multiscale Model. Simul. 19, 2021; library and stopping rule are ours.)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from diagnosis.prove.answers import NOTHING
from grids.recordings import Recording, noise_of, read_recording
from grids.specimen import Specimen, read_specimen
from models import get

FloatArray = NDArray[np.float64]
STRONG = 10.0
PIECE = 0.12
"""Shortest support of a test function (s); longer swings are cut in pieces that overlap by half."""
LONGEST = 0.3
MARGIN = 0.02
"""Left out beside an impact (s)."""
MOST_TERMS = 2

TERMS: Mapping[str, tuple[str, str]] = {
    "sign": ("pivot_inset", "contact_geometry"),
    "one": ("tilt", "tilt"),
    "angle": ("added_stiffness", "added_stiffness"),
    "rate": ("viscous_damping", "viscous_damping"),
    "sign_rate": ("coulomb_damping", "coulomb_damping"),
    "square_rate": ("quadratic_damping", "quadratic_damping"),
    "base": ("base_gain", "base_gain"),
    "gain": ("gain", "gain"),
    "base_rate": ("delay", "delay"),
    "vertical": ("vertical_acceleration", "vertical_acceleration"),
    "joint": ("flexible_joint", "flexible_joint"),
}
"""Term: the mechanism that it stands for, and its class."""


def answer(folder: Path) -> dict[str, Any]:
    """The answer of this method to a case folder, in the form of `answers`."""
    specimen = read_specimen(folder / "specimen.toml")
    recordings = [read_recording(folder / f"train_{k}.nc") for k in (1, 2)]
    blocks = [_rows(specimen, recording) for recording in recordings]
    names = [name for name in TERMS if all(name in columns for _, columns, _ in blocks)]
    wanted = np.concatenate([w for w, _, _ in blocks])
    library = {name: np.concatenate([columns[name] for _, columns, _ in blocks]) for name in names}
    base = np.vstack([b for _, _, b in blocks])

    chosen: list[str] = []
    steps: list[dict[str, float]] = []
    current = _bic(wanted, base, [])
    while len(chosen) < MOST_TERMS and wanted.size:
        tried = {n: _bic(wanted, base, [library[c] for c in (*chosen, n)]) for n in names if n not in chosen}
        best = min(tried, key=lambda n: tried[n])
        if current - tried[best] < STRONG:
            break
        steps.append({n: tried[n] - tried[best] for n in tried} | {"drop": current - tried[best]})
        chosen.append(best)
        current = tried[best]
    if not chosen:
        return {"verdict": "nothing_missing", "statement": "", **NOTHING}
    effects = [
        {"name": TERMS[n][0], "class": TERMS[n][1], "parameters": {}, "evidence": step["drop"], "p_value": 0.0}
        for n, step in zip(chosen, steps, strict=True)
    ]
    rivals = [
        {"name": TERMS[n][0], "class": TERMS[n][1], "evidence_gap": gap}
        for n, gap in steps[0].items()
        if n != "drop" and n not in chosen and gap < STRONG
    ]
    return {
        "verdict": "cannot_tell_apart" if rivals else "missing", "statement": "", **NOTHING,
        "effects": effects, "rivals": rivals,
    }  # fmt: skip


def _bic(wanted: FloatArray, base: FloatArray, columns: list[FloatArray]) -> float:
    """Of a least squares in the base's two columns (unit priors) and ``columns``."""
    count = wanted.size
    design = np.column_stack([base, *columns])
    prior = np.zeros((2, design.shape[1]))
    prior[0, 0] = prior[1, 1] = 1.0
    whole, aim = np.vstack([design, prior]), np.concatenate([wanted, np.zeros(2)])
    left = aim - whole @ np.linalg.lstsq(whole, aim, rcond=None)[0]
    return float(count * math.log(float(left @ left) / count) + design.shape[1] * math.log(count))


def _rows(specimen: Specimen, recording: Recording) -> tuple[FloatArray, dict[str, FloatArray], FloatArray]:
    """Weak equation errors (n,), library columns by term, and the base's columns (n, 2), over the noise."""
    step, theta = recording.time_step, recording.channels["rotation_1"]
    a = recording.channels["base_acceleration_x"]
    vertical = recording.channels.get("base_acceleration_z")
    gravity = specimen.parameters.get("gravity", 9.80665)
    effective_gravity = (
        gravity + vertical if vertical is not None and specimen.vertical else np.full(theta.size, gravity)
    )
    sigma = noise_of(theta).sigma
    width = max(5, round(0.05 / step) | 1)
    smooth = savgol_filter(theta, width, 3)
    rate = savgol_filter(theta, width, 3, deriv=1, delta=step)
    sign = np.sign(smooth)

    def equation(changes: Mapping[str, float]) -> FloatArray:
        values = {k: v * changes.get(k, 1.0) for k, v in specimen.parameters.items()}
        derived = get(specimen.model).derive(values)
        p2, alpha = float(derived["frequency_parameter"][0]) ** 2, float(derived["alpha"][0])
        lean = alpha * sign - theta
        return np.asarray(-p2 / gravity * (effective_gravity * np.sin(lean) + a * np.cos(lean)))

    model = equation({})
    tolerance = {name: specimen.tolerance.get(name, 0.0) for name in ("width", "height")}
    by_base = [(equation({name: 1.0 + sigma_1}) - model) for name, sigma_1 in tolerance.items()]
    scale = float(np.max(np.abs(smooth)))
    columns = {
        "sign": sign, "one": np.ones_like(theta), "angle": theta, "rate": rate, "sign_rate": np.sign(rate),
        "square_rate": rate * np.abs(rate), "base": a, "gain": sign * np.mean(np.abs(model)) / gravity + a / gravity,
        "base_rate": np.gradient(a, step), "joint": sign * np.exp(-np.abs(smooth) / (0.1 * scale)),
    }  # fmt: skip
    if vertical is not None and not specimen.vertical:
        columns["vertical"] = vertical * sign
    errors, rows, base = [], [], []
    for first, last in _pieces(smooth, step, 8.0 * sigma):
        test, curve = weights(last - first, step)
        cut = slice(first, last)
        spread = sigma * step * math.sqrt(float(curve @ curve))
        errors.append(step * float(curve @ theta[cut] - test @ model[cut]) / spread)
        rows.append([step * float(test @ column[cut]) / spread for column in columns.values()])
        base.append([step * float(test @ column[cut]) / spread for column in by_base])
    table = np.array(rows).reshape(-1, len(columns))
    named = {name: table[:, k] for k, name in enumerate(columns)}
    return np.array(errors), named, np.array(base).reshape(-1, 2)


def _pieces(theta: FloatArray, step: float, least: float) -> list[tuple[int, int]]:
    """Samples between which test functions act: within swings that rise over ``least`` (rad)."""
    crossings = np.flatnonzero(theta[1:] * theta[:-1] <= 0.0) + 1
    margin, shortest, longest = (round(s / step) for s in (MARGIN, PIECE, LONGEST))
    found = []
    for start, end in zip(crossings[:-1].tolist(), crossings[1:].tolist(), strict=True):
        first, last = start + margin, end - margin
        if last - first < shortest or np.max(np.abs(theta[first:last])) < least:
            continue
        length = min(longest, last - first)
        for begin in range(first, last - length + 1, max(1, length // 2)):
            found.append((begin, begin + length))
    return found


def weights(count: int, step: float) -> tuple[FloatArray, FloatArray]:
    """The test function phi and phi'' at ``count`` samples, a ``step`` (s) apart."""
    x = np.linspace(-1.0, 1.0, count)
    stretch = 2.0 / ((count - 1) * step)
    test = (1.0 - x**2) ** 4
    curve = (-8.0 * (1.0 - x**2) ** 3 + 48.0 * x**2 * (1.0 - x**2) ** 2) * stretch**2
    return test, curve
