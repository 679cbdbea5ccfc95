"""A law in a table estimated inside the simulator: which tables, how smooth, and their values.

Where no mechanism explains the recordings, the values c of the tables that the model can hold (`models.tables`: over
the coordinate of a port, its rate or the base acceleration, some of them times the rate or its sign) become unknowns of
the windowed fit, beside base parameters, effects and states. Which tables, and how smooth, is decided on the problem
linearised in the simulator: with the states and other unknowns projected out, H = J'WJ, g = J'Wr at c = 0, and a prior
c ~ N(0, (lambda P)^-1) on second differences, the evidence

    g'(H + lambda P)^-1 g - log det(H + lambda P) + log det(lambda P)

chooses term by term (the sparse part) and lambda (the smooth part). The chosen ones are fitted by the same solver as
everything else; bands are those of the posterior at the optimum.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.errors.model import Errors, refitted
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.misfit import Misfit, reduce
from diagnosis.fit.solver import Fitted, fit, normal
from diagnosis.fit.unknowns import Unknown, without_instruments
from diagnosis.forces.columns import motions_of
from diagnosis.search.refit import Explanation
from grids.stages import Stage
from models.base import FloatArray, Mechanism
from models.identification import Motion
from models.model import Model
from models.tables import KNOTS, SIDES, Tables, row

MOST_TERMS = 3
MORE = 10.0
"""Evidence (2 log) that one more table must bring."""
SMOOTH = np.geomspace(1e-3, 1e3, 13)
JUMP = 100.0
"""Weight of a jump at zero, of tables that may not jump there, over that of a bend."""
SLOPE = 0.3
"""Of a slope: beyond the rows that the motion tells, a table rises less and less."""
RIDGE = 0.02
UNIT, WIDEST = 0.02, 100.0
"""One unit of a table's value over the typical acceleration of the motion, and the most units a fit may reach."""
NORMAL = 1.959964
ITERATIONS = 6
"""Of the fit with tables, which is nearly linear and costs two runs a row each."""


@dataclass(frozen=True)
class Table:
    """One term of a law: ``value`` with its 95 % band at the rows ``at`` of its variable, and its evidence."""

    term: str
    at: FloatArray
    value: FloatArray
    low95: FloatArray
    high95: FloatArray
    evidence: float


@dataclass(frozen=True)
class Law:
    """An explanation with a law in a table beside its effects."""

    explanation: Explanation
    tables: tuple[Table, ...]
    mechanism: Mechanism

    @property
    def values(self) -> dict[str, float]:
        """Every parameter of the mechanism."""
        point = self.explanation.fitted.point.values
        return {p.name: point[f"{self.mechanism.name}.{p.name}"] for p in self.mechanism.parameters}

    @property
    def oscillator(self) -> Mapping[str, tuple[float, float, float]]:
        """Gains, frequency and damping of an oscillator beside the tables with their 95 % intervals; empty without."""
        fitted, form = self.explanation.fitted, self.mechanism
        names = {f"{form.name}.{name}": name for name in form.tabulated.oscillator} if form.tabulated else {}
        deviation = np.sqrt(np.diag(linearise_about(fitted).inverse))
        found = {}
        for x, at, sd in zip(fitted.misfit.unknowns, fitted.u, deviation, strict=False):
            if x.name in names:
                ends = (x.value(float(np.clip(at + side * NORMAL * sd, *x.bounds))) for side in (0.0, -1.0, 1.0))
                estimate, low, high = ends
                found[names[x.name]] = (estimate, low, high)
        return found

    @property
    def stages(self) -> tuple[Stage, ...]:
        """When it acts in each recording; none of one that always acts."""
        return tuple(self.explanation.fitted.misfit.predictor.stages.get(self.mechanism.name, ()))


