"""One paragraph in plain words, as an engineer would write it in a report."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from string import Formatter
from typing import Any

from diagnosis.answer.judgement import FITTED, REFIT
from diagnosis.answer.phases import EVERYWHERE, words_of
from diagnosis.answer.result import Beyond, Diagnosis, Effect, Extrapolated, Fit, Located, Unfit
from diagnosis.answer.rivals import nearly_as_much, told_apart
from diagnosis.answer.untried import left_out, suspects_left_out
from diagnosis.answer.when import comes_and_goes, held_text, merged, when_text
from diagnosis.data.measured import identification_of
from diagnosis.fit.unknowns import effects
from diagnosis.forces.constancy import BLOW, FOR_A_WHILE, Constancy
from diagnosis.forces.varying import WINDOW
from diagnosis.search.found import MISSING
from diagnosis.search.null import LEAST_P
from models import get
from models.base import Mechanism
from models.identification import Identification
from models.model import Model

CONFIRMED = 0.5
"""Share of the achievable on held-out recordings under which the reader is warned."""
MOST_NAMED = 4
"""Recordings whose gain is printed; of more, the largest and the smallest."""


def statement(found: Diagnosis, model: Model) -> str:
    """The paragraph; every number in it is in another field of the answer too."""
    known = effects(model)
    declared = identification_of(model)
    parts = _suspicions(found.suspicions)
    parts += [f"Seen in the recordings: {what}." for what in found.seen]
    if not found.finished and not found.effects:
        parts.append(
            "The search was stopped before anything was found: the base model is calibrated, and whether something is "
            "missing from it is not known. Run it again."
        )
        return " ".join(parts)
    if found.verdict == "nothing_missing":
        parts += [_nothing(found), *_unfit(found.unfit), *_untested(declared)]
        return " ".join([*parts, *_skipped(found)])
    parts.append(f"The model leaves something out ({_beyond_chance(found.p_value)}).")
    parts += _shows(found.shows, words_of(declared))
    if found.unexplained:
        parts.append(
            "Even the best model of the library leaves most of the motion unexplained, so a name would mean nothing: "
            "check the signs, units and clocks of the recordings, and the specimen."
        )
    if found.effects:
        said = [effect_text(effect, known[effect.name]) for effect in found.effects]
        opening = "What the library can say" if found.verdict == "not_in_library" else "Best explanation"
        parts.append(f"{opening}: {'; and '.join(said)}.")
    parts += _another(found)
    if found.effects and not any(effect.stages for effect in found.effects):
        parts += _by_recording(found.provenance.get("gain_by_recording", {}))
    parts += _acts(found.located, words_of(declared), {effect.name for effect in found.effects if effect.stages})
    if found.verdict == "not_in_library" and not found.unexplained:
        parts.append("That does not settle it: what is missing is not in the library of mechanisms.")
        parts += left_out(found)
        parts += _contradicted(found)
        parts += [_beyond(one) for one in found.beyond]
        parts += _unfit(found.unfit)
        acting = declared if found.other_model is None else identification_of(get(found.other_model.model))
        parts += [_flag(flag, acting) for flag in _distinct(found.constancy)[:2]]
        if found.missing_force:
            parts += _law(found.missing_force, found.other_model is None)
    if found.verdict == "cannot_tell_apart" and found.rivals:
        parts += [f"These recordings cannot tell {which}." for which in told_apart(found.rivals, len(found.effects))]
    elif found.rivals:
        parts += nearly_as_much(found.rivals, len(found.effects))
    if found.verdict != "not_in_library":
        parts += _unfit(found.unfit)
        parts += suspects_left_out(found)
    if found.detail is not None and found.verdict != "not_in_library":
        parts.append(_detail(found.detail, found.provenance["constancy_threshold"]))
    parts.append(_fit(found.train, found.holdout))
    parts += [_extrapolated(one) for one in found.extrapolated]
    parts += held_text(found.held_stages)
    parts += _untested(declared)
    if found.next_experiment and found.next_experiment.get("static_test"):
        parts.append(f"To settle it: {found.next_experiment['static_test']}.")
    if not found.finished:
        parts.append(
            "The search was stopped before its end: this is what stood by then, and what was not tried may explain "
            "the recordings as well."
        )
    return " ".join([*parts, *_skipped(found)])


def _law(force: Mapping[str, Any], extends: bool) -> list[str]:
    """What was estimated in the place of what is missing; ``extends``: the specimen that is written holds it."""
    parts = []
    if force["terms"]:
        what = " and a ".join(term["meaning"] for term in force["terms"])
        part = "is part" if extends else "is no part"
        parts.append(f"A law in a table, estimated in its place, {part} of extended.toml: a {what}.")
    if force["oscillator"]:
        parts.append(oscillator_text(force["oscillator"]))
        if extends and not force["terms"]:
            parts.append("It is part of extended.toml.")
    return [*parts, *comes_and_goes(force["stages"])]


def oscillator_text(found: Mapping[str, Mapping[str, float]]) -> str:
    """What an oscillator does that the base drives, beside a law in a table or alone."""

    def of(name: str, factor: float = 1.0) -> str:
        return "{:.3g} ({:.3g} to {:.3g})".format(
            *(factor * found[name][key] for key in ("estimate", "low95", "high95"))
        )

    return (
        f"What is missing has a frequency of its own: an oscillator of {of('frequency')} Hz with "
        f"{of('damping', 100.0)} % of critical damping, driven by the base. The block is "
        f"carried by {of('motion')} of its motion against the base, as by a support that moves, and pushed by "
        f"{of('force')} of the force that accelerates it, as by a mass that swings."
    )


def _extrapolated(one: Extrapolated) -> str:
    return (
        f"{one.recording} reaches {one.peak:.3g} {one.unit}, {one.peak / one.learned:.1f} times the largest that was "
        f"learned from ({one.learned:.3g} {one.unit}): its prediction extrapolates, with a misfit of {one.after:.3f} "
        f"of {one.channel}."
    )


def _beyond(one: Beyond) -> str:
    """That an effect would have to be larger than it may be."""
    unit = "" if one.unit == "1" else f" {one.unit}"
    return (
        f"{one.effect.replace('_', ' ').capitalize()} would have to go on beyond the range of the library: its "
        f"{one.parameter.replace('_', ' ')} ends at {one.limit:.3g}{unit}, and {one.wanted:.3g}{unit} fits better "
        f"(evidence {one.evidence:.0f})."
    )


def _unfit(windows: Sequence[Unfit]) -> list[str]:
    """That windows are left far from the noise, the worst of them."""
    if not windows:
        return []
    worst = [
        f"{one.recording}, {one.start:.1f} to {one.end:.1f} s ({one.misfit:.0f} times)" for one in windows[:MOST_NAMED]
    ]
    if len(windows) == 1:
        return [
            f"In one window the residual stays far above the variance that is expected: {worst[0]}. One event is too "
            "little to name what acts there: look at what happened, or repeat it."
        ]
    more = "" if len(windows) <= MOST_NAMED else f"; and {len(windows) - MOST_NAMED} more"
    return [f"In these windows the residual stays far above the variance that is expected: {'; '.join(worst)}{more}."]


def _contradicted(found: Diagnosis) -> list[str]:
    """That what was found predicts recordings held out worse than the model without it."""
    if found.contradicted is None:
        return []
    without, with_it = found.contradicted
    return [
        f"With what was found the model predicts recordings held out worse than without: misfit {with_it:.3f} "
        f"of the signal in place of {without:.3f}."
    ]


def _another(found: Diagnosis) -> list[str]:
    """That the answer is another base model, by how much, and over what."""
    other = found.other_model
    if other is None:
        return []
    named = " and ".join(name.replace("_", " ") for name in other.instead)
    with_all = f"this one even with {named}" if named else "this one, which no mechanism of the library improves"
    errs = ", which errs clearly all the same" if other.inadequate else ""
    return [
        f"That is another base model, {other.model}: it explains the recordings better than {with_all}{errs} "
        f"(evidence {other.evidence:.0f} over that, its parameters and states paid for). extended.toml is a specimen "
        "of it: diagnose again with it to look for what is left."
    ]


def _suspicions(by_recording: Mapping[str, Sequence[str]]) -> list[str]:
    """What looks wrong, once for all recordings in which it does."""
    recordings: dict[str, list[str]] = {}
    for name, all_of in by_recording.items():
        for what in all_of:
            recordings.setdefault(what, []).append(name)
    return [
        f"Check this first: {', '.join(names)}: {what}{'' if what.endswith(('.', '?', '!')) else '.'}"
        for what, names in recordings.items()
    ]


def _nothing(found: Diagnosis) -> str:
    """Nothing is named: nothing is missing, or the strongest suspect is not certain enough."""
    suspect = found.undecided
    if suspect is None:
        chance = f", {p_text(found.p_value)}" if found.p_value is not None else ""
        explained = (
            "The model explains the recordings within their noise but for one window, and nothing is named as missing"
            if found.unfit
            else "The model explains the recordings within their noise; nothing is missing"
        )
        return f"{explained} (the strongest suspect is no stronger than chance{chance})."
    why = (
        f"but that rests on {suspect.rests_on}"
        if suspect.rests_on
        else "less than a name takes: a weak effect, or a rare chance"
    )
    if suspect.rests_on == FITTED:
        why += ", for those held out are less likely with it"
    if suspect.rests_on == REFIT:
        why += ", for the derivative at no effect shows no more than chance brings"
    return (
        "Nothing is named as missing from the model, but one thing is not decided: "
        f"{suspect.name.replace('_', ' ')} gains {suspect.gain:.0f} in 2 log likelihood ({p_text(found.p_value)}), "
        f"{why}. Another recording would decide."
    )


def p_text(p_value: float | None) -> str:
    """A p-value as papers print it."""
    if p_value is None:
        return "not tested"
    return "p < 1e-6" if p_value <= LEAST_P else f"p = {p_value:.2g}"


def _beyond_chance(p_value: float | None) -> str:
    far = p_value is not None and p_value <= LEAST_P
    return f"far beyond chance, {p_text(p_value)}" if far else p_text(p_value)


def _untested(declared: Identification) -> list[str]:
    return [] if declared.forces else ["Laws outside the library are not tested for with this model."]


def _by_recording(gains: Mapping[str, float]) -> list[str]:
    """What each recording says of the effects, and whether one of them alone decides."""
    whole = sum(max(gain, 0.0) for gain in gains.values())
    if len(gains) < 2 or whole == 0.0:
        return []
    strongest, *others = sorted(gains, key=lambda name: -gains[name])
    named = [strongest, *others] if len(gains) <= MOST_NAMED else [strongest, others[-1]]
    some = ("most ", "least ") if len(named) < len(gains) else ("",) * len(named)
    shares = [f"{word}{name} {max(gains[name], 0.0) / whole:.0%}" for word, name in zip(some, named, strict=True)]
    said = ", ".join(shares)
    rest = sum(gains[name] for name in others)
    alone = f"; without {strongest} it would not have been named" if rest < MISSING else ""
    return [f"Of the gain in likelihood the recordings give: {said}{alone}."] if whole > 0.0 else []


def _skipped(found: Diagnosis) -> list[str]:
    said = [f"Stopped after the search; left out: {', '.join(found.skipped)}."] if found.skipped else []
    return said + [f"Could not be done: {what} ({why})." for what, why in found.failed.items()]


def _distinct(found: Sequence[Constancy]) -> list[Constancy]:
    """The strongest of each dependence: forces that depend on the same thing are mostly one force seen twice."""
    strongest: dict[str, Constancy] = {}
    for flag in found:
        strongest.setdefault(flag.depends_on, flag)
    return list(strongest.values())


def _flag(found: Constancy, declared: Identification) -> str:
    if found.parameter == BLOW:
        return f"Something acts on it for a moment, {found.stronger}: a blow, or a sensor that was knocked."
    meaning = next(kind.meaning for kind in declared.forces if kind.name == found.parameter)
    what = f"What acts is a {meaning}"
    stronger = f", stronger {found.stronger}" if found.stronger else ""
    if found.depends_on == FOR_A_WHILE:
        return f"{what} that is there for a while only."
    if found.depends_on == WINDOW:
        return f"{what} that changes in the course of the recordings, from window to window."
    if found.depends_on.startswith("recording"):
        return f"{what} that is not the same in {found.depends_on}."
    return f"{what} that depends on the {found.depends_on}{stronger}."


def _detail(found: Constancy, tenth: float) -> str:
    """``tenth``: evidence of a tenth of the law's force."""
    what = found.parameter.replace("_", " ")
    return (
        f"What is left is not the same everywhere ({what}, by {found.depends_on}; evidence {found.evidence:.0f}, where "
        f"a tenth of the force of the law named would have {tenth:.0f}): it is taken for a detail of that law."
    )


