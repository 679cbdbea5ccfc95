"""The base model itself may be the wrong one: other base models, compared with the best that this one can do.

A model declares which ones (`models.identification.Rung`). Each is fitted to the same windows and channels, the
specimen's parameters with their tolerances carried over and what it has more searched in its ranges. It is tried where
the base model with the best mechanism leaves more than the sensors' noise and its errors, as estimated, hold a smooth
error of the model beyond chance, or events that scatter as much as they may. It is named where it explains clearly more
than the base model with all mechanisms found, each under the errors estimated with itself
(`diagnosis.errors.likelihood.by_piece`): twice the log likelihood rises by what a further effect must bring, after the
other model has paid for its parameters and for every state more that it starts a window from, and still does without
the window that weighs most, and under its own errors without that of every recording.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.data.measured import Measured, for_model, identification_of
from diagnosis.errors.adequacy import inadequacy
from diagnosis.errors.model import Errors, disturbance_about, refitted
from diagnosis.fit.growing import fit_from
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import with_noise_of_the_base
from diagnosis.fit.solver import fit
from diagnosis.fit.starts import Origin, nominal
from diagnosis.fit.unknowns import clip, fixed_values, in_range, of_specimen
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.progress import Progress
from diagnosis.search.budget import ENDED, LADDER, Budget
from diagnosis.search.candidates import Candidate
from diagnosis.search.details import least
from diagnosis.search.found import Search, adequate, adjusted, left_over_white_noise, price
from diagnosis.search.refit import Explanation, gain_by_window
from diagnosis.search.weighing import reweighed
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models import get
from models.base import FloatArray
from models.errors import InputError
from models.identification import Rung

LEFT = 1.5
"""Misfit per sample, over the sensors' noise, from which on other base models are tried."""
CHANCE = 0.05
"""p-value of a smooth error of the model above which coloured noise and scatter of events explain what is left."""
DECISIVE = 2.0
"""Gain over that of the best single mechanism with which another base model that errs nowhere ends the search."""
WORSE = "it explains less of the recordings than what was found with the base model"
PER_STATE = 2.0
"""What every state that a window starts from beyond those of the base model costs."""


@dataclass(frozen=True)
class Climbed:
    """Another base model in the place of the one given: the search ``before`` it, and ``after``.

    ``evidence``: gain in 2 log likelihood over all that the one given could do, prices paid; ``inadequate``: with that
    it errs clearly.
    """

    rung: Rung
    before: Search
    after: Search
    evidence: float
    inadequate: bool

    @property
    def gain(self) -> float:
        """The same before prices, as the evidence of mechanisms is given."""
        return self.evidence + price(self.after.chosen.candidates[0])


@dataclass(frozen=True)
class Weighed:
    """A fit converged together with its own errors: ``deviance`` and its parts ``by_window`` (W,), prices paid."""

    explanation: Explanation
    errors: Errors
    deviance: float
    by_window: FloatArray

    def over(self, other: Weighed) -> tuple[float, float]:
        """Gain over another fit, and the same without the window that weighs most."""
        gain = other.deviance - self.deviance
        return gain, gain - max(float(np.max(other.by_window - self.by_window)), 0.0)


def rungs(
    found: Search, specimen: Specimen, held: Sequence[Recording], seed: int, progress: Progress
) -> list[tuple[Rung, Weighed]]:
    """Other base models fitted to the recordings, if the search so far asks for one; `Search.not_tried`: which are not.

    ``held``: recordings held out, which have to hold what the other model starts a window from.
    """
    ladder = found.measured.identification.ladder
    if not ladder or not _asked(found):
        return []
    budget = Budget(LADDER)
    recordings = [*found.measured.recordings, *held]
    below, best, tried = [_plain(found.base)], _plain(found.chosen), []
    for rung in ladder:
        if not _meant_for(rung, recordings):
            continue
        why = ENDED if budget.spent or found.whole.spent else _refusal(rung, specimen)
        if not why:
            progress(f"another base model: {rung.name.replace('_', ' ')}", 0.48)
            try:
                below.append(_fitted(rung, specimen, below, best, recordings, seed))
                tried.append((rung, _weighed(below[-1])))
            except InputError as error:
                why = str(error)
        if why:
            found.not_tried[rung.name] = why
    found.budget = found.budget.after(budget)  # the search's own work goes on where it was
    return tried


