"""What there is: models and mechanisms by name, printed as a table."""

from __future__ import annotations

from typing import TypeVar

from models.base import Mechanism
from models.model import Model

Entry = TypeVar("Entry", Model, Mechanism)


class Catalogue(dict[str, Entry]):
    """Entries by name; it prints one line for each."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {_about(entry)}" for name, entry in self.items())


def models() -> Catalogue[Model]:
    """The models by name."""
    import models as room

    return Catalogue({name: room.get(name) for name in room.MODELS})


def mechanisms() -> Catalogue[Mechanism]:
    """The mechanisms by name: what a base model leaves out. A further form of one is ``name (its models)``."""
    from models.mechanisms import MECHANISMS

    found: Catalogue[Mechanism] = Catalogue()
    for mechanism in MECHANISMS:
        name = mechanism.name
        found[name if name not in found else f"{name} ({', '.join(mechanism.acts)})"] = mechanism
    return found


def _about(entry: Model | Mechanism) -> str:
    if isinstance(entry, Mechanism):
        parameters = ", ".join(f"{p.name} [{p.unit}]" for p in entry.parameters)
        return f"{entry.effect_class}: {parameters}; acts on {', '.join(entry.acts)}"
    return entry.title
