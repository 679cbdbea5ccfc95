"""What the shape of a law may stand for: a gap before a spring, say, for a layer that hardens.

Beside the law with that shape the other mechanism has no score, for both do the same; and a fit does not find its way
from the one to the other. So others are also tried beside the law without the shape.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.unknowns import values_of
from diagnosis.search.beside import extended, seconds
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search
from diagnosis.search.refit import Explanation, again, extend, further, without
from diagnosis.search.weighing import CLOSE

IDLE = 0.01
"""Share of its range within which a shape stays at its null: a law does without it."""


def in_the_place_of_shapes(found: Search, single: Explanation) -> list[Explanation]:
    """Pairs of the law of a single without the shape that it can do without, and another mechanism.

    Of these fits those that come near the single, with the shape free again. None where the law has no such shape, or
    gains little by it.
    """
    (law,) = single.candidates
    plain = _without_shapes(law)
    if plain is None or single.measured.stretches is not None or not found.affordable(f"others beside {law.name}"):
        return []
    simpler = _in_its_place(single, plain)
    if simpler.loss - single.loss < MISSING:
        return []
    pairs = extended(found, simpler, seconds(found, simpler), most=single.loss + CLOSE)
    return [_with_shapes(single, pair) for pair in pairs if pair.loss < single.loss + CLOSE]


def without_idle_shapes(single: Explanation, pair: Explanation) -> Explanation:
    """The single without the shapes of its law that the law can do without and, in a pair with it, does without.

    The same single where there are none. What the other effect of the pair brings is in the place of these shapes, and
    is what it brings over the law without them.
    """
    (law,) = single.candidates
    plain = _without_shapes(law) if law in pair.candidates else None
    if plain is None:
        return single
    shapes = [k for k, x in enumerate(law.unknowns) if x not in plain.unknowns]
    idle = [IDLE * np.ptp(law.unknowns[k].bounds) for k in shapes]
    there, alone = (np.abs(one.part(law)[shapes] - law.null[shapes]) for one in (pair, single))
    return _in_its_place(single, plain) if np.all(there <= idle) and np.any(alone > idle) else single


def _in_its_place(single: Explanation, plain: Candidate) -> Explanation:
    """The fit of the law of a single without its shapes, from where that stands."""
    (law,) = single.candidates
    start = single.part(law)[[law.unknowns.index(x) for x in plain.unknowns]]
    return further(extend(without(single, law, 0), plain, start))


def _without_shapes(law: Candidate) -> Candidate | None:
    """The law with the shapes held at a null that is an end of their range; None where it has none."""
    null = law.null
    spare = [k for k, x in enumerate(law.unknowns) if k and null[k] in x.bounds]
    if not spare:
        return None
    held = values_of([law.unknowns[k] for k in spare], null[spare])
    kept = tuple(x for k, x in enumerate(law.unknowns) if k not in spare)
    return replace(law, unknowns=kept, held={**law.held, **held})


def _with_shapes(single: Explanation, pair: Explanation) -> Explanation:
    """The pair with the law of the single as it is there, fitted again from where the pair stands."""
    other = pair.candidates[-1]
    grown = extend(single, other, pair.part(other), 0)
    f, (law,) = grown.fitted, single.candidates
    known = {x.name: c for x, c in zip(pair.fitted.misfit.unknowns, pair.fitted.u, strict=True)}
    known = {**dict(zip((x.name for x in law.unknowns), law.null, strict=True)), **known}
    u = np.array([known[x.name] for x in f.misfit.unknowns])
    return again(replace(grown, fitted=replace(f, u=u, states=pair.fitted.states)))
