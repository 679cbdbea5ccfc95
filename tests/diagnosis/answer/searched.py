"""Searches whose answers are put together again: a test of what comes after a search need not repeat it."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module

import pytest

from diagnosis import diagnose
from diagnosis.answer.assembly import assemble
from diagnosis.answer.result import Diagnosis
from diagnosis.answer.statement import statement
from diagnosis.answer.task import Task
from diagnosis.fit.unknowns import library
from diagnosis.progress import Stages
from diagnosis.search.budget import SEARCH, Budget
from diagnosis.search.found import Search
from diagnosis.search.ladder import Climbed
from models.base import Mechanism
from models.model import Model
from tests.diagnosis.made import SPECIMEN, recording

FEW = (
    "restitution", "velocity_restitution", "degradation", "viscous_damping", "pivot_inset", "tilt", "offset", "gain",
    "delay",
)  # fmt: skip
"""Mechanisms that may be missing here: the whole library takes three times as long."""
LONG_AGO = -1e9
"""s, the beginning of a budget of which nothing is left."""


@dataclass(frozen=True)
class Searched:
    """An answer, and what it was put together from."""

    answer: Diagnosis
    task: Task
    found: Search
    climbed: Climbed | None

    def judged_again(self) -> Diagnosis:
        """The answer judged and put together anew, with no work left for further laws in a table."""
        task = replace(self.task, stages=Stages())
        found = replace(self.found, whole=Budget(SEARCH, LONG_AGO), not_tried=dict(self.found.not_tried))
        answer = assemble(task, found, self.climbed)
        return replace(answer, statement=statement(answer, found.measured.model))


@contextmanager
def among(names: Collection[str]) -> Iterator[pytest.MonkeyPatch]:
    """Searches in which only mechanisms of these names may be missing."""

    def some(model: Model) -> dict[str, Mechanism]:
        return {name: one for name, one in library(model).items() if name in names}

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(import_module("diagnosis.search.candidates"), "library", some)
        yield patch


@cache
def searched(factor_on_housner: float | None = None) -> Searched:
    """Two recordings of a block, whose impacts keep that share of Housner's restitution, and one that is held out."""
    effect = None if factor_on_housner is None else {"restitution": {"factor_on_housner": factor_on_housner}}
    training = [recording("train_1", 1, effect), recording("train_2", 2, effect)]
    given: list[tuple[Task, Search, Climbed | None]] = []

    def assembled(task: Task, found: Search, climbed: Climbed | None) -> Diagnosis:
        given.append((task, found, climbed))
        return assemble(task, found, climbed)

    with among(FEW) as patch:
        patch.setattr(import_module("diagnosis.answer.diagnose"), "assemble", assembled)
        answer = diagnose(SPECIMEN, training, [recording("test_1", 3, effect)])
    return Searched(answer, *given[0])
