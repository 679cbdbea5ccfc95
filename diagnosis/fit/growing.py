"""A fit whose windows grow: short ones first, in which neighbouring trajectories stay together.

Where motion is chaotic they part after a few events: in windows of full length the states of many end at motions with
other events, and the parameters with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.starts import Origin, searched
from diagnosis.fit.whitening import sensor_noise_only

SHARES = (0.25, 0.5, 0.75)
"""Of the windows' lengths, one after the other."""
FEWEST = 20
"""Samples of a window that is shortened."""


def fit_from(plain: Misfit, origins: Sequence[Origin], seed: int = 0) -> Fitted:
    """The minimum against the sensors' white noise, searched from ``origins`` over what is not known there."""
    if plain.measured.parts_quickly:
        return fit_growing(plain, origins, seed)
    start = searched(plain, origins, seed)
    return fit_thoroughly(plain, start.u, start.states)


def fit_growing(plain: Misfit, origins: Sequence[Origin], seed: int = 0) -> Fitted:
    """The same with windows that grow."""
    start = searched(_shortened(plain, SHARES[0]), origins, seed)
    for share in SHARES:
        start = fit_thoroughly(_shortened(plain, share), start.u, start.states)
    return fit_thoroughly(plain, start.u, start.states)


def _shortened(plain: Misfit, share: float) -> Misfit:
    m = plain.measured
    lengths = [min(w.samples, max(int(share * w.samples), FEWEST)) for w in m.windows]
    windows = tuple(replace(w, samples=length) for w, length in zip(m.windows, lengths, strict=True))
    predictor = replace(plain.predictor, measured=m.cut_again(windows))
    return replace(plain, predictor=predictor, whitening=sensor_noise_only(predictor))