def _asked(found: Search) -> bool:
    """Whether what stands leaves more than the sensors' noise, and its errors hold what no sensor explains."""
    smooth, errors = inadequacy(found.errors), found.errors
    if smooth.large:
        return True
    if left_over_white_noise(found.chosen, errors) < LEFT:
        return False
    unlikely = not smooth.judged or smooth.p_value < CHANCE or errors.scatter >= errors.most_scatter
    return unlikely or not adequate(found.chosen)


def climb(found: Search, tried: Sequence[tuple[Rung, Weighed]], *, decisive: bool) -> Climbed | None:
    """The search with the best of the other base models, if the recordings ask for it.

    ``decisive``: only if it errs nowhere, leaves no law outside the library and gains `DECISIVE` times as much as the
    best single mechanism, so that no further mechanism need be looked for.
    """
    if not tried:
        return None
    before = _as_found(found)
    rung, best = min(tried, key=lambda entry: entry[1].deviance)
    evidence, rest = best.over(before)
    if rest < found.more:
        return None
    if decisive:
        start = _as_found(found.at_null or found, base=True)
        if inadequacy(best.errors).large or best.over(start)[0] < DECISIVE * before.over(start)[0]:
            return None
    on = replace(best, explanation=reweighed(best.explanation, best.errors))
    if _elsewhere(found, on) < found.more:
        return None
    others = [one.explanation for _, one in tried if one is not best]
    errs = found.outside is not None or inadequacy(found.errors).large
    after = _on(found, on, others)
    return None if decisive and _leaves_a_law(after) else Climbed(rung, found, after, evidence, errs)


def _elsewhere(found: Search, best: Weighed) -> float:
    """Gain over what was found without the window of each recording that weighs most, under the other model's errors.

    What happens once in a recording, a blow to its base for instance, can be fitted by states that are free in its
    window; left unexplained it makes the errors larger everywhere, so that each window gains by errors of its own.
    """
    gains = gain_by_window(reweighed(found.chosen, best.errors), best.explanation)
    gains = gains - (adjusted(best.explanation) - best.explanation.loss) / gains.size
    of = found.measured.recording_of
    largest = [max(float(gains[of == r].max()), 0.0) for r in np.unique(of)]
    if len(largest) == gains.size:  # of each recording one window
        return float(gains.sum()) - max(largest)
    return float(gains.sum()) - sum(largest)


def _leaves_a_law(found: Search) -> bool:
    """Whether a force that no mechanism has acts beside what was found."""
    if not found.measured.identification.forces:
        return False
    return bool(found.tested(found.chosen).flags(least(found, found.chosen)))


def _meant_for(rung: Rung, recordings: Sequence[Recording]) -> bool:
    held = [all(c in r.channels for r in recordings) for c in rung.recorded]
    return all(held) and not any(all(c in r.channels for r in recordings) for c in rung.not_recorded)


def _refusal(rung: Rung, specimen: Specimen) -> str:
    acting = get(rung.model).mechanisms
    own = [n for n in specimen.mechanisms if n in get(specimen.model).mechanisms and n not in acting]
    if own:
        return f"{', '.join(own)} does not act on model {rung.model}"
    return rung.refusal(_nominal(specimen))


def _nominal(specimen: Specimen) -> dict[str, float]:
    """The specimen's own parameters, those to be calibrated at where their search starts."""
    unknown = {x.name: x.start for x in of_specimen(specimen, get(specimen.model)) if "." not in x.name}
    return {**unknown, **specimen.parameters}


def _plain(explanation: Explanation) -> Explanation:
    """The explanation refitted as if the errors were the sensors' white noise."""
    f = explanation.fitted
    plain = replace(f.misfit, whitening=sensor_noise_only(f.misfit.predictor))
    return replace(explanation, fitted=fit(plain, f.u, f.states))


def _fitted(
    rung: Rung,
    specimen: Specimen,
    below: Sequence[Explanation],
    found: Explanation,
    recordings: Sequence[Recording],
    seed: int,
) -> Explanation:
    """The other model on the same windows, as an explanation with one effect: the rung.

    Its search goes on from the base model and the rungs ``below``, too, and from what is likely. Raises InputError
    where it does worse than what was ``found``, all against white noise of the sensors.
    """
    base_model = below[0]
    plain = _misfit(rung, specimen, base_model.measured, recordings)
    origins = [nominal(plain), *(_origin(plain, one) for one in below)]
    likely = {f"{rung.name}.{name}": value for name, value in rung.likely(_nominal(specimen)).items()}
    places = [origins]
    if likely:
        places.append([_with(plain, origin, likely) for origin in origins])
    fitted = min((fit_from(plain, place, seed, found.loss) for place in places), key=lambda one: one.loss)
    if fitted.loss > found.loss:
        raise InputError(WORSE)
    own = tuple(x for x in plain.unknowns if x.name.startswith(f"{rung.name}."))
    states = len(plain.measured.free) - len(base_model.measured.free)
    price = PER_STATE * (states * len(plain.measured.windows) + 1)
    return Explanation((Candidate(rung.mechanism, own, {}, price=price),), with_noise_of_the_base(fitted))


