"""Constancy tests: is what a parameter stands for the same everywhere? The answer to laws in no library.

For each kind of force and each thing z it may depend on (side, time, amplitude, recording, direction) the
column G (f z) is tested with the constant column G f, the base parameters, the states and every active
mechanism projected out: a score test with one degree of freedom. What acts for a while only is
scanned over time. Statistics are divided by the misfit that the model leaves anyway.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnosis.forces.columns import KINDS, Forces
from models.base import FloatArray

FLAG = 15.0
SCAN_FLAG = 25.0
"""The scan over time tries many intervals."""
SPELL = "a spell of time"
SHORTEST_SPELL = 2
"""Windows."""
SAME_FORCE = {
    ("lean", "direction of motion"): ("coulomb_damping", "side"),
    ("stiffness", "direction of motion"): ("coulomb_damping", "size of the rotation"),
}
"""One force under two names: sign(theta theta') = sign(theta') sign(theta); told as the right one."""
WITHOUT_STRENGTH = ("lean",)
"""A couple in one direction has a sign, not a strength."""
STRONGER = {
    "side": ("for theta < 0, to the left", "for theta > 0, to the right"),
    "amplitude of the motion": ("in weak motion", "in strong motion"),
    "size of the rotation": ("at small rotation", "at large rotation"),
    "time": ("early", "late"),
    "direction of motion": ("on the way back", "on the way out"),
}
"""Where a force is, with the smaller and with the larger value of what it depends on."""


@dataclass(frozen=True)
class Constancy:
    """A parameter that is not the same everywhere, what it depends on, and where it is ``stronger`` ("" if untold)."""

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


def modulations(forces: Forces) -> Iterator[tuple[str, FloatArray]]:
    """What a force may depend on, as factors (W, N) about zero."""
    m = forces.fitted.measured
    yield "side", np.sign(forces.rotation)
    yield "amplitude of the motion", np.broadcast_to(_centred(forces.peak), forces.rotation.shape)
    yield "size of the rotation", _centred(np.abs(forces.rotation) / np.max(forces.peak))
    length = max(r.time[-1] for r in m.recordings)
    yield "time", _centred(forces.time / length)
    yield "direction of motion", np.sign(forces.rotation * forces.rate)
    record = m.recording_of[:, None]
    for r, recording in enumerate(m.recordings[1:], start=1):
        inside = np.broadcast_to(record == r, forces.rotation.shape).astype(float)
        yield f"recording ({recording.name})", _centred(inside)


def _centred(values: FloatArray) -> FloatArray:
    return np.asarray(values - np.mean(values))


def inflation(forces: Forces) -> float:
    """Misfit per sample that the model leaves, at least 1."""
    m = forces.fitted.measured
    chi2 = np.sum(forces.screen.residual**2, axis=1)
    return max(1.0, float(np.median(chi2 / m.count)))


def tests(forces: Forces) -> list[Tested]:
    """All tests, strongest first."""
    screen, excess = forces.screen, inflation(forces)
    found = []
    for kind in KINDS:
        plain = forces.column(kind)
        norm = screen.product(plain, plain)
        if norm < 1e-9:
            continue
        along = screen.scores_with_residual(plain)
        found.append(Tested(kind, "", along**2 / norm / excess))
        for depends_on, factor in modulations(forces):
            column = forces.column(kind, factor)
            cross = screen.product(column, plain) / norm
            information = screen.product(column, column) - cross**2 * norm
            if information < 1e-3 * max(screen.product(column, column), 1e-12):
                continue
            score = screen.scores_with_residual(column) - cross * along
            sign = float(np.sign(score) * np.sign(along))
            statistic = without_loudest(*screen.by_window(column - cross * plain))
            found.append(Tested(kind, depends_on, statistic / excess, sign, -float(np.sign(score))))
        spell = _spell(forces, plain) / excess
        found.append(Tested(kind, SPELL, spell * FLAG / SCAN_FLAG))
    return sorted(found, key=lambda t: -t.statistic)


def without_loudest(score: FloatArray, information: FloatArray) -> float:
    """Smallest score statistic when any one window (W,) is left out: one alone must not decide."""
    left = np.maximum(information.sum() - information, 1e-12)
    return float(np.min((score.sum() - score) ** 2 / left))


def _spell(forces: Forces, column: FloatArray) -> float:
    """Largest statistic of the force acting in one spell of windows, the loudest left out, against acting always."""
    score, information = forces.screen.by_window(column)
    total_score, total = score.sum(), information.sum()
    records = forces.fitted.measured.recording_of
    best = 0.0
    for r in np.unique(records):
        own = np.flatnonzero(records == r)
        for a in range(own.size):
            for b in range(a + SHORTEST_SPELL, own.size + 1):
                inside, part = _but_loudest(score[own[a:b]], information[own[a:b]])
                left = part * (1.0 - part / total)
                if left > 1e-3 * total:
                    best = max(best, (inside - part / total * total_score) ** 2 / left)
    return float(best)


def _but_loudest(score: FloatArray, information: FloatArray) -> tuple[float, float]:
    """Sums without the window that adds most to the score's size."""
    loudest = int(np.argmax(score * np.sign(score.sum())))
    return float(score.sum() - score[loudest]), float(information.sum() - information[loudest])


def flags(tested: list[Tested], threshold: float = FLAG) -> tuple[Constancy, ...]:
    """Dependences beyond the threshold: one a kind of force, the strongest first, each force under one name.

    Plain forces are no flags: each has its mechanism in the library, which was refitted and is the better judge.
    """
    strongest: dict[str, Tested] = {}
    for test in tested:
        if test.depends_on and test.statistic >= threshold:
            strongest.setdefault(test.kind, test)
    found: dict[str, Constancy] = {}
    for test in strongest.values():
        one = flag(test, test.statistic)
        found.setdefault(one.parameter, one)
    return tuple(found.values())


def flag(test: Tested, evidence: float) -> Constancy:
    """A dependence told, with the end at which the force is stronger."""
    kind, depends_on = SAME_FORCE.get((test.kind, test.depends_on), (test.kind, test.depends_on))
    ends = STRONGER.get(depends_on)
    if ends is None or kind in WITHOUT_STRENGTH or not test.extra:
        return Constancy(kind, depends_on, evidence)
    return Constancy(kind, depends_on, evidence, ends[1 if test.extra > 0.0 else 0])
