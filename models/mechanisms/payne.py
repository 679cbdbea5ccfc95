"""The rubber is softer in large cycles than in small ones, and recovers at once."""

from __future__ import annotations

from functools import partial

from models.base import Mechanism, MechanismParameter
from models.rubber.base import with_law

MECHANISM = Mechanism(
    name="payne",
    effect_class="payne",
    parameters=(
        MechanismParameter("softening", "s_P", "1", "largest share of stiffness lost", 0.0, 0.7),
        MechanismParameter("strain", "eps_P", "1", "strain over which it is lost", 0.02, 2.0, null=0.5, shape=True),
    ),
    equation="s = k [1 - softening (1 - exp(-A/(strain e)))] u + c u', A = |u| at the last reversal, or |u| if larger",
    signature="with the amplitude of the cycle; small cycles after large ones are stiff again",
    sentence="the rubber loses up to {softening:.1%} of its stiffness in large cycles, over a strain of {strain:.2f}",
    acts={"isolated": partial(with_law, name="payne")},
    static_test="cycle the rubber slowly to a small strain, to a large one and to the small one again",
    source="Payne (J. Appl. Polym. Sci. 6, 1962); A is a form of this project: models/isolated/bearing.py",
)
