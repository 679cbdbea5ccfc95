"""What a short impulse at a port of the model leaves in the rest of its window.

From samples of every window the model starts again in the state of the fitted motion, its rates changed as a unit of
impulse changes them, up and down: half the difference over the size of the change.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.fit.along import Along
from diagnosis.fit.unknowns import without_instruments
from diagnosis.fit.whitening import HALF_WIDTH
from models.base import FloatArray
from models.identification import Port

CHANGE = 0.01
"""Of the largest rate, by which the rates are changed."""
FEWEST_LEFT = 3
"""Samples of a window that must follow an impulse."""


@dataclass(frozen=True)
class Impulses:
    """Changes (W, C, N, K) of the channels by a unit impulse at a port, `HALF_WIDTH` s after one another.

    ``offset`` (K,): s from the start of the window; ``values``: by port.
    """

    offset: FloatArray
    values: Mapping[str, FloatArray]


def jumps_at(along: Along, ports: Sequence[Port]) -> dict[str, dict[str, FloatArray]]:
    """By port, by how much an impulse of one changes the free rates (W, N); ports that move nothing are left out."""
    m = along.predictor.measured
    wall = m.model.build(without_instruments(along.point.values), along.predictor.options)
    at = {name: along.states[name] for name in m.free}
    shape = m.values.shape[::2]
    # a state that follows another one jumps with it
    own = {
        port.name: {rate: np.broadcast_to(jump, shape) for rate, jump in port.jumps(wall, at).items() if rate in m.free}
        for port in ports
    }
    return {name: rates for name, rates in own.items() if any(np.any(jump) for jump in rates.values())}


def impulses(along: Along, ports: Sequence[Port]) -> Impulses:
    """Of every window, about a motion; a port whose impulses move nothing, as at a bonded joint, is left out."""
    m = along.predictor.measured
    duration = max(w.samples * step for w, step in zip(m.windows, m.time_steps, strict=True))
    offset = np.arange(0.0, duration, HALF_WIDTH)
    jumps = jumps_at(along, ports)
    found = {name: np.zeros((*m.values.shape, offset.size)) for name in jumps}
    size = {name: CHANGE * _largest(along, rates) for name, rates in jumps.items()}
    length = np.array([window.samples for window in m.windows])
    for r in along.plain:
        own, step = along.windows(r), m.recordings[r].time_step
        window, knot = (x.ravel() for x in np.meshgrid(own, np.arange(offset.size), indexing="ij"))
        sample = np.round(offset[knot] / step).astype(np.intp)
        inside = sample + FEWEST_LEFT < length[window]
        window, knot, sample = window[inside], knot[inside], sample[inside]
        start = along.at(window, sample)
        for name, rates in jumps.items():
            changed = {key: np.concatenate([x, x]) for key, x in start.items()}
            for rate, jump in rates.items():
                step_of = size[name] * jump[window, sample]
                changed[rate] = changed[rate] + np.concatenate([step_of, -step_of])
            both, since = np.tile(window, 2), np.tile(sample, 2)
            ran = along.run(r, m.first[both] + since, m.values.shape[2], changed)
            up, down = along.recorded(both, since, ran).reshape(2, window.size, *m.values.shape[1:])
            found[name][window, :, :, knot] = np.nan_to_num((up - down) / (2.0 * size[name]))
    return Impulses(offset, found)


def _largest(along: Along, rates: Mapping[str, FloatArray]) -> float:
    """The impulse that changes a rate by its largest value along the motion, where it changes it most."""
    each = [np.max(np.abs(along.states[name])) / np.max(np.abs(jump)) for name, jump in rates.items() if np.any(jump)]
    return float(max(min(each), 1e-9))
