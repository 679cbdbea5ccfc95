"""The laws of the family in compiled kernels: one fibre's response, composed from the laws' own updates.

There is a variant for each law alone, all of it in registers, and one for any combination, where each law goes over
all fibres and lanes by itself behind a flag of the call, so that a law that does not act costs nothing; a kernel is
compiled with the one that it is asked for. A flat table holds the hidden states, in rows of one number for each fibre
and lane, and the laws' numbers, in rows of one for each lane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from inspect import signature
from typing import Any, NamedTuple

import numpy as np

from models.base import FloatArray
from models.lanes.compiler import in_kernels, inlined
from models.rubber import LAWS
from models.rubber.base import Numbers, RubberLaw
from models.rubber.layer import Hidden

Table = Any
Given = Sequence[tuple[RubberLaw, Numbers]]

ORDER = tuple(law for role in ("shifts", "adds", "softens") for law in LAWS.values() if law.role == role)
VARIANTS = ((), *((law,) for law in ORDER), ORDER)
"""The laws that a kernel can be compiled for, by the number of the variant."""
HIDDEN_ROW = {law.name: row for row, law in enumerate(law for law in ORDER if law.hidden)}
N_HIDDEN = len(HIDDEN_ROW)
_ENDS = np.cumsum([0, *(len(law.wanted) for law in ORDER)]).tolist()
NUMBER_ROWS = {law.name: range(_ENDS[k], _ENDS[k + 1]) for k, law in enumerate(ORDER)}
N_NUMBERS = _ENDS[-1]


def variant_for(laws: Given) -> tuple[int, ...]:
    """A tuple as long as the number of the smallest variant that holds ``laws``: the compiler knows its length.

    Its items are a sum of bits, 2^k for the k-th law of the variant, that says which of them act.
    """
    wanted = {law.name for law, _ in laws}
    fitting = [k for k, held in enumerate(VARIANTS) if wanted <= {law.name for law in held}]
    number = min(fitting, key=lambda k: len(VARIANTS[k]))
    return (sum(1 << k for k, law in enumerate(VARIANTS[number]) if law.name in wanted),) * number


def number_table(laws: Given, step: FloatArray) -> FloatArray:
    """The numbers (n, `N_NUMBERS`) of n layers for steps of ``step`` (n,) seconds; absent laws at their null."""
    table = np.zeros((step.size, N_NUMBERS))
    if not laws:
        return table  # of which the variant without laws reads nothing
    one = {"stiffness": np.ones(1), "thickness": np.ones(1)}
    given = {law.name: p for law, p in laws}
    for law in ORDER:
        found = law.numbers(given.get(law.name, {**one, **law.nulls}), step)
        for row, name in zip(NUMBER_ROWS[law.name], law.wanted, strict=True):
            table[:, row] = found[name]
    return table


def hidden_table(laws: Given, hidden: Hidden) -> FloatArray:
    """Hidden states by law, arrays (n, ...), as the kernel's rows (n, `N_HIDDEN`, ...)."""
    shape = hidden[0].shape
    table = np.zeros((shape[0], N_HIDDEN, *shape[1:]))
    for (law, _), h in zip(laws, hidden, strict=True):
        if law.hidden:
            table[:, HIDDEN_ROW[law.name]] = h
    return table


def hidden_states(laws: Given, table: FloatArray) -> list[FloatArray]:
    """The hidden states by law from the rows that `hidden_table` writes."""
    return [table[:, HIDDEN_ROW[law.name]] if law.hidden else np.zeros_like(table[:, 0]) for law, _ in laws]


class Places(NamedTuple):
    """Where the flat table holds the hidden states and the numbers: first place and length of a row."""

    hidden: int
    columns: int
    numbers: int
    lanes: int


Step = Callable[..., Any]
Going = tuple[float, float, float, float]
"""What passes from law to law: u and its growth as shifts have left them, stress beyond k u and slope so far."""


def responding(laws: Sequence[RubberLaw], places: Places) -> tuple[Step, Step]:
    """Compiled ``numbers(t, i)``: what the laws want of lane i, read once for many of its fibres; and
    ``respond(t, j, u, change, k, numbers)``: stress beyond k u and its slope, without dashpot, of fibre j.

    ``u`` is the compression at the end of a step over which it has grown by ``change`` (m), k the spring. The
    hidden states in the table ``t`` go on by the step.
    """
    numbers, found = _none, _untouched
    for place, law in enumerate(laws):
        numbers = _with(numbers, _numbers_at(list(NUMBER_ROWS[law.name]), places))
        found = _JOINS[law.role](found, _updating(law, places), place == 0)

    @inlined
    def respond(t: Table, j: int, u: float, change: float, k: float, n: Any) -> tuple[float, float]:
        _, _, more, slope = found(t, j, u, change, k, n)
        return more, slope

    return numbers, respond


