"""What was measured, arranged by windows: the arrays that every prediction is compared with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.averaging import averaged, stride
from diagnosis.data.gathered import gather, memories, refuse_dead, smoothed, start_of
from diagnosis.data.noise import base_noise, response_noise
from diagnosis.data.windows import ABOVE_NOISE, Window, cut, over_noise
from grids.instruments.base import Surroundings
from grids.recordings.base import SHARE, FloatArray, Recording
from grids.recordings.levels import level_by_level, stem
from grids.recordings.zero import Zeros, zeros
from models import MODELS, get
from models.base import Values
from models.errors import InputError
from models.identification import NARROWEST, Identification, Stretches, WindowLengths
from models.kinematics import Place
from models.model import Model
from models.shaking import Shaking


@dataclass(frozen=True)
class AsItWas:
    """How events that do not repeat exactly fell in the recordings, as pulses of base acceleration make it so.

    ``pulses``: by recording, base acceleration (n_samples,) in m s-2; ``offset`` (W, C, N): what they change in the
    windows to the first order, so that a prediction less its offset is one without scatter, but linear about the motion
    as it was.
    """

    pulses: tuple[FloatArray, ...]
    offset: FloatArray


UNSEEN = 4.0
"""Scatter of a state whose channel is not recorded over that of the state it begins as."""
FIRST = 4.0
"""Over the least errors that are assumed: what residuals are weighed with at first."""


@dataclass(frozen=True)
class Measured:
    """W windows of some recordings, C channels, at most N samples a window.

    ``values`` and ``mask`` (W, C, N); ``sigma`` (W, C); ``base`` (W, N), the measured base acceleration;
    ``states`` (W, S), the model's free states at the windows' starts as the measurement suggests, ``state_size`` (S,)
    their scatter; ``memory``: what happened before each window (W,), for laws with a memory.
    ``reference_peak``: largest value of the leading channel of the first recording with a window; ``lengths`` of
    windows in s.
    ``alike``: states that begin as another one where their channel is not recorded; ``bonded``: and stay so.
    """

    model: Model
    recordings: tuple[Recording, ...]
    shakings: tuple[Shaking, ...]
    base_noise: tuple[float, ...]
    windows: tuple[Window, ...]
    channels: tuple[str, ...]
    values: FloatArray
    mask: NDArray[np.bool_]
    sigma: FloatArray
    base: FloatArray
    states: FloatArray
    state_size: FloatArray
    memory: dict[str, FloatArray]
    reference_peak: float
    lengths: WindowLengths | None
    stretches: Stretches | None = None
    alike: Mapping[str, str] = field(default_factory=dict)
    bonded: bool = False
    assumed: FloatArray | None = None
    """Least errors (W, C) beside the noise, of a model that runs through whole recordings."""
    as_it_was: AsItWas | None = None
    step_error: FloatArray | None = None
    """What steps of the model longer than by its own rule change in the windows (W, C, N): taken off predictions."""

    @property
    def first_errors(self) -> FloatArray:
        """Deviations (W, C) that residuals are weighed with before the errors are estimated."""
        return self.sigma if self.assumed is None else np.maximum(self.sigma, FIRST * self.assumed)

    @property
    def unit(self) -> FloatArray:
        """Deviation of each channel (C,), over all recordings, in units of which errors are stated."""
        sigma = self.sigma if self.assumed is None else np.maximum(self.sigma, self.assumed)
        return np.asarray(np.sqrt(np.mean(sigma**2, axis=0)))

    @property
    def units(self) -> FloatArray:
        """Deviation (W, C) in units of which errors are estimated: each recording has a noise level of its own.

        That of all recordings for a model that runs through them whole, whose own error is by far the largest.
        """
        return self.sigma if self.stretches is None else np.broadcast_to(self.unit, self.sigma.shape)

    @property
    def lead(self) -> int:
        """Index of the leading channel, or of what stands for it (`standing_for`)."""
        return self.standing_for(self.identification.leads[0].channel)

    def standing_for(self, channel: str) -> int:
        """Index of a channel; where it is not compared, of the first channel of the body that it leads."""
        own = [k for k, name in enumerate(self.channels) if stem(name) == channel]
        body = next((lead.body for lead in self.identification.leads if lead.channel == channel), 0)
        own += [k for k, name in enumerate(self.channels) if name in self.places and self.places[name].body == body]
        return own[0] if own else 0

    @property
    def leading(self) -> FloatArray:
        """The leading channel (W, N) as measured, or as estimated from others where it was not recorded."""
        lead = self.identification.leads[0].channel
        if not any(lead in r.estimated for r in self.recordings):
            return self.values[:, self.lead]
        found = np.zeros((len(self.windows), self.values.shape[2]))
        for w, window in enumerate(self.windows):
            part = self.recordings[window.recording].channels[lead][window.first : window.first + window.samples]
            found[w, : part.size] = part
        return found

    @property
    def places(self) -> Mapping[str, Place]:
        """What the compared channels measure that are no observables of the model."""
        known = self.recordings[0].places
        return {name: known[name] for name in self.channels if name in known}

    def sensed(
        self, ran: Mapping[str, FloatArray], time_step: float, ground: Callable[[], tuple[FloatArray, FloatArray]]
    ) -> dict[str, FloatArray]:
        """The compared channels before any instrument, of a run's observables and poses (..., samples).

        ``ground`` gives the accelerations of the base, which channels with `places` need.
        """
        seen, places = self.identification.seen(ran), self.places
        return {c: places[c].read(seen, time_step, ground()) if c in places else seen[c] for c in self.channels}

    def around(self, time_step: float, base: FloatArray, start: FloatArray | float = 0.0) -> Surroundings:
        """What instruments need beside the compared channels; ``base`` and ``start``: see `Surroundings`."""
        return Surroundings(time_step, base, self.reference_peak, start, places=self.places)

    def unit_of(self, channel: str) -> str:
        """SI unit of a compared channel."""
        if channel in self.places:
            return self.places[channel].unit
        name = self.identification.same.get(channel, stem(channel))
        return next(q.unit for q in self.model.observables if q.name == name)

    @property
    def identification(self) -> Identification:
        return identification_of(self.model)

    @property
    def parts_quickly(self) -> bool:
        """Whether neighbouring trajectories part within a window: chaotic motion of more than one body."""
        return self.identification.chaotic and len(self.identification.leads) > 1

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the states (S,) that every window has its own of; the model carries the others to its start."""
        following = self.alike if self.bonded else ()
        return tuple(state.name for state in self.identification.free if state.name not in following)

    @cached_property
    def zeros(self) -> Zeros:
        """What the records of the base tell of their accelerometers' zeros."""
        return zeros(self.recordings)

    @cached_property
    def recording_of(self) -> NDArray[np.int64]:
        return np.array([w.recording for w in self.windows], np.int64)

    @cached_property
    def first(self) -> NDArray[np.int64]:
        return np.array([w.first for w in self.windows], np.int64)

    @cached_property
    def time_steps(self) -> FloatArray:
        """Of each window's recording (W,), in s."""
        return np.array([self.recordings[w.recording].time_step for w in self.windows], np.float64)

    @cached_property
    def strides(self) -> NDArray[np.int64]:
        """Samples of each window (W,) that are averaged to one that is compared."""
        if self.stretches is not None:  # of means already
            return np.ones(len(self.windows), np.int64)
        return np.array([stride(step) for step in self.time_steps], np.int64)

    def averaged(self, values: FloatArray) -> FloatArray:
        """Samples (..., W, C, n) that are compared, of samples (..., W, C, N) as recorded."""
        return averaged(values, self.strides)

    @cached_property
    def compared(self) -> NDArray[np.bool_]:
        """Which of the averaged samples are compared (W, C, n)."""
        return np.asarray(self.averaged(self.mask.astype(np.float64)) == 1.0)

    @cached_property
    def count(self) -> FloatArray:
        """Averaged samples compared in each window, all channels together (W,)."""
        return np.asarray(self.compared.sum(axis=(1, 2)), np.float64)

    def of_windows(self, windows: NDArray[np.int64]) -> Measured:
        """Some of the windows alone."""
        return replace(
            self,
            windows=tuple(self.windows[w] for w in windows),
            assumed=None if self.assumed is None else self.assumed[windows],
            as_it_was=self.as_it_was and replace(self.as_it_was, offset=self.as_it_was.offset[windows]),
            step_error=None if self.step_error is None else self.step_error[windows],
            values=self.values[windows], mask=self.mask[windows], sigma=self.sigma[windows], base=self.base[windows],
            states=self.states[windows], memory={name: before[windows] for name, before in self.memory.items()},
        )  # fmt: skip

    def cut_again(self, windows: tuple[Window, ...]) -> Measured:
        """The same starts with other lengths."""
        gathered = gather(self.recordings, windows, self.channels)
        return replace(self.in_own_steps, windows=windows, as_it_was=None, **gathered)

    @property
    def in_own_steps(self) -> Measured:
        """The same for the model in steps of its own rule."""
        return replace(self, model=self.model.stepping(None), step_error=None)

    @property
    def undisturbed(self) -> Measured:
        """The same, events taken to be as the law has them."""
        return self if self.as_it_was is None else replace(self, as_it_was=None)

    def disturbed(self, shaking: Shaking, recording: int) -> Shaking:
        """The base motion of a recording with the pulses that make its events as they were."""
        if self.as_it_was is None:
            return shaking
        if shaking is self.shakings[recording]:
            return self._disturbed[recording]
        return replace(shaking, horizontal=shaking.horizontal + self.as_it_was.pulses[recording])

    @cached_property
    def _disturbed(self) -> tuple[Shaking, ...]:
        """The measured base motions so: kept, and with them what kernels read of them."""
        pulses = self.as_it_was.pulses if self.as_it_was is not None else ()
        return tuple(replace(s, horizontal=s.horizontal + p) for s, p in zip(self.shakings, pulses, strict=True))

    def times(self, window: int) -> FloatArray:
        """Times (N,) of a window's samples, in s."""
        cutout = self.windows[window]
        step = self.recordings[cutout.recording].time_step
        return np.asarray((cutout.first + np.arange(self.values.shape[2])) * step, np.float64)