def _shows(places: Sequence[Located], words: Mapping[str, str]) -> list[str]:
    """Where the residual of the base model lies, which is not where its cause acts."""
    if not places:
        return []
    first = places[0]
    return [
        f"The residual shows {_phases(first, words)}, most of all in {first.recording} from {first.start:.1f} s to "
        f"{first.end:.1f} s ({first.channel}, {first.share:.0%} of the excess misfit)."
    ]


def _acts(places: Sequence[Located], words: Mapping[str, str], staged: Collection[str]) -> list[str]:
    """Where each effect acts, or, without a name, where something must be added; ``staged`` ones begin or end."""
    said = []
    for name in dict.fromkeys(place.effect for place in places):
        own = [place for place in places if place.effect == name]
        what = f"{name.replace('_', ' ').capitalize()} acts" if name else "Something must be added"
        where = [
            _in_recording(r, [p for p in own if p.recording == r]) for r in dict.fromkeys(p.recording for p in own)
        ]
        phases = "" if name in staged and own[0].where == (EVERYWHERE,) else f" {_phases(own[0], words)}"
        said.append(f"{what}{phases}: {' and '.join(where)}.")
    return said


def _in_recording(recording: str, places: Sequence[Located]) -> str:
    spells = len(merged([(place.start, place.end) for place in places]))
    start, end = min(place.start for place in places), max(place.end for place in places)
    often = f", {spells} times" if spells > 1 else ""
    return f"in {recording} from {start:.1f} s to {end:.1f} s{often} ({sum(p.share for p in places):.0%} of it)"