def passing(law: RubberLaw, places: Places, first: int) -> tuple[Step, Step]:
    """Compiled ``numbers(t, i)``, as of `responding`, and ``go_on(t, j, u, k, numbers)``: one law's pass over fibre j.

    It reads and writes `Going` in four rows of the table ``t`` from ``first`` on, each as long as one of hidden states.
    """

    second, third, fourth = (first + row * places.columns for row in (1, 2, 3))

    @inlined
    def held(t: Table, j: int, u: float, change: float, k: float, n: Any) -> Going:
        return t[first + j], t[second + j], t[third + j], t[fourth + j]

    found = _JOINS[law.role](held, _updating(law, places), False)

    @inlined
    def go_on(t: Table, j: int, u: float, k: float, n: Any) -> None:
        t[first + j], t[second + j], t[third + j], t[fourth + j] = found(t, j, u, 0.0, k, n)

    return _with(_none, _numbers_at(list(NUMBER_ROWS[law.name]), places)), go_on


def guarded(passes: Sequence[Step]) -> Step:
    """Compiled ``(t, acting)``: those of the ``passes``, compiled ``(t)``, whose bits of ``acting`` are set."""

    @inlined
    def nothing(t: Table, acting: int) -> None:
        return

    found: Step = nothing
    for k, own in enumerate(passes):
        found = _then(found, own, 1 << k)
    return found


def _then(before: Step, own: Step, bit: int) -> Step:
    @inlined
    def both(t: Table, acting: int) -> None:
        before(t, acting)
        if acting & bit:
            own(t)

    return both


@inlined
def _none(t: Table, i: int) -> Any:
    return ()


@inlined
def _untouched(t: Table, j: int, u: float, change: float, k: float, n: Any) -> Going:
    return u, change, 0.0, 0.0


def _with(before: Step, own: Step) -> Step:
    @inlined
    def both(t: Table, i: int) -> Any:
        return before(t, i), own(t, i)

    return both


def _shifting(before: Step, update: Step, first: bool) -> Step:
    @inlined
    def shifted(t: Table, j: int, u: float, change: float, k: float, n: Any) -> Going:
        left, grown, more, slope = before(t, j, u, change, k, n[0])
        was, shift, _ = update(t, j, left, grown, n[1])
        return left - shift, grown - (shift - was), -k * shift if first else more - k * shift, slope

    return shifted


def _adding(before: Step, update: Step, first: bool) -> Step:
    @inlined
    def added(t: Table, j: int, u: float, change: float, k: float, n: Any) -> Going:
        left, grown, more, slope = before(t, j, u, change, k, n[0])
        _, stress, steeper = update(t, j, left, grown, n[1])
        return left, grown, stress if first else more + stress, steeper if first else slope + steeper

    return added


def _softening(before: Step, update: Step, first: bool) -> Step:
    @inlined
    def softened(t: Table, j: int, u: float, change: float, k: float, n: Any) -> Going:
        left, grown, more, slope = before(t, j, u, change, k, n[0])
        _, lost, _ = update(t, j, left, grown, n[1])
        if first:
            steep = lost * k
            return left, grown, -steep * u, -steep
        return left, grown, more - lost * (k * u + more), slope - lost * (k + slope)

    return softened


_JOINS = {"shifts": _shifting, "adds": _adding, "softens": _softening}


def _updating(law: RubberLaw, places: Places) -> Step:
    """Compiled ``(t, j, u, change, numbers)``: one law's step, its hidden state in the table ``t``.

    Returns the hidden state as it was, effect and slope.
    """
    update = inlined(law.update)
    if not law.hidden:

        @inlined
        def plain(t: Table, j: int, u: float, change: float, n: Any) -> tuple[float, float, float]:
            _, effect, slope = update(u, change, 0.0, *n)
            return 0.0, effect, slope

        return plain
    at = places.hidden + HIDDEN_ROW[law.name] * places.columns

    @inlined
    def remembering(t: Table, j: int, u: float, change: float, n: Any) -> tuple[float, float, float]:
        was = t[at + j]
        t[at + j], effect, slope = update(u, change, was, *n)
        return was, effect, slope

    return remembering


def _numbers_at(rows: Sequence[int], places: Places) -> Step:
    """Compiled ``(t, i)``: the numbers of some rows for lane i, as a tuple."""
    before, at = (_numbers_at(rows[:-1], places) if len(rows) > 1 else None), places.numbers + rows[-1] * places.lanes
    if before is None:

        @inlined
        def only(t: Table, i: int) -> Any:
            return (t[at + i],)

        return only

    @inlined
    def more(t: Table, i: int) -> Any:
        return (*before(t, i), t[at + i])

    return more


def looks_back(laws: Sequence[RubberLaw]) -> bool:
    """Whether one of the laws wants to know how the compression has changed."""
    return any("change" in signature(law.update).parameters for law in laws)


def chosen(variants: Sequence[Callable[..., None]]) -> Callable[..., None]:
    """A function ``(t, which)`` for kernels: of ``variants``, compiled ``(t, which)``, the one `variant_for` names.

    Which one is known when the kernel that calls it is compiled, and only that one is.
    """

    def run(t: Table, which: Any) -> None:
        variants[len(which)](t, which)

    def variant(t: Any, which: Any) -> Callable[..., None]:
        one = variants[len(which)]
        return lambda t, which: one(t, which)

    return in_kernels(run, variant)
