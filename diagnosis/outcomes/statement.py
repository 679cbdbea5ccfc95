"""One paragraph in plain words about outcomes."""

from __future__ import annotations

from diagnosis.answer.rivals import told_apart
from diagnosis.outcomes.adequacy import INADEQUATE, swapped
from diagnosis.outcomes.answer import Compared, OutcomeDiagnosis, Wrong
from diagnosis.outcomes.ladder import SCATTERS
from diagnosis.outcomes.search import Search
from grids.units import with_unit


def statement(answer: OutcomeDiagnosis, found: Search) -> str:
    """The paragraph; every number in it is in another field of the answer too."""
    parts = [_opening(answer)]
    if answer.wrong[0].wrong:
        parts.append(f"{_wrong(answer.wrong[0])}.")
        parts += [f"{_wrong(one)}." for one in answer.wrong[1:2]]
    if answer.effects:
        known = {repair.name: repair.mechanism for repair in found.chosen.effects}
        said = [
            known[e.name].says({name: one.estimate for name, one in e.parameters.items()})
            + f" (evidence {e.evidence:.0f}, p {_at_most(e.p_value)})"
            for e in answer.effects
        ]
        lead = "What the library can say" if answer.verdict == "not_in_library" else "Best explanation"
        parts.append(f"{lead}: {'; and '.join(said)}.")
    if answer.at_bound:
        parts.append(f"The fit runs into the end of the range of {', '.join(answer.at_bound)}: more of it is wanted.")
    if answer.rivals:
        parts += [f"Outcomes alone cannot tell {which}." for which in told_apart(answer.rivals, len(answer.effects))]
    if answer.verdict == "not_in_library":
        parts.append(why_unexplained(answer))
        base = next(one for one in answer.compared if one.cross_validated)
        if swapped(base.chance, answer.overturned):
            parts.append(
                f"The base model is right about most runs if they are turned round: are 0 and 1 swapped in column "
                f"'{found.outcomes.column}'?"
            )
    parts.append(
        f"From run to run the motion's scale at which it overturns scatters by {answer.scatter.estimate:.0%} "
        f"({answer.scatter.low95:.0%} to {answer.scatter.high95:.0%}{_end(answer)})."
    )
    parts.append(_scores(answer))
    if not answer.finished and answer.effects:
        parts.append("The search was stopped; this is what was found until then.")
    return " ".join(parts)


def _end(answer: OutcomeDiagnosis) -> str:
    """Of the scatter: the largest one that is weighed is an end of what was tried, not of what may be."""
    return ", the largest that was tried" if answer.scatter.high95 >= SCATTERS[-1] else ""


def _opening(answer: OutcomeDiagnosis) -> str:
    if not answer.finished and not answer.effects:
        return "The search was stopped before anything was found: whether something is missing is not known."
    if answer.effects:
        return f"The model leaves something out (p {_at_most(answer.p_value)})."
    if answer.verdict == "nothing_missing":
        return f"Nothing of the library is missing that these outcomes could show (p {answer.p_value:.2g})."
    return "No mechanism of the library improves the predictions, and the model does not explain the outcomes."


def why_unexplained(answer: OutcomeDiagnosis) -> str:
    """Why the outcomes count as unexplained."""
    if answer.misfit_p_value <= INADEQUATE:
        return (
            "That does not settle it: what is left hangs together within groups of runs "
            f"(p {_at_most(answer.misfit_p_value)}), so something that depends on the motion is not in the library."
        )
    if answer.slope_p_value <= INADEQUATE:
        return f"That does not settle it: what is left depends on the motion (p {_at_most(answer.slope_p_value)})."
    return "That does not settle it: runs left out are predicted worse than by a coin."


def _at_most(p: float) -> str:
    return f"at most {p:.2g}" if p <= 0.0011 else f"{p:.2g}"


def _wrong(one: Wrong) -> str:
    did = "overturned" if one.predicted == "stands" else "stood"
    where = f"Of {one.over}" if one.low is None or one.high is None else (
        f"It shows along {one.over} (standard score {one.standard_score:+.1f}): between "
        f"{with_unit(one.low, one.unit)} and {with_unit(one.high, one.unit)}"
    )  # fmt: skip
    return f"{where}, {one.wrong} of {one.runs} {did} where the base model {one.predicted}"


def _scores(answer: OutcomeDiagnosis) -> str:
    crossed = [one for one in answer.compared if one.cross_validated]
    figures = "; ".join(_score(one) for one in crossed)
    return f"Accuracy with each group of runs predicted from the others: {figures}."


def _score(one: Compared) -> str:
    a, loss = one.scores.accuracy, one.scores.log_loss
    name = one.by if "model" in one.by else f"threshold of {one.by}"
    return f"{name} {a.value:.3f} ({a.low95:.2f} to {a.high95:.2f}), log-loss {loss.value:.3f}"
