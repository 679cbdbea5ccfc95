"""Constancy tests: is what a parameter stands for the same everywhere? The answer to laws in no library.

For each kind of force and each thing z it may depend on (side, time, amplitude, recording, direction) the
column G (f z) is tested with the constant column G f, the base parameters, the states and every active
mechanism projected out: a score test with one degree of freedom. What acts for a while only is
scanned over time. Errors estimated without a law hold part of what it does, so the strongest are tested once more with
the variances estimated beside the column (`diagnosis.errors.evidence`): a scatter with a pattern is a law.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.errors.evidence import Without
from diagnosis.errors.model import Errors
from diagnosis.fit.solver import Fitted
from diagnosis.forces.columns import Forces
from diagnosis.forces.columns import forces as forces_about
from models.base import FloatArray
from models.identification import Force, Identification, Port

FLAG = 15.0
SCAN_FLAG = 25.0
"""The scan over time tries many intervals."""
FOR_A_WHILE = "a limited time"
BLOW = "blow"
"""A force that is there for a moment: what it is along the motion cannot be told."""
AMPLITUDE = "amplitude of the motion"
TIME = "time"
STRONGEST = 6
"""Dependences that are tested with the errors estimated anew."""
SHORTEST_INTERVAL = 2
"""Windows."""
STRONGER = {AMPLITUDE: ("in weak motion", "in strong motion"), TIME: ("early", "late")}
"""Where a force is, with the smaller and with the larger value of what it depends on, for every model."""


@dataclass(frozen=True)
class Constancy:
    """A parameter that is not the same everywhere, what it depends on, and where it is ``stronger`` ("" if unknown)."""

    parameter: str
    depends_on: str
    evidence: float
    stronger: str = ""


@dataclass(frozen=True)
class Tested:
    """One test: statistic of a force of ``kind`` modulated by ``depends_on`` (nothing: the plain force).

    ``sign``: positive where the force is stronger with the larger value (the right side, later);
    ``extra``: sign of the part that depends, a force that resists the motion or the rotation being positive.
    """

    kind: str
    depends_on: str
    statistic: float
    sign: float = 0.0
    extra: float = 0.0


@dataclass(frozen=True)
class About:
    """The force columns about a fit and all tests of them under these errors, strongest first."""

    forces: Forces
    errors: Errors
    tested: list[Tested]

    @classmethod
    def of(cls, fitted: Fitted, errors: Errors) -> About:
        columns = forces_about(fitted)
        return cls(columns, errors, tests(columns, errors))

    def flags(self, threshold: float) -> tuple[Constancy, ...]:
        return flags(self.forces, self.tested, threshold)


def modulations(forces: Forces, port: Port) -> Iterator[tuple[str, FloatArray]]:
    """What a force at a port may depend on, as factors (W, N) about zero."""
    m = forces.fitted.measured
    for dependence in m.identification.dependences:
        factor = dependence.factor(forces.motions[port.name])
        yield dependence.name, _centred(factor) if dependence.about_mean else factor
    shape = forces.time.shape
    yield AMPLITUDE, np.broadcast_to(_centred(forces.peak(port)), shape)
    yield TIME, _centred(forces.time / max(r.time[-1] for r in m.recordings))
    record = m.recording_of[:, None]
    for r, recording in enumerate(m.recordings[1:], start=1):
        yield f"recording ({recording.name})", _centred(np.broadcast_to(record == r, shape).astype(float))


def _centred(values: FloatArray) -> FloatArray:
    return np.asarray(values - np.mean(values))


def tests(forces: Forces, errors: Errors) -> list[Tested]:
    """All tests, strongest first; ``errors``: estimated about the fit of the forces."""
    found = _scores(forces)
    dependent = [t for t in found if t.depends_on not in ("", FOR_A_WHILE)][:STRONGEST]
    again = []
    for kind in forces.kinds:
        own = [test for test in dependent if test.kind == kind.name]
        again += _with_own_errors(forces, errors, kind, own) if own else []
    return sorted([*(t for t in found if t not in dependent), *again], key=lambda t: -t.statistic)


def _with_own_errors(forces: Forces, errors: Errors, kind: Force, tested: list[Tested]) -> list[Tested]:
    """Tests of a kind with the variances estimated beside each column, where that shows more."""
    without = Without.estimated(errors, forces.fitted.measured, forces.predicted(kind)[..., None])
    factors = dict(modulations(forces, kind.port))
    found = []
    for test in tested:
        shown = without.evidence(forces.predicted(kind, factors[test.depends_on]))
        more = replace(test, statistic=shown.without_largest, extra=float(np.sign(shown.coefficient)))
        found.append(max(test, more, key=lambda t: t.statistic))
    return found


def _scores(forces: Forces) -> list[Tested]:
    """All tests under the errors as they are, strongest first."""
    screen = forces.screen
    found = []
    for kind in forces.kinds:
        plain = forces.column(kind)
        norm = screen.product(plain, plain)
        if norm < 1e-9:
            continue
        along = screen.scores_with_residual(plain)
        found.append(Tested(kind.name, "", along**2 / norm))
        for depends_on, factor in modulations(forces, kind.port):
            column = forces.column(kind, factor)
            cross = screen.product(column, plain) / norm
            information = screen.product(column, column) - cross**2 * norm
            if information < 1e-3 * max(screen.product(column, column), 1e-12):
                continue
            score = screen.scores_with_residual(column) - cross * along
            sign = float(np.sign(score) * np.sign(along))
            statistic = without_largest(*screen.by_window(column - cross * plain))
            found.append(Tested(kind.name, depends_on, statistic, sign, -float(np.sign(score))))
        interval = _in_an_interval(forces, plain)
        found.append(Tested(kind.name, FOR_A_WHILE, interval * FLAG / SCAN_FLAG))
    return sorted(found, key=lambda t: -t.statistic)


def without_largest(score: FloatArray, information: FloatArray) -> float:
    """Smallest score statistic when any one window (W,) is left out: one alone must not decide."""
    left = np.maximum(information.sum() - information, 1e-12)
    return float(np.min((score.sum() - score) ** 2 / left))


def _in_an_interval(forces: Forces, column: FloatArray) -> float:
    """Largest statistic of a force in successive windows alone, the most influential left out."""
    score, information = forces.screen.by_window(column)
    total_score, total = score.sum(), information.sum()
    records = forces.fitted.measured.recording_of
    best = 0.0
    for r in np.unique(records):
        own = np.flatnonzero(records == r)
        for a in range(own.size):
            for b in range(a + SHORTEST_INTERVAL, own.size + 1):
                inside, part = _but_largest(score[own[a:b]], information[own[a:b]])
                left = part * (1.0 - part / total)
                if left > 1e-3 * total:
                    best = max(best, (inside - part / total * total_score) ** 2 / left)
    return float(best)


def _but_largest(score: FloatArray, information: FloatArray) -> tuple[float, float]:
    """Sums without the window that adds most to the score's size."""
    largest = int(np.argmax(score * np.sign(score.sum())))
    return float(score.sum() - score[largest]), float(information.sum() - information[largest])


