"""A force that is not the same in every window is seen; impacts that each scatter, and what is constant, are not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnosis.errors import evidence
from diagnosis.errors.likelihood import Piece, maximise
from diagnosis.errors.model import Errors
from diagnosis.forces.columns import Forces
from diagnosis.forces.constancy import FLAG
from diagnosis.forces.varying import WINDOW, varying
from models.housner.identification import IDENTIFICATION
from tests.diagnosis.forces.left import KINDS, about_nothing, with_impacts, with_residual

MANY_IMPACTS = (4, 13)
"""Motions with three impacts in most windows."""
SIZE, SCATTER = 0.08, 0.03
"""Relative changes of the rate at an impact: beyond what scatter may reach, and the largest of single ones."""


@pytest.fixture(scope="module")
def errors() -> tuple[Forces, Errors]:
    return about_nothing(MANY_IMPACTS)


def strongest(about: Forces, errors: Errors) -> dict[str, float]:
    return {test.kind: test.statistic for test in varying(about, errors, FLAG)}


def shape_of(errors: tuple[Forces, Errors]) -> tuple[int, int]:
    return errors[1].kicks.columns.shape[0], errors[1].kicks.columns.shape[3]


def test_impacts_of_one_window_that_err_alike_are_a_law_that_changes(errors: tuple[Forces, Errors]) -> None:
    """Every window's impacts lose more or less by up to 8 %."""
    windows, most = shape_of(errors)
    comes_and_goes = np.where(np.arange(windows) % 3 == 0, 1.0, -0.5)
    alike = with_impacts(errors, SIZE * np.repeat(comes_and_goes[:, None], most, axis=1))
    found = varying(errors[0], alike, FLAG)
    assert found[0].kind == "restitution" and found[0].depends_on == WINDOW
    assert found[0].statistic > FLAG


def test_impacts_that_scatter_one_by_one_are_none(errors: tuple[Forces, Errors]) -> None:
    draws = [SCATTER * np.random.default_rng(k).normal(size=shape_of(errors)) for k in range(6)]
    chance = [max(strongest(errors[0], with_impacts(errors, draw)).values()) for draw in draws]
    assert max(chance) < 10.0 and np.mean(chance) < 4.0


def test_one_window_that_is_badly_off_is_none(errors: tuple[Forces, Errors]) -> None:
    """All others gain where a share of its own takes what made the errors look large."""
    about, _ = errors
    one = np.broadcast_to((np.arange(shape_of(errors)[0]) == 4)[:, None], about.time.shape).astype(float)
    size = 200.0 / np.sqrt(about.screen.product(about.column(KINDS["contact"]), about.column(KINDS["contact"])))
    assert max(strongest(about, with_residual(errors, size * about.predicted(KINDS["contact"], one))).values()) < 5.0


def test_no_window_is_left_out_where_all_gain_far_too_little(
    errors: tuple[Forces, Errors], monkeypatch: pytest.MonkeyPatch
) -> None:
    pieces: list[int] = []

    def counted(some: Sequence[Piece], *rest: Any) -> Any:
        pieces.append(len(some))
        return maximise(some, *rest)

    monkeypatch.setattr(evidence, "maximise", counted)
    full = len(errors[1].pieces)
    for least, left_out in ((FLAG, False), (0.0, True)):
        pieces.clear()
        assert max(test.statistic for test in varying(*errors, least)) < 5.0
        assert (min(pieces) < full) is left_out


def test_nothing_missing_gains_nothing(errors: tuple[Forces, Errors]) -> None:
    assert max(strongest(*errors).values()) < 5.0


@pytest.mark.parametrize("kind", ["viscous_damping", "stiffness"])
def test_a_force_in_some_windows_is_seen_and_one_in_all_is_not(errors: tuple[Forces, Errors], kind: str) -> None:
    """Of a size that losses at impacts, which may scatter, cannot stand for."""
    about, _ = errors
    some = np.broadcast_to((np.arange(shape_of(errors)[0]) % 3 == 0)[:, None], about.time.shape).astype(float)
    size = 60.0 / np.sqrt(about.screen.product(about.column(KINDS[kind]), about.column(KINDS[kind])))
    now_and_then = with_residual(errors, size * about.predicted(KINDS[kind], some))
    always = with_residual(errors, size * about.predicted(KINDS[kind]))
    assert strongest(about, now_and_then)[kind] > FLAG
    assert strongest(about, always)[kind] < 5.0


def test_a_law_that_wears_is_not_asked(errors: tuple[Forces, Errors]) -> None:
    """It changes from window to window itself."""
    about, _ = errors
    worn = {"degradation.loss_of_restitution_per_impact": 0.002, "degradation.floor": 0.8}
    fixed = {**about.fitted.misfit.fixed, **worn}
    fitted = replace(about.fitted, misfit=replace(about.fitted.misfit, fixed=fixed))
    assert varying(replace(about, fitted=fitted), errors[1], FLAG) == []


def test_every_kind_that_moves_something_is_tested(errors: tuple[Forces, Errors]) -> None:
    assert set(strongest(*errors)) == {kind.name for kind in IDENTIFICATION.forces}
