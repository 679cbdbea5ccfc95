"""A search whose budget of work ends gives its best answer so far and says what it did not try."""

from __future__ import annotations

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from models.runs import DONE
from tests.diagnosis.made import SPECIMEN, recording, searched

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
