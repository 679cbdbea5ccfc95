"""Slenderness, inertia, onset and restitution of a block: closed forms and limits."""

import numpy as np
import pytest

from models.housner.model import MODEL
from models.housner.reference.impact import momentum_restitution


def derived(**values: float) -> dict[str, float]:
    block = MODEL.build(values)
    return {
        "alpha": float(block.slenderness[0]),
        "radius": float(block.radius[0]),
        "p": float(block.frequency_parameter[0]),
        "inertia": float(block.pivot_inertia[0]),
        "e": float(momentum_restitution(block, block.right, block.left)[0]),
        "e_of_block": float(block.momentum_restitution[0]),
    }


@pytest.mark.parametrize("alpha", [0.05, 0.2, 0.25, 0.9])
def test_rectangle(alpha: float) -> None:
    block = derived(width=2 * np.sin(alpha), height=2 * np.cos(alpha), mass=700.0, gravity=9.81)
    assert block["alpha"] == pytest.approx(alpha, rel=1e-14)
    assert block["radius"] == pytest.approx(1.0, rel=1e-14)
    assert block["inertia"] == pytest.approx(4.0 / 3.0 * 700.0, rel=1e-14)
    assert block["p"] == pytest.approx(np.sqrt(3 * 9.81 / 4), rel=1e-14)
    assert block["e"] == pytest.approx(1 - 1.5 * np.sin(alpha) ** 2, rel=1e-13)
    assert block["e_of_block"] == pytest.approx(block["e"], rel=1e-14)


def test_rectangle_stops_rocking_at_54_74_degrees() -> None:
    limit = np.arcsin(np.sqrt(2 / 3))
    assert np.degrees(limit) == pytest.approx(54.74, abs=0.005)
    assert derived(width=np.tan(limit), height=1.0, mass=1.0)["e"] == pytest.approx(0.0, abs=1e-14)
    assert derived(width=1.01 * np.tan(limit), height=1.0, mass=1.0)["e"] < 0.0


@pytest.mark.parametrize(
    ("aspect", "alpha", "onset", "e"),
    [(0.4, 11.3099, 0.200, 0.92308), (1.1, 28.8108, 0.550, 0.53551)],
)
def test_limit_of_the_paper(aspect: float, alpha: float, onset: float, e: float) -> None:
    """The wall's mass neglected, a point mass at its top."""
    block = derived(height=1.8, aspect_ratio=aspect, mass=0.0, top_mass=5000.0)
    assert np.degrees(block["alpha"]) == pytest.approx(alpha, abs=5e-5)
    assert np.tan(block["alpha"]) == pytest.approx(onset, abs=1e-12)
    assert block["e"] == pytest.approx(e, abs=5e-6)
    assert block["e"] == pytest.approx(np.cos(2 * block["alpha"]), abs=1e-14)


def test_point_mass_stops_rocking_at_45_degrees() -> None:
    assert derived(height=1.0, aspect_ratio=2.0, mass=0.0, top_mass=1.0)["e"] == pytest.approx(0.0, abs=1e-14)


def test_wall_and_top_mass_move_as_one_body() -> None:
    b, h1, h2, m1, m2, i1, i2 = 0.36, 0.9, 0.3, 1500.0, 5000.0, 600.0, 1800.0
    block = derived(
        width=2 * b, height=2 * h1, mass=m1, inertia=i1, top_mass=m2, top_mass_height=h2, top_mass_inertia=i2
    )
    total = m1 * h1 + m2 * (2 * h1 + h2)
    about_corner = i1 + m1 * (h1**2 + b**2) + i2 + m2 * ((2 * h1 + h2) ** 2 + b**2)
    assert block["alpha"] == pytest.approx(np.arctan(b * (m1 + m2) / total), rel=1e-14)
    assert block["radius"] == pytest.approx(np.hypot(b, total / (m1 + m2)), rel=1e-14)
    assert block["inertia"] == pytest.approx(about_corner, rel=1e-14)
    assert block["e"] == pytest.approx(1 - 2 * (m1 + m2) * b**2 / about_corner, rel=1e-13)


@pytest.mark.parametrize("inset", [0.1, 0.35])
def test_moved_pivot(inset: float) -> None:
    """alpha, R, I_O, onset and e all follow from b' = (1 - inset) b; the body stays what it is."""
    b, h, m = 0.3, 1.0, 100.0
    block = derived(width=2 * b, height=2 * h, mass=m, **{"pivot_inset.inset_over_half_width": inset})
    shorter, own = (1 - inset) * b, m * ((2 * b) ** 2 + (2 * h) ** 2) / 12
    about_corner = own + m * (h**2 + shorter**2)
    assert np.tan(block["alpha"]) == pytest.approx(shorter / h, rel=1e-14)
    assert block["inertia"] == pytest.approx(about_corner, rel=1e-14)
    assert block["e"] == pytest.approx(1 - 2 * m * shorter**2 / about_corner, rel=1e-13)
