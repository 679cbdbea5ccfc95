"""What a search amounts to: verdict, p-values, what stays undecided, whether anything is explained at all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.answer.by_score import as_scored
from diagnosis.answer.heldout import Shown, relative_misfit
from diagnosis.answer.result import Undecided, Unfit, Verdict
from diagnosis.errors.adequacy import Inadequacy
from diagnosis.forces.constancy import Constancy
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Near, Search, adjusted, by_window, price
from diagnosis.search.left_out import WORSE
from diagnosis.search.null import LEAST_P
from diagnosis.search.refit import gain_by_window

UNEXPLAINED = 0.5
"""Share of the squared motion in the windows that, left over by the best model, makes any name meaningless."""
FAR, FEW, ALONE = 3.0, 2, 6.0
"""Misfit per sample of a window far from the noise, how many make an answer inadequate (one may be misread), and from
which misfit on a single one is told.

Of 100 windows with 20 independent samples two are as far with a chance of 3e-7, and one beyond 6 with 1e-14.
"""
FITTED = "the recordings fitted to"
"""What an effect rests on that makes those held out less likely."""
REFIT = "the refit alone"
"""What an effect rests on whose score is no larger than chance brings."""
CHANCE = 0.05
"""p-value from which on the strongest suspect is no stronger than chance."""


def explains(shown: Shown) -> bool:
    """Whether the model with all that was found explains more than it leaves, channels weighed alike."""
    m = shown.measured
    rest = np.where(m.mask & np.isfinite(shown.after), shown.after - m.values, m.values)
    left, whole = ((np.where(m.mask, x, 0.0) ** 2).sum(axis=(0, 2)) for x in (rest, m.values))
    return float(np.mean(left / np.maximum(whole, 1e-300))) < UNEXPLAINED


def contradicted(found: Search, held: Shown) -> tuple[float, float] | None:
    """Misfit on recordings held out without and with what was found, if that predicts them worse; else None.

    None, too, where an effect begins or ends: what acts in later recordings is then another question.
    """
    if found.best is None or any(c.spell is not None for c in found.chosen.candidates):
        return None
    without, with_it = (relative_misfit(held.measured, predicted) for predicted in (held.before, held.after))
    return (without, with_it) if with_it > WORSE * without else None


def unfit_windows(found: Search) -> tuple[Unfit, ...]:
    """The windows that what was found leaves far from the noise, the worst first.

    The likelihood counts a window that cannot be explained by its logarithm only, so that one wrong event does not pass
    for noise; what acts in a few windows alone must not go unsaid for that.
    """
    m = found.measured
    if m.stretches is not None:  # the model's own error is a part of theirs
        return ()
    fitted = found.chosen.measured
    each = by_window(found.chosen)
    far = [k for k in np.argsort(-each) if each[k] > FAR]
    if len(far) < FEW and not any(each[k] > ALONE for k in far):
        return ()
    of = [(fitted.recordings[w.recording], w, float(each[k])) for k in far for w in [fitted.windows[k]]]
    return tuple(Unfit(r.name, float(r.time[w.first]), float(r.time[w.first + w.samples - 1]), x) for r, w, x in of)


def far_from_noise(unfit: Sequence[Unfit]) -> bool:
    """Whether so many windows are left far from the noise that what was found is no explanation."""
    return len(unfit) >= FEW


def verdict_of(found: Search, near: Sequence[Near], flagged: bool, explained: bool, finished: bool) -> Verdict:
    """One of the four. ``near``: the rivals; ``flagged``: something speaks against what was found."""
    if not finished:  # what was not tried may explain it as well
        return "cannot_tell_apart"
    if flagged or not explained:
        return "not_in_library"
    if found.best is None:
        return "nothing_missing"
    others = {one.candidate.effect_class for one in near}
    return "cannot_tell_apart" if others - set(found.best.classes) else "missing"


def p_value(found: Search, gain: float) -> float:
    """Chance of a gain (less the price of shapes) by the score's null distribution; stated down to LEAST_P."""
    return max(found.null.p_value(gain), LEAST_P) if found.null else 1.0


def p_of_effects(found: Search, gains: Sequence[float], effects: Sequence[Candidate]) -> list[float]:
    """p-value of each of the effects of an answer, from its evidence less the price of its details."""
    each = [(c, gain - price(c)) for gain, c in zip(gains, effects, strict=True)]
    if len(each) == 1:
        return [p_value(found, as_scored(found, *each[0]))]
    return [p_value(found, gain) for _, gain in each]


def p_of_missing(
    found: Search,
    gains: Sequence[float],
    left: Inadequacy,
    flagged: Sequence[Constancy],
    unfit: Sequence[Unfit],
    finished: bool,
) -> float | None:
    """p-value of "something is missing"; None if a search was stopped early.

    Of the strongest effect or that of `p_of_doubts`, if less. Without an effect that of the doubts, which say that the
    model lacks something: a suspect that is not named says no such thing. Without doubts that of the strongest suspect.
    What is weak and alone counts as its score does.
    """
    least = p_of_doubts(found, left, flagged, unfit)
    if gains:
        return min([*p_of_effects(found, gains, found.chosen.candidates), *least])
    if found.null is None or not finished:
        return None
    if least:
        return min(least)
    suspects = (as_scored(found, e.candidates[0], found.gain(e)) for e in found.singles)
    return p_value(found, max(suspects, default=0.0))


def p_of_doubts(found: Search, left: Inadequacy, flagged: Sequence[Constancy], unfit: Sequence[Unfit]) -> list[float]:
    """p-values of the model's own large error, of what is not the same everywhere, and of many ``unfit`` windows."""
    least = [max(left.p_value, LEAST_P)] if left.large else []
    least += [LEAST_P] if far_from_noise(unfit) else []
    return least + [p_value(found, one.evidence) for one in flagged]


def undecided(found: Search, p_missing: float | None) -> Undecided | None:
    """What was found and is doubted, or the strongest suspect where chance hardly brings its gain."""
    if found.doubted is not None:
        one, gain, rests_on = found.doubted
        return Undecided(one.names[0], one.classes[0], gain, rests_on)
    if found.best is not None or p_missing is None or p_missing >= CHANCE or not found.singles:
        return None
    suspect = min(found.singles, key=adjusted)
    gain, rests_on = found.gain(suspect), ""
    if gain >= MISSING:
        largest = float(gain_by_window(found.base, suspect).max(initial=0.0))
        rests_on = "one window" if gain - largest < MISSING else "one recording"
    return Undecided(suspect.names[0], suspect.classes[0], gain, rests_on)
