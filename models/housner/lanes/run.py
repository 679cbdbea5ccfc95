"""From blocks and a shaking to the tables of the lane kernel, and back to results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.housner.block import Block
from models.housner.declaration import REST_VELOCITY
from models.housner.lanes import rows as r
from models.housner.lanes.advance import advance
from models.housner.pitch import pitch as low_passed
from models.shaking import Shaking

EVENTS = ("onset", "impact", "rest", "overturned")
LARGEST_PHASE = 0.0075
"""Largest p h of a step (rad); the error of the rule falls with its fourth power."""
JOINT_PHASE = 0.2
MODAL_PHASE = 0.15
"""Largest phase (rad) of a bending wall's mode in a step, at its frequency while the wall rocks."""
CHUNK = 64


@dataclass(frozen=True)
class Lanes:
    """What the kernel returns for n lanes: the table of results, samples and events if asked for."""

    result: NDArray[np.float64]
    rotation: NDArray[np.float64] | None
    rate: NDArray[np.float64] | None
    shift: NDArray[np.float64] | None
    events: tuple[tuple[tuple[float, str], ...], ...] | None
    steps: int


def substeps(block: Block, time_step: float) -> NDArray[np.int64]:
    """Steps per sample of the record, lane by lane: never a matter of which lanes run together."""
    phase = block.frequency_parameter * time_step / LARGEST_PHASE
    with np.errstate(divide="ignore"):
        joint = np.where(
            block.joint_angle > 0.0,
            block.frequency_parameter
            * np.sqrt(block.slenderness / np.maximum(block.joint_angle, 1e-12))
            * time_step
            / JOINT_PHASE,
            0.0,
        )
    bends = np.isfinite(block.first_frequency)
    rigid = 1.0 - block.modal_moment**2 / (block.modal_mass * block.pivot_inertia)
    mode = np.where(bends, 2.0 * np.pi * block.first_frequency, 0.0) / np.sqrt(rigid) * time_step / MODAL_PHASE
    return np.maximum(1, np.ceil(np.maximum(np.maximum(phase, joint), mode) - 1e-9)).astype(np.int64)


