"""What was found, in windows that grow with it.

Where neighbouring trajectories part within a window, those of the base fit last as long as the base model can follow
(`diagnosis.fit.growing`), which is short where much is missing. The model with what was found follows further, and
more of a law that is not the right one is left over in windows that grow with it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.followed import followed
from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.fit.growing import fit_followed
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.setup import with_noise_of_the_base
from diagnosis.fit.starts import Origin
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.found import Search


def grown(found: Search, whole: Measured) -> Search:
    """The search with what it has found fitted anew, and its errors, in windows of ``whole`` as far as it follows."""
    chosen = found.chosen
    misfit, fitted = chosen.fitted.misfit, chosen.fitted
    predictor = replace(misfit.predictor, measured=whole)
    plain = Misfit(predictor, sensor_noise_only(predictor), misfit.unknowns, misfit.fixed)
    place = {(w.recording, w.first): k for k, w in enumerate(whole.windows)}
    own = [place[w.recording, w.first] for w in fitted.measured.windows]
    states, samples = whole.states.copy(), np.zeros(len(whole.windows), np.intp)
    states[own], samples[own] = fitted.states, [w.samples for w in fitted.measured.windows]
    origin = Origin(fitted.u, states, np.ones(len(misfit.unknowns), bool))
    first = followed(with_noise_of_the_base(fit_followed(plain, [origin], known=samples)))
    again, errors = refitted(first, disturbance_about(first))
    return replace(found, best=replace(chosen, fitted=again), errors=errors, about=None)
