"""From a specimen and its recordings to the calibrated base fit that everything else starts from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import models
from diagnosis.data.measured import Measured, arrange, identification_of
from diagnosis.fit.memory import counted
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.starts import calibrate_base
from diagnosis.fit.unknowns import fixed_values, of_specimen, without_instruments
from diagnosis.fit.whitening import responses, sensor_noise_only, with_base_noise
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.errors import InputError
from models.model import Model


def vertical_acts(specimen: Specimen, model: Model, recordings: Sequence[Recording]) -> bool:
    """Whether the measured vertical motion acts on the base model."""
    if specimen.vertical is not None:
        return specimen.vertical
    return model.vertical_by_default and all("base_acceleration_z" in r.channels for r in recordings)


def measure(specimen: Specimen, recordings: Sequence[Recording], reference_peak: float | None = None) -> Measured:
    """The recordings cut in windows. Raises InputError when there is nothing to compare.

    ``reference_peak`` (rad): what levels of instruments are given over where the specimen does not say; default:
    the largest value of the leading channel of the first recording.
    """
    if not recordings:
        raise InputError("no recording to learn from: name at least one.")
    model = models.get(specimen.model)
    windows = identification_of(model).windows
    lengths = None
    if windows is not None:
        values = {u.name: u.start for u in of_specimen(specimen, model)} | fixed_values(specimen)
        lengths = windows.in_seconds(model.derive(without_instruments(values), specimen.options))
    vertical = vertical_acts(specimen, model, recordings)
    return arrange(model, recordings, vertical, lengths, specimen.reference_peak or reference_peak)


def base_fit(specimen: Specimen, measured: Measured, seed: int = 0) -> Fitted:
    """The calibrated base: first against sensor noise alone, then with the noise of the base motion."""
    unknowns = of_specimen(specimen, measured.model)
    ranged = {u.name for u in unknowns if u.prior is None}
    coordinates = tuple(name for name in measured.identification.coordinates if name in ranged)
    predictor = Predictor(measured, specimen.options, specimen.stages, coordinates)
    plain = Misfit(predictor, sensor_noise_only(predictor), unknowns, fixed_values(specimen))
    first = calibrate_base(plain, seed)
    point = plain.point(first.u, first.states)
    whitening = with_base_noise(predictor, responses(predictor, point))
    predictor = replace(predictor, measured=counted(predictor, point))
    return fit_thoroughly(Misfit(predictor, whitening, unknowns, plain.fixed), first.u, first.states)
