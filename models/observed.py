"""Observables that are computed when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from models.base import FloatArray


class Observed(Mapping[str, FloatArray]):
    """Observables by name, each computed when it is asked for."""

    def __init__(self, forms: Mapping[str, Callable[[], FloatArray]]) -> None:
        self._forms = forms

    @classmethod
    def joined(cls, *parts: Mapping[str, FloatArray]) -> Observed:
        """Those of all parts, of the last one that has a name."""
        return cls({name: partial(part.__getitem__, name) for part in parts for name in part})

    def __getitem__(self, name: str) -> FloatArray:
        return self._forms[name]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._forms)

    def __len__(self) -> int:
        return len(self._forms)
