"""One paragraph in plain words, as a laboratory engineer would write it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from string import Formatter

from diagnosis.forces import KINDS
from diagnosis.result import Constancy, Effect, Fit, Located, Rival, Verdict
from models.base import Mechanism

WHERE = {
    "impact": "at impacts",
    "between_impacts": "between impacts",
    "first_uplift": "at the first uplift",
    "large_rotation": "at large rotations",
    "small_rotation": "at small rotations",
    "left": "while rocking to the left",
    "right": "while rocking to the right",
    "late": "more so late in the recording",
    "above_10_hz": "above 10 Hz",
    "everywhere": "throughout",
}


def statement(
    verdict: Verdict,
    effects: Sequence[Effect],
    rivals: Sequence[Rival],
    located: Sequence[Located],
    constancy: Sequence[Constancy],
    train: Fit,
    holdout: Fit | None,
    p_value: float,
    known: Mapping[str, Mechanism],
    next_experiment: Mapping[str, object] | None,
    finished: bool,
) -> str:
    """The paragraph; every number in it stands in the other fields too."""
    parts: list[str] = []
    if verdict == "nothing_missing":
        parts.append(
            "The model explains the recordings within their noise; nothing is missing "
            f"(the strongest suspect is no stronger than chance, p = {p_value:.2g})."
        )
    else:
        if effects or finished:
            chance = "far beyond chance" if p_value < 1e-6 else f"p = {p_value:.1g}"
            parts.append(f"The model leaves something out ({chance}).")
        if located:
            parts.append(_where(located))
    if effects:
        told = [effect_told(effect, known[effect.name]) for effect in effects]
        opening = "Best explanation" if verdict in ("missing", "cannot_tell_apart") else "What the library can say"
        parts.append(f"{opening}: {'; and '.join(told)}.")
    if verdict == "not_in_library":
        parts.append("That does not settle it: what is missing is not in the library of mechanisms.")
        parts += [_flag(found) for found in constancy[:2]]
    if verdict == "cannot_tell_apart" and rivals:
        names = ", ".join(f"{r.name.replace('_', ' ')} ({r.evidence_gap:.1f} less)" for r in rivals)
        parts.append(f"These recordings cannot tell it apart from: {names}.")
    elif rivals:
        names = ", ".join(r.name.replace("_", " ") for r in rivals)
        parts.append(f"{names[0].upper()}{names[1:]} would explain nearly as much.")
    if verdict != "nothing_missing":
        parts.append(_fit(train, holdout))
    if next_experiment and next_experiment.get("static_test"):
        parts.append(f"To settle it: {next_experiment['static_test']}.")
    if not finished:
        parts.append(
            "The search was stopped before its end: this is what stood by then, and what was not tried may explain "
            "the recordings as well."
        )
    return " ".join(parts)


_NOUNS = ("side", "amplitude of the motion", "size of the rotation", "time", "direction of motion")


def _flag(found: Constancy) -> str:
    if found.depends_on in _NOUNS:
        return f"What acts is a {KINDS[found.parameter]} that depends on the {found.depends_on}."
    if found.depends_on == "a spell of time":
        return f"What acts is a {KINDS[found.parameter]} that is there for a while only."
    if found.depends_on.startswith("recording"):
        return f"What acts is a {KINDS[found.parameter]} that is not the same in {found.depends_on}."
    return f"What acts is a {KINDS[found.parameter]} ({found.depends_on})."


def _where(located: Sequence[Located]) -> str:
    first = located[0]
    words = " and ".join(WHERE[w] for w in first.where)
    return (
        f"The mismatch lives {words}, most of it in {first.recording} from {first.start:.1f} s to {first.end:.1f} s "
        f"({first.channel}, {first.share:.0%} of the excess)."
    )


def effect_told(effect: Effect, mechanism: Mechanism) -> str:
    """An effect in the library's sentence, with its interval and evidence."""
    values = {name: e.estimate for name, e in effect.parameters.items()}
    sentence = mechanism.sentence_for(values)
    name, main = next(iter(effect.parameters.items()))
    form = _form(sentence, name)
    low, high = (format(end, form or ".4g") for end in (main.low95, main.high95))
    unit = "" if main.unit == "1" or form else f" {main.unit}"
    bound = ", at the end of its range" if main.at_bound else ""
    said = sentence.format_map({**mechanism.nulls, **values})
    interval = f"95 % interval {low} to {high}{unit}{bound}"
    return f"{effect.name.replace('_', ' ')}: {said} ({interval}; evidence {effect.evidence:.0f})"


def _form(sentence: str, parameter: str) -> str:
    """How the sentence writes the parameter where it writes it in percent, else empty."""
    forms = (form or "" for _, name, form, _ in Formatter().parse(sentence) if name == parameter)
    return next((form for form in forms if form.endswith("%")), "")


def _fit(train: Fit, holdout: Fit | None) -> str:
    text = f"The misfit falls from {train.before:.3f} to {train.after:.3f} of the signal on the recordings fitted to"
    if holdout is None:
        return text + "; no recording was held out."
    text += f", and from {holdout.before:.3f} to {holdout.after:.3f} on those held out"
    if holdout.share_of_achievable is not None:
        text += f" ({holdout.share_of_achievable:.0%} of what the noise allows)"
    return text + "."
