"""How likely a motion overturns a specimen: its simulated margin, and what scatters from run to run.

Every run is simulated at a ladder of scales of its motion. Overturning is not monotone in the scale, so the margin is
not one number but the set of scales that overturn. What differs between two runs of one motion (where the specimen
was placed, how the table followed) acts as a scale exp(sigma z), z standard normal:

    P(overturned) = sum_k O_k [Phi((u_k + d/2)/sigma) - Phi((u_k - d/2)/sigma)],   u_k = log scale, d its step,

O_k = 1 where scale exp(u_k) overturns. One outcome in `ODD` is taken to have another reason altogether.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import norm

from diagnosis.data.averaging import averaged, stride
from diagnosis.fit.setup import vertical_acts
from diagnosis.fit.unknowns import fixed_values, instruments_of, without_instruments
from diagnosis.progress import Progress, silent
from grids.instruments import moved
from grids.motions import Motion
from grids.specimen import Specimen
from grids.stages import after_the_last
from models.base import MISSING, FloatArray
from models.model import Model
from models.shaking import Shaking

LOG_SCALES = np.linspace(-1.05, 1.05, 15)
SCATTERS = np.geomspace(0.07, 0.8, 12)
"""Standard deviations of the log scale that are weighed against each other."""
ODD = 0.01
TAIL = 5.0
"""Free motion (s) after a record within which a specimen may still fall."""
UNKNOWN = 0.5
"""What counts where the model has no valid answer."""


def weights(scatter: FloatArray) -> FloatArray:
    """Probabilities (s, k) of the scales of the ladder for each standard deviation of the log scale (s,)."""
    step = LOG_SCALES[1] - LOG_SCALES[0]
    edges = np.concatenate([[-np.inf], LOG_SCALES[:-1] + step / 2, [np.inf]])
    return np.asarray(np.diff(norm.cdf(edges / scatter[:, None]), axis=1))


def probabilities(fell: FloatArray) -> FloatArray:
    """Chance of overturning (points, runs, scatters) from the outcome of every scale (points, runs, scales)."""
    return np.asarray(ODD + (1.0 - 2.0 * ODD) * (fell @ weights(SCATTERS).T))


def _thinned(shaking: Shaking) -> Shaking:
    size = np.array([stride(shaking.time_step)])

    def mean(values: FloatArray) -> FloatArray:
        return np.asarray(averaged(values[None, None], size)[0, 0])

    vertical = None if shaking.vertical is None else mean(shaking.vertical)
    step = shaking.time_step * int(size[0])
    return replace(shaking, time_step=step, horizontal=mean(shaking.horizontal), vertical=vertical)


@dataclass(frozen=True)
class Ladder:
    """The runs of one table, simulated for any values of the specimen's parameters."""

    model: Model
    specimen: Specimen
    shakings: Sequence[Shaking]
    fixed: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, model: Model, specimen: Specimen, motions: Sequence[Motion]) -> Ladder:
        """The motions as means over about 10 ms: overturning does not feel what is faster."""
        acts = vertical_acts(specimen, model, ())
        shakings = [_thinned(motion.shaking(vertical_acts=acts)) for motion in motions]
        return cls(model, specimen, shakings, fixed_values(after_the_last(specimen)))

    def fell(self, points: Sequence[Mapping[str, float]], progress: Progress = silent) -> FloatArray:
        """Whether each point's specimen overturns (points, runs, scales): 1, 0, or `UNKNOWN`.

        Runs are simulated side by side in threads; the kernels do not hold the interpreter.
        """
        sets = [{**self.fixed, **point} for point in points]
        together = [instruments_of(values) for values in sets]
        alike = all(one == together[0] for one in together)
        found = np.empty((len(sets), len(self.shakings), LOG_SCALES.size))

        def run(k: int) -> None:
            if alike:
                found[:, k] = self._of_run(sets, moved(self.shakings[k], together[0]))
                return
            for j, values in enumerate(sets):
                found[j, k] = self._of_run([values], moved(self.shakings[k], together[j]))[0]

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            waiting = [pool.submit(run, k) for k in range(len(self.shakings))]
            try:
                for done, one in enumerate(waiting):
                    one.result()
                    progress("", (done + 1) / len(waiting))
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        return found

    def _of_run(self, sets: Sequence[Mapping[str, float]], shaking: Shaking) -> FloatArray:
        """One run: (points, scales)."""
        walls = [without_instruments(values) for values in sets]
        values = {name: np.repeat([wall[name] for wall in walls], LOG_SCALES.size) for name in walls[0]}
        scale = np.tile(np.exp(LOG_SCALES), len(sets))
        flags = self.model.evaluate(
            values, shaking, scale, outputs=("overturned",), tail=TAIL, options=self.specimen.options
        )["overturned"]
        fell = np.where(flags == MISSING, UNKNOWN, flags.astype(np.float64))
        return np.asarray(fell.reshape(len(sets), LOG_SCALES.size))
