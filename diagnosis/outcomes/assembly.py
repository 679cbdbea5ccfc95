"""From the filled banks to the answer: comparisons, cross-validation, place, intervals, samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

import numpy as np

from diagnosis.answer.result import Effect, Rival, Verdict
from diagnosis.fit.intervals import Estimate
from diagnosis.fit.unknowns import Unknown
from diagnosis.outcomes.adequacy import INADEQUATE, chance_of_slopes, worse_than_even
from diagnosis.outcomes.answer import Compared, OutcomeDiagnosis, Posterior
from diagnosis.outcomes.bank import Bank
from diagnosis.outcomes.evidence import best, chance_of_misfit, expected, left_out, log_of_kept
from diagnosis.outcomes.ladder import SCATTERS
from diagnosis.outcomes.measures import THRESHOLDS, exceeding, measures_of, threshold
from diagnosis.outcomes.scores import reliability, scores
from diagnosis.outcomes.search import Found, Search
from diagnosis.outcomes.statement import statement
from diagnosis.outcomes.wrong import wrong_predictions
from diagnosis.progress import Progress
from grids.specimen import Specimen, with_values
from models.base import FloatArray
from study.provenance import program

SAMPLES = 256
BASE, EXTENDED = "base model", "extended model"


def assemble(found: Search, flags: FloatArray, rng: np.random.Generator, progress: Progress) -> OutcomeDiagnosis:
    """The answer of a search."""
    progress("leaving out one group of motions after the other", 0.92)
    outcomes, chosen = found.outcomes, found.chosen
    measures = measures_of(outcomes.motions)
    base, last = expected(found.base, flags), expected(chosen.bank, flags)
    misfit = chance_of_misfit(last, flags, outcomes.groups, rng)
    posterior = _posterior(chosen.bank, flags, rng)
    estimates = _estimates(chosen, posterior, flags)
    own = {u.name for repair in chosen.effects for u in repair.unknowns}
    at = best(chosen.bank, flags)
    scatter = Estimate(float(SCATTERS[at.scatter]), *_ends(posterior.scatter), "1")
    compared = _compared(found, flags, measures, base, last)
    slope = chance_of_slopes(last, flags, measures, rng)
    explained = min(misfit, slope) > INADEQUATE and not worse_than_even(compared, EXTENDED)
    answer = OutcomeDiagnosis(
        verdict=_verdict(found, explained),
        statement="",
        effects=tuple(_effect(step, estimates) for step in found.steps),
        rivals=_rivals(found),
        wrong=wrong_predictions(base, flags, outcomes.groups, measures),
        left=wrong_predictions(last, flags, outcomes.groups, measures),
        compared=compared,
        base={name: one for name, one in estimates.items() if name not in own},
        at_bound=tuple(name for name, one in estimates.items() if one.at_bound),
        scatter=scatter,
        p_value=found.p_value,
        misfit_p_value=misfit,
        slope_p_value=slope,
        extended=_extended(found.specimen, found.chosen, estimates),
        posterior=posterior,
        runs=outcomes.runs,
        groups=outcomes.groups,
        overturned=flags,
        measures=measures,
        not_tried=dict(found.not_tried),
        finished=found.finished,
        provenance={
            "specimen": found.specimen.title,
            "model": found.specimen.model,
            "outcomes": outcomes.name,
            "runs": outcomes.size,
            **program(),
        },
    )
    return replace(answer, statement=statement(answer, found))


def _verdict(found: Search, explained: bool) -> Verdict:
    if not found.finished and not found.steps:
        return "cannot_tell_apart"
    if not found.steps:
        return "nothing_missing" if explained else "not_in_library"
    if not explained:
        return "not_in_library"
    other = {rival.effect_class for rival in _rivals(found)}
    return "cannot_tell_apart" if other - {r.mechanism.effect_class for r in found.chosen.effects} else "missing"


def _rivals(found: Search) -> tuple[Rival, ...]:
    """Of every effect that was found, the strongest first; not what was found itself."""
    named = {repair.name for repair in found.chosen.effects}
    of_all = [
        Rival(repair.name, repair.mechanism.effect_class, gap, step.effects[-1].name)
        for step in found.steps
        for repair, gap in step.rivals
        if repair.name not in named
    ]
    return tuple({rival.name: rival for rival in sorted(of_all, key=lambda one: -one.evidence_gap)}.values())


def _effect(step: Found, estimates: Mapping[str, Estimate]) -> Effect:
    repair = step.effects[-1]
    parameters = {u.name.partition(".")[2]: estimates[u.name] for u in repair.unknowns}
    return Effect(repair.name, repair.mechanism.effect_class, parameters, step.gain, step.p_value)


def _compared(
    found: Search, flags: FloatArray, measures: Mapping[str, FloatArray], base: FloatArray, last: FloatArray
) -> tuple[Compared, ...]:
    groups = np.asarray(found.outcomes.groups)
    tried = [Found((), found.base), *found.steps, *found.others]
    names = (BASE, EXTENDED, *THRESHOLDS)
    across = {name: np.zeros(flags.size) for name in names}
    for group in dict.fromkeys(found.outcomes.groups):
        out = groups == group
        kept = (~out).astype(np.float64)
        across[BASE][out] = left_out(found.base, flags, kept)[out]
        chosen = max(tried, key=lambda one: log_of_kept(one.bank, flags, kept) - _price(one))
        across[EXTENDED][out] = left_out(chosen.bank, flags, kept)[out]
        for name in THRESHOLDS:
            across[name][out] = exceeding(measures[name][out], *threshold(measures[name][~out], flags[~out]))
    within = {BASE: base, EXTENDED: last} | {
        name: exceeding(measures[name], *threshold(measures[name], flags)) for name in THRESHOLDS
    }
    return tuple(
        Compared(name, crossed, chance, scores(chance, flags, found.outcomes.groups), reliability(chance, flags))
        for crossed, of in ((True, across), (False, within))
        for name, chance in of.items()
    )


def _price(one: Found) -> float:
    """What the unknowns of its effects cost in log likelihood when explanations compete (Akaike, 1974)."""
    return float(sum(len(repair.unknowns) for repair in one.effects))


def _posterior(bank: Bank, flags: FloatArray, rng: np.random.Generator) -> Posterior:
    shares = bank.shares(bank.log_likelihood(flags))
    drawn = rng.choice(shares.size, SAMPLES, p=shares.ravel())
    point, scatter = np.unravel_index(drawn, shares.shape)
    values = {
        one.name: np.array([one.value(float(u)) for u in bank.points[point, column]])
        for column, one in enumerate(bank.unknowns)
    }
    return Posterior(values, {one.name: one.unit for one in bank.unknowns}, SCATTERS[scatter])


def _ends(samples: FloatArray) -> tuple[float, float]:
    low, high = np.quantile(samples, (0.025, 0.975), method="closest_observation")
    return float(low), float(high)


def _estimates(chosen: Found, posterior: Posterior, flags: FloatArray) -> dict[str, Estimate]:
    at = best(chosen.bank, flags)
    values = chosen.bank.values(at.point)
    return {one.name: _estimate(one, values[one.name], posterior.values[one.name]) for one in chosen.bank.unknowns}


def _estimate(unknown: Unknown, value: float, samples: FloatArray) -> Estimate:
    low, high = unknown.bounds
    edge = 0.02 * (high - low)
    u = unknown.coordinate(value)
    null = unknown.coordinate(unknown.start)
    reached: Literal["", "low", "high"] = "low" if u < low + edge else "high" if u > high - edge else ""
    if unknown.prior is None and reached and abs(u - null) > edge:
        if unknown.kind == "inverse":
            reached = "low" if reached == "high" else "high"
        return Estimate(value, *_ends(samples), unknown.unit, reached)
    return Estimate(value, *_ends(samples), unknown.unit)


def _extended(specimen: Specimen, chosen: Found, estimates: Mapping[str, Estimate]) -> Specimen:
    """The specimen with the most probable values and every effect switched on."""
    fitted = with_values(specimen, {name: one.estimate for name, one in estimates.items()})
    return replace(fitted, title=f"{specimen.title}, extended" if chosen.effects else specimen.title, calibrate={})
