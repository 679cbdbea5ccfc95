"""A law in a table, as a model declares the one that it can hold: what its tables run over, and what they are times of.

A table has `KNOTS` values from zero to its reach on either side of zero, linear between them and constant beyond.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

SIDES = ("below", "above")
KNOTS = 6
"""Rows on either side of zero, from zero to the reach."""
Along = Literal["coordinate", "rate", "base"]
"""Of a motion: its coordinate, its rate, or the acceleration of the base."""


@dataclass(frozen=True)
class Variable:
    """What tables run over; ``reach``: the parameter that says how far, in ``unit``; ``meaning``: of its last rows."""

    along: Along
    reach: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Term:
    """One table: over ``variable``, at the ``port`` of the model; its values, in ``unit``, are times ``factor``.

    ``factor``: the rate of the port's coordinate, its sign (``direction``), the rate while the coordinate grows away
    from zero and 0 while it comes back (``outward``), or nothing. ``event``: it acts at the events of the model and not
    between them.
    """

    variable: str
    meaning: str
    unit: str
    port: str
    factor: Literal["", "rate", "direction", "outward"] = ""
    event: bool = False


@dataclass(frozen=True)
class Tables:
    """The terms of a law by name, and the variables.

    ``units``: by port, from the coefficients of a wall, the couple or force that a value of one is, as the port of the
    diagnosis takes it (`models.identification.Port`); ``jumps``: variables of tables that may jump at zero;
    ``oscillator``: the parameters of an oscillator beside the tables (motion, force, frequency and damping as in
    `models.oscillator`), where the model has one.
    """

    terms: Mapping[str, Term]
    variables: Mapping[str, Variable]
    units: Callable[[Any], Mapping[str, Any]]
    jumps: tuple[str, ...] = ()
    oscillator: tuple[str, ...] = ()

    def variable(self, term: str) -> Variable:
        """What the table of a term runs over."""
        return self.variables[self.terms[term].variable]

    @property
    def rows(self) -> tuple[tuple[str, str], ...]:
        """Parameter and term of every value, term by term, the values below zero first."""
        return tuple((row(term, side, knot), term) for term in self.terms for side in SIDES for knot in range(KNOTS))


def row(term: str, side: str, knot: int) -> str:
    """Name of the parameter that holds one value of a table."""
    return f"{term}_{side}_{knot}"
