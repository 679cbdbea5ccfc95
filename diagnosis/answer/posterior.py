"""Which samples of a fit a study can vary."""

from __future__ import annotations

from collections.abc import Collection

from diagnosis.fit.posterior import samples
from diagnosis.fit.solver import Fitted
from models.base import FloatArray
from models.model import Model


def posterior(fitted: Fitted, model: Model, ended: Collection[str] = (), seed: int = 0) -> dict[str, FloatArray]:
    """Samples (n,) of the wall's parameters and mechanisms; none of instruments, tables and what has ``ended``."""

    def stays(name: str) -> bool:
        mechanism, dot, _ = name.partition(".")
        if not dot:
            return True
        acting = model.mechanisms.get(mechanism)
        return acting is not None and not acting.tabulated and mechanism not in ended

    return {name: values for name, values in samples(fitted, seed=seed).items() if stays(name)}
