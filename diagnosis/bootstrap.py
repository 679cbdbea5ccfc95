"""Parametric bootstrap of the p-value: recordings made by the fitted base model, searched the same way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.candidates import candidates
from diagnosis.fit import fit
from diagnosis.found import Search
from diagnosis.refit import Explanation, best_of, extend
from diagnosis.screen import open_screen, score
from diagnosis.select import FEWEST, Progress
from diagnosis.starts import start_of
from grids.specimen import Specimen

REFITTED = 3


def p_value(specimen: Specimen, found: Search, draws: int, seed: int, progress: Progress) -> float:
    """(1 + draws with a gain at least as large)/(1 + draws): windows from the base fit plus noise."""
    observed = found.base.loss - min([found.base.loss, *(e.loss for e in found.singles)])
    base = found.base.fitted
    predictor, m = base.misfit.predictor, base.misfit.predictor.measured
    motion = predictor.predict([base.misfit.point(base.u, base.states)])[0]
    rng = np.random.default_rng(seed)
    above = 0
    for draw in range(draws):
        progress(f"bootstrap {draw + 1} of {draws}", 0.9)
        noise = rng.normal(size=motion.shape) * m.sigma[..., None]
        made = replace(m, values=np.where(m.mask, motion + noise, 0.0))
        misfit = replace(base.misfit, predictor=replace(predictor, measured=made))
        again = Explanation((), fit(misfit, start_of(misfit.unknowns), base.states))
        scores = score(open_screen(again.fitted), candidates(made, specimen))[: min(FEWEST, REFITTED)]
        fits = [extend(again, s.candidate, start) for s in scores for start in s.starts[:1]]
        gain = again.loss - best_of([again, *fits]).loss
        above += gain >= observed
    return (1 + above) / (1 + draws)
