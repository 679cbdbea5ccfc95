"""Runs from rest, shown last: where the motion is chaotic they diverge from the recording after a while."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.answer.heldout import Shown, traces_of, with_held
from diagnosis.answer.result import HeldStage, Trace
from diagnosis.data.measured import Measured, seen_as
from diagnosis.fit.through import read
from diagnosis.fit.unknowns import instruments_of
from diagnosis.search.refit import Explanation
from grids.instruments.base import Surroundings
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.recordings.base import FloatArray, Recording
from grids.specimen import Specimen
from models.kinematics import Place, ground_along
from models.piecewise import cannot_be_cut, in_force, simulate


def with_runs_from_rest(
    specimen: Specimen, shown: Sequence[Shown], before: Explanation, after: Explanation
) -> tuple[Trace, ...]:
    """The traces of all recordings with the runs from the specimen's initial state beside them.

    Without them where a run cannot be cut at an instant at which something begins to act.
    """
    found: list[Trace] = []
    for k, each in enumerate(shown):
        if each.measured.stretches is not None:  # they are runs from rest
            found += traces_of(each, held_out=k == 1)
            continue
        runs: dict[str, list[dict[str, FloatArray]]] = {}
        for recording in each.measured.recordings:
            ways = ((before, ()), (after, each.held_stages))
            if any(no_run(e, recording, held) for e, held in ways):
                continue
            runs[recording.name] = [
                sensed_run(e, each.measured, recording, each.measured.channels, specimen.initial, held)
                for e, held in ways
            ]
        for trace in traces_of(each, held_out=k == 1):
            if trace.recording in runs:
                pair = [run[trace.channel] for run in runs[trace.recording]]
                trace = replace(trace, from_rest_before=pair[0], from_rest_after=pair[1])
            found.append(trace)
    return tuple(found)


def no_run(explanation: Explanation, recording: Recording, held: Sequence[HeldStage] = ()) -> str:
    """Why there is no run of a recording from rest: it cannot be cut where something begins to act; empty: there is."""
    fitted = explanation.fitted
    parts = with_held(fitted.misfit.predictor, held).parts(fitted.point.values, recording)
    parts = in_force(parts, 0, recording.time.size)
    return cannot_be_cut(explanation.measured.model, [one.values for one in parts])


def sensed_run(
    explanation: Explanation,
    measured: Measured,
    recording: Recording,
    channels: Sequence[str],
    initial: Mapping[str, float] | None = None,
    held: Sequence[HeldStage] = (),
    more: Mapping[str, Place] | None = None,
) -> dict[str, FloatArray]:
    """Channels of one run under the recording's base motion, as the instruments would record them.

    ``more``: places of channels that the recording does not hold.
    """
    measured = seen_as(measured, explanation.measured)
    misfit, values = explanation.fitted.misfit, explanation.fitted.point.values
    like = measured.shakings[0]
    shaking = recording.shaking(like.vertical is not None, vertical_acts=like.vertical_acts)
    predictor = with_held(misfit.predictor, held)
    sets = predictor.sets(instruments_of(values), recording)
    begins = dict(initial or {})
    begins |= {name: begins[of] for name, of in measured.alike.items() if of in begins}
    moved = moved_in_stages(shaking, sets)
    history = simulate(
        measured.model,
        predictor.parts(values, recording),
        moved,
        initial=begins or None,
        duration=shaking.duration,
        options=predictor.options,
    )
    seen = measured.identification.seen(history.channels)
    places, ground = {**recording.places, **(more or {})}, ground_along(moved, np.zeros(1, np.int64), history.time.size)
    of_base = ground[0][0], ground[1][0]
    found = {c: np.ravel(read(places, seen, c, shaking.time_step, of_base)) for c in channels}
    around = Surroundings(shaking.time_step, moved.horizontal, measured.reference_peak, places=places)
    return dict(recorded_in_stages(found, sets, around))
