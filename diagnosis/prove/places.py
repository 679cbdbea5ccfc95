"""Where and when an answer says that something acts, against the key: overlap of intervals, and instants.

A key holds for each recording ``active``, a list of [begin, end] in s (or ``active_interval``, one of them), and its
``duration``; what acts throughout has neither, or covers every recording.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnosis.answer.when import Spans, merged
from diagnosis.prove.scores import Scored

LEARNED_FROM = "train_"
"""How the names of the recordings begin that an answer says where it acts in."""
CYCLE = 1.0
"""s, of a key that gives none."""


def true_spans(case: Scored) -> dict[str, Spans] | None:
    """By recording learned from, in which times (s) the hidden effect acts; None where it acts throughout."""
    notes = {name: note for name, note in case.key.get("recordings", {}).items() if name.startswith(LEARNED_FROM)}
    found = {}
    for name, note in notes.items():
        if "active" not in note and "active_interval" not in note:
            return None
        spans = note["active"] if "active" in note else [note["active_interval"]]
        found[name] = [(float(begin), float(end)) for begin, end in spans]
    whole = all(_length(found[name]) >= 0.99 * float(notes[name].get("duration", math.inf)) for name in found)
    return None if whole else found


def said_spans(case: Scored) -> dict[str, Spans]:
    """By recording, the union of the intervals that the answer gives, whatever the channel."""
    found: dict[str, Spans] = {}
    for one in case.answer["located"]:
        found.setdefault(str(one["recording"]), []).append((float(one["start"]), float(one["end"])))
    return {name: merged(spans) for name, spans in found.items()}


def _length(spans: Sequence[tuple[float, float]]) -> float:
    return sum(end - begin for begin, end in merged(spans))


def overlap(case: Scored) -> float | None:
    """Length of the intersection over that of the union of true and said times, over all recordings learned from."""
    true = true_spans(case)
    if true is None:
        return None
    said = said_spans(case)
    either = sum(_length([*true[name], *said.get(name, [])]) for name in true)
    both = sum(_length(true[name]) + _length(said.get(name, [])) for name in true) - either
    return both / either if either > 0.0 else 0.0


def instants_right(case: Scored) -> bool | None:
    """Whether every instant at which the effect begins or ends is found within one rocking cycle.

    The stages of the effects of the right class are compared; without such an effect none is found. The cycle is the
    key's (``cycles``), else `CYCLE`. None: nothing begins or ends within a recording.
    """
    true = true_spans(case)
    if true is None:
        return None
    stages = [s for effect in case.effects if effect["class"] in case.truth for s in effect.get("stages", ())]
    flags = []
    for name, spans in true.items():
        note = case.key["recordings"][name]
        for k, (begin, end) in enumerate(spans):
            cycle = float(note["cycles"][k]) if "cycles" in note else CYCLE
            for which, instant in (("begins", begin), ("ends", end)):
                if 0.0 < instant < float(note.get("duration", math.inf)) - 1e-9:
                    said = [float(s[which]) for s in stages if s["recording"] == name]
                    flags.append(any(abs(one - instant) <= cycle for one in said))
    return all(flags) if flags else None
