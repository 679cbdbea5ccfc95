"""How walls move: models, the mechanisms they leave out, and their integrators."""

from __future__ import annotations

from typing import TYPE_CHECKING

from models.errors import InputError, nearest

if TYPE_CHECKING:
    from models.model import Model

MODELS = ("housner", "stacked", "interface", "interface_linear", "isolated")
"""The models, from the simplest to the richest; each is a folder with a `model.MODEL`."""


def get(name: str) -> Model:
    """The model of that name, imported when it is asked for; raises InputError for one that is not known."""
    match name:
        case "housner":
            from models.housner.model import MODEL as housner

            return housner
        case "stacked":
            from models.stacked.model import MODEL as stacked

            return stacked
        case "interface":
            from models.interface.model import MODEL as interface

            return interface
        case "interface_linear":
            from models.interface_linear.model import MODEL as interface_linear

            return interface_linear
        case "isolated":
            from models.isolated.model import MODEL as isolated

            return isolated
    raise InputError(f"model '{name}' is not known; {nearest(name, MODELS)}")
