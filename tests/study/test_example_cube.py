"""The small cube that ships is one that today's commands read."""

from __future__ import annotations

import numpy as np

from tests.study.cubes import EXAMPLE


def test_the_committed_cube_opens_and_maps() -> None:
    from study.open import open_study

    cube = open_study(EXAMPLE)
    onset = cube.rocking.onset_map(x="aspect_ratio", y="top_mass")
    # the more slender the wall, the earlier it rocks
    assert np.all(np.diff(onset.max("top_mass")) >= 0.0)
    assert EXAMPLE.stat().st_size < 1_000_000