def _phases(place: Located, words: Mapping[str, str]) -> str:
    return " and ".join(words[word] for word in place.where)


def effect_text(effect: Effect, mechanism: Mechanism) -> str:
    """An effect in the library's sentence, with its interval and evidence."""
    values = {name: e.estimate for name, e in effect.parameters.items()}
    name, main = next(iter(effect.parameters.items()))
    form = _form(mechanism.sentence_for(values), name)
    low, high = (format(end, form or ".4g") for end in (main.low95, main.high95))
    unit = "" if main.unit == "1" or form else f" {main.unit}"
    bound = ", at the end of its range" if main.at_bound else ""
    interval = f"95 % interval {low} to {high}{unit}{bound}"
    said = f"{effect.name.replace('_', ' ')}: {mechanism.says(values)} ({interval}; evidence {effect.evidence:.0f})"
    return f"{said}, {when_text(effect.stages)}" if effect.stages else said


def _form(sentence: str, parameter: str) -> str:
    """How the sentence writes the parameter where it writes it in percent, else empty."""
    forms = (form or "" for _, name, form, _ in Formatter().parse(sentence) if name == parameter)
    return next((form for form in forms if form.endswith("%")), "")


def _fit(train: Fit, holdout: Fit | None) -> str:
    text = f"The misfit {_change(train)} of the signal on the recordings fitted to"
    if holdout is None:
        return text + "; no recording was held out."
    verb = _change(train).split()[0]
    text += f", and {_change(holdout).removeprefix(f'{verb} ')} on those held out"
    if holdout.share_of_achievable is not None and holdout.after != holdout.before:
        share = f"{holdout.share_of_achievable:.0%}"
        of = "of it; they have no noise of their own" if holdout.noise_free else "of what the noise allows"
        text += f" ({share} {of})"
        if holdout.share_of_achievable < CONFIRMED:
            text += ", so they hardly confirm the explanation"
    return text + "."


def _change(fit: Fit) -> str:
    if fit.after == fit.before:
        return f"is {fit.after:.3f}"
    return f"{'falls' if fit.after < fit.before else 'rises'} from {fit.before:.3f} to {fit.after:.3f}"
