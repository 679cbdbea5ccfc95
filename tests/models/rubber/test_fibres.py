"""Exact strip plus fibres of the difference: accuracy against the number of fibres, and open fibres."""

import numpy as np
import pytest

from models.interface.fibres import NODES, WEIGHTS, Fibres
from models.interface.strip import strip
from models.rubber import LAWS
from tests.models.interface.walls import SHORT, wall
from tests.models.rubber.laws import GIVEN, alone, numbers

B, K = 0.36, 6.21e7
MEMORY = {
    "hardening": lambda u: 0.0 * u,
    "locking": lambda u: 0.0 * u,
    "maxwell": lambda u: 0.3 * u,
    "mullins": lambda u: np.full_like(u, 2e-3),
    "permanent_set": lambda u: np.full_like(u, 2e-4),
}
"""Hidden states along the contact; Bouc-Wen is on its virgin curve."""


def force(name: str, z: float, s: float, x: np.ndarray, weights: np.ndarray, exact_part: bool) -> float:
    """Force of partial contact from stresses at ``x``: of the whole law, or of its difference to the exact strip."""
    # far enough from where it locks for the contacts drawn here
    more = {"lock_strain": 3.0} if name == "locking" else {}
    layer, u = alone(name, **more), np.maximum(x * s - z, 0.0)
    hidden = layer.relaxed(u) if name == "bouc_wen" else [MEMORY[name](u)]
    total = np.where(u > 0.0, np.maximum(layer.stress(u, hidden), 0.0), 0.0)
    return float(weights @ (total - K * u) + strip(B, K, 0.0, z, s).force if exact_part else weights @ total)


@pytest.mark.parametrize("name", LAWS)
def test_fibres_of_the_difference_beat_fibres_of_the_whole_law(name: str) -> None:
    """Random partial contacts: 16 fibres of the difference beat 16 of the whole law, all but the set 32 of it."""
    rng = np.random.default_rng(0)
    many = ((np.arange(50_000) + 0.5) / 50_000 * 2 - 1) * B, np.full(50_000, 2 * B / 50_000)
    rules = {n: tuple(B * v for v in np.polynomial.legendre.leggauss(n)) for n in (8, 16, 32)}
    errors: dict[tuple[int, bool], list[float]] = {(n, part): [] for n in rules for part in (False, True)}
    for _ in range(60):
        s = rng.uniform(2e-3, 0.03)
        z = s * B * rng.uniform(-1.0, 0.9)
        exact = force(name, z, s, *many, True)
        for n, part in errors:
            errors[n, part].append(abs(force(name, z, s, *rules[n], part) / exact - 1.0))
    middle = {key: float(np.median(found)) for key, found in errors.items()}
    assert middle[32, True] < middle[16, True] < middle[8, True]
    if name == "permanent_set":  # its own edge of contact lies inside the strip's: the difference has a step there
        assert middle[16, True] < 5e-3
    else:
        assert middle[16, True] < 5e-4
        assert middle[16, True] < 0.25 * middle[16, False]
        assert middle[16, True] < middle[32, False]


def test_hardening_against_its_closed_form() -> None:
    """Partial contact of length l: N = k S l^2/2 (1 + beta2 S^2 l^2/(2 e^2))."""
    one = wall({**SHORT, **GIVEN["hardening"], "damping_ratio": 0.0})
    fibres, rng = Fibres(one, "base"), np.random.default_rng(1)
    k = float(one.base_stiffness[0])
    for _ in range(100):
        angle = rng.uniform(2e-3, 0.03)
        s = np.sin(angle)
        z = s * B * rng.uniform(-0.9, 0.5)
        length = B - z / s
        more = fibres.difference((z, angle, 0.0, 0.0), [np.zeros((1, 16))]).force.item()
        exact = k * s * length**2 / 2 * (1 + 20.0 * (s * length / 0.01) ** 2 / 2)
        assert strip(B, k, 0.0, z, s).force + more == pytest.approx(exact, rel=2e-3)
    assert NODES.size == WEIGHTS.size == 16


def test_an_open_fibre_forgets_only_what_relaxes() -> None:
    """Open: u = 0; the Maxwell arm relaxes, the largest compression and the set stay; no force."""
    opened, still = np.zeros(3), np.array([1e-3, 5e-4, 0.0])
    for name, expected in (("maxwell", -still / 0.05), ("mullins", 0.0 * still), ("permanent_set", 0.0 * still)):
        np.testing.assert_allclose(LAWS[name].rate(opened, opened, still, numbers(name)), expected)
    for name in LAWS:
        one = wall({**SHORT, **GIVEN[name]})
        fibres = Fibres(one, "base")
        found = fibres.difference((1e-3, 1e-4, -0.2, 0.1), fibres.relaxed(np.array([-1.1e-3]), np.zeros(1)))
        assert found.force == found.moment == 0.0


@pytest.mark.parametrize("name", [name for name in LAWS if LAWS[name].hidden])
def test_what_fades_at_rest_never_becomes_a_subnormal_number(name: str) -> None:
    """Some processors need ten times as long for sums of them: a hidden state ends at zero, or stays a number."""
    law = LAWS[name]
    p = numbers(name)
    table = law.numbers(p, np.array([1e-3]))
    values = [float(np.ravel(table[wanted])[0]) for wanted in law.wanted]
    h = 1e-3
    for _ in range(60_000):
        h = law.update(0.0, 0.0, h, *values)[0]
        if h == 0.0:
            break
        assert abs(h) > np.finfo(float).tiny