def _misfit(rung: Rung, specimen: Specimen, measured: Measured, recordings: Sequence[Recording]) -> Misfit:
    """Of the other model on the same windows, against white noise of the sensors."""
    other = get(rung.model)
    channel = {state.name: state.channel for state in identification_of(other).free}
    alike = {s: of for s, of in rung.alike.items() if not all(channel[s] in r.channels for r in recordings)}
    seen = for_model(measured, other, alike, rung.bonded)
    ranges = rung.ranges(_nominal(specimen))
    own = tuple(in_range(f"{rung.name}.{p.name}", p.unit, *ranges[p.name]) for p in rung.parameters)
    base = tuple(x for x in of_specimen(specimen, measured.model) if x.name not in rung.without)
    predictor = Predictor(seen, _options(rung, specimen.options), specimen.stages, rung=rung)
    return Misfit(predictor, sensor_noise_only(predictor), (*base, *own), fixed_values(specimen))


def _with(misfit: Misfit, origin: Origin, values: Mapping[str, float]) -> Origin:
    """The same start with some ``values`` known."""
    own = [(x.coordinate(values[x.name]), True) if x.name in values else None for x in misfit.unknowns]
    given = [one or (u, known) for one, u, known in zip(own, origin.u, origin.known, strict=True)]
    u, known = (np.array(each) for each in zip(*given, strict=True))
    return replace(origin, u=clip(misfit.unknowns, u), known=known)


def _origin(misfit: Misfit, below: Explanation) -> Origin:
    """What another base model's fit knows of this one's parameters and states: rungs share bare names."""
    rung = misfit.predictor.rung
    rungs = {c.name for c in below.candidates} | ({rung.name} if rung else set())

    def plain(name: str) -> str:
        of, _, parameter = name.rpartition(".")
        return parameter if of in rungs else name

    values = {plain(name): value for name, value in below.fitted.values.items()}
    own = [plain(x.name) for x in misfit.unknowns]
    u = [x.coordinate(values.get(name, x.start)) for x, name in zip(misfit.unknowns, own, strict=True)]
    fitted = dict(zip(below.measured.free, below.fitted.states.T, strict=True))
    states = [fitted.get(name, x) for name, x in zip(misfit.measured.free, misfit.measured.states.T, strict=True)]
    return Origin(clip(misfit.unknowns, np.array(u)), np.stack(states, axis=1), np.array([n in values for n in own]))


def _options(rung: Rung, given: Mapping[str, str]) -> dict[str, str]:
    """Options of the other model: the rung's own, and those of the specimen that it knows too."""
    known = get(rung.model).options
    return {name: word for name, word in given.items() if word in known.get(name, ())} | dict(rung.options)


def _weighed(explanation: Explanation) -> Weighed:
    """The explanation and its errors, each estimated under the other in turn."""
    fitted, errors = refitted(explanation.fitted, disturbance_about(explanation.fitted))
    return _judged(replace(explanation, fitted=fitted), errors)


def _as_found(found: Search, base: bool = False) -> Weighed:
    """What the search has found, or its ``base`` model, with the errors estimated there."""
    return _judged(found.base if base else found.chosen, found.errors)


def _judged(explanation: Explanation, errors: Errors) -> Weighed:
    return Weighed(explanation, errors, errors.loss + adjusted(explanation) - explanation.loss, errors.by_window)


def _on(found: Search, best: Weighed, others: Sequence[Explanation]) -> Search:
    """The search with the other model, under the errors estimated with it."""
    on = best.explanation
    tried = [on, *(reweighed(other, best.errors) for other in others)]
    return replace(
        found, base=reweighed(found.base, best.errors), best=on, errors=best.errors, tried=tried, singles=[],
        weighed=on, outside=None, about=None,
    )  # fmt: skip