def flags(forces: Forces, tested: list[Tested], threshold: float = FLAG) -> tuple[Constancy, ...]:
    """Dependences beyond the threshold: one a kind of force, the strongest first, each force under one name.

    Plain forces are no flags: each has its mechanism in the library, which was refitted and is the better judge.
    """
    strongest: dict[str, Tested] = {}
    for test in tested:
        if test.depends_on and test.statistic >= threshold:
            strongest.setdefault(test.kind, test)
    found: dict[str, Constancy] = {}
    for test in strongest.values():
        one = flag(forces.fitted.measured.identification, test, test.statistic)
        found.setdefault(one.parameter, one)
    return tuple(found.values())


def flag(declared: Identification, test: Tested, evidence: float) -> Constancy:
    """A dependence under the name that the model declares, with the end at which the force is stronger."""
    kinds = {kind.name: kind for kind in declared.forces}
    name, depends_on = kinds[test.kind].named.get(test.depends_on, (test.kind, test.depends_on))
    ends = {**STRONGER, **{d.name: d.stronger for d in declared.dependences}}.get(depends_on)
    if ends is None or kinds[name].signed or not test.extra:
        return Constancy(name, depends_on, evidence)
    return Constancy(name, depends_on, evidence, ends[1 if test.extra > 0.0 else 0])
