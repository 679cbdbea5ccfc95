"""What the library says of a mechanism, in words for the report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from models.base import Mechanism

OTHER_BASES = {
    "second_body": "a second body moves: the two-body model explains the recordings, the single block does not",
    "compliant_base": "the base is compliant: the model on an elastic layer explains the recordings",
}


@dataclass(frozen=True)
class Suspect:
    """A mechanism or another base model: equation, where its residual lives, meanings of parameters."""

    name: str
    sentence: str
    equation: str = ""
    signature: str = ""
    source: str = ""
    meanings: Mapping[str, str] = field(default_factory=dict)
    mechanism: Mechanism | None = None

    def says(self, estimates: Mapping[str, float]) -> str:
        """The library's sentence with the estimates in place; shapes that were not fitted at their default.

        The equation where there is nothing to put in place.
        """
        given = {name.rpartition(".")[2]: value for name, value in estimates.items()}
        if not given:
            return self.equation or self.sentence
        if self.mechanism is None:
            return self.sentence
        return self.mechanism.sentence_for(given).format_map({**self.mechanism.nulls, **given})


def suspect_of(name: str, model: str) -> Suspect:
    """The entry of the library as it acts on ``model``, or of another base model, by name."""
    import models
    from grids.instruments import INSTRUMENTS

    found: Mechanism | None = {**models.get(model).mechanisms, **INSTRUMENTS}.get(name)
    if found is None:
        return Suspect(name, OTHER_BASES.get(name, name.replace("_", " ")))
    meanings = {p.name: p.meaning for p in found.parameters}
    return Suspect(name, found.sentence, found.equation, found.signature, found.source, meanings, found)
