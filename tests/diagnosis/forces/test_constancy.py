"""Constancy tests: on which side a law outside the library acts, and each force under one name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.fit.setup import base_fit, measure
from diagnosis.forces import constancy
from diagnosis.forces.columns import Forces, forces
from models.housner.identification import IDENTIFICATION
from tests.diagnosis.made import SPECIMEN, recording

KINDS = {kind.name: kind for kind in IDENTIFICATION.forces}


@pytest.fixture(scope="module")
def about() -> Forces:
    """The base model about two recordings in which nothing is missing."""
    return forces(base_fit(SPECIMEN, measure(SPECIMEN, [recording(f"train_{k}", k) for k in (1, 2)])))


def left_over(about: Forces, kind: str, factor: np.ndarray) -> Forces:
    """The same with what a missing force leaves in the residuals, predicted less measured."""
    rest = about.screen.residual - 3.0 * about.column(KINDS[kind], factor)
    return replace(about, screen=replace(about.screen, residual=rest))


@pytest.mark.parametrize("kind", ["viscous_damping", "coulomb_damping", "restitution"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_loss_on_one_side_is_found_on_that_side(about: Forces, kind: str, side: float) -> None:
    """A loss that acts on one side only, its plain part and its dependent part alike."""
    one_sided = (np.sign(about.motion.coordinate) == side).astype(float)
    found = constancy.tests(left_over(about, kind, one_sided))
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
