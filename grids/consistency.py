"""Whether the names given in a plan or specimen describe one wall: nothing missing, nothing twice."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TypeVar

from models.base import Mechanism
from models.errors import InputError
from models.model import Model

ValueT = TypeVar("ValueT")


def check_names(model: Model, given: Collection[str], mechanisms: Mapping[str, Mechanism]) -> None:
    """Raise InputError unless ``given`` (values and axes together) holds each thing exactly once.

    ``mechanisms``: those addressed in ``given``, by name.
    """
    names = set(given)
    in_groups: set[str] = set()
    for group in model.alternatives:
        members = {name for choice in group for name in choice}
        in_groups |= members
        present = members & names
        if any(present == set(choice) for choice in group):
            continue
        choices = "; or ".join(" and ".join(choice) if choice else "none of them" for choice in group)
        if any(set(choice) < present for choice in group):
            raise InputError(f"{_listed(sorted(present))} are alternatives, all given; give exactly one of: {choices}.")
        held = f"only {_listed(sorted(present))} given" if present else "none is given"
        raise InputError(
            f"model '{model.name}' needs one of these alternatives, {held}; give exactly one of: {choices}."
        )
    for parameter in model.parameters:
        if parameter.default is None and parameter.name not in in_groups and parameter.name not in names:
            raise InputError(
                f"{parameter.name} ({parameter.meaning}, {parameter.unit}) is missing; "
                f"give it in [parameters], it has no default."
            )
    for mechanism in mechanisms.values():
        _check_mechanism(mechanism, names)


def _check_mechanism(mechanism: Mechanism, names: set[str]) -> None:
    if mechanism.name in names:
        handle = next(n for n in sorted(names) if n.startswith(f"{mechanism.name}."))
        raise InputError(
            f"'{mechanism.name}' and '{handle}' are two handles for the same physics; give the one or the other."
        )
    effects = [p.name for p in mechanism.parameters if not p.shape]
    handles = {f"{mechanism.name}.{effect}{joint}" for effect in effects for joint in ("", "_base", "_top")}
    if effects and not handles & names:
        shape = next(n for n in sorted(names) if n.startswith(f"{mechanism.name}."))
        raise InputError(
            f"'{shape}' only shapes the effect of mechanism '{mechanism.name}', which is off; "
            f"give {_listed([f'{mechanism.name}.{effect}' for effect in effects], 'or')} too."
        )
    for parameter in mechanism.parameters:
        name = f"{mechanism.name}.{parameter.name}"
        if parameter.required and not {name, f"{name}_base", f"{name}_top"} & names:
            raise InputError(
                f"'{name}' ({parameter.meaning}, {parameter.unit}) is missing: it decides what the mechanism does and "
                "has no natural default; give it too."
            )


def replaced(model: Model, base: Mapping[str, ValueT], overrides: Collection[str]) -> dict[str, ValueT]:
    """``base`` without what ``overrides`` replaces: the same names, and alternatives left behind.

    With width and height in ``base``, an override of aspect_ratio drops the width.
    """
    kept = {name: value for name, value in base.items() if name not in overrides}
    for group in model.alternatives:
        members = {name for choice in group for name in choice}
        new = members & set(overrides)
        if not new:
            continue
        fitting = [set(choice) for choice in group if new <= set(choice) <= new | kept.keys()]
        if len(fitting) == 1:
            kept = {name: value for name, value in kept.items() if name not in members - fitting[0]}
    return kept


def _listed(names: Iterable[str], word: str = "and") -> str:
    *head, last = (f"'{name}'" for name in names)
    return f"{', '.join(head)} {word} {last}" if head else last


def check_joints(model: Model, options: Mapping[str, str], varied: Collection[str], given: Collection[str]) -> None:
    """Raise InputError for what is ``given`` for a joint without rubber, or for a law that the joint does not have.

    Where joints or a law are an axis (``varied``) it belongs to the cells that use it.
    """
    if "joints" not in model.options:
        return
    given = [*given, *(name for name, word in options.items() if word != model.options[name][0])]
    for joint, other in (("base", "top"), ("top", "base")):
        own = sorted(name for name in given if _of_joint(model, name, joint, other))
        if own and options.get("joints") == other and "joints" not in varied:
            raise InputError(
                f"{own[0]} is given, but joints = '{other}' leaves no rubber at the {joint}: leave it out, or set "
                "joints = 'both' in [options]."
            )
        if any(name.endswith("rubber_law") for name in varied):
            continue
        law = options.get(f"{joint}_rubber_law", "same")
        law = options.get("rubber_law", "as_given") if law == "same" else law
        for name in own:
            kind = _kind(name)
            if law != "as_given" and kind not in (None, law):
                raise InputError(
                    f"{name} is given, but the law of the {joint} layer is {law}: leave it out, or set "
                    f"{joint}_rubber_law = '{kind}' in [options]."
                )


def _of_joint(model: Model, name: str, joint: str, other: str) -> bool:
    """Whether a parameter, an option or a handle of a mechanism addresses the layer of ``joint`` alone."""
    mechanism, dot, parameter = name.partition(".")
    if not dot:
        twin = name.replace(f"{joint}_", f"{other}_", 1)  # the block on top has sizes that begin with top, too
        return name.startswith(f"{joint}_") and (twin in model.options or any(p.name == twin for p in model.parameters))
    found = model.mechanisms.get(mechanism)
    return found is not None and model.name in found.at_joints and parameter.endswith(f"_{joint}")


def _kind(name: str) -> str | None:
    """The rubber law whose number it is, if it is one's."""
    from models.rubber import ELEMENTS

    law = ELEMENTS.get(name.partition(".")[0])
    return None if law is None else law.kind


def check_laws(options: Mapping[str, str], varied: Collection[str], mechanisms: Collection[str]) -> None:
    """Raise InputError for the parameters of a rubber law that ``options`` leave unused everywhere.

    Where a law is an axis (``varied``) its parameters belong to the cells that use it.
    """
    from models.rubber import ELEMENTS

    joints = {options.get(f"{joint}_rubber_law", "same") for joint in ("base", "top")}
    overall = options.get("rubber_law", "as_given")
    if overall == "as_given" and joints != {"same"}:
        overall = "linear"  # a law named for one joint alone leaves the other linear
    used = {overall if word == "same" else word for word in joints}
    if "as_given" in used or any(name.endswith("rubber_law") for name in varied):
        return
    for name, law in ELEMENTS.items():
        if name in mechanisms and law.kind not in used:
            raise InputError(
                f"parameters of the rubber law {name} are given, but the law in use is {_listed(sorted(used))}; "
                f"leave them out, or choose rubber_law = '{law.kind}'."
            )