def identification_of(model: Model) -> Identification:
    """What ``model`` declares for a comparison with recordings; InputError says why there can be none."""
    declared = model.identification
    lacking = "what they need to know of it" if declared is None else declared.refusal()
    if declared is None or lacking:
        offered = [name for name in MODELS if (known := get(name).identification) and not known.refusal()]
        raise InputError(
            f"calibration and diagnosis of model {model.name} are not offered yet: {lacking} is not declared or "
            f"measured; use model {' or '.join(offered)}, or simulate."
        )
    return declared


def arrange(
    model: Model,
    recordings: Sequence[Recording],
    vertical: bool,
    lengths: WindowLengths,
    reference_peak: float | None = None,
) -> Measured:
    """Cut the recordings in windows; channels are compared that all of them hold (see `left_out`).

    ``lengths`` in s. Raises InputError when nothing can be compared.
    """
    declared = identification_of(model)
    observed = [*(q.name for q in model.observables if q.unit != SHARE), *declared.same]
    placed = placed_in(model, recordings, {})
    channels = tuple(c for c in (*observed, *placed) if all(c in r.responses for r in recordings))
    for state in declared.free:
        lacking = [r.name for r in recordings if state.channel not in r.channels]
        if lacking:
            raise InputError(
                f"{state.channel} is missing in {', '.join(lacking)}: model {model.name} cannot start a window "
                "without it; record or map it."
            )
    refuse_dead(recordings, [*channels, *(state.channel for state in declared.free)])
    leads = [lead.channel for lead in declared.leads]
    windows: list[Window] = []
    for k, recording in enumerate(recordings):
        sizes = [
            over_noise(recording.channels[c], response_noise(recording, c), recording.time_step, lengths) for c in leads
        ]
        windows += cut(np.max(sizes, axis=0), recording.time_step, k, lengths)
    if not windows:
        raise InputError(
            f"{' or '.join(leads)} never exceeds {ABOVE_NOISE:g} times its noise in "
            f"{', '.join(r.name for r in recordings)}: nothing can be compared; shake harder, or reduce the noise."
        )
    with_vertical = vertical or all("base_acceleration_z" in r.channels for r in recordings)
    start = np.stack([start_of(recordings, windows, state) for state in declared.free], axis=1)
    if reference_peak is None:
        moving = recordings[windows[0].recording]
        reference_peak = float(np.max(np.abs(smoothed(moving, leads[0], lengths))))
    return Measured(
        model=model,
        recordings=tuple(recordings),
        shakings=tuple(r.shaking(with_vertical, vertical_acts=vertical) for r in recordings),
        base_noise=tuple(base_noise(r) for r in recordings),
        windows=tuple(windows),
        channels=channels,
        **gather(recordings, windows, channels),
        states=start,
        state_size=np.maximum(np.std(start, axis=0), 1e-12),
        memory=memories(recordings, windows, declared, lengths),
        reference_peak=reference_peak,
        lengths=lengths,
    )


