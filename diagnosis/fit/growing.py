"""A fit whose windows grow: short ones first, in which neighbouring trajectories stay together.

Where motion is chaotic they part after a few events: in windows of full length the states of many end at motions with
other events, and the parameters with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diagnosis.data.windows import Window
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.starts import Origin, searched
from diagnosis.fit.whitening import sensor_noise_only

SHARES = (0.25, 0.5, 0.75)
"""Of the windows' lengths, one after the other."""
FEWEST = 20
"""Samples of a window that is shortened."""


def fit_from(plain: Misfit, origins: Sequence[Origin], seed: int = 0) -> Fitted:
    """The minimum against the sensors' white noise, searched from ``origins`` over what is not known there.

    With windows that grow where neighbouring trajectories part within one.
    """
    shares = SHARES if plain.measured.parts_quickly else ()
    stages = [*(_shortened(plain, share) for share in shares), plain]
    found = searched(stages[0], origins, seed)
    for stage in stages:
        found = fit_thoroughly(stage, found.u, found.states)
    return found


def cut_again(misfit: Misfit, windows: Sequence[Window]) -> Misfit:
    """The misfit with other lengths of its windows, against white noise of the sensors."""
    predictor = replace(misfit.predictor, measured=misfit.measured.cut_again(tuple(windows)))
    return replace(misfit, predictor=predictor, whitening=sensor_noise_only(predictor))


def _shortened(plain: Misfit, share: float) -> Misfit:
    windows = plain.measured.windows
    lengths = [min(w.samples, max(int(share * w.samples), FEWEST)) for w in windows]
    return cut_again(plain, [replace(w, samples=n) for w, n in zip(windows, lengths, strict=True)])
