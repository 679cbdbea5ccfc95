"""What a caller chooses by name, held against what a model declares."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Protocol

from models.errors import InputError, nearest


class Declared(Protocol):
    """The part of `models.base.Model` that is needed here, which nobody writes to."""

    @property
    def name(self) -> str: ...
    @property
    def options(self) -> Mapping[str, tuple[str, ...]]: ...
    @property
    def integrators(self) -> tuple[str, ...]: ...
    @property
    def states(self) -> tuple[str, ...]: ...


def resolve_options(model: Declared, options: Mapping[str, str] | None) -> dict[str, str]:
    """Every option of ``model`` with its word, the default where none is given."""
    chosen = {name: known[0] for name, known in model.options.items()}
    for name, word in (options or {}).items():
        if name not in chosen:
            raise InputError(f"{model.name} has no option '{name}'; {nearest(name, chosen)}")
        if word not in model.options[name]:
            raise InputError(f"{name} is '{word}'; {nearest(word, model.options[name])}")
        chosen[name] = word
    return chosen


def check_integrator(model: Declared, integrator: str) -> None:
    """Refuse an integrator that ``model`` does not have."""
    if integrator not in model.integrators:
        raise InputError(f"integrator is '{integrator}'; {nearest(integrator, model.integrators)}")


def check_states(model: Declared, names: Iterable[str]) -> None:
    """Refuse initial values of what is no state of ``model``."""
    for name in names:
        if name not in model.states:
            raise InputError(f"[initial] has no state '{name}'; {nearest(name, model.states)}")
