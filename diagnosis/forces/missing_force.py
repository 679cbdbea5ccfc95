"""The shape of a force that is in no library, by sparse regression over the leading coordinate, its rate and the base.

Columns of every kind of force, plain and modulated, compete by orthogonal matching pursuit: the one
that takes most off the misfit enters, all are refitted, until the next would bring less than FLAG.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from diagnosis.forces.columns import Forces
from diagnosis.forces.constancy import FLAG, modulations
from models.identification import Motion

MOST_TERMS = 4
CURVE_POINTS = 41


def missing_force(forces: Forces) -> Mapping[str, Any]:
    """Terms with their coefficients (over the base acceleration, m s-2, that would do the same) and a curve.

    ``terms``: kind, dependence, coefficient, standard error, gain; ``curve``: the leading coordinate and the
    force at zero rate and without shaking that the terms along the coordinate add up to.
    """
    screen = forces.screen
    factors = {"": np.ones_like(forces.time), **dict(modulations(forces))}
    library = {}
    kinds = {kind.name: kind for kind in forces.kinds}
    for kind in forces.kinds:
        for depends_on, factor in factors.items():
            column = forces.column(kind, factor)
            norm = screen.product(column, column)
            if norm > 1e-6:
                library[kind.name, depends_on] = column
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
        {"kind": name, "meaning": kinds[name].meaning, "depends_on": depends_on, "coefficient": float(c),
         "standard_error": float(e), "gain": float(g)}
        for (name, depends_on), c, e, g in zip(chosen, solution, errors, gains, strict=True)
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
    """Force over the leading coordinate at zero rate, from the terms that depend on nothing else."""
    reach = forces.motion.reach
    rotation = np.linspace(-reach, reach, CURVE_POINTS)
    still = Motion(rotation, np.zeros_like(rotation), np.zeros_like(rotation), reach)
    kinds = {kind.name: kind for kind in forces.kinds}
    factors = {d.name: d.factor for d in forces.fitted.measured.identification.dependences}
    force = np.zeros_like(rotation)
    for term in terms:
        along, depends_on = kinds[term["kind"]].along, term["depends_on"]
        if along is not None and (not depends_on or depends_on in factors):
            factor = factors[depends_on](still) if depends_on else 1.0
            force += term["coefficient"] * along(still) * factor
    return {"rotation": rotation.tolist(), "force": force.tolist()}
