"""The laws of the family in compiled kernels: any of them on one fibre, each in a pass of its own.

Each law goes over all fibres and lanes by itself behind a flag of the call, so that a law that does not act costs
nothing and one compiled kernel holds every combination. A flat table holds the hidden states, in rows of one number for
each fibre and lane, and the laws' numbers, in rows of one for each lane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from models.base import FloatArray
from models.lanes.compiler import inlined
from models.rubber import ELEMENTS
from models.rubber.base import Numbers, RubberLaw
from models.rubber.layer import Hidden

Table = Any
Given = Sequence[tuple[RubberLaw, Numbers]]

ORDER = tuple(law for role in ("shifts", "adds", "softens") for law in ELEMENTS.values() if law.role == role)
HIDDEN_ROW = {law.name: row for row, law in enumerate(law for law in ORDER if law.hidden)}
N_HIDDEN = len(HIDDEN_ROW)
_ENDS = np.cumsum([0, *(len(law.wanted) for law in ORDER)]).tolist()
NUMBER_ROWS = {law.name: range(_ENDS[k], _ENDS[k + 1]) for k, law in enumerate(ORDER)}
N_NUMBERS = _ENDS[-1]


def acting(laws: Given) -> int:
    """Which laws act, as a sum of bits: 2^k for the k-th of `ORDER`."""
    names = {law.name for law, _ in laws}
    return sum(1 << k for k, law in enumerate(ORDER) if law.name in names)


def number_table(laws: Given, step: FloatArray) -> FloatArray:
    """The numbers (n, `N_NUMBERS`) of n layers for steps of ``step`` (n,) seconds; absent laws at their null."""
    table = np.zeros((step.size, N_NUMBERS))
    if not laws:
        return table
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


def passing(law: RubberLaw, places: Places, first: int) -> tuple[Step, Step]:
    """One law's pass over a fibre: compiled ``numbers(t, i)``, what the law wants of lane i; and ``go_on(t, j, k,
    numbers)``, which takes fibre j with the spring k over the coming step.

    What the laws before have left and what this one leaves, `Going`, stands in four rows of the table ``t`` from
    ``first`` on, each as long as one of hidden states.
    """
    join = _JOINS[law.role](_updating(law, places))
    second, third, fourth = (first + row * places.columns for row in (1, 2, 3))

    @inlined
    def go_on(t: Table, j: int, k: float, n: Any) -> None:
        t[first + j], t[second + j], t[third + j], t[fourth + j] = join(
            t, j, t[first + j], t[second + j], t[third + j], t[fourth + j], k, n
        )

    return _numbers_at(list(NUMBER_ROWS[law.name]), places), go_on


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


def _shifting(update: Step) -> Step:
    @inlined
    def shifted(t: Table, j: int, u: float, change: float, more: float, slope: float, k: float, n: Any) -> Going:
        was, shift, _ = update(t, j, u, change, n)
        return u - shift, change - (shift - was), more - k * shift, slope

    return shifted


def _adding(update: Step) -> Step:
    @inlined
    def added(t: Table, j: int, u: float, change: float, more: float, slope: float, k: float, n: Any) -> Going:
        _, stress, steeper = update(t, j, u, change, n)
        return u, change, more + stress, slope + steeper

    return added


def _softening(update: Step) -> Step:
    @inlined
    def softened(t: Table, j: int, u: float, change: float, more: float, slope: float, k: float, n: Any) -> Going:
        _, lost, _ = update(t, j, u, change, n)
        return u, change, more - lost * (k * u + more), slope - lost * (k + slope)

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
