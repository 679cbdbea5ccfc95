"""Stand-ins for explanations and their effects: only their losses, window by window, decide."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.search import beside, details, exchange, select, weighing
from diagnosis.search import found as counting
from diagnosis.search.found import Search


@dataclass(frozen=True)
class Effect:
    """Stands for a candidate: all of them are laws of the joints unless they say otherwise."""

    name: str
    order: int = 0
    of_joints: bool = True
    unknowns: tuple[int, ...] = (1,)
    held: tuple[str, ...] = ()
    price: float = 0.0
    spell: None = None

    @property
    def mechanism(self) -> Any:
        return SimpleNamespace(beside="")

    @property
    def effect_class(self) -> str:
        return self.name


@dataclass(frozen=True)
class Explained:
    """Stands for an explanation."""

    candidates: tuple[Effect, ...]
    fitted: Any
    in_spell = False
    measured: Any = field(default_factory=lambda: SimpleNamespace(recording_of=np.zeros(2, int), stretches=object()))

    @property
    def loss(self) -> float:
        return float(self.fitted.loss)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(c.name for c in self.candidates)

    @property
    def classes(self) -> tuple[str, ...]:
        return self.names

    @property
    def removable(self) -> tuple[Effect, ...]:
        return self.candidates

    def part(self, candidate: Effect) -> Any:
        assert candidate in self.candidates
        return "as fitted"


def fit(*candidates: Effect, loss: float, first: float | None = None) -> Any:
    """An explanation of two windows; ``first``: the loss of the first of them, by default half of it."""
    first = 0.5 * loss if first is None else first
    return Explained(candidates, SimpleNamespace(window_losses=np.array([first, loss - first]), loss=loss))


NOTHING: Any = SimpleNamespace(loss=0.0, base=None)
A, B, C = (Effect(name) for name in ("maxwell", "hardening", "bouc_wen"))
TILT = Effect("tilt", of_joints=False)


def nothing_is_fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is fitted: refits leave what they are given."""

    def same(one: Any, *_: Any) -> Any:
        return one

    for module in (select, exchange):
        for name in ("again", "reshaped", "over_ranges"):
            monkeypatch.setattr(module, name, same)
        monkeypatch.setattr(module, "seconds", lambda *_: [])
    monkeypatch.setattr(weighing, "estimate", lambda f, *_: SimpleNamespace(loss=f.loss, base=None))
    monkeypatch.setattr(weighing, "fit_under", lambda f, errors: (f, errors))
    monkeypatch.setattr(weighing, "refitted", lambda f, *_: (f, SimpleNamespace(loss=f.loss, base=None)))
    monkeypatch.setattr(weighing, "reweighed", same)
    monkeypatch.setattr(weighing, "from_states_of", same)
    monkeypatch.setattr(exchange, "extended", lambda *_, **__: [])
    monkeypatch.setattr(exchange, "in_the_place_of_each", lambda *_: [])
    monkeypatch.setattr(exchange, "astray", lambda _: False)
    monkeypatch.setattr(select, "in_the_place_of_shapes", lambda *_: [])
    monkeypatch.setattr(select, "without_idle_shapes", lambda single, _: single)
    monkeypatch.setattr(details, "of_joints", lambda c, _: c.of_joints)
    for module in (beside, counting):
        monkeypatch.setattr(module, "explains_all", lambda _: False)
    for module in (select, details, counting):
        monkeypatch.setattr(module, "adequate", lambda _: True)
    for module in (counting, weighing):
        monkeypatch.setattr(module, "errs", lambda _: False)
    monkeypatch.setattr(counting, "settles", lambda *_: False)


def search(base: Any, *tried: Any) -> Any:
    made: Any = base
    some: Any = list(tried)
    return Search(made, (), NOTHING, singles=list(some), tried=some, at_null=None)
