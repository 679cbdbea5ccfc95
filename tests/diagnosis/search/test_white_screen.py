"""The screen against white noise is made once for a fit and its errors."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.search import white_screen
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, further
from diagnosis.search.screen import score
from diagnosis.search.weighing import as_white_noise
from diagnosis.search.white_screen import against_white_noise
from tests.diagnosis.made import SPECIMEN, recording


def test_it_is_made_once_for_a_fit_and_anew_for_another(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = [c for c in candidates(measured, SPECIMEN) if c.name in ("tilt", "restitution", "gain")]
    found = Search(Explanation((), fitted), tuple(some), errors)
    made = []
    monkeypatch.setattr(white_screen, "score", lambda *given: made.append(given) or score(*given))

    _, scores = against_white_noise(found, found.base, some)
    directly = score(linearise_about(as_white_noise(fitted, errors)), some)
    assert [one.candidate for one in scores] == [one.candidate for one in directly]
    assert [one.statistic for one in scores] == pytest.approx([one.statistic for one in directly])

    _, fewer = against_white_noise(found, found.base, some[1:])
    assert len(made) == 1 and {one.candidate for one in fewer} == set(some[1:])

    other = further(found.base, 1)
    against_white_noise(found, other, some)
    assert len(made) == 2
    found.errors = replace(errors)
    against_white_noise(found, other, some)
    assert len(made) == 3
