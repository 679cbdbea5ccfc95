"""Rivals in the words of a statement: of several effects it is said in the place of which one each would stand."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.answer.result import Rival


def told_apart(rivals: Sequence[Rival], effects: int) -> list[str]:
    """ "it apart from: filter (2.1 less)", one for each of several ``effects`` that has rivals."""
    return [
        f"{place if effects > 1 else 'it'} apart from: "
        + ", ".join(f"{_plain(rival.name)} ({rival.evidence_gap:.1f} less)" for rival in own)
        for place, own in _by_place(rivals).items()
    ]


def nearly_as_much(rivals: Sequence[Rival], effects: int) -> list[str]:
    """The same as sentences where no rival is of another class."""
    said = []
    for place, own in _by_place(rivals).items():
        names = ", ".join(_plain(rival.name) for rival in own)
        instead = f" in the place of {place}" if effects > 1 else ""
        said.append(f"{names[0].upper()}{names[1:]}{instead} would explain nearly as much.")
    return said


def _by_place(rivals: Sequence[Rival]) -> dict[str, list[Rival]]:
    found: dict[str, list[Rival]] = {}
    for rival in rivals:
        found.setdefault(_plain(rival.in_place_of), []).append(rival)
    return found


def _plain(name: str) -> str:
    return name.replace("_", " ")
