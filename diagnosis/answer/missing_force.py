"""The law in a table as a report shows it: curves with bands, and what the nearest law of the library does instead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from diagnosis.forces.action import Action, action
from diagnosis.search.found import Search, adjusted
from diagnosis.search.refit import Explanation
from diagnosis.search.tables import Law, Table
from grids.instruments import INSTRUMENTS
from models.base import FloatArray
from models.tables import KNOTS, Term, Variable


def missing_force(found: Search, law: Law) -> Mapping[str, Any]:
    """``terms``: curves with 95 % bands and evidence; ``nearest``: the best single mechanism, and its curve in each
    term; ``parameters``: every value of the law, by name; ``stages``: when it acts in each recording, if not always;
    ``oscillator``: motion, force, frequency and damping of one beside the tables with their intervals, or None.
    """
    tables = law.mechanism.tabulated
    assert tables is not None
    singles = [e for e in found.singles if e.names[0] not in INSTRUMENTS]
    nearest = min(singles, key=adjusted) if singles else None
    acting = _action(nearest) if nearest else None
    terms = []
    for table in law.tables:
        one, over = tables.terms[table.term], tables.variable(table.term)
        terms.append(
            {
                "term": table.term, "meaning": one.meaning, "unit": one.unit, "variable": one.variable,
                "variable_unit": over.unit, "at": table.at.tolist(), "value": table.value.tolist(),
                "low95": table.low95.tolist(), "high95": table.high95.tolist(), "evidence": table.evidence,
                "nearest": None if acting is None or nearest is None else _curve(nearest, acting, one, over, table),
            }
        )  # fmt: skip
    stages = [asdict(one) for one in law.stages]
    return {
        "terms": terms, "nearest": nearest.names[0] if nearest else None, "parameters": law.values, "stages": stages,
        "oscillator": _oscillator(law),
    }  # fmt: skip


def _oscillator(law: Law) -> dict[str, dict[str, float]] | None:
    return {
        name.removeprefix("oscillator_"): dict(zip(("estimate", "low95", "high95"), ends, strict=True))
        for name, ends in law.oscillator.items()
    } or None


def _action(explanation: Explanation) -> Action:
    return action(explanation.fitted.misfit.predictor, explanation.fitted.point, explanation.names[0])


def _curve(
    explanation: Explanation, acting: Action, term: Term, over: Variable, table: Table
) -> list[float | None] | None:  # fmt: skip
    """What the effect does on average at each row of a table, in the table's own unit; None where it was not.

    None where a force at one port moves several bodies: what an effect changes of their rates is no force there. Forces
    over a factor (the rate, its sign, ...) are fitted as that factor times the row; what acts at events is the
    relative change of the rate.
    """
    m = explanation.measured
    if len(m.identification.leads) > 1:
        return None
    step = m.time_steps[:, None]
    inside = np.asarray(m.mask.any(axis=1))
    inside[:, :-1] &= inside[:, 1:]
    inside[:, -1] = False
    motion, impulse = acting.motion, acting.amount.sum(axis=1)
    growing = motion.coordinate * motion.rate > 0.0
    factors = {
        "": np.ones_like(motion.rate), "rate": motion.rate, "direction": np.sign(motion.rate),
        "outward": motion.rate * growing,
    }  # fmt: skip
    x = {"coordinate": motion.coordinate, "rate": motion.rate, "base": motion.base}[over.along]
    if term.event:
        after = np.roll(motion.rate, -1, axis=1)
        inside &= acting.event & (after != impulse)
        value, weight = impulse / np.where(inside, after - impulse, 1.0), np.ones_like(x)
    else:
        inside &= ~acting.event
        factor = factors[term.factor]
        value, weight = impulse / step * factor, factor**2
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
