"""From a specimen and its recordings to the calibrated base fit that everything else starts from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import models
from diagnosis.data.measured import Measured, arrange
from diagnosis.fit.memory import counted
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.starts import calibrate_base
from diagnosis.fit.unknowns import fixed_values, of_specimen
from diagnosis.fit.whitening import responses, sensor_noise_only, with_base_noise
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.errors import InputError
from models.model import Model


def vertical_acts(specimen: Specimen, model: Model, recordings: Sequence[Recording]) -> bool:
    """Whether the base model feels the measured vertical motion."""
    if specimen.vertical is not None:
        return specimen.vertical
    return model.vertical_by_default and all("base_acceleration_z" in r.channels for r in recordings)


def measure(specimen: Specimen, recordings: Sequence[Recording], reference_peak: float | None = None) -> Measured:
    """The recordings cut in windows. Raises InputError when there is nothing to compare."""
    if not recordings:
        raise InputError("no recording to learn from: name at least one.")
    model = models.get(specimen.model)
    return arrange(model, recordings, vertical_acts(specimen, model, recordings), reference_peak)


def base_fit(specimen: Specimen, measured: Measured, seed: int = 0) -> Fitted:
    """The calibrated base: first against sensor noise alone, then with the noise of the base motion."""
    predictor = Predictor(measured, specimen.options)
    unknowns = of_specimen(specimen, measured.model)
    plain = Misfit(predictor, sensor_noise_only(predictor), unknowns, fixed_values(specimen))
    first = calibrate_base(plain, seed)
    point = plain.point(first.u, first.states)
    whitening = with_base_noise(predictor, responses(predictor, point))
    predictor = replace(predictor, measured=counted(predictor, point))
    return fit_thoroughly(Misfit(predictor, whitening, unknowns, plain.fixed), first.u, first.states)
