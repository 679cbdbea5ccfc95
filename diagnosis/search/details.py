"""What a law of the joints may leave: nobody states the law of a layer exactly.

A layer's law is an idealisation, and programs that state the same one differ in its details (what a relaxing arm does
while its edge is lifted). Where such a law moves the specimen by many times the noise, these details are beyond the
noise too, and another law of the same layer, or a force that is not the same everywhere, makes them up. Evidence goes
with the square of a force, so what brings less than `OF_LAW` of a law's own evidence is less than a tenth of its force.

Only where the explanation is adequate: what leaves more than the noise in all windows leaves no details. And effects
of other kinds (sensors, a lean, a mass off its centre) are none: they are named from the ordinary threshold on
(`Search.more`).
"""

from __future__ import annotations

from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search, adequate, adjusted
from diagnosis.search.refit import QUICK, Explanation, without

OF_LAW = 0.01
"""Share of the evidence of a law of the joints: a tenth of its force."""


def least(found: Search, before: Explanation, new: Candidate | None = None) -> float:
    """What a ``new`` effect must bring beside those of ``before``; None: what a departure from constancy must bring."""
    if (new is not None and not of_joints(new, before)) or not adequate(before):
        return found.more
    return max(found.more, MISSING + OF_LAW * _of_strongest_law(found, before))


def of_joints(candidate: Candidate, explanation: Explanation) -> bool:
    """Whether a mechanism is a law of the joints of the model."""
    return explanation.measured.model.name in candidate.mechanism.at_joints


def _of_strongest_law(found: Search, explanation: Explanation) -> float:
    """Evidence of the strongest law of the joints; 0 where there is none."""
    laws = [c for c in explanation.candidates if of_joints(c, explanation)]
    if len(explanation.candidates) == 1:
        return found.gain(explanation) if laws else 0.0
    if found.strongest_law is None or found.strongest_law[0] is not explanation:
        rests = (without(explanation, law, QUICK) for law in laws)
        strongest = max((adjusted(rest) - adjusted(explanation) for rest in rests), default=0.0)
        found.strongest_law = explanation, strongest
    return found.strongest_law[1]