def estimate(explanation: Explanation, errors: Errors | None = None) -> Law | None:
    """The law that the explanation lacks; None where the model has no port for one, or no table is worth its rows.

    An oscillator among the explanation's unknowns (`diagnosis.search.driven`) is part of the law.
    ``errors``: those of the recordings, from which they are estimated anew with the law in. Its tables are chosen again
    under them: what they hold needs none.
    """
    fitted = explanation.fitted
    model = fitted.measured.model
    form = form_of(model)
    if form is None or form.tabulated is None:
        return None
    tables, motions = form.tabulated, motions_of(fitted)
    if not {one.port for one in tables.terms.values()} <= set(motions):  # a joint is bonded
        return None
    unknowns = {term: _unknowns(form, term, motions[one.port], fitted) for term, one in tables.terms.items()}
    reaches = _reaches(tables, motions)
    off = {f"{form.name}.{p.name}": p.null for p in form.parameters}
    off |= {f"{form.name}.{name}": reach for name, reach in reaches.items()}
    first = next(iter(unknowns.values()))[0]
    on = {**without_instruments(fitted.point.values), **off, first.name: first.scale}
    if model.check(on, fitted.misfit.predictor.options):
        return None
    base = replace(fitted.misfit, fixed={**fitted.misfit.fixed, **off})
    bends = {term: prior_rows(one.variable in tables.jumps) for term, one in tables.terms.items()}
    chosen = _choose(base, fitted, unknowns, bends)
    beside = {f"{form.name}.{name}" for name in tables.oscillator} & {x.name for x in base.unknowns}
    if not chosen and not beside:
        return None
    best = _fitted(base, fitted, unknowns, chosen, bends) if chosen else replace(fitted, misfit=base)
    if errors is not None:
        best, _ = refitted(best, errors.base, errors, rounds=1)
        chosen = _choose(replace(best.misfit, unknowns=base.unknowns, smooth=None), best, unknowns, bends)
        if not chosen and not beside:
            return None
        best = _fitted(replace(best.misfit, unknowns=base.unknowns, smooth=None), best, unknowns, chosen, bends)
    return Law(Explanation(explanation.candidates, best), _tables(best, unknowns, chosen, tables, reaches), form)


def form_of(model: Model) -> Mechanism | None:
    """The law in a table that a model can hold."""
    return next((one for one in model.mechanisms.values() if one.tabulated), None)


def _reaches(tables: Tables, motions: Mapping[str, Motion]) -> dict[str, float]:
    """Parameter by parameter, how far the motion goes in each variable of a table."""
    found = {}
    for one in tables.terms.values():
        motion, variable = motions[one.port], tables.variables[one.variable]
        largest = {"coordinate": motion.reach, "rate": np.max(np.abs(motion.rate)), "base": np.max(np.abs(motion.base))}
        found[variable.reach] = max(float(largest[variable.along]), 1e-9)
    return found


def _unknowns(form: Mechanism, term: str, motion: Motion, fitted: Fitted) -> tuple[Unknown, ...]:
    """The values of a term's table, in units of what its force would have to be to matter.

    Shares (of a weight, of the restitution) are of order one themselves.
    """
    step = fitted.measured.recordings[0].time_step
    inside = fitted.measured.mask[:, 0]
    typical = float(np.sqrt(np.mean((np.gradient(motion.rate, axis=1) / step)[inside] ** 2)))
    speed = float(np.sqrt(np.mean(motion.rate[inside] ** 2)))
    unit = form.parameter(row(term, SIDES[0], 0)).unit
    scale = UNIT * {"rad s-2": typical, "s-1": typical / speed, "1": 1.0, "s": 1.0 / speed, "s m-1": 1.0 / speed}[unit]
    reach = WIDEST * scale
    names = [row(term, side, knot) for side in SIDES for knot in range(KNOTS)]
    return tuple(Unknown(f"{form.name}.{name}", unit, -reach, reach, 0.0, scale) for name in names)


def prior_rows(jumps: bool) -> FloatArray:
    """Rows R of the prior R c ~ N(0, 1/lambda) on a table's values: bends, the jump at zero, and a little on all."""
    below, above = np.arange(KNOTS)[::-1], KNOTS + np.arange(KNOTS)
    rows = []
    for side in (below, above):
        for k in range(1, KNOTS - 1):
            bend = np.zeros(2 * KNOTS)
            bend[side[k - 1 : k + 2]] = 1.0, -2.0, 1.0
            rows.append(bend)
        for k in range(KNOTS - 1):
            slope = np.zeros(2 * KNOTS)
            slope[side[k : k + 2]] = -SLOPE, SLOPE
            rows.append(slope)
    if not jumps:
        jump = np.zeros(2 * KNOTS)
        jump[0], jump[KNOTS] = -JUMP, JUMP
        rows.append(jump)
    return np.concatenate([np.array(rows), RIDGE * np.eye(2 * KNOTS)])


