"""How walls move: models, the mechanisms they leave out, and their integrators."""

from __future__ import annotations

from importlib import import_module

from models.base import Model
from models.errors import InputError, nearest

MODELS = ("housner", "stacked", "interface", "interface_linear", "isolated")
"""The models, from the simplest to the richest; each is a folder with a `model.MODEL`."""


def get(name: str) -> Model:
    """The model of that name."""
    if name not in MODELS:
        raise InputError(f"model '{name}' is not known; {nearest(name, MODELS)}")
    model: Model = import_module(f"models.{name}.model").MODEL
    return model
