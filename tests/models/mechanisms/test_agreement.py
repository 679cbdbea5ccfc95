"""The kernel against the reference for random values of every mechanism, free and under a pulse.

Both runs stay away from overturning, so neighbouring trajectories stay neighbours and the error is that
of the kernel's steps: 1e-7 and less of the peak. Where a law has a kink inside a step (a row of a table, the gap of a
spring, the largest rotation so far of a crushing corner) it is of second order in the step and larger;
a bending wall and a flexible joint are fast and shorten the steps, and their error is that of steps of .15 and .2 rad.
"""

import zlib

import numpy as np
import pytest

from models.shaking import Shaking
from models.tables import KNOTS, row
from tests.models.mechanisms.cases import ALPHA, HOUSNER, TYPICAL, WALL, by_lanes, by_reference, dotted, free, pulse

ACCURACY = {
    "table_force": 5e-5,
    "added_stiffness": 2e-5,
    "crushing": 2e-6,
    "flexible_joint": 3e-6,
    "wall_flexibility": 3e-6,
}


def random_values(name: str, rng: np.random.Generator) -> dict[str, float]:
    """Between a third and all of the typical distance from the null (of the inverse where that is infinite)."""
    found = {}
    for parameter in HOUSNER.mechanisms[name].parameters:
        typical, share = TYPICAL[name][parameter.name], float(rng.uniform(0.35, 1.0))
        if parameter.fit_inverse:
            found[parameter.name] = typical / share
        elif parameter.shape:
            found[parameter.name] = typical
        else:
            sign = 1.0 if parameter.low >= parameter.null else float(rng.choice([-1.0, 1.0]))
            found[parameter.name] = parameter.null + sign * share * (typical - parameter.null)
    return dotted(name, found)


def cases(name: str) -> list[tuple[dict[str, float], Shaking, dict[str, float]]]:
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    start = {"rotation_1": float(rng.uniform(0.3, 0.6)) * ALPHA, "rotation_rate_1": float(rng.uniform(-0.1, 0.1))}
    return [
        ({**WALL, **random_values(name, rng)}, pulse(float(rng.uniform(3.9, 4.2)), 0.5, rest=1.6), {}),
        ({**WALL, **random_values(name, rng)}, free(1.8), start),
    ]


@pytest.mark.parametrize("name", TYPICAL)
def test_kernel_equals_reference(name: str) -> None:
    for values, shaking, start in cases(name):
        fast, slow = by_lanes(values, shaking, start), by_reference(values, shaking, start)
        peak = slow.outputs["peak_rotation"]
        assert 0.05 * ALPHA < peak < 0.9 * ALPHA
        accuracy = ACCURACY.get(name, 2e-7)
        np.testing.assert_allclose(fast.rotation, slow.rotation, rtol=0, atol=accuracy * peak)
        size = max(float(np.max(np.abs(slow.shift))), 1e-3)
        np.testing.assert_allclose(fast.shift, slow.shift, rtol=0, atol=10 * accuracy * size)
        assert [kind for _, kind in fast.events] == [kind for _, kind in slow.events]
        for output in ("impacts", "overturned", "status"):
            assert fast.outputs[output] == slow.outputs[output]
        for output in ("onset_time", "uplift_duration", "dissipated_energy"):
            expected = slow.outputs[output]
            np.testing.assert_allclose(fast.outputs[output], expected, rtol=max(1e-6, accuracy), err_msg=output)
        # the kernel looks at the ends of its steps and at events, the reference at eight points of its own
        np.testing.assert_allclose(fast.outputs["friction_demand"], slow.outputs["friction_demand"], rtol=5e-3)


@pytest.mark.parametrize(
    ("name", "order"),
    [
        ("viscous_damping", 3.5),
        ("rounded_corner", 3.5),
        ("flexible_joint", 3.5),
        ("sliding", 3.5),
        ("bounce", 3.5),
        ("wall_flexibility", 3.5),
        ("added_stiffness", 1.5),
    ],
)
def test_the_kernel_converges_to_the_reference(name: str, order: float) -> None:
    """With the fourth power of the step, with the second where a kink lies inside a step."""
    values, shaking, start = cases(name)[1]
    slow = by_reference(values, shaking, start).rotation
    coarse = np.max(np.abs(by_lanes(values, shaking, start, refinement=1).rotation - slow))
    fine = np.max(np.abs(by_lanes(values, shaking, start, refinement=4).rotation - slow))
    assert np.log(coarse / fine) / np.log(4.0) > order


def test_the_onset_under_a_table_that_bends_within_the_step_is_that_of_the_reference() -> None:
    """The couple over the base acceleration bends at a row that the base passes within the step of the onset."""
    # the row is at just below the acceleration at which the block lifts, that it changes itself
    shaking, bend = pulse(4.0, 0.5, rest=0.5), 2.0235
    law = {row("base", "below", 1): 0.3, row("base", "above", 1): -0.3}

    values = {**WALL, **dotted("table_force", {"reach_base": (KNOTS - 1) * bend, **law})}
    slow = by_reference(values, shaking, {}).outputs["onset_time"]
    assert bend / abs(float(np.interp(slow, shaking.time, shaking.horizontal))) == pytest.approx(0.998, abs=5e-4)
    assert by_lanes(values, shaking, {}).outputs["onset_time"] == pytest.approx(slow, rel=1e-8)
