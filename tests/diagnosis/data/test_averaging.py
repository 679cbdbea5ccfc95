"""Samples that are compared are means of successive ones, whatever the recordings' sampling."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diagnosis.data.averaging import averaged, stride


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.integers(1, 40), st.integers(0, 99))
def test_means_of_whole_groups_and_nothing_beyond(strides: list[int], samples: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=(2, len(strides), 3, samples))
    found = averaged(values, np.array(strides))
    assert found.shape == (2, len(strides), 3, samples // min(strides))
    for w, size in enumerate(strides):
        n = samples // size
        whole = values[:, w, :, : n * size].reshape(2, 3, n, size)
        np.testing.assert_allclose(found[:, w, :, :n], whole.mean(axis=-1), rtol=0.0, atol=1e-14)
        assert not found[:, w, :, n:].any()


def test_means_keep_a_rate_of_100_hz() -> None:
    assert [stride(1.0 / rate) for rate in (50, 100, 128, 200, 250, 500, 1000)] == [1, 1, 1, 2, 2, 5, 10]
