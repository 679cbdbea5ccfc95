"""Effects and base parameters of an answer, with their intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diagnosis.answer.judgement import p_of_effects
from diagnosis.answer.rescale import over_peak, true_peak
from diagnosis.answer.result import Effect
from diagnosis.answer.when import stages_of
from diagnosis.fit.intervals import Estimate, settled
from diagnosis.progress import Progress
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from diagnosis.search.variants import held_numbers, widened


def estimated(
    found: Search, chosen: Explanation, gains: Sequence[float], p_missing: float | None, progress: Progress | None
) -> tuple[Explanation, tuple[Effect, ...], dict[str, Estimate]]:
    """Effects, strongest first, and base parameters; by profile likelihood with a ``progress`` to call.

    With the explanation that they are of: a profile may have found a better optimum.
    """
    if progress:
        progress("intervals", 0.9)
    named = [x.name for c in chosen.candidates for x in c.unknowns]
    fitted, values = settled(chosen.fitted, named if progress else ())
    chosen = replace(chosen, fitted=fitted)
    values, whole = widened(values, chosen, found), held_numbers(chosen, found.tried)
    chances = p_of_effects(found, gains, chosen.candidates)
    if len(chances) == 1 and p_missing is not None:  # of the one effect it may be the bootstrap's
        chances = [p_missing]
    effects, peak = [], true_peak(chosen)
    order = sorted(zip(chosen.candidates, gains, chances, strict=True), key=lambda entry: -entry[1])
    for candidate, gain, chance in order:
        parameters = {x.name.partition(".")[2]: values.pop(x.name) for x in candidate.unknowns}
        parameters |= {name.partition(".")[2]: whole[name] for name in candidate.held}
        parameters = over_peak(parameters, candidate, chosen.measured.reference_peak, peak)
        stages = stages_of(chosen, candidate)
        effects.append(Effect(candidate.name, candidate.effect_class, parameters, gain, chance, stages))
    tabulated = tuple(f"{name}." for name, m in chosen.measured.model.mechanisms.items() if m.tabulated)
    return chosen, tuple(effects), {name: value for name, value in values.items() if not name.startswith(tabulated)}
