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

from diagnosis.fit.along import Along
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of, library
from grids.instruments import INSTRUMENTS
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows
from grids.stages import intervals
from models.base import FloatArray
from models.identification import Motion
from models.kinematics import ground_along

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
    along = Along(predictor, point)
    states = along.states
    lead = states[m.identification.leads[0].channel]
    step = m.time_steps[:, None]
    rates = [s for s in m.identification.states if s.rate]
    of_lead = next((states[s.name] for s in rates if s.channel == m.identification.leads[0].channel), None)
    rate = np.gradient(lead, axis=1) / step if of_lead is None else of_lead
    motion = Motion(lead, rate, m.base, float(np.max(np.abs(lead), where=inside, initial=0.0)))
    instrument = INSTRUMENTS.get(effect)
    if instrument is not None and "base" not in instrument.acts:
        return Action(effect, "error", _errors(predictor, point, effect, states), _events(predictor, motion), motion)
    amount = np.zeros(m.values.shape)
    # from the same states both: those that a model carries are not quite those of its run through the window
    ahead, less = (one_step(at, along) for at in (point, _without(predictor, point, effect)))
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


def one_step(point: Point, along: Along) -> dict[str, FloatArray]:
    """The states (W, N - 1) one sample after each sample of a motion, by the model at ``point``."""
    ran_from = Along(along.predictor, point)
    m = along.predictor.measured
    count = m.values.shape[2] - 1
    found = {name: np.zeros((len(m.windows), count)) for name in m.free}
    for r, recording in enumerate(m.recordings):
        own = along.windows(r)
        if not own.size:
            continue
        window, sample = (x.ravel() for x in np.meshgrid(own, np.arange(count), indexing="ij"))
        first = np.minimum(m.first[window] + sample, recording.time.size - 2)
        ran = ran_from.run(r, first, 2, along.at(window, sample))
        for name in found:
            found[name][own] = ran[name][:, 1].reshape(own.size, count)
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
        ground = moved_in_stages(m.shakings[r], predictor.sets(instruments, recording), moved_in_windows)
        base, _ = ground_along(ground, m.first[own], m.values.shape[2])
        around = m.around(recording.time_step, base, start)
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
