"""The linear chain: matrices, natural frequencies, modal damping, and its exact step.

M x'' + C x' + K x = -M 1 a - e_1 f, M = diag(m_j), K tridiagonal with k_b at the bearings and k_s at every storey,
C likewise; f is what the bearings' force has beyond k_b x_1 + c_b x_1'.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

from models.base import FloatArray
from models.isolated.chain import Chain
from models.isolated.declaration import MODES


def tridiagonal(levels: int, base: FloatArray, storey: FloatArray) -> FloatArray:
    """Matrix ``(n, levels, levels)`` of a chain with values ``base`` and ``storey`` (n,) between levels."""
    links = np.concatenate([base[:, None], np.repeat(storey[:, None], levels - 1, axis=1)], axis=1)
    matrix = np.zeros((base.size, levels, levels))
    at = np.arange(levels)
    matrix[:, at, at] = links
    matrix[:, at[:-1], at[:-1]] += links[:, 1:]
    matrix[:, at[1:], at[:-1]] = matrix[:, at[:-1], at[1:]] = -links[:, 1:]
    return matrix


def modes(chain: Chain, levels: int) -> tuple[FloatArray, FloatArray]:
    """Circular frequencies (rad s-1), ascending, and damping ratios, ``(n, levels)``, of chains of one length.

    The ratios come from the diagonal of the modal damping matrix: the dashpots do not follow the springs, so the
    modes are coupled by the others.
    """
    root = 1.0 / np.sqrt(chain.masses[:, :levels])
    weight = root[:, :, None] * root[:, None, :]
    squares, shapes = np.linalg.eigh(tridiagonal(levels, chain.stiffness, chain.storey_stiffness) * weight)
    omega = np.sqrt(np.maximum(squares, 0.0))
    lost = tridiagonal(levels, chain.damping, chain.storey_damping) * weight
    return omega, np.asarray(np.einsum("nik,nij,njk->nk", shapes, lost, shapes) / (2.0 * omega))


def derived(chain: Chain) -> dict[str, FloatArray]:
    """The declared derived quantities, arrays ``(n,)``."""
    frequencies, ratios = np.full((2, chain.size, MODES), np.nan)
    for levels in np.unique(chain.levels):
        lanes = np.flatnonzero(chain.levels == levels)
        omega, damping = modes(chain.take(lanes), int(levels))
        kept = min(int(levels), MODES)
        frequencies[lanes, :kept] = omega[:, :kept] / (2.0 * np.pi)
        ratios[lanes, :kept] = damping[:, :kept]
    found = {"mass": chain.mass}
    found |= {f"frequency_{k + 1}": frequencies[:, k] for k in range(MODES)}
    return found | {f"modal_damping_{k + 1}": ratios[:, k] for k in range(MODES)}


def exact_step(chain: Chain, levels: int, h: FloatArray) -> tuple[FloatArray, FloatArray]:
    """y1 = P y0 + G (a0, a1, f0, f1) for y = (x, x'), a and f linear over a step of ``h`` (n,) seconds.

    ``P`` (n, 2 levels, 2 levels) and ``G`` (n, 2 levels, 4), by the exponential of the matrix that holds the
    inputs and their slopes as states too (Van Loan, IEEE Trans. Autom. Control 23, 1978), with time
    in steps and rates in metres per step, so that it is well scaled. It is computed once for lanes of one building.
    """
    numbers = np.column_stack([
        chain.masses[:, :levels], chain.stiffness, chain.damping, chain.storey_stiffness, chain.storey_damping, h
    ])  # fmt: skip
    places: dict[bytes, int] = {}
    building = np.array([places.setdefault(row.tobytes(), len(places)) for row in numbers])
    one = np.unique(building, return_index=True)[1]
    transitions, gains = _exact_steps(chain.take(one), levels, h[one])
    return transitions[building], gains[building]


def _exact_steps(chain: Chain, levels: int, h: FloatArray) -> tuple[FloatArray, FloatArray]:
    """`exact_step` of every lane by itself."""
    inverse = 1.0 / chain.masses[:, :levels]
    size = 2 * levels
    whole = np.zeros((chain.size, size + 4, size + 4))
    at = np.arange(levels)
    whole[:, at, levels + at] = 1.0
    per_mass, step = inverse[:, :, None], h[:, None, None]
    stiffness = tridiagonal(levels, chain.stiffness, chain.storey_stiffness)
    damping = tridiagonal(levels, chain.damping, chain.storey_damping)
    whole[:, levels:size, :levels] = -(step**2) * per_mass * stiffness
    whole[:, levels:size, levels:size] = -step * per_mass * damping
    whole[:, levels:size, size] = -(h[:, None] ** 2)
    whole[:, levels, size + 2] = -(h**2) * inverse[:, 0]
    # a' and f' over a step
    whole[:, size, size + 1] = whole[:, size + 2, size + 3] = 1.0
    found = expm(whole)[:, :size]
    found[:, levels:] /= step
    found[:, :, levels:size] *= step
    level, slope = found[:, :, size::2], found[:, :, size + 1 :: 2]
    ends = np.stack(
        [level[..., 0] - slope[..., 0], slope[..., 0], level[..., 1] - slope[..., 1], slope[..., 1]], axis=2
    )
    return np.ascontiguousarray(found[:, :, :size]), ends