def _choose(
    base: Misfit, fitted: Fitted, unknowns: dict[str, tuple[Unknown, ...]], bends: Mapping[str, FloatArray]
) -> list[tuple[str, float, float]]:
    """Terms with their smoothness lambda and evidence, by forward selection on the linearised problem."""
    whole = replace(base, unknowns=(*base.unknowns, *(u for term in unknowns.values() for u in term)))
    count = len(base.unknowns)
    u = _placed(whole.unknowns, fitted)
    linear = whole.linearise(u, fitted.states)
    reduced, weights = reduce(linear), whole.weights(linear.residual)
    hessian, gradient = normal(whole, reduced, weights, u)
    tables = np.arange(count, u.size)
    known = np.setdiff1d(np.arange(gradient.size), tables)
    within = hessian[np.ix_(known, known)] + 1e-9 * np.eye(known.size)
    along = np.linalg.solve(within, hessian[np.ix_(known, tables)])
    h = hessian[np.ix_(tables, tables)] - hessian[np.ix_(tables, known)] @ along
    g = gradient[tables] - along.T @ gradient[known] - h @ u[tables]
    place = {term: 2 * KNOTS * k + np.arange(2 * KNOTS) for k, term in enumerate(unknowns)}
    chosen: list[tuple[str, float, float]] = []
    reached = 0.0
    while len(chosen) < MOST_TERMS:
        trials = [
            (_evidence(h, g, place, bends, [*((t, s) for t, s, _ in chosen), (term, smooth)]), term, float(smooth))
            for term in unknowns
            if term not in [t for t, _, _ in chosen]
            for smooth in SMOOTH
        ]
        best, term, smooth = max(trials)
        if best - reached < MORE:
            break
        chosen.append((term, smooth, best - reached))
        reached = best
    return chosen


def _evidence(
    h: FloatArray, g: FloatArray, place: dict[str, NDArray[np.intp]], bends: Mapping[str, FloatArray],
    terms: Sequence[tuple[str, float]],
) -> float:  # fmt: skip
    at = np.concatenate([place[term] for term, _ in terms])
    prior = np.zeros((at.size, at.size))
    for k, (term, smooth) in enumerate(terms):
        own = slice(2 * KNOTS * k, 2 * KNOTS * (k + 1))
        prior[own, own] = smooth * bends[term].T @ bends[term]
    whole = h[np.ix_(at, at)] + prior
    explained = g[at] @ np.linalg.solve(whole, g[at])
    return float(explained - np.linalg.slogdet(whole)[1] + np.linalg.slogdet(prior)[1])


def _fitted(
    base: Misfit, fitted: Fitted, unknowns: dict[str, tuple[Unknown, ...]], chosen: Sequence[tuple[str, float, float]],
    bends: Mapping[str, FloatArray],
) -> Fitted:  # fmt: skip
    """Everything refitted with the chosen tables."""
    count = len(base.unknowns)
    extra = [u for term, _, _ in chosen for u in unknowns[term]]
    prior = []
    for k, (term, smooth, _) in enumerate(chosen):
        rows = np.zeros((bends[term].shape[0], count + len(extra)))
        rows[:, count + 2 * KNOTS * k : count + 2 * KNOTS * (k + 1)] = np.sqrt(smooth) * bends[term]
        prior.append(rows)
    misfit = replace(base, unknowns=(*base.unknowns, *extra), smooth=np.concatenate(prior) if prior else None)
    return fit(misfit, _placed(misfit.unknowns, fitted), fitted.states, ITERATIONS)


def _placed(unknowns: Sequence[Unknown], fitted: Fitted) -> FloatArray:
    """Coordinates of a fit among these unknowns, 0 where it has none."""
    known = dict(zip((x.name for x in fitted.misfit.unknowns), fitted.u, strict=True))
    return np.array([known.get(x.name, 0.0) for x in unknowns])


def _tables(
    fitted: Fitted, unknowns: dict[str, tuple[Unknown, ...]], chosen: Sequence[tuple[str, float, float]],
    tables: Tables, reaches: dict[str, float],
) -> tuple[Table, ...]:  # fmt: skip
    deviation = np.sqrt(np.diag(linearise_about(fitted).inverse))
    names = [u.name for u in fitted.misfit.unknowns]
    found = []
    for term, _, evidence in chosen:
        index = np.array([names.index(u.name) for u in unknowns[term]])
        order = np.concatenate([np.arange(KNOTS)[::-1], KNOTS + np.arange(KNOTS)])
        scale = np.array([u.scale for u in unknowns[term]])
        value, band = (scale * fitted.u[index])[order], (NORMAL * scale * deviation[index])[order]
        one_side = np.linspace(0.0, reaches[tables.variable(term).reach], KNOTS)
        at = np.concatenate([-one_side[::-1], one_side])
        found.append(Table(term, at, value, value - band, value + band, evidence))
    return tuple(found)
