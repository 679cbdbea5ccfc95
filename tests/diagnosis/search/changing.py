"""Blocks whose mechanisms change at instants and the search for these, and the screen about one that is as it was."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

import models
from diagnosis.data.measured import Measured
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.progress import silent
from diagnosis.search.beginnings import alone
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import Score, score
from grids.recordings.base import Recording
from models.piecewise import Part, simulate
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion, recording

MODEL = models.get("housner")
FEW = ("restitution", "viscous_damping", "tilt", "gain", "offset")
"""Mechanisms that are searched for."""
SCREENED = ("restitution", "tilt", "gain", "viscous_damping")
STILL = 1.5
"""s of rest before and after the shaking, by which errors of the sensors are told from the model's."""


def made(name: str, seed: int, changes: Sequence[tuple[float, Mapping[str, float]]], error: float = 0.0) -> Recording:
    """A block whose mechanisms change at instants (s), the sensor off by ``error`` of the peak from the last on."""
    plain = motion(seed)
    rest = np.zeros(round(STILL / TIME_STEP))
    shaking = replace(plain, horizontal=np.concatenate([rest, plain.horizontal, rest]))
    parts = [Part(0, TRUE), *(Part(round(at / TIME_STEP), {**TRUE, **values}) for at, values in changes if values)]
    rotation = np.ravel(simulate(MODEL, parts, shaking).channels["rotation_1"])
    time = TIME_STEP * np.arange(rotation.size)
    peak = float(np.max(np.abs(rotation)))
    rng = np.random.default_rng(seed + 1000)
    seen = rotation + 0.005 * peak * rng.normal(size=time.size)
    seen += error * peak * (time >= (changes[-1][0] if changes else 0.0))
    base = shaking.horizontal + 0.003 * shaking.pga * rng.normal(size=time.size)
    return Recording(name, TIME_STEP, time, {"base_acceleration_x": base, "rotation_1": seen})


def searched(
    recordings: Sequence[Recording], shortest: float | None = None, among: Sequence[str] = FEW
) -> tuple[Search, list[Search]]:
    """What an ordinary search that found nothing goes on with, and what the search for beginnings yields.

    ``shortest`` (s): of a spell that is no blow; ``among``: mechanisms that are searched for.
    """
    measured = measure(SPECIMEN, recordings)
    if shortest is not None:
        assert measured.lengths is not None
        measured = replace(measured, lengths=replace(measured.lengths, shortest=shortest))
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(c for c in candidates(measured, SPECIMEN) if c.name in among)
    found = Search(Explanation((), fitted), some, errors)
    opened = linearise_about(fitted)
    found.scores = score(opened, some)
    found.null = null_distribution(opened, found.scores)
    return found, list(alone(found, silent))


@cache
def opened() -> tuple[Measured, Linearisation]:
    """The base model linearised about two recordings of a plain block."""
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    return measured, linearise_about(base_fit(SPECIMEN, measured))


@cache
def screened() -> tuple[Score, ...]:
    """The scores of four mechanisms about it."""
    measured, screen = opened()
    return tuple(score(screen, [c for c in candidates(measured, SPECIMEN) if c.name in SCREENED]))
