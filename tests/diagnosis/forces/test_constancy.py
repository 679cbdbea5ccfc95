"""Constancy tests: on which side a law outside the library acts, and each force under one name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.evidence import Without
from diagnosis.errors.kicks import BEFORE
from diagnosis.errors.model import Errors
from diagnosis.forces import constancy
from diagnosis.forces.columns import Forces
from models.housner.identification import IDENTIFICATION
from tests.diagnosis.forces.left import KINDS, about_nothing, with_impacts


@pytest.fixture(scope="module")
def errors() -> tuple[Forces, Errors]:
    return about_nothing()


@pytest.fixture(scope="module")
def about(errors: tuple[Forces, Errors]) -> Forces:
    return errors[0]


def left_over(about: Forces, kind: str, factor: np.ndarray) -> Forces:
    """The same with what a missing force leaves in the residuals, predicted less measured."""
    rest = about.screen.residual - 3.0 * about.column(KINDS[kind], factor)
    return replace(about, screen=replace(about.screen, residual=rest))


@pytest.mark.parametrize("kind", ["viscous_damping", "coulomb_damping", "restitution"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_loss_on_one_side_is_found_on_that_side(errors: tuple[Forces, Errors], kind: str, side: float) -> None:
    """A loss that acts on one side only, its plain part and its dependent part alike."""
    about, estimated = errors
    one_sided = (np.sign(about.motion.coordinate) == side).astype(float)
    found = constancy.tests(left_over(about, kind, one_sided), estimated)
    own = next(t for t in found if (t.kind, t.depends_on) == (kind, "side"))
    assert own.statistic > 15.0
    assert constancy.flag(IDENTIFICATION, own, own.statistic).stronger == (
        "for theta > 0, to the right" if side > 0 else "for theta < 0, to the left"
    )


def test_friction_on_one_side_is_named_once(about: Forces) -> None:
    """sign(theta theta') times a constant couple is sign(theta) times friction."""
    twice = [
        constancy.Tested("lean", "direction of motion", 90.0, 0.0, -1.0),
        constancy.Tested("coulomb_damping", "side", 80.0, 0.0, -1.0),
    ]
    for order in (twice, twice[::-1]):
        found = constancy.flags(about, sorted(order, key=lambda t: -t.statistic))
        assert [(f.parameter, f.depends_on) for f in found] == [("coulomb_damping", "side")]
        assert found[0].stronger == "for theta < 0, to the left"
    alone = constancy.flags(about, twice[:1])
    assert [(f.parameter, f.depends_on) for f in alone] == [("coulomb_damping", "side")]


def test_the_two_names_are_one_force(about: Forces) -> None:
    outward = about.column(KINDS["lean"], np.sign(about.motion.coordinate * about.motion.rate))
    sided = about.column(KINDS["coulomb_damping"], np.sign(about.motion.coordinate))
    np.testing.assert_allclose(outward, sided, atol=1e-9 * np.abs(sided).max())


def scatter_of(errors: Errors) -> float:
    return float(np.sqrt(sum(t for c, t in zip(errors.components, errors.theta, strict=True) if c.kind == "scatter")))


def test_a_scatter_with_a_pattern_is_a_law(errors: tuple[Forces, Errors]) -> None:
    """Impacts that lose 3 % more on one side than on average pass for scatter; impacts that scatter are no law."""
    about, _ = errors
    m, kind = about.fitted.measured, KINDS["restitution"]
    shape = errors[1].kicks.columns.shape[::3]
    side = np.zeros(shape)
    events = about.events
    before = events.sample - m.first[events.window] - BEFORE
    side[events.window, events.place] = np.sign(about.motion.coordinate[events.window, before])
    column, plain = about.predicted(kind, np.sign(about.motion.coordinate)), about.predicted(kind)[..., None]
    patterned = with_impacts(errors, 0.03 * side)
    assert scatter_of(patterned) > 0.015
    assert Without.estimated(patterned, m, plain).evidence(column).without_largest > constancy.FLAG
    chance = []
    for k in range(6):
        random = with_impacts(errors, 0.03 * np.random.default_rng(k).normal(size=shape))
        chance.append(Without.estimated(random, m, plain).evidence(column).gain)
    assert max(chance) < 12.0 and np.mean(chance) < 4.0
