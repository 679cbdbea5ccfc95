"""``extended.toml``: the specimen with what was found switched on."""

from __future__ import annotations

from dataclasses import replace

import models
from diagnosis.answer.result import Diagnosis, OtherModel
from diagnosis.data.measured import identification_of
from diagnosis.fit.unknowns import library
from grids.specimen import Specimen, with_values
from grids.stages import Stage


def extend(specimen: Specimen, diagnosis: Diagnosis) -> Specimen:
    """The specimen with fitted parameters instead of nominal ones and every effect of the answer.

    What was to be calibrated has its value now; tolerances stay, about what was measured. Where a mechanism was
    calibrated (``mechanism.parameter`` in [calibrate]), its value stands among the mechanisms. Where the answer is
    another base model it is a specimen of that one, all its parameters as fitted.
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
    return replace(
        specimen,
        title=f"{specimen.title}, extended",
        model=other.model,
        parameters=other.parameters,
        tolerance={},
        measured={},
        calibrate={},
        options=other.options,
        vertical=other.vertical,
        initial=initial,
        mechanisms=_with_base(specimen, diagnosis).mechanisms,
        reference_peak=diagnosis.reference_peak or specimen.reference_peak,
    )
