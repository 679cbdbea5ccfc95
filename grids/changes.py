"""What differs between the plan a study was started with and the plan it is given now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from grids.plan import Plan


@dataclass(frozen=True)
class Changes:
    """``differences``: sentences about what forbids to go on; ``added``: what merely adds cells."""

    differences: tuple[str, ...]
    added: tuple[str, ...]


def describe(plan: Plan) -> dict[str, Any]:
    """What decides the content of the plan's cells, for JSON (infinity and NaN as Python writes them).

    How the work is cut into blocks is no part of it.
    """
    import models

    return {
        "model": plan.model,
        "model_version": models.get(plan.model).version,
        "options": dict(plan.options),
        "fixed": dict(plan.fixed),
        "motions": {motion.name: motion.fingerprint for motion in plan.motions},
        "vertical": {motion.name: motion.vertical is not None for motion in plan.motions},
        "axes": {
            axis.name: {
                "unit": axis.unit,
                "points": {
                    str(label): {name: _plain(values[i]) for name, values in axis.sets.items()}
                    for i, label in enumerate(axis.values.tolist())
                },
            }
            for axis in plan.axes
        },
        "outputs": sorted(plan.outputs),
        "integrator": plan.integrator,
        "tail": plan.tail,
    }


def compare(old: Mapping[str, Any], new: Mapping[str, Any]) -> Changes:
    """The changes between two descriptions made by `describe`."""
    differences: list[str] = []
    added: list[str] = []
    for key in ("model", "model_version", "integrator"):
        if old[key] != new[key]:
            differences.append(f"{key.replace('_', ' ')}: {old[key]} before, {new[key]} now")
    if old["tail"] != new["tail"]:
        differences.append(f"tail: {old['tail']:g} s before, {new['tail']:g} s now")
    differences += _values("option", old["options"], new["options"])
    differences += _values("parameter", old["fixed"], new["fixed"])
    before, now = set(old["outputs"]), set(new["outputs"])
    differences += [f"output {name} is left out now" for name in sorted(before - now)]
    differences += [f"output {name} is asked for in addition now" for name in sorted(now - before)]
    differences += _motions(old, new)
    old_axes, new_axes = old["axes"], new["axes"]
    differences += [f"axis {name} is no longer there" for name in old_axes if name not in new_axes]
    differences += [f"axis {name} is new" for name in new_axes if name not in old_axes]
    common = [name for name in old_axes if name in new_axes]
    if len(common) == len(old_axes) == len(new_axes) and common != list(new_axes):
        differences.append(f"the axes are in another order: {', '.join(common)} before, {', '.join(new_axes)} now")
    for name in common:
        gone, changed, gained = _points(old_axes[name], new_axes[name])
        unit = old_axes[name]["unit"]
        if gone:
            differences.append(f"axis {name} lost {_some(gone, unit)}")
        differences += [f"axis {name}: point {label} means something else now" for label in changed[:1]]
        if gained:
            added.append(f"axis {name} gained {_some(gained, unit)}")
    return Changes(tuple(differences), tuple(added))


def _motions(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[str]:
    """What became of the records; further ones may join along the axis that lists them."""
    sentences = []
    for name, fingerprint in old["motions"].items():
        if name not in new["motions"]:
            sentences.append(f"motion {name} is no longer there")
        elif old["vertical"][name] != new["vertical"][name]:
            words = {True: "with", False: "without"}
            sentences.append(
                f"motion {name} is {words[new['vertical'][name]]} its vertical component now, "
                f"{words[old['vertical'][name]]} it before"
            )
        elif new["motions"][name] != fingerprint:
            sentences.append(f"motion {name} has other samples now")
    if len(old["motions"]) == 1 == len(new["motions"]) and not old["motions"].keys() & new["motions"].keys():
        sentences = [f"motion: {next(iter(old['motions']))} before, {next(iter(new['motions']))} now"]
    return sentences


def _values(kind: str, old: Mapping[str, Any], new: Mapping[str, Any]) -> list[str]:
    sentences = []
    for name in sorted(old.keys() | new.keys()):
        if name not in new:
            sentences.append(f"{kind} {name} = {old[name]} is no longer fixed")
        elif name not in old:
            sentences.append(f"{kind} {name} = {new[name]} is new")
        elif old[name] != new[name]:
            sentences.append(f"{kind} {name}: {old[name]} before, {new[name]} now")
    return sentences


def _points(old: Mapping[str, Any], new: Mapping[str, Any]) -> tuple[list[str], list[str], list[str]]:
    before, now = old["points"], new["points"]
    gone = [label for label in before if label not in now]
    changed = [label for label in before if label in now and before[label] != now[label]]
    return gone, changed, [label for label in now if label not in before]


def _some(labels: list[str], unit: str) -> str:
    suffix = "" if unit == "1" else f" {unit}"
    more = f" and {len(labels) - 3} more" if len(labels) > 3 else ""
    return ", ".join(f"{label}{suffix}" for label in labels[:3]) + more


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value
