"""From a specimen and its recordings to the calibrated base fit that everything else starts from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import models
from diagnosis.data.gathered import refuse_moved
from diagnosis.data.measured import Measured, arrange, identification_of, placed_in
from diagnosis.data.pose import with_rotations
from diagnosis.data.stretches import arrange_stretches
from diagnosis.fit.growing import fit_followed
from diagnosis.fit.memory import counted
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.starts import nominal
from diagnosis.fit.unknowns import fixed_values, of_specimen, without_instruments
from diagnosis.fit.whitening import responses, sensor_noise_only, with_base_noise
from grids.instruments.integrated_displacement import MECHANISM as INTEGRATED
from grids.recordings.base import Recording
from grids.recordings.integration import Integrated, integrated
from grids.specimen import Specimen, with_mechanism
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
    the largest value of the leading channel of the first recording that moves.
    """
    if not recordings:
        raise InputError("no recording to learn from: name at least one.")
    refuse_moved(recordings)
    model = models.get(specimen.model)
    declared = identification_of(model)
    values = {u.name: u.start for u in of_specimen(specimen, model)} | fixed_values(specimen)
    derived = model.derive(without_instruments(values), specimen.options)
    peak = specimen.reference_peak or reference_peak
    if declared.windows is not None:
        if INTEGRATED.name in specimen.mechanisms:
            raise InputError(
                f"[mechanisms.{INTEGRATED.name}] acts on whole recordings, and model {model.name} is compared in "
                "windows: leave it out, and the displacements too."
            )
        vertical = vertical_acts(specimen, model, recordings)
        plain = without_instruments(values)
        recordings = with_rotations(model, declared, plain, specimen.options, recordings)
        return arrange(model, recordings, vertical, declared.windows.in_seconds(derived), peak)
    if declared.stretches is None:
        raise InputError(f"model {model.name} declares neither windows nor stretches of whole runs.")
    placed = placed_in(model, recordings, values)
    left = [acceleration for _, acceleration in declared.stretches.integrals if INTEGRATED.name in specimen.mechanisms]
    stretches = declared.stretches.in_seconds(derived)
    return arrange_stretches(model, recordings, stretches, model.points(values), placed, left, peak)


def as_recorded(specimen: Specimen, recordings: Sequence[Recording]) -> tuple[Specimen, tuple[Integrated, ...]]:
    """The specimen with instruments that the recordings show and nobody has mentioned; and what was seen."""
    stretches = identification_of(models.get(specimen.model)).stretches
    if stretches is None or INTEGRATED.name in specimen.mechanisms:
        return specimen, ()
    found = tuple(one for one in (integrated(recordings, *pair) for pair in stretches.integrals) if one is not None)
    for one in found:
        specimen = with_mechanism(specimen, INTEGRATED.name, {"high_pass_hz": one.corner_hz})
    return specimen, found


def base_fit(specimen: Specimen, measured: Measured, seed: int = 0) -> Fitted:
    """The calibrated base."""
    unknowns = of_specimen(specimen, measured.model)
    ranged = {u.name for u in unknowns if u.prior is None}
    coordinates = tuple(name for name in measured.identification.coordinates if name in ranged)
    predictor = Predictor(measured, specimen.options, specimen.stages, coordinates)
    plain = Misfit(predictor, sensor_noise_only(predictor), unknowns, fixed_values(specimen))
    return with_noise_of_the_base(fit_followed(plain, [nominal(plain)], seed))


def with_noise_of_the_base(first: Fitted) -> Fitted:
    """A fit against the sensors' noise alone taken on with that of the base motion."""
    plain, predictor = first.misfit, first.misfit.predictor
    if predictor.measured.stretches is not None:  # what the noise of the base leaves goes on from stretch to stretch
        return first
    point = plain.point(first.u, first.states)
    whitening = with_base_noise(predictor, responses(predictor, point))
    predictor = replace(predictor, measured=counted(predictor, point))
    return fit_thoroughly(replace(plain, predictor=predictor, whitening=whitening), first.u, first.states)
