"""Rotations that start windows, where they were not recorded but follow from other channels.

Displacements, uplifts and compressions of points are functions of the bodies' rotations, which the model gives at the
specimen's own geometry, everything else at rest. Sample by sample the rotations are those of least squares over these
channels, each over its noise (Gauss-Newton from either side of upright). They lead and start windows and are not
compared: what is compared are the channels that were recorded.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from diagnosis.data.noise import response_noise
from grids.recordings.base import FloatArray, Recording
from grids.recordings.overturned import cut_before_fall
from models.base import Values
from models.errors import InputError
from models.identification import Identification
from models.model import Model
from models.shaking import Shaking

ROUNDS = 8
PROBE = 1e-6
"""rad, of the differences that give slopes."""
BESIDE = 1e-3
"""rad on either side of upright at which the channels must tell the rotations."""
TELLING = 0.05
"""Of how well they tell them on the better side: the smallest singular value of the slopes there."""
FARTHEST = 1.5
"""rad; beyond this a body lies."""


def with_rotations(
    model: Model, declared: Identification, values: Values, options: Mapping[str, str], recordings: Sequence[Recording]
) -> list[Recording]:
    """The recordings with the channels that start a window, estimated where they were not recorded.

    As they are where nothing is lacking or no recorded channel says where a body is. Raises InputError where these
    channels do not tell the rotations on both sides.
    """
    wanted = list(dict.fromkeys(state.channel for state in declared.free))
    found = []
    for recording in recordings:
        lacking = tuple(name for name in wanted if name not in recording.channels)
        usable = _usable(model, recording)
        estimate = lacking and any(name in recording.places for name in usable)
        found.append(
            _estimated(model, declared, values, options, recording, lacking, usable) if estimate else recording
        )
    return found


def _usable(model: Model, recording: Recording) -> tuple[str, ...]:
    """Channels that are functions of where the bodies are."""
    lengths = {q.name for q in model.observables if q.unit in ("m", "rad")}
    return tuple(
        name
        for name in recording.responses
        if (recording.places[name].order == 0 if name in recording.places else name in lengths)
    )


def _estimated(
    model: Model, declared: Identification, values: Values, options: Mapping[str, str], recording: Recording,
    lacking: tuple[str, ...], usable: tuple[str, ...],
) -> Recording:  # fmt: skip
    rest = declared.rest(model.derive(values, options))
    still = Shaking.silence(4.0 * recording.time_step, recording.time_step)
    sigma = np.array([max(response_noise(recording, name), 1e-300) for name in usable])
    measured = np.stack([recording.channels[name] for name in usable], axis=1) / sigma
    known = {s.channel: recording.channels[s.channel] for s in declared.free if s.channel in recording.channels}

    def read(theta: FloatArray, given: Mapping[str, FloatArray]) -> FloatArray:
        """Channels (n, C) over their noise at rotations (n, K) beside those given (n,)."""
        n = len(theta)
        initial = {name: np.full(n, value) for name, value in rest.items()} | dict(given)
        initial |= dict(zip(lacking, theta.T, strict=True))
        ran = declared.seen(
            model.trajectories(values, still, first=np.zeros(n, np.int64), samples=2, initial=initial, options=options)
        )
        ground = np.zeros(2), np.zeros(2)
        each = [
            recording.places[name].read(ran, recording.time_step, ground) if name in recording.places else ran[name]
            for name in usable
        ]
        return np.asarray(np.stack([x[:, 0] for x in each], axis=1) / sigma)

    def slopes(theta: FloatArray, given: Mapping[str, FloatArray]) -> FloatArray:
        found = np.empty((len(theta), len(usable), len(lacking)))
        for k in range(len(lacking)):
            step = PROBE * np.eye(len(lacking))[k]
            found[:, :, k] = (read(theta + step, given) - read(theta - step, given)) / (2.0 * PROBE)
        return found

    sides = BESIDE * np.array(list(product((-1.0, 1.0), repeat=len(lacking)))) * (1.0 + np.arange(len(lacking)))
    size = np.linalg.svd(slopes(sides, {name: np.zeros(len(sides)) for name in known}), compute_uv=False)
    least = size[:, -1]
    if len(usable) < len(lacking) or np.min(least) <= TELLING * max(np.max(least), TELLING**4 * np.max(size)):
        raise InputError(
            f"{recording.name}: {', '.join(usable)} do not tell {' and '.join(lacking)} on both sides; record the "
            "rotation, a horizontal displacement at a height, or the uplift of both corners."
        )
    theta, least = np.zeros((recording.time.size, len(lacking))), np.full(recording.time.size, np.inf)
    for side in sides:  # a body that turns the other way is another minimum
        trial = np.broadcast_to(side, theta.shape)
        for _ in range(ROUNDS):
            step = np.einsum("nkc,nc->nk", np.linalg.pinv(slopes(trial, known)), measured - read(trial, known))
            trial = np.clip(trial + step, -FARTHEST, FARTHEST)
            if np.max(np.abs(step)) < PROBE:
                break
        off = np.sum((measured - read(trial, known)) ** 2, axis=1)
        theta, least = np.where((off < least)[:, None], trial, theta), np.minimum(off, least)
    channels = {**recording.channels, **{name: np.ascontiguousarray(theta[:, k]) for k, name in enumerate(lacking)}}
    return cut_before_fall(replace(recording, channels=channels, estimated=frozenset(lacking)))
