"""Another base model as an answer: whether it stands on recordings held out, and what it is."""

from __future__ import annotations

from diagnosis.answer.heldout import worsens
from diagnosis.answer.result import OtherModel
from diagnosis.data.measured import Measured
from diagnosis.search.ladder import Climbed
from diagnosis.search.refit import Explanation


def confirmed(climbed: Climbed | None, held: Measured | None) -> Climbed | None:
    """The other model, unless it predicts recordings held out worse than the base model with all that was found.

    That is noted in `Search.not_tried` then.
    """
    if climbed is None or held is None:
        return climbed
    before, after = climbed.before, climbed.after
    if not worsens(before.chosen, after.chosen, held, after.errors):
        return climbed
    before.not_tried[climbed.rung.name] = "it predicts the recordings held out worse than the base model"
    return None


def other_model(climbed: Climbed, final: Explanation) -> OtherModel:
    """The other model with the parameters of its fit."""
    fitted = final.fitted
    like = fitted.measured.shakings[0]
    return OtherModel(
        effect=climbed.rung.name,
        model=climbed.rung.model,
        options=dict(fitted.misfit.predictor.options),
        parameters={name: value for name, value in fitted.point.values.items() if "." not in name},
        evidence=climbed.evidence,
        instead=() if climbed.before.best is None else climbed.before.best.names,
        inadequate=climbed.inadequate,
        vertical=like.vertical is not None and like.vertical_acts,
    )
