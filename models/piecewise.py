"""Runs whose parameters change at given samples: cut there, each part begun from the state in which the last one ended.

A state is handed over whole: what `Model.resume` gives, motion and memories. A model says in `Model.resumes_with` with
which mechanisms its states are all that a run remembers; with others a run cannot be cut and is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from operator import itemgetter, or_
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.answers import missing
from models.base import UNANSWERED, Event, FloatArray, History, OverParts, Quantity, Values
from models.errors import InputError
from models.model import Model
from models.observed import Observed
from models.runs import by_lane
from models.shaking import Shaking, Shakings

JOINED: Mapping[OverParts, Callable[[Sequence[float]], float]] = {
    "first": itemgetter(0), "largest": max, "least": min, "total": math.fsum,
    "bits": lambda values: float(reduce(or_, map(int, values))),
}  # fmt: skip
"""An output of a whole run from those of its parts that have one, by `Quantity.over_parts`; the last is the last's."""
LEFT_LYING = ("largest", "least", "last")
"""What goes on as it was where nothing moves any more."""


@dataclass(frozen=True)
class Part:
    """Values that hold from sample ``first`` of the shaking on."""

    first: int
    values: Values


def in_force(parts: Sequence[Part], first: int, samples: int) -> list[Part]:
    """The parts of a run of so many ``samples`` that begins at sample ``first``, their samples counted from there."""
    begun = max(k for k, one in enumerate(parts) if one.first <= first)
    found = {max(0, one.first - first): one.values for one in parts[begun:]}  # of those from one sample on, the last
    return [Part(at, values) for at, values in found.items() if at < samples or at == 0]


def cannot_be_cut(model: Model[Any], parts: Sequence[Values]) -> str:
    """Why a run with these sets of values, one after the other, cannot be cut; empty where it can, or has one alone."""
    if len(parts) < 2:
        return ""
    allowed = model.resumes_with
    if allowed is None:
        return (
            f"a run of model '{model.name}' cannot be cut at an instant: its states do not hold all that it "
            "remembers; leave the stages out."
        )
    used = {name.partition(".")[0] for values in parts for name in values if "." in name}
    kept = sorted(used - set(allowed))
    if not kept:
        return ""
    return (
        f"a run with {kept[0]} cannot be cut at an instant: {kept[0]} remembers more than the motion; leave the "
        f"stages out, or {kept[0]}."
    )


def simulate(
    model: Model[Any],
    parts: Sequence[Part],
    shaking: Shaking,
    *,
    scale: float = 1.0,
    initial: Mapping[str, float] | None = None,
    duration: float | None = None,
    tail: float = 0.0,
    options: Mapping[str, str] | None = None,
    integrator: str = "lanes",
) -> History:
    """As `Model.simulate`, with the values of each part from its first sample on (the first part's is 0)."""
    step = shaking.time_step
    last = round((shaking.duration + tail if duration is None else duration) / step)
    parts = in_force(parts, 0, last)
    if why := cannot_be_cut(model, [one.values for one in parts]):
        raise InputError(why)
    ends = [*(one.first for one in parts[1:]), last]
    state: Mapping[str, Any] = {name: np.array([value], float) for name, value in (initial or {}).items()}
    found: list[History] = []
    for one, end in zip(parts, ends, strict=True):
        if found and _lies(found[-1]):
            found.append(_lying(model, found[-1], end - one.first))
            continue
        history, state = model.simulate_from(
            one.values, begun_at(shaking, one.first), initial=state, samples=end - one.first, scale=scale,
            options=options, integrator=integrator,
        )  # fmt: skip
        found.append(history)
    return found[0] if len(found) == 1 else _joined(model, found, [one.first for one in parts], step)


def begun_at(shaking: Shaking, first: int) -> Shaking:
    """The shaking from sample ``first`` on; the base at rest beyond its end."""

    def part(samples: FloatArray) -> FloatArray:
        left = samples[first:]
        return left if left.size > 1 else np.append(left, np.zeros(2 - left.size))

    shaking = shaking.lines  # before it is cut
    vertical = None if shaking.vertical is None else part(shaking.vertical)
    earlier = None
    if first + 1 < shaking.horizontal.size:  # beyond the end filters give nothing
        earlier = np.append([] if shaking.earlier is None else shaking.earlier, shaking.horizontal[:first])
    return replace(shaking, horizontal=part(shaking.horizontal), vertical=vertical, earlier=earlier)


def _lies(part: History) -> bool:
    """Whether a part ends with a wall that has fallen: overturned, and nothing moves any more."""
    still = all(np.array_equal(x[..., -1], x[..., -2]) for x in part.channels.values())
    return bool(part.outputs.get("overturned")) and still


def _lying(model: Model[Any], before: History, samples: int) -> History:
    """What has overturned stays where it lies."""
    channels = {name: np.repeat(x[..., -1:], samples + 1, axis=-1) for name, x in before.channels.items()}
    kept = {q.name: before.outputs[q.name] for q in model.outputs if q.over_parts in LEFT_LYING}
    return History(before.time[: samples + 1], channels, (), kept)