def refine(samples: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Linear interpolation at n steps per sample."""
    if n == 1:
        return samples
    fine = np.arange((samples.size - 1) * n + 1)
    return np.interp(fine / n, np.arange(samples.size), samples)


def records(shaking: Shaking, n: int, tail: float, pitch: float | None) -> tuple[FloatArray, FloatArray, int]:
    """The record at the ends of the steps with its quiet tail, extremes of its chunks, steps of shaking."""
    step = shaking.time_step / n
    quiet = int(np.ceil(tail / step - 1e-9))
    channels = [shaking.horizontal, shaking.vertical]
    channels += list(low_passed(shaking.horizontal, shaking.time_step, pitch)) if pitch is not None else [None, None]
    shaken = (shaking.horizontal.size - 1) * n
    record = np.zeros((5, shaken + quiet + 2))
    record[4, :shaken] = 1.0
    for row, samples in enumerate(channels):
        if samples is not None:
            record[row, : shaken + 1] = refine(samples, n)
    if quiet:
        record[:, shaken + 1 :] = 0.0
    count = record.shape[1] // CHUNK
    chunk = np.zeros((4, max(count, 1)))
    if count:
        size = np.abs(record[:4])
        chunk[:] = size[:, : count * CHUNK].reshape(4, count, CHUNK).max(axis=2)
        ends = size[:, CHUNK : count * CHUNK + 1 : CHUNK]
        chunk[:, : ends.shape[1]] = np.maximum(chunk[:, : ends.shape[1]], ends)
    return record, chunk, shaken


def given_table(block: Block, scale: FloatArray, initial: Mapping[str, FloatArray]) -> FloatArray:
    """The constants of the lanes, a line a lane with the columns of `rows`."""
    table = np.zeros((block.size, r.N_GIVEN))
    p, alpha = block.frequency_parameter, block.slenderness
    with np.errstate(divide="ignore"):
        joint = np.where(block.joint_angle > 0.0, 1.0 / block.joint_angle, -1.0)
    for row, values in (
        (r.Q_SCALE, scale),
        (r.Q_OFFSET, block.offset),
        (r.Q_GRAVITY, block.gravity),
        (r.Q_VSCALE, block.vertical_factor * scale),
        (r.Q_MASS, block.mass),
        (r.Q_HEIGHT, block.height),
        (r.Q_RIGHT, block.right),
        (r.Q_LEFT, block.left),
        (r.Q_INERTIA, block.inertia),
        (r.Q_RESTITUTION, block.restitution),
        (r.Q_FACTOR, block.restitution_factor),
        (r.Q_ASPECT, block.aspect_coefficient * block.aspect**2),
        (r.Q_EXPONENT, block.amplitude_exponent),
        (r.Q_SLOPE, block.velocity_slope),
        (r.Q_LOSS, block.loss_per_impact),
        (r.Q_FLOOR, block.restitution_floor),
        (r.Q_REST, REST_VELOCITY * p * alpha),
        (r.Q_ALPHA, alpha),
        (r.Q_P, p),
        (r.Q_RHO, block.corner_radius),
        (r.Q_CRUSH, block.crushing_rate),
        (r.Q_JOINT, joint),
        (r.Q_K, block.stiffness),
        (r.Q_GAP, block.gap),
        (r.Q_VISCOUS, block.viscous),
        (r.Q_COULOMB, block.coulomb),
        (r.Q_QUADRATIC, block.quadratic),
        (r.Q_PITCH, block.pitch_per_acceleration),
        (r.Q_BOUNCE, block.contact_restitution),
        (r.Q_FRICTION, block.friction),
        (r.Q_FREQUENCY, 2.0 * np.pi * block.first_frequency),
        (r.Q_MODAL_MASS, block.modal_mass / block.mass),
        (r.Q_MODAL_FORCE, block.modal_force / block.mass),
        (r.Q_MODAL_MOMENT, block.modal_moment / block.mass),
        (r.Q_THETA, initial.get("rotation_1", 0.0)),
        (r.Q_OMEGA, initial.get("rotation_rate_1", 0.0)),
        (r.Q_PEAK, initial.get("peak_rotation_1", 0.0)),
        (r.Q_IMPACTS, initial.get("impacts", 0.0)),
    ):
        table[:, row] = values
    return table


def run(
    block: Block,
    shaking: Shaking,
    scale: FloatArray,
    *,
    tail: float = 0.0,
    linear: bool = False,
    initial: Mapping[str, FloatArray] | None = None,
    first: NDArray[np.int64] | None = None,
    last: NDArray[np.int64] | None = None,
    samples: int = 0,
    log: int = 0,
    fall: bool = False,
    refinement: int = 1,
) -> Lanes:
    """Run n lanes of ``block`` under ``scale`` (n,) times the shaking.

    ``first`` and ``last`` (n,) are samples of the shaking between which each lane runs (default: all,
    and the tail); ``samples`` > 0 returns theta, theta' and the mass centre's displacement beyond that
    of rocking on fixed corners (n, samples) at the samples from ``first`` on; ``log`` > 0 returns up to
    that many events a lane. ``refinement`` divides every step.
    """
    n = block.size
    out = np.zeros((n, r.N_RESULT))
    trace = np.zeros((n, samples, 3))
    logged: list[tuple[tuple[float, str], ...]] = [()] * n
    steps = 0
    per_sample = substeps(block, shaking.time_step) * refinement
    pitched = np.where(block.pitch_per_acceleration != 0.0, block.pitch_low_pass, 0.0)
    start = {k: np.broadcast_to(np.asarray(v, float), (n,)) for k, v in (initial or {}).items()}
    for sub, pitch in sorted(set(zip(per_sample.tolist(), pitched.tolist(), strict=True))):
        lanes = np.flatnonzero((per_sample == sub) & (pitched == pitch))
        part = block.take(lanes)
        record, chunk, shaken = records(shaking, sub, tail, pitch if pitch > 0.0 else None)
        begin = np.zeros(lanes.size, np.int64) if first is None else first[lanes] * sub
        end = np.full(lanes.size, record.shape[1] - 2) if last is None else last[lanes] * sub
        given = given_table(part, scale[lanes], {k: v[lanes] for k, v in start.items()})
        result = np.zeros((lanes.size, r.N_RESULT))
        part_trace = np.zeros((lanes.size, samples, 3))
        part_log = np.zeros((lanes.size, log, 2))
        count = np.zeros(lanes.size, np.int64)
        steps += advance(
            record, chunk, shaking.time_step / sub, shaken, begin, end, given, result,
            sub if samples else 0, part_trace, part_log, count, fall,
            None if part.plain else True, True if linear else None,
        )  # fmt: skip
        out[lanes] = result
        trace[lanes] = part_trace
        for k, lane in enumerate(lanes):
            logged[lane] = tuple((t, EVENTS[int(kind)]) for t, kind in part_log[k, : min(count[k], log)])
    return Lanes(
        out,
        trace[:, :, 0] if samples else None,
        trace[:, :, 1] if samples else None,
        trace[:, :, 2] if samples else None,
        tuple(logged) if log else None,
        steps,
    )


def outputs(block: Block, result: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """The declared outputs from the table of results."""
    status = result[:, r.R_STATUS].astype(np.int8)
    return {
        "peak_rotation": result[:, r.R_PEAK],
        "peak_rotation_ratio": result[:, r.R_PEAK] / block.slenderness,
        "uplift_duration": result[:, r.R_UPLIFT],
        "onset_time": result[:, r.R_ONSET],
        "overturned": status == r.OVERTURNED,
        "overturning_time": result[:, r.R_OVERTURNED_AT],
        "impacts": result[:, r.R_IMPACTS].astype(np.int32),
        "residual_rotation": result[:, r.R_ROTATION],
        "dissipated_energy": result[:, r.R_DISSIPATED],
        "needed_friction": np.where(result[:, r.R_DEMAND] > 1e299, np.inf, result[:, r.R_DEMAND]),
        "status": status,
    }
