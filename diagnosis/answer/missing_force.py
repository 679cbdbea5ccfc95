"""The law in a table as a report shows it: curves with bands, and what the nearest law of the library does instead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.along import Along
from diagnosis.fit.impulses import jumps_at
from diagnosis.fit.unknowns import without_instruments
from diagnosis.forces.action import action
from diagnosis.forces.columns import motions_of
from diagnosis.progress import Stages
from diagnosis.search.found import Search, adjusted
from diagnosis.search.refit import Explanation
from diagnosis.search.tables import Law, Table
from grids.instruments import INSTRUMENTS
from models.base import FloatArray
from models.identification import Motion
from models.tables import KNOTS, Tables, Term, Variable


def missing_force(found: Search, law: Law, stages: Stages) -> Mapping[str, Any]:
    """``terms``: curves with 95 % bands and evidence; ``nearest``: the best single mechanism, and its curve in each
    term, None where what it does cannot be told; ``parameters``: every value of the law, by name; ``stages``: when it
    acts in each recording, if not always; ``oscillator``: motion, force, frequency and damping of one beside the
    tables with their intervals, or None.
    """
    tables = law.mechanism.tabulated
    assert tables is not None
    singles = [e for e in found.singles if e.names[0] not in INSTRUMENTS]
    nearest = min(singles, key=adjusted) if singles else None
    doing = None
    if nearest is not None:
        what = f"what the nearest law ({nearest.names[0]}) does"
        doing = stages.optional(what, lambda: _Doing.of(nearest, tables), lambda: None)
    terms = []
    for table in law.tables:
        one, over = tables.terms[table.term], tables.variable(table.term)
        terms.append(
            {
                "term": table.term, "meaning": one.meaning, "unit": one.unit, "variable": one.variable,
                "variable_unit": over.unit, "at": table.at.tolist(), "value": table.value.tolist(),
                "low95": table.low95.tolist(), "high95": table.high95.tolist(), "evidence": table.evidence,
                "nearest": None if doing is None else _curve(doing, one, over, table),
            }
        )  # fmt: skip
    return {
        "terms": terms, "nearest": doing.explanation.names[0] if doing else None, "parameters": law.values,
        "stages": [asdict(one) for one in law.stages], "oscillator": _oscillator(law),
    }  # fmt: skip


def _oscillator(law: Law) -> dict[str, dict[str, float]] | None:
    return {
        name.removeprefix("oscillator_"): dict(zip(("estimate", "low95", "high95"), ends, strict=True))
        for name, ends in law.oscillator.items()
    } or None


@dataclass(frozen=True)
class _Doing:
    """What an effect does along the fitted motion.

    ``forces``: by port, the couple (W, N) that changes the rates as the effect does, in units of a table's values;
    ``motions``: by port; ``event`` (W, N): an event lies in the step; ``change`` (W, N): of the leading rate in a step.
    """

    explanation: Explanation
    forces: Mapping[str, FloatArray]
    motions: Mapping[str, Motion]
    event: NDArray[np.bool_]
    change: FloatArray

    @classmethod
    def of(cls, explanation: Explanation, tables: Tables) -> _Doing:
        """Of the first effect: couples in as many joints as the model has rates, which they change in one way only."""
        fitted, m = explanation.fitted, explanation.measured
        predictor = fitted.misfit.predictor
        acting = action(predictor, fitted.point, explanation.names[0])
        rates = [state for state in m.identification.states if state.rate and state.name in m.free]
        ports = {one.port.name: one.port for one in m.identification.forces}
        joints = [ports[name] for name in dict.fromkeys(one.port for one in tables.terms.values())][: len(rates)]
        jumps = jumps_at(Along(predictor, fitted.point), joints)
        by_unit = np.array([[jumps[joint.name][rate.name] for joint in joints] for rate in rates])
        changed = acting.amount[:, [m.standing_for(state.channel) for state in rates]]
        # a unit impulse resists, a value of a table drives
        impulse = -np.linalg.solve(np.moveaxis(by_unit, (0, 1), (2, 3)), np.moveaxis(changed, 1, 2)[..., None])[..., 0]
        wall = m.model.build(without_instruments(fitted.point.values), predictor.options)
        unit, step = tables.units(wall), m.time_steps[:, None]
        forces = {
            one.name: impulse[..., k] / (step * float(np.ravel(unit[one.name])[0])) for k, one in enumerate(joints)
        }
        motions = {**motions_of(fitted), joints[0].name: acting.motion}
        return cls(explanation, forces, motions, acting.event, acting.amount.sum(axis=1))


def _curve(doing: _Doing, one: Term, over: Variable, table: Table) -> list[float | None] | None:
    """What the effect does on average at each row of a table, in the table's own unit; None where it was not.

    None for a force on the upper block, which couples in both joints stand for. Forces over a factor (the rate, its
    sign, ...) are fitted as that factor times the row; what acts at events is the relative change of the rate.
    """
    if one.port not in doing.forces:
        return None
    m, motion = doing.explanation.measured, doing.motions[one.port]
    inside = np.asarray(m.mask.any(axis=1))
    inside[:, :-1] &= inside[:, 1:]
    inside[:, -1] = False
    growing = motion.coordinate * motion.rate > 0.0
    factors = {
        "": np.ones_like(motion.rate), "rate": motion.rate, "direction": np.sign(motion.rate),
        "outward": motion.rate * growing,
    }  # fmt: skip
    x = {"coordinate": motion.coordinate, "rate": motion.rate, "base": motion.base}[over.along]
    if one.event:
        after = np.roll(motion.rate, -1, axis=1)
        inside &= doing.event & (after != doing.change)
        value, weight = doing.change / np.where(inside, after - doing.change, 1.0), np.ones_like(x)
    else:
        inside &= ~doing.event
        factor = factors[one.factor]
        value, weight = doing.forces[one.port] * factor, factor**2
    found = _averages(x[inside], value[inside], weight[inside], table.at)
    return [None if np.isnan(v) else float(v) for v in found]


def _averages(x: FloatArray, value: FloatArray, weight: FloatArray, at: FloatArray) -> FloatArray:
    """Weighted means of ``value`` around the rows ``at``, each side of zero on its own; nan without samples."""
    found = np.full(at.size, np.nan)
    spacing = at[-1] / (KNOTS - 1)
    for k, centre in enumerate(at):
        side = -1.0 if k < KNOTS else 1.0
        near = np.maximum(0.0, 1.0 - np.abs(x - centre) / spacing) * (side * x > 0.0)
        if np.sum(near * weight) > 0.0:
            found[k] = np.sum(near * value) / np.sum(near * weight)
    return found
