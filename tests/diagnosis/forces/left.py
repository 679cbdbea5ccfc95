"""Two recordings in which nothing is missing, and what a force or impacts would have left in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.errors.likelihood import climbed, maximise
from diagnosis.errors.model import Errors, calibrated
from diagnosis.fit.setup import measure
from diagnosis.forces.columns import Forces, forces
from models.housner.identification import IDENTIFICATION
from tests.diagnosis.made import SPECIMEN, recording

KINDS = {kind.name: kind for kind in IDENTIFICATION.forces}


def about_nothing(seeds: Sequence[int] = (1, 2)) -> tuple[Forces, Errors]:
    """The base model about two recordings in which nothing is missing, and their errors."""
    fitted, found = calibrated(SPECIMEN, measure(SPECIMEN, [recording(f"train_{k}", k) for k in seeds]))
    return forces(fitted), found


def with_impacts(errors: tuple[Forces, Errors], changes: np.ndarray) -> Errors:
    """The errors estimated from the same residuals with every impact's rate changed by a share, ``changes`` (W, K)."""
    return with_residual(errors, np.einsum("wcnk,wk->wcn", errors[1].kicks.columns, changes))


def with_residual(errors: tuple[Forces, Errors], left: np.ndarray) -> Errors:
    """The errors estimated from the same residuals with ``left`` (W, C, N) recorded beside."""
    about, found = errors
    m = about.fitted.measured
    moved = m.averaged(left[None])[0] / m.units[:, :, None]
    pieces = list(found.pieces)
    for w in range(len(m.windows)):
        pieces[w] = replace(pieces[w], residual=pieces[w].residual - moved[w].ravel()[m.compared[w].ravel()])
    theta, weights = climbed(pieces, found.prior, np.maximum(found.theta, 1e-4), found.weights, 0, 6)
    theta, state = maximise(pieces, found.prior, theta, weights)
    return replace(found, pieces=tuple(pieces), theta=theta, deviance=state.deviance)
