"""What an effect does along the fitted motion, from sample to sample: where it acts, whatever it is.

From every sample of a window the model starts in the state of the motion *with* the effect and runs to the next
sample, with it and without it. What it then lacks,

    impulse(t) = rate(t + dt) with the effect - rate(t + dt) without it,

is the effect's force over the step (an acceleration times dt), or its jump where an event lies in the step:
sharp to one sample, to the integrator's error. What an instrument adds to a channel is its error there; the lag
and the clock of the responses to first order, -(lag - rate t) times the channel's slope. An effect with stages acts in
them alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of, library
from grids.instruments import INSTRUMENTS
from grids.instruments.base import Surroundings
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows
from grids.stages import intervals
from models.base import FloatArray
from models.identification import Largest, Motion
from models.kinematics import ground_along
from models.piecewise import trajectories

Kind = Literal["force", "error"]


@dataclass(frozen=True)
class Action:
    """One effect's action in every window.

    ``amount`` (W, C, N): of a ``force``, the change of the rate that belongs to the channel until the next sample
    (rad s-1, or m s-1); of an ``error``, what is added to the channel (its unit). Zero where nothing is compared.
    ``event`` (W, N): whether an event of the model's `Separation` lies in the step from a sample to the next.
    """

    effect: str
    kind: Kind
    amount: FloatArray
    event: NDArray[np.bool_]
    motion: Motion


def action(predictor: Predictor, point: Point, effect: str) -> Action:
    """What ``effect``, one of those that act at ``point``, does along the motion there."""
    m = predictor.measured
    inside = np.asarray(m.mask.all(axis=1))
    states = states_along(predictor, point)
    lead = states[m.identification.leads[0].channel]
    step = np.array([m.recordings[w.recording].time_step for w in m.windows])[:, None]
    rates = [s for s in m.identification.states if s.rate]
    of_lead = next((states[s.name] for s in rates if s.channel == m.identification.leads[0].channel), None)
    rate = np.gradient(lead, axis=1) / step if of_lead is None else of_lead
    motion = Motion(lead, rate, m.base, float(np.max(np.abs(lead), where=inside, initial=0.0)))
    instrument = INSTRUMENTS.get(effect)
    if instrument is not None and "base" not in instrument.acts:
        return Action(effect, "error", _errors(predictor, point, effect, states), _events(predictor, motion), motion)
    amount = np.zeros(m.values.shape)
    # from the same states both: those that a model carries are not quite those of its run through the window
    carried = _carried(predictor, point, states)
    ahead, less = (_one_step(predictor, at, states, carried) for at in (point, _without(predictor, point, effect)))
    both = inside[:, :-1] & inside[:, 1:]
    for state in rates:
        lacking = np.where(both, ahead[state.name] - less[state.name], 0.0)
        amount[:, m.standing_for(state.channel), :-1] += np.where(np.isfinite(lacking), lacking, 0.0)
    return Action(effect, "force", amount, _events(predictor, motion), motion)


def _without(predictor: Predictor, point: Point, effect: str) -> Point:
    """The point with every parameter of the effect at its null."""
    mechanism = library(predictor.measured.model)[effect]
    values = dict(point.values)
    for key in [key for key in values if key.partition(".")[0] == effect]:
        values[key] = mechanism.parameter(key.partition(".")[2]).null
    return Point(values, point.states)


def states_along(predictor: Predictor, point: Point) -> dict[str, FloatArray]:
    """The model's states and leading channels (W, N) along the windows, before any sensor of the responses."""
    m = predictor.measured
    leads = [lead.channel for lead in m.identification.leads]
    names = dict.fromkeys([*m.free, *leads, *m.channels])
    found = {name: np.zeros((len(m.windows), m.values.shape[2])) for name in names}
    carried = predictor.carried(point)
    for r in range(len(m.recordings)):
        own = np.flatnonzero(m.recording_of == r)
        if own.size:
            initial = {name: point.states[own, k] for k, name in enumerate(m.free)}
            initial |= {name: before[own] for name, before in (m.memory | carried).items()}
            ran = _run(predictor, point.values, r, m.first[own], m.values.shape[2], initial)
            step, samples = m.recordings[r].time_step, m.values.shape[2]
            sensed = m.sensed(ran, step, ground_along(m.shakings[r], m.first[own], samples))
            for name in names:
                found[name][own] = sensed[name] if name in sensed else ran[name]
    return found


def _one_step(
    predictor: Predictor, point: Point, states: Mapping[str, FloatArray], carried: dict[str, FloatArray]
) -> dict[str, FloatArray]:
    """The states (W, N - 1) one sample after each sample of the motion ``states``, by the model at ``point``.

    ``carried`` (W, N, ...): what else the motion has at each sample.
    """
    m = predictor.measured
    count = m.values.shape[2] - 1
    found = {name: np.zeros((len(m.windows), count)) for name in m.free}
    memory = _memories(predictor, states) | carried
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        if not own.size:
            continue
        first = m.first[own][:, None] + np.arange(count)
        first = np.minimum(first, recording.time.size - 2)
        initial = {name: states[name][own, :-1].ravel() for name in m.free}
        initial |= {name: x[own, :-1].reshape(own.size * count, *x.shape[2:]) for name, x in memory.items()}
        ran = _run(predictor, point.values, r, first.ravel(), 2, initial)
        for name in found:
            found[name][own] = ran[name][:, 1].reshape(own.size, count)
    return found