def _joined(model: Model[Any], parts: Sequence[History], firsts: Sequence[int], step: float) -> History:
    """Parts as one history; the sample between two of them is that of the later one."""
    kept = [slice(None, -1)] * (len(parts) - 1) + [slice(None)]
    channels = {
        name: np.concatenate([p.channels[name][..., k] for p, k in zip(parts, kept, strict=True)], axis=-1)
        for name in parts[0].channels
    }
    begins = [step * first for first in firsts]
    events = tuple(
        replace(event, time=event.time + begin)
        for part, begin in zip(parts, begins, strict=True)
        for event in part.events
        if (event.time > 0.0 or begin == 0.0) and not (begin > 0.0 and _first_uplift(event, part))
    )
    lost = [part.outputs["status"] for part in parts if part.outputs.get("status") in UNANSWERED]
    if lost:  # what follows begins from no answer
        outputs = {q.name: lost[0] if q.name == "status" else missing(q) for q in model.outputs}
    else:
        outputs = {q.name: _over(q, [p.outputs.get(q.name, math.nan) for p in parts], begins) for q in model.outputs}
    count = next(iter(channels.values())).shape[-1]
    return History(step * np.arange(count, dtype=np.float64), channels, _once(events), outputs)


def _first_uplift(event: Event, part: History) -> bool:
    """Whether an onset is only the first uplift of its part; walls on layers have one onset in a run."""
    return event.kind == "onset" and any(e.kind == "uplift" and e.time == event.time for e in part.events)


def _once(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """Events to the first overturning of each body."""
    seen: set[int] = set()
    found = []
    for event in events:
        if event.kind == "overturned":
            if event.body in seen:
                continue
            seen.add(event.body)
        found.append(event)
    return tuple(found)


def _over(output: Quantity, values: Sequence[float], begins: Sequence[float]) -> float:
    """An output of the whole from those of the parts, which begin at ``begins`` (s)."""
    rule = output.over_parts
    if rule is None:
        raise ValueError(f"the output {output.name} does not declare how it follows from those of parts of a run")
    if rule == "last":
        return values[-1]
    if rule == "first":
        values = [value + begin for value, begin in zip(values, begins, strict=True)]
    known = [value for value in values if not math.isnan(value)]
    return JOINED[rule](known) if known else math.nan


def trajectories(
    model: Model[Any],
    parts: Sequence[Values],
    changes: NDArray[np.int64],
    shaking: Shaking | Shakings,
    *,
    first: NDArray[np.int64],
    samples: int | NDArray[np.int64],
    initial: Mapping[str, FloatArray],
    options: Mapping[str, str] | None = None,
) -> Mapping[str, FloatArray]:
    """As `Model.trajectories`; lane k goes from part j to part j + 1 at sample ``changes[k, j]``.

    The change may lie before or after the lane's window, which then is of one part.
    """
    if len(parts) == 1:
        return model.trajectories(parts[0], shaking, first=first, samples=samples, initial=initial, options=options)
    n, end = first.size, first + samples - 1
    shakings = Shakings.over(shaking, n)
    edges = [first, *(np.clip(changes[:, j], first, end) for j in range(len(parts) - 1)), end]
    if np.any(np.count_nonzero(np.diff(edges, axis=0) > 0, axis=0) > 1):
        if why := cannot_be_cut(model, parts):
            raise InputError(why)
    state = {name: by_lane(v, n).copy() for name, v in initial.items()}
    pieces: list[_Piece] = []
    for values, start, stop in zip(parts, edges[:-1], edges[1:], strict=True):
        lanes = np.flatnonzero(stop > start)
        if not lanes.size:
            continue
        length = stop[lanes] - start[lanes]
        own = {k: np.broadcast_to(np.asarray(v, float), (n,))[lanes] for k, v in values.items()}
        channels, after = model.follow(
            own, shakings.take(lanes), first=start[lanes], steps=length,
            initial={name: v[lanes] for name, v in state.items()}, options=options,
        )  # fmt: skip
        pieces.append(_Piece(lanes, start[lanes] - first[lanes], length, channels))
        for name, after_lanes in after.items():
            state.setdefault(name, np.zeros(n))[lanes] = after_lanes
    longest = int(np.max(samples))
    return Observed({name: partial(_whole, pieces, name, n, longest) for one in pieces[:1] for name in one.channels})


@dataclass(frozen=True)
class _Piece:
    """Channels of some ``lanes`` (k,), from sample ``at`` (k,) of each on, over its ``length`` (k,)."""

    lanes: NDArray[np.intp]
    at: NDArray[np.int64]
    length: NDArray[np.int64]
    channels: Mapping[str, FloatArray]


def _whole(pieces: Sequence[_Piece], name: str, n: int, samples: int) -> FloatArray:
    """One channel of all n lanes; the sample between two pieces is that of the later one."""
    channels = [piece.channels[name] for piece in pieces]
    whole = np.full((n, *channels[0].shape[1:-1], samples), np.nan)
    for piece, channel in zip(pieces, channels, strict=True):
        for row, (lane, at, length) in enumerate(zip(piece.lanes, piece.at, piece.length, strict=True)):
            whole[lane, ..., at : at + length + 1] = channel[row, ..., : length + 1]
    return whole
