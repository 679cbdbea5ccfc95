"""A search whose budget of work ends gives its best answer so far and says what it did not try."""

from __future__ import annotations

import models
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from models.housner.lanes.run import BENDING, substeps
from models.runs import DONE
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion, recording, searched

TRIED = ("viscous_damping", "restitution")


def test_what_a_spent_budget_leaves_out_is_said() -> None:
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, {"viscous_damping": {"rate": 0.15}}) for k in (1, 2)])
    before = DONE.steps
    fitted, errors = calibrated(SPECIMEN, measured)
    assert DONE.steps - before > 10 * measured.mask.sum()
    tried = tuple(c for c in candidates(measured, SPECIMEN) if c.name in TRIED)
    ended = searched(Search(Explanation((), fitted), tried, errors, budget=Budget(0)))
    assert ended.best is None and ended.not_tried == dict.fromkeys(TRIED, ENDED)
    whole = searched(Search(Explanation((), fitted), tried, errors))
    assert whole.best is not None and whole.best.names == ("viscous_damping",)
    assert ENDED not in whole.not_tried.values()


def test_a_step_of_a_bending_wall_counts_as_several() -> None:
    model, base = models.get("housner"), motion(1, duration=2.0)

    def work(frequency: float) -> int:
        before = DONE.steps
        values = {**TRUE, "wall_flexibility.first_frequency": frequency}
        model.simulate(values, base, duration=base.duration)
        return DONE.steps - before

    bending = model.build({**TRUE, "wall_flexibility.first_frequency": 20.0})
    steps = int(substeps(bending, TIME_STEP)[0]) * (base.horizontal.size - 1)
    assert work(20.0) >= BENDING * steps > 2 * steps
