"""The catalogue as declared: names, nulls, ranges and classes that files and reports rely on."""

import numpy as np
import pytest

from models.mechanisms import MECHANISMS
from tests.models.mechanisms.cases import HOUSNER, TYPICAL, WALL, dotted

INF = np.inf
OF_A_TABLE = "table_force"
TABLE = {
    "vertical_acceleration": ("vertical_acceleration", {"kappa": (0, 0, 1.5)}),
    "sliding": ("sliding", {"friction": (INF, 0.03, 1.5)}),
    "pivot_inset": ("contact_geometry", {"inset_over_half_width": (0, 0, 0.35)}),
    "rounded_corner": ("contact_geometry", {"radius_over_half_width": (0, 0, 0.3)}),
    "crushing": ("contact_geometry", {"inset_per_rotation": (0, 0, 5)}),
    "tilt": ("tilt", {"tilt": (0, -0.05, 0.05)}),
    "eccentricity": ("eccentricity", {"offset_over_half_width": (0, -0.2, 0.2)}),
    "flexible_joint": ("flexible_joint", {"angle": (0, 0, 0.03)}),
    "added_stiffness": ("added_stiffness", {"over_m_g_R": (0, -0.5, 0.5), "gap": None}),
    "table_pitch": ("table_pitch", {"pitch_per_acceleration": (0, -0.003, 0.003), "low_pass_hz": None}),
    "restitution": ("restitution", {"factor_on_housner": (1, 0.5, 1.1)}),
    "velocity_restitution": ("velocity_restitution", {"beta": (0, -0.2, 0.5)}),
    "bounce": ("bounce", {"contact_restitution": (0, 0, 0.6)}),
    "viscous_damping": ("viscous_damping", {"rate": (0, 0, 1)}),
    "coulomb_damping": ("coulomb_damping", {"over_m_g_b": (0, 0, 0.1)}),
    "quadratic_damping": ("quadratic_damping", {"coefficient": (0, 0, 5)}),
    "degradation": ("degradation", {"loss_of_restitution_per_impact": (0, 0, 0.03), "floor": None}),
    "wall_flexibility": ("wall_flexibility", {"first_frequency": (INF, 3, 100)}),
}


@pytest.mark.parametrize("name", TABLE)
def test_a_mechanism_is_declared_as_in_the_catalogue(name: str) -> None:
    effect_class, parameters = TABLE[name]
    mechanism = HOUSNER.mechanisms[name]
    assert mechanism.effect_class == effect_class
    assert [p.name for p in mechanism.parameters] == list(parameters)
    for parameter in mechanism.parameters:
        catalogued = parameters[parameter.name]
        assert parameter.shape == (catalogued is None)
        if catalogued is not None:
            assert (parameter.null, parameter.low, parameter.high) == catalogued
            assert parameter.fit_inverse == np.isinf(parameter.null)


def test_nothing_acts_that_the_catalogue_does_not_name() -> None:
    assert list(HOUSNER.mechanisms) == [m.name for m in MECHANISMS if "housner" in m.acts]
    assert set(HOUSNER.mechanisms) == {*TABLE, OF_A_TABLE} == set(TYPICAL)
    assert [name for name, form in HOUSNER.mechanisms.items() if form.tabulated] == [OF_A_TABLE]


@pytest.mark.parametrize("name", TABLE)
def test_a_report_can_print_the_sentence(name: str) -> None:
    mechanism = HOUSNER.mechanisms[name]
    sentence = mechanism.sentence.format(**{**mechanism.nulls, **TYPICAL[name]})
    assert "{" not in sentence and len(sentence) > 20
    assert mechanism.equation and mechanism.signature and mechanism.source


@pytest.mark.parametrize(
    ("one", "other"),
    [("sliding", "bounce"), ("sliding", "wall_flexibility"), ("coulomb_damping", "wall_flexibility")],
)
def test_mechanisms_that_do_not_act_together_are_refused(one: str, other: str) -> None:
    values = {**WALL, **dotted(one, TYPICAL[one]), **dotted(other, TYPICAL[other])}
    (sentence,) = HOUSNER.check(values)
    assert one in sentence and other in sentence
    assert not HOUSNER.check({**values, **dotted(other, HOUSNER.mechanisms[other].nulls)})
