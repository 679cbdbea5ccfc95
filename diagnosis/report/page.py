"""``report.html``: one page that opens anywhere, without a network."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

import models
from diagnosis.answer.heldout import HORIZON
from diagnosis.answer.phases import words_of
from diagnosis.answer.result import Diagnosis, OtherModel, Rival, Windows
from diagnosis.answer.statement import oscillator_text
from diagnosis.answer.when import when_text
from diagnosis.data.measured import identification_of
from diagnosis.data.windows import ABOVE_NOISE
from diagnosis.errors.words import error_lines
from diagnosis.fit.unknowns import effects
from diagnosis.forces.constancy import BLOW
from diagnosis.report import words
from grids.recordings import CHANNELS, Recording, noise_levels
from grids.recordings.levels import level_of, stem
from grids.specimen import Specimen
from models.base import Mechanism
from models.model import Model

if TYPE_CHECKING:
    from jinja2 import Environment

    from diagnosis.report.svg import Picture

HEADLINES = {
    "missing": "Something is missing from the model: {names}",
    "cannot_tell_apart": "Something is missing from the model: {names}, or a rival",
    "not_in_library": "Something is missing that is not in the library",
    "nothing_missing": "Nothing is missing from the model",
}
MOST_PLACES = 8
"""Intervals that the page lists."""


def headline(found: Diagnosis) -> str:
    """The answer in a line."""
    names = words.listed(words.plain(effect.name) for effect in found.effects)
    if not found.finished:
        return f"Stopped early; found so far: {names}" if names else "Stopped before anything was found"
    if found.unexplained:
        return "The model does not explain the recordings"
    if found.undecided:
        return f"Nothing is named; not decided: {words.plain(found.undecided.name)}"
    return HEADLINES[found.verdict].format(names=names)


def report_page(
    diagnosis: Diagnosis,
    specimen: Specimen,
    train: Sequence[Recording],
    holdout: Sequence[Recording],
    drawn: Mapping[str, Picture],
) -> str:
    """The page as text, with the pictures ``drawn``. What it says of the fit stands in ``diagnosis``."""
    model = models.get(specimen.model)
    known, declared = effects(model), identification_of(model)
    short = {name: channel.meaning.partition(",")[0] for name, channel in CHANNELS.items()} | {
        quantity.name: quantity.meaning.partition(",")[0] for quantity in model.observables
    }
    places = {name: place for r in (*train, *holdout) for name, place in r.places.items()} | dict(specimen.places)
    short |= {name: f"{name}, {place.meaning}" for name, place in places.items()}
    short |= {name: _at_level(short[stem(name)], name) for name in _by_level(diagnosis)}
    return (
        environment()
        .get_template("report.html.j2")
        .render(
            d=diagnosis,
            specimen=specimen,
            model=model,
            headline=headline(diagnosis),
            effects=[
                (
                    effect,
                    known[effect.name],
                    known[effect.name].says({n: v.estimate for n, v in effect.parameters.items()}),
                    when_text(effect.stages),
                )
                for effect in diagnosis.effects
            ],
            other_title=models.get(diagnosis.other_model.model).title if diagnosis.other_model else "",
            other_parameters=_other_parameters(diagnosis.other_model),
            rivals=_rivals(diagnosis, known),
            channels=short,
            phases=words_of(declared),
            forces=_forces(diagnosis, model),
            recordings=[_read_row(r, held) for held, rs in ((False, train), (True, holdout)) for r in rs],
            horizons=_horizons(diagnosis),
            windows=_window_counts(diagnosis.windows),
            parameters=_parameters(diagnosis, specimen),
            pictures={name: picture.page() for name, picture in drawn.items()},
            most_places=MOST_PLACES,
            compared=_compared(diagnosis, [*train, *holdout]),
            above_noise=ABOVE_NOISE,
            errors=error_lines(diagnosis.errors) if diagnosis.errors else [],
            held_out_names={trace.recording for trace in diagnosis.traces if trace.held_out},
        )
    )


def _by_level(diagnosis: Diagnosis) -> list[str]:
    """The channels of single levels that the page speaks of."""
    sensor = (diagnosis.next_experiment or {}).get("sensor")
    named = [
        *(trace.channel for trace in diagnosis.traces),
        *diagnosis.channels,
        *([sensor["channel"]] if sensor else []),
    ]
    return [name for name in named if level_of(name) is not None]


def _at_level(meaning: str, name: str) -> str:
    return meaning.replace("of a level", f"of level {level_of(name)}")


def _forces(diagnosis: Diagnosis, model: Model[Any]) -> dict[str, str]:
    """What may be left over, by name: the forces of the model that explains the recordings, and a blow."""
    other = [models.get(diagnosis.other_model.model)] if diagnosis.other_model else []
    kinds = [kind for one in (model, *other) for kind in identification_of(one).forces]
    return {kind.name: kind.meaning for kind in kinds} | {BLOW: "a blow, or a sensor that was knocked"}


@functools.cache
def environment() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

    environment = Environment(
        loader=PackageLoader("diagnosis.report", "templates"),
        autoescape=select_autoescape(["html", "j2"]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "plain": words.plain, "number": words.number, "percent": words.percent, "chance": words.chance,
        "unit": words.unit_text, "listed": words.listed, "named": words.named, "estimate": words.estimate_texts,
        "stated": words.stated, "quantity": words.quantity, "oscillator": oscillator_text,
    }  # fmt: skip
    return environment


def _read_row(recording: Recording, held_out: bool) -> dict[str, Any]:
    channels = []
    for name, noises in noise_levels(recording).items():
        unit = recording.channel(name).unit
        peak = float(np.max(np.abs(recording.channels[name])))
        sigma = float(np.median([noise.sigma for noise in noises]))
        channels.append(
            {
                "name": name,
                "peak": words.quantity(peak, unit),
                "noise": words.quantity(sigma, unit, 2) if sigma > 0.0 else "none",
                "share": words.percent(sigma / peak) if peak > 0.0 else "–",
                "white": all(noise.white for noise in noises),
            }
        )
    return {"recording": recording, "held_out": held_out, "channels": channels}


def _other_parameters(other: OtherModel | None) -> list[tuple[str, str, str]]:
    """Name, meaning and value of every parameter of another base model."""
    if other is None:
        return []
    declared = {p.name: p for p in models.get(other.model).parameters}
    return [(n, declared[n].meaning, words.stated(v, declared[n].unit)) for n, v in other.parameters.items()]


def _rivals(diagnosis: Diagnosis, known: Mapping[str, Mechanism]) -> list[tuple[Rival, Mechanism, str]]:
    """Each rival with its mechanism and what it would mean by its own refit; the equation without one."""
    refitted = {tried.name: tried.estimate or {} for tried in diagnosis.screen}
    found = []
    for rival in diagnosis.rivals:
        mechanism, estimate = known[rival.name], refitted.get(rival.name)
        found.append((rival, mechanism, mechanism.says(estimate) if estimate else mechanism.equation))
    return found


def _compared(diagnosis: Diagnosis, recordings: Sequence[Recording]) -> list[tuple[str, float]]:
    """Recording by recording, the share of its time that lies in windows."""
    found = []
    for recording in recordings:
        strips = [strip for strip in diagnosis.windows if strip.recording == recording.name]
        if strips:
            inside = np.zeros(recording.time.size, bool)
            for start, end in zip(strips[0].start, strips[0].end, strict=True):
                inside |= (recording.time >= start) & (recording.time < end)
            found.append((recording.name, float(np.mean(inside))))
    return found


def _window_counts(windows: Sequence[Windows]) -> dict[str, int]:
    """Windows in all, and those where the models miss the recording by more than the noise explains."""
    from diagnosis.report.figures.levels import BORDERS

    return {
        "all": sum(strip.before.size for strip in windows),
        "before": sum(int((strip.before >= BORDERS[0]).sum()) for strip in windows),
        "after": sum(int((strip.after >= BORDERS[0]).sum()) for strip in windows),
    }


def _horizons(diagnosis: Diagnosis) -> list[tuple[str, ...]]:
    return [(name, *(_horizon(seconds) for seconds in pair)) for name, pair in diagnosis.prediction_horizon.items()]


def _horizon(seconds: float) -> str:
    if seconds >= HORIZON:
        return f"to the end, or over {HORIZON:g} s"
    return f"{seconds:.2f} s" if seconds >= 0.01 else "under 0.01 s"


def _parameters(diagnosis: Diagnosis, specimen: Specimen) -> list[Mapping[str, Any]]:
    """Effects first, then the base: estimate and interval as texts, what was stated, bounds hit."""
    rows: list[Mapping[str, Any]] = []
    known = effects(models.get(specimen.model))
    for effect in diagnosis.effects:
        declared = {p.name: p.meaning for p in known[effect.name].addressable(specimen.model)}
        for name, value in effect.parameters.items():
            rows.append(
                {
                    "name": words.plain(effect.name if name == effect.name else f"{effect.name}.{name}"),
                    "meaning": declared.get(name, ""),
                    "value": value,
                    "stated": "",
                    "new": True,
                }
            )
    meanings = {p.name: p.meaning for p in models.get(specimen.model).parameters}
    for name, value in diagnosis.base.items():
        stated = ""
        if name in specimen.parameters:
            stated = words.stated(specimen.nominal[name], value.unit)
            if name in specimen.tolerance:
                stated += f" ± {words.stated(100 * specimen.tolerance[name], '1')} %"
        elif name in specimen.calibrate:
            low, high = specimen.calibrate[name]
            stated = f"{words.stated(low, '1')} to {words.stated(high, value.unit)}"
        meaning = meanings.get(name, "")
        rows.append({"name": words.plain(name), "meaning": meaning, "value": value, "stated": stated, "new": False})
    return rows
