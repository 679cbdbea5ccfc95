"""Distributions of sampled parameters: quantiles, truncation, units, words, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.stats import lognorm, norm, truncnorm

from grids.axes import Request
from grids.axes.distributions import read_distribution
from grids.targets import Targets, find_model
from models.errors import InputError

REQUEST = Request("sample", {}, Targets(find_model("interface", ""), with_scales=True), Path("."))
SHARE = np.linspace(0.01, 0.99, 33)


def drawn(name: str, entry: object) -> np.ndarray:
    return np.asarray(read_distribution(REQUEST, name, entry)(SHARE))


def test_quantiles() -> None:
    """Against scipy's distributions."""
    cases = {
        "uniform": ([2, 4], 2 + 2 * SHARE),
        "log-uniform": ({"range": [1, 100], "unit": "MPa", "spacing": "log"}, 1e6 * 100**SHARE),
        "normal": ({"normal": [5, 0.5], "unit": "MPa"}, norm(5e6, 5e5).ppf(SHARE)),
        "lognormal": ({"lognormal": ["5 MPa", 0.4]}, lognorm(0.4, scale=5e6).ppf(SHARE)),
        "truncated": (
            {"normal": [5, 2], "truncated": [4, 9], "unit": "MPa"},
            truncnorm(-0.5, 2.0, 5e6, 2e6).ppf(SHARE),
        ),
    }
    for what, (entry, exact) in cases.items():
        np.testing.assert_allclose(drawn("layer_modulus", entry), exact, rtol=1e-9, err_msg=what)


def test_a_unit_is_not_that_of_a_logarithmic_spread() -> None:
    exact = lognorm(0.3, scale=0.05).ppf(SHARE)
    np.testing.assert_allclose(drawn("damping_ratio", {"lognormal": [5, 0.3], "unit": "%"}), exact, rtol=1e-9)


def test_words_are_equally_likely() -> None:
    words = drawn("rubber_law", ["linear", "hardening", "mullins"])
    assert words.tolist() == ["linear"] * 11 + ["hardening"] * 11 + ["mullins"] * 11
    assert read_distribution(REQUEST, "rubber_law", ["linear", "maxwell"])(np.ones(1))[0] == "maxwell"


@pytest.mark.parametrize(
    ("name", "entry", "words"),
    [
        ("layer_modulus", {"normal": [5, 0], "unit": "MPa"}, "above zero"),
        ("layer_modulus", {"lognormal": [-5, 1]}, "above zero"),
        ("layer_modulus", {"normal": [1, 1], "lognormal": [1, 1]}, "exactly one"),
        ("layer_modulus", {"normal": [1, 1], "spacing": "log"}, "not known beside normal"),
        ("layer_modulus", {"normal": [1, 1], "truncated": [3, 2]}, "low must be below high"),
        ("layer_modulus", {"normal": [1, 1], "truncated": [300, 400]}, "nothing between"),
        ("layer_modulus", {"range": [1, 2, 3]}, "two numbers"),
        ("sliding.friction", ["0.1", "inf"], "both ends must be finite; correct them"),
        (
            "sliding.friction",
            {"range": [0.1, float("inf")], "spacing": "log"},
            "both ends must be finite; correct them",
        ),
        ("sliding.friction", {"normal": [float("inf"), 1.0]}, "finite"),
        ("sliding.friction", {"lognormal": [float("inf"), 0.1]}, "finite"),
        ("sliding.friction", {"normal": [0.5, float("inf")]}, "finite"),
        ("sliding.friction", {"lognormal": [0.5, float("inf")]}, "finite"),
        ("rubber_law", ["linear"], "two different words"),
        ("rubber_law", ["linear", "hardned"], "did you mean 'hardening'"),
        ("motion", ["a", "b"], "axis of their own"),
    ],
)
def test_one_sentence(name: str, entry: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_distribution(REQUEST, name, entry)


def test_a_truncation_may_be_open_to_one_side() -> None:
    exact = truncnorm(-0.5, np.inf, 5e6, 2e6).ppf(SHARE)
    opened = drawn("layer_modulus", {"normal": [5e6, 2e6], "truncated": [4e6, float("inf")]})
    np.testing.assert_allclose(opened, exact, rtol=1e-9)


def test_what_leaves_the_bounds_says_how_to_cut_it() -> None:
    with pytest.raises(InputError, match=r"truncated = \[low, high\]"):
        drawn("damping_ratio", {"normal": [0.01, 0.1]})
