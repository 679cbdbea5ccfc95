"""``extended.toml``: the specimen with what was found switched on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import sqrt

import models
from diagnosis.answer.result import Diagnosis, OtherModel
from diagnosis.data.measured import identification_of
from diagnosis.fit.unknowns import library
from grids.specimen import Specimen, with_values
from grids.stages import Stage
from models.identification import Rung

SEARCHED = 0.3
"""Relative sd of what was searched in a range, in a specimen of another base model: what is still missing moves it."""
OF_95 = 3.92
"""Standard deviations in a 95 % interval."""


def extend(specimen: Specimen, diagnosis: Diagnosis) -> Specimen:
    """The specimen with fitted parameters instead of nominal ones and every effect of the answer.

    What was to be calibrated has its value now; tolerances stay, about what was measured. Where a mechanism was
    calibrated (``mechanism.parameter`` in [calibrate]), its value stands among the mechanisms. Where the answer is
    another base model it is a specimen of that one: its parameters as fitted, and with what the laboratory knows of
    them as tolerances, so that it can be diagnosed again.
    """
    if diagnosis.other_model is not None:
        return _of_another_model(specimen, diagnosis, diagnosis.other_model)
    fitted_base = _with_base(specimen, diagnosis)
    mechanisms = dict(fitted_base.mechanisms)
    known = library(models.get(specimen.model))
    stages = dict(specimen.stages)
    for effect in diagnosis.effects:
        fitted = {name: value.estimate for name, value in effect.parameters.items()}
        off = {p.name: p.null for p in known[effect.name].parameters if not p.shape}
        if not off.keys() & fitted.keys() and effect.name not in mechanisms:
            fitted = off | fitted  # what acts through a shape alone (a high-pass) names the effect's own value too
        mechanisms[effect.name] = {**mechanisms.get(effect.name, {}), **fitted}
        if effect.stages:
            stages[effect.name] = tuple(Stage(one.recording, one.begins, one.ends) for one in effect.stages)
    if diagnosis.missing_force:
        form = next(name for name, mechanism in known.items() if mechanism.tabulated)
        mechanisms[form] = dict(diagnosis.missing_force["parameters"])
        if acting := diagnosis.missing_force["stages"]:
            stages[form] = tuple(Stage(**one) for one in acting)
    unknown = {name: ends for name, ends in specimen.calibrate.items() if name not in diagnosis.base}
    return replace(
        fitted_base,
        title=f"{specimen.title}, extended" if diagnosis.effects else specimen.title,
        calibrate=unknown,
        mechanisms=mechanisms,
        stages=stages,
        reference_peak=diagnosis.reference_peak or specimen.reference_peak,
    )


def _with_base(specimen: Specimen, diagnosis: Diagnosis) -> Specimen:
    """The specimen with the calibrated base and the instruments that were seen."""
    seen = replace(specimen, mechanisms={**specimen.mechanisms, **diagnosis.instruments})
    return with_values(seen, {name: value.estimate for name, value in diagnosis.base.items()})


def _of_another_model(specimen: Specimen, diagnosis: Diagnosis, other: OtherModel) -> Specimen:
    rung = next(r for r in identification_of(models.get(specimen.model)).ladder if r.name == other.effect)
    initial = dict(specimen.initial)
    initial |= {name: initial[of] for name, of in rung.alike.items() if of in initial}
    measured, tolerance = _known(specimen, diagnosis, other, rung)
    return replace(
        specimen,
        title=f"{specimen.title}, extended",
        model=other.model,
        parameters=other.parameters,
        tolerance=tolerance,
        measured=measured,
        calibrate={},
        options=other.options,
        vertical=other.vertical,
        initial=initial,
        mechanisms=_with_base(specimen, diagnosis).mechanisms,
        reference_peak=diagnosis.reference_peak or specimen.reference_peak,
    )


def _known(
    specimen: Specimen, diagnosis: Diagnosis, other: OtherModel, rung: Rung
) -> tuple[dict[str, float], dict[str, float]]:
    """What the laboratory has measured of the other model's parameters, and their relative sd.

    Tolerances are carried over to first order; what was searched within a range is known to `SEARCHED`, for what is
    still missing may have moved it, and where a joint is to its interval.
    """
    effect = next(one for one in diagnosis.effects if one.name == other.effect)
    own = {name: value.estimate for name, value in effect.parameters.items()}
    base = {name: value.estimate for name, value in diagnosis.base.items() if name in specimen.calibrate}
    given = {**base, **specimen.nominal}
    at = rung.carried_over(given, own)
    variance = dict.fromkeys(at, 0.0)

    def add(moved: Mapping[str, float]) -> None:
        for name, value in at.items():
            if value:
                variance[name] += (moved[name] / value - 1.0) ** 2

    for name, relative in (*specimen.tolerance.items(), *((name, SEARCHED) for name in base)):
        add(rung.carried_over({**given, name: given[name] * (1.0 + relative)}, own))
    for name, value in effect.parameters.items():
        relative = SEARCHED if name in at else min((value.high95 - value.low95) / (OF_95 * value.estimate), SEARCHED)
        add(rung.carried_over(given, {**own, name: value.estimate * (1.0 - relative)}))
    tolerance = {name: float(f"{min(sqrt(one), SEARCHED):.4g}") for name, one in variance.items() if one > 0.0}
    return {name: at[name] for name in tolerance if at[name] != other.parameters[name]}, tolerance
