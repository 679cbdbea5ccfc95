"""A sum of elements of one kind: two that are alike are one, and a law named alone means all its elements."""

from __future__ import annotations

import numpy as np
import pytest

from grids.consistency import check_laws
from models.errors import InputError
from models.rubber import ELEMENTS, LAWS
from tests.models.isolated.buildings import BODY, MODEL, two_tones
from tests.models.isolated.buildings import LAWS as GIVEN

YIELD = {"yield_compression": 0.01, "exponent": 2.0}


def displacement(values: dict[str, float], **options: str) -> np.ndarray:
    ran = MODEL.simulate({**BODY, **values}, two_tones(), options=options)
    return np.ravel(ran.channels["bearing_displacement"])


def yields(name: str, ratio: float) -> dict[str, float]:
    return {f"{name}.post_yield_ratio": ratio, **{f"{name}.{k}": v for k, v in YIELD.items()}}


def relaxes(name: str, ratio: float) -> dict[str, float]:
    return {f"{name}.arm_stiffness_ratio": ratio, f"{name}.relaxation_time": 0.1}


@pytest.mark.parametrize(
    ("two", "one"),
    [
        (yields("bouc_wen", 0.5) | yields("bouc_wen_2", 0.4), yields("bouc_wen", 0.2)),
        (relaxes("maxwell", 0.5) | relaxes("maxwell_2", 0.4), relaxes("maxwell", 0.9)),
    ],
    ids=["what the first leaves is shared again", "arms add up"],
)
def test_two_that_are_alike_are_one(two: dict[str, float], one: dict[str, float]) -> None:
    together, alone = displacement(two), displacement(one)
    np.testing.assert_allclose(together, alone, rtol=0.0, atol=1e-10 * np.max(np.abs(alone)))


def test_a_second_element_alone_is_the_first() -> None:
    second, first = displacement(yields("bouc_wen_2", 0.3)), displacement(yields("bouc_wen", 0.3))
    np.testing.assert_allclose(second, first, rtol=0.0, atol=1e-10 * np.max(np.abs(first)))


def test_a_law_named_alone_means_all_its_elements() -> None:
    laws = {**GIVEN["two yields"], **GIVEN["maxwell"]}
    named = displacement(laws, rubber_law="bouc_wen")
    np.testing.assert_array_equal(named, displacement(GIVEN["two yields"]))


def test_an_element_of_another_kind_is_refused_with_the_law_to_name() -> None:
    with pytest.raises(InputError, match=r"maxwell_2 are given, but the law in use is 'bouc_wen'.*= 'maxwell'"):
        check_laws({"rubber_law": "bouc_wen"}, (), ("bouc_wen", "maxwell_2"))
    check_laws({"rubber_law": "maxwell"}, (), ("maxwell", "maxwell_2"))


def test_a_number_that_an_element_cannot_have_is_refused_under_its_name() -> None:
    with pytest.raises(InputError, match=r"^bouc_wen_2.exponent is 2.5"):
        displacement({**yields("bouc_wen", 0.5), **yields("bouc_wen_2", 0.5), "bouc_wen_2.exponent": 2.5})


def test_further_elements_are_those_of_laws_of_the_family() -> None:
    assert {law.kind for law in ELEMENTS.values()} == set(LAWS)
    for name in set(ELEMENTS) - set(LAWS):
        first, again = ELEMENTS[name].mechanism, LAWS[ELEMENTS[name].kind].mechanism
        assert first.parameters == again.parameters and first.beside == again.name
        assert list(first.acts) == ["isolated"] and f"{name}" in MODEL.mechanisms