def seen_as(measured: Measured, other: Measured) -> Measured:
    """The same windows, recordings and channels for the model of ``other``."""
    if measured.model.name == other.model.name:
        return measured
    return for_model(measured, other.model.stepping(None), other.alike, other.bonded)


def for_model(measured: Measured, model: Model, alike: Mapping[str, str], bonded: bool) -> Measured:
    """The same windows, recordings and channels for another ``model``; the others: see `Measured`."""
    declared = identification_of(model)
    lengths = measured.lengths and replace(measured.lengths, carrying=max(NARROWEST, measured.lengths.carrying))
    found = replace(measured.in_own_steps, model=model, alike=alike, bonded=bonded, lengths=lengths, as_it_was=None)
    states = {state.name: state for state in declared.free}
    used = [states[alike.get(name, name)] for name in found.free]
    start = np.stack([start_of(measured.recordings, measured.windows, state) for state in used], axis=1)
    unseen = np.array([UNSEEN if name in alike else 1.0 for name in found.free])
    return replace(
        found,
        states=start,
        state_size=np.maximum(unseen * np.std(start, axis=0), 1e-12),
        memory=memories(measured.recordings, measured.windows, declared, lengths) if lengths else {},
    )


def left_out(recordings: Sequence[Recording]) -> dict[str, tuple[str, ...]]:
    """Responses that only some recordings hold, so that none is compared by them; with those that lack them.

    Those of levels one by one.
    """
    compared = [{c for c in r.responses if r.channel(c).unit != SHARE} for r in recordings]
    split = [level_by_level(r) for r in recordings]
    held = dict.fromkeys(c for r, names in zip(split, compared, strict=True) for c in r.channels if stem(c) in names)
    lacking = {c: tuple(r.name for r in split if c not in r.channels) for c in held}
    return {c: names for c, names in lacking.items() if names}


def placed_in(model: Model, recordings: Sequence[Recording], values: Values) -> tuple[str, ...]:
    """Channels that say what they measure; InputError where recordings differ or the model lacks the body."""
    found: dict[str, Place] = {}
    for recording in recordings:
        for name, place in recording.places.items():
            if found.setdefault(name, place) != place:
                raise InputError(
                    f"{name} is '{place.meaning}' in {recording.name} and another channel before: rename it."
                )
            model.check_place(name, place, values)
    return tuple(found)
