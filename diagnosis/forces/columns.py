"""What an unknown force would leave in every window, without a new model.

The changes that short impulses at a port of the model leave (`diagnosis.fit.impulses`) are what any force there leaves.
So a law that is in no library is tested by the sum of them times f, with f taken along the fitted motion for the kinds
that the model declares (`models.identification.Force`). A loss of the rate at events is the sum of what each of them
leaves (`diagnosis.errors.kicks`): the columns of their scatter, so that a law of events is a pattern of that scatter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diagnosis.errors.kicks import Kicks, kicks
from diagnosis.fit.along import Along
from diagnosis.fit.impulses import Impulses, impulses, jumps_at
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import HALF_WIDTH
from models.base import FloatArray
from models.identification import Force, Motion, Port


@dataclass(frozen=True)
class Forces:
    """The fitted motion of every window, and how to turn a force along it into a column.

    ``motions``: by port, its coordinate along the windows; ``time`` (W, N); ``weight`` (W, K, N) of a sample in an
    impulse; ``events``: what a change of the rate at each of them leaves.
    """

    fitted: Fitted
    screen: Linearisation
    response: Impulses
    motions: Mapping[str, Motion]
    time: FloatArray
    weight: FloatArray
    events: Kicks

    @property
    def kinds(self) -> tuple[Force, ...]:
        """The kinds of force that the model declares, at ports where a force moves something."""
        return tuple(kind for kind in self.fitted.measured.identification.forces if kind.port.name in self.motions)

    @property
    def motion(self) -> Motion:
        """That of the first port."""
        return next(iter(self.motions.values()))

    def peak(self, port: Port) -> FloatArray:
        """Largest coordinate of each window (W, 1)."""
        m = self.fitted.measured
        inside = np.abs(self.motions[port.name].coordinate) * m.mask[:, m.lead]
        return np.asarray(np.max(inside, axis=1, keepdims=True))

    def column(self, kind: Force, factor: FloatArray | None = None) -> FloatArray:
        """Whitened residual (W, M), off the states, that a force of this kind times ``factor`` (W, N) leaves."""
        return self.screen.reduced(self.fitted.misfit.whitening(self.predicted(kind, factor)))

    def predicted(self, kind: Force, factor: FloatArray | None = None) -> FloatArray:
        """Change (W, C, N) of the channels by a force of this kind times ``factor`` (W, N)."""
        modulation = np.ones_like(self.time) if factor is None else factor
        if kind.along is None:
            return self.events.losing(modulation, self.fitted.measured.first)
        force = kind.along(self.motions[kind.port.name]) * modulation
        each = np.einsum("wkn,wn->wk", self.weight, force, optimize=True)
        return np.asarray(np.einsum("wcnk,wk->wcn", self.response.values[kind.port.name], each, optimize=True))


def motions_of(fitted: Fitted) -> dict[str, Motion]:
    """By port of the model at which a force moves something, its coordinate along the windows of a fit."""
    return _motions(Along(fitted.misfit.predictor, fitted.point))


def _ports(along: Along) -> list[Port]:
    return list({kind.port.name: kind.port for kind in along.predictor.measured.identification.forces}.values())


def _motions(along: Along) -> dict[str, Motion]:
    ports = _ports(along)
    acting = jumps_at(along, ports)
    return {port.name: _motion(along, along.observed(port.coordinate)) for port in ports if port.name in acting}


def _motion(along: Along, coordinate: FloatArray) -> Motion:
    m = along.predictor.measured
    step = m.time_steps[:, None]
    last = np.array([m.recordings[w.recording].time.size - 1 - w.first for w in m.windows])
    known = np.minimum(np.arange(coordinate.shape[1]), last[:, None])  # behind the end of a recording nothing ran
    coordinate = np.take_along_axis(coordinate, known, axis=1)
    reach = float(np.max(np.abs(coordinate) * m.mask[:, m.lead]))
    return Motion(coordinate, np.gradient(coordinate, axis=1) / step, m.base, reach)


def forces(fitted: Fitted) -> Forces:
    """The force columns about a fit."""
    predictor, m = fitted.misfit.predictor, fitted.measured
    mask, along = m.mask[:, m.lead], Along(fitted.misfit.predictor, fitted.point)
    response = impulses(along, _ports(along))
    step = m.time_steps[:, None]
    since = np.arange(m.values.shape[2])[None] * step
    pulses = np.maximum(0.0, 1.0 - np.abs(since[:, None, :] - response.offset[None, :, None]) / HALF_WIDTH)
    pulses = pulses * mask[:, None, :]
    return Forces(
        fitted=fitted,
        screen=linearise_about(fitted),
        response=response,
        motions=_motions(along),
        time=m.first[:, None] * step + since,
        weight=pulses / np.maximum(pulses.sum(axis=2, keepdims=True), 1.0),
        events=kicks(predictor, fitted.point),
    )
