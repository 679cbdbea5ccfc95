"""``extended.toml``: the specimen with what was found switched on."""

from __future__ import annotations

from dataclasses import replace

from diagnosis.answer.result import Diagnosis
from grids.specimen import Specimen

BASES = {"second_body": "stacked", "compliant_base": "interface"}
"""Effects that are another base model."""


def extend(specimen: Specimen, diagnosis: Diagnosis) -> Specimen:
    """The specimen with fitted parameters instead of nominal ones and every effect of the answer.

    What was to be calibrated has its value now; tolerances stay for parameters that keep a name in
    [parameters]. Where a mechanism was calibrated (``mechanism.parameter`` in [calibrate]), its value
    stands among the mechanisms.
    """
    parameters = dict(specimen.parameters)
    mechanisms = {name: dict(values) for name, values in specimen.mechanisms.items()}
    for name, value in diagnosis.base.items():
        mechanism, dot, parameter = name.partition(".")
        if dot:
            mechanisms.setdefault(mechanism, {})[parameter] = value.estimate
        else:
            parameters[name] = value.estimate
    model = specimen.model
    for effect in diagnosis.effects:
        if effect.name in BASES:
            model = BASES[effect.name]
            parameters |= {name: value.estimate for name, value in effect.parameters.items()}
        else:
            fitted = {name: value.estimate for name, value in effect.parameters.items()}
            mechanisms[effect.name] = {**_off(effect.name, model), **mechanisms.get(effect.name, {}), **fitted}
    unknown = {name: ends for name, ends in specimen.calibrate.items() if name not in diagnosis.base}
    return replace(
        specimen,
        title=f"{specimen.title}, extended" if diagnosis.effects else specimen.title,
        model=model,
        parameters=parameters,
        calibrate=unknown,
        tolerance={name: value for name, value in specimen.tolerance.items() if name in parameters},
        mechanisms=mechanisms,
    )


def _off(name: str, model: str) -> dict[str, float]:
    """The null of a mechanism's own parameters: what acts through a shape alone (a high-pass) names them too."""
    import models
    from grids.instruments import INSTRUMENTS

    mechanism = {**models.get(model).mechanisms, **INSTRUMENTS}[name]
    return {p.name: p.null for p in mechanism.parameters if not p.shape}