def _run(
    predictor: Predictor, values: Mapping[str, float], r: int, first: NDArray[np.int64], samples: int,
    initial: Mapping[str, FloatArray],
) -> Mapping[str, FloatArray]:  # fmt: skip
    """Observables (n, samples) of recording ``r`` from each of the samples ``first`` (n,) on."""
    m = predictor.measured
    recording = m.recordings[r]
    shaking = moved_in_stages(m.shakings[r], predictor.sets(instruments_of(values), recording), moved_in_windows)
    parts = predictor.parts(values, recording)
    instants = np.tile(np.array([part.first for part in parts[1:]], np.int64), (first.size, 1))
    ran = trajectories(
        m.model, [part.values for part in parts], instants, shaking, first=first, samples=samples, initial=initial,
        options=predictor.options,
    )  # fmt: skip
    return m.identification.seen(ran)


def _carried(predictor: Predictor, point: Point, states: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """What the model carries (W, N, ...) at every sample of the motion ``states``; by what acts at a window's start."""
    m = predictor.measured
    found: dict[str, FloatArray] = {}
    starts = predictor.carried(point)
    for r, recording in enumerate(m.recordings):
        sets = predictor.sets(instruments_of(point.values), recording)
        shaking = moved_in_stages(m.shakings[r], sets, moved_in_windows)
        parts = predictor.parts(point.values, recording)
        begun = np.searchsorted([part.first for part in parts], m.first, side="right") - 1
        for k, part in enumerate(parts):
            own = np.flatnonzero((m.recording_of == r) & (begun == k))
            if not own.size:
                continue
            ran = m.model.carry(
                part.values, shaking, {name: states[name][own] for name in m.free}, np.arange(m.values.shape[2]),
                first=m.first[own], initial={name: x[own] for name, x in starts.items()}, options=predictor.options,
            )  # fmt: skip
            for name, x in ran.items():
                found.setdefault(name, np.zeros((len(m.windows), *x.shape[1:])))[own] = x
    return found


def _memories(predictor: Predictor, states: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """The declared memories (W, N) at every sample: that of the window's start, and what came since."""
    m = predictor.measured
    found = {}
    for one in m.identification.memories:
        before, signal = m.memory[one.name][:, None], states[one.channel]
        if isinstance(one, Largest):
            found[one.name] = np.maximum(before, np.maximum.accumulate(np.abs(signal), axis=1))
        else:
            changes = signal[:, 1:] * signal[:, :-1] < 0.0
            found[one.name] = before + np.pad(np.cumsum(changes, axis=1), ((0, 0), (1, 0)))
    return found


def _events(predictor: Predictor, motion: Motion) -> NDArray[np.bool_]:
    """Whether the signal that separates phases changes its sign in the step after a sample (W, N)."""
    separation = predictor.measured.identification.separation
    found = np.zeros(motion.coordinate.shape, bool)
    if separation is not None:
        signal = separation.signal(motion)
        found[:, :-1] = signal[:, 1:] * signal[:, :-1] <= 0.0
    return found


def _errors(predictor: Predictor, point: Point, effect: str, states: Mapping[str, FloatArray]) -> FloatArray:
    """What an instrument of the responses adds to every channel (W, C, N)."""
    m = predictor.measured
    instruments = instruments_of(point.values)
    less = {name: values for name, values in instruments.items() if name != effect}
    form, values = INSTRUMENTS[effect], {**INSTRUMENTS[effect].nulls, **instruments[effect]}
    rate, lag = form.acts["clock"](values) if "clock" in form.acts else (0.0, 0.0)
    lag += form.acts["lag"](values) if "lag" in form.acts else 0.0
    found = np.zeros(m.values.shape)
    for r, recording in enumerate(m.recordings):
        own = np.flatnonzero(m.recording_of == r)
        start = np.asarray(recording.time_step * m.first[own, None], float)
        around = Surroundings(recording.time_step, m.base[own], m.reference_peak, start)
        true = {channel: states[channel][own] for channel in m.channels}
        seen, plain = (
            recorded_in_stages(true, predictor.sets(switched, recording), around, recorded_in_windows)
            for switched in (instruments, less)
        )
        time = (m.first[own][:, None] + np.arange(m.values.shape[2])) * recording.time_step
        spans = intervals(predictor.stages.get(effect, ()), recording.name)
        acts = np.any(
            [(begins <= time) & (time < ends) for begins, ends in spans] or [np.zeros(time.shape, bool)], axis=0
        )
        for c, channel in enumerate(m.channels):
            slope = np.gradient(true[channel], axis=1) / recording.time_step
            found[own, c] = seen[channel] - plain[channel] + acts * slope * (rate * time - lag)
    return np.where(m.mask, found, 0.0)
