"""The shape of a force that is in no library, by sparse regression over (theta, theta', contact, a).

Columns of every kind of force, plain and modulated, compete by orthogonal matching pursuit: the one
that takes most off the misfit enters, all are refitted, until the next would bring less than FLAG.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from diagnosis.forces.columns import KINDS, Forces
from diagnosis.forces.constancy import FLAG, Tested, modulations

MOST_TERMS = 4
CURVE_POINTS = 41


def missing_force(forces: Forces, tested: Sequence[Tested]) -> Mapping[str, Any]:
    """Terms with their coefficients (over the base acceleration, m s-2, that would do the same) and a curve.

    ``terms``: kind, dependence, coefficient, standard error, gain; ``curve``: rotation (rad) and the force
    at zero velocity that the terms along the rotation add up to.
    """
    screen = forces.screen
    factors = {"": np.ones_like(forces.rotation), **dict(modulations(forces))}
    library = {}
    for kind in KINDS:
        for depends_on, factor in factors.items():
            column = forces.column(kind, factor)
            norm = screen.product(column, column)
            if norm > 1e-6:
                library[kind, depends_on] = column
    chosen: list[tuple[str, str]] = []
    gains: list[float] = []
    solution, errors, reached = np.zeros(0), np.zeros(0), 0.0
    while len(chosen) < MOST_TERMS:
        best = None
        for name in library:
            if name in chosen:
                continue
            trial = _solve(forces, [library[n] for n in (*chosen, name)])
            if trial is not None and (best is None or trial[2] > best[1][2]):
                best = (name, trial)
        if best is None or best[1][2] - reached < FLAG:
            break
        chosen.append(best[0])
        gains.append(best[1][2] - reached)
        solution, errors, reached = best[1]
    terms = [
        {"kind": kind, "meaning": KINDS[kind], "depends_on": depends_on, "coefficient": float(c),
         "standard_error": float(e), "gain": float(g)}
        for (kind, depends_on), c, e, g in zip(chosen, solution, errors, gains, strict=True)
    ]  # fmt: skip
    return {"unit": "m s-2", "terms": terms, "curve": _curve(forces, terms)}


def _solve(forces: Forces, columns: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray, float] | None:
    """Coefficients, standard errors and gain of the columns together; None if they are not independent."""
    screen = forces.screen
    gram = np.array([[screen.product(a, b) for b in columns] for a in columns])
    score = np.array([screen.scores_with_residual(a) for a in columns])
    size = np.sqrt(np.diag(gram))
    if np.linalg.cond(gram / np.outer(size, size)) > 1e4:
        return None
    inverse = np.linalg.inv(gram)
    solution = -inverse @ score
    return solution, np.sqrt(np.diag(inverse)), float(score @ inverse @ score)


def _curve(forces: Forces, terms: Sequence[Mapping[str, Any]]) -> dict[str, list[float]]:
    """Force over rotation at zero velocity, from the terms that depend on nothing else."""
    peak = float(np.max(forces.peak))
    rotation = np.linspace(-peak, peak, CURVE_POINTS)
    shapes = {"contact": np.sign(rotation), "stiffness": rotation / peak, "lean": np.ones_like(rotation)}
    factors = {"": 1.0, "side": np.sign(rotation), "size of the rotation": np.abs(rotation) / peak}
    force = np.zeros_like(rotation)
    for term in terms:
        if term["kind"] in shapes and term["depends_on"] in factors:
            force += term["coefficient"] * shapes[term["kind"]] * factors[term["depends_on"]]
    return {"rotation": rotation.tolist(), "force": force.tolist()}
