"""One run of a specimen as a labelled history: observables over time, events with CF flags."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import models
from grids.instruments import INSTRUMENTS
from grids.instruments.base import Surroundings
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.netcdf_lock import NETCDF_LOCK
from grids.recordings.base import SHARE
from grids.recordings.netcdf import BAND_LIMITED, BETWEEN, LINEAR
from grids.recordings.placed import attributes
from grids.specimen import Specimen
from grids.stages import Mechanisms, first_sample, stretches
from models.base import STATUS, Event, FloatArray, History
from models.errors import InputError, nearest
from models.kinematics import Place, ground_along
from models.model import Model
from models.piecewise import Part, simulate
from models.shaking import Shaking
from study.provenance import as_json, attribute, commit, machine, now, source, versions
from study.store import write_whole

EVENT_KINDS = ("onset", "impact", "uplift", "closing", "rest", "overturned", "change_of_pattern")


def simulate_specimen(
    specimen: Specimen,
    shaking: Shaking,
    *,
    scale: float = 1.0,
    duration: float | None = None,
    tail: float = 10.0,
    integrator: str = "lanes",
    recording: str | None = None,
    places: Mapping[str, Place] | None = None,
) -> xr.Dataset:
    """Every observable (and the base acceleration) over ``time``, the events over ``event``.

    So are the channels of the specimen at positions on the bodies, and those of ``places``.
    ``scale`` multiplies the shaking; ``duration`` (s) fixes the length of the run, else it lasts
    the record and at most ``tail`` s of free motion. With instruments among the specimen's mechanisms
    the shaking is what the accelerometers of the base read, and the channels are what is recorded.
    Mechanisms with stages act as they say for the ``recording`` of that name, else as after their last stage; an
    instant is that of the next sample. Raises InputError for a specimen without a value for every parameter, for an
    unknown integrator, and where a run cannot be cut (`models.piecewise`).
    """
    model = models.get(specimen.model)
    if specimen.calibrate:
        raise InputError(
            f"specimen '{specimen.title}': {', '.join(specimen.calibrate)} has a range in [calibrate] and no "
            "value; give it one in [parameters], or calibrate first."
        )
    if integrator not in model.integrators:
        raise InputError(f"integrator '{integrator}' is not known: {nearest(integrator, model.integrators)}")
    read = shaking.scaled(scale)
    ways = [(first_sample(begin, read.time_step), acting) for begin, acting in stretches(specimen, recording)]
    instruments = {name: given for name, given in specimen.mechanisms.items() if name in INSTRUMENTS}
    moved = moved_in_stages(read, ways)
    history = simulate(
        model,
        _parts(specimen, ways),
        moved,
        initial=dict(specimen.initial) or None,
        duration=duration,
        tail=tail,
        options=dict(specimen.options),
        integrator=integrator,
    )
    placed = {**specimen.places, **(places or {})}
    _check_places(model, specimen, placed)
    along = tuple(x[0] for x in ground_along(moved, np.zeros(1, np.int64), history.time.size))
    read_off = {name: one.read(history.channels, read.time_step, (along[0], along[1])) for name, one in placed.items()}
    observed = {quantity.name: history.channels[quantity.name] for quantity in model.observables}
    history = replace(history, channels={**observed, **read_off})
    channels = _recorded(model, history, moved, ways, specimen.reference_peak, placed)
    dataset = _label(model, replace(history, channels=channels), read, placed)
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": specimen.title,
        "source": f"{source()}, {model.name} {model.version}, {integrator}",
        "history": f"{now()} rocking simulate",
        "provenance": as_json(
            {
                "values": _values(specimen, specimen.mechanisms),
                "stages": {name: [vars(one) for one in stages] for name, stages in specimen.stages.items()},
                "options": model.resolve_options(specimen.options),
                "versions": versions(),
                "commit": commit(),
                "time": now(),
                **machine(),
            }
        ),
        "outputs": as_json({**history.outputs, "status": STATUS[int(history.outputs["status"])]}),
    }
    if instruments:
        dataset.attrs["instruments"] = as_json(instruments)
    return dataset


def _check_places(model: Model, specimen: Specimen, placed: Mapping[str, Place]) -> None:
    """Raises InputError for channels that the model does not predict with this specimen's mechanisms."""
    for name, place in placed.items():
        model.check_place(name, place, specimen.parameters)
        for mechanism, why in model.unplaced(place).items():
            if mechanism in specimen.mechanisms:
                raise InputError(
                    f"channel {name} is not predicted with {mechanism}: {why}; leave the channel or {mechanism} out."
                )


Ways = Sequence[tuple[int, Mechanisms]]
"""From which sample on which mechanisms act."""


def _values(specimen: Specimen, mechanisms: Mechanisms) -> dict[str, float]:
    """Parameters of the wall with those of its own mechanisms."""
    values: dict[str, float] = dict(specimen.parameters)
    for mechanism, parameters in mechanisms.items():
        if mechanism not in INSTRUMENTS:
            values |= {f"{mechanism}.{name}": value for name, value in parameters.items()}
    return values


def _parts(specimen: Specimen, ways: Ways) -> list[Part]:
    """The wall's values from sample to sample, where they change."""
    found: list[Part] = []
    for first, acting in ways:
        values = _values(specimen, acting)
        if not found or values != found[-1].values:
            found.append(Part(first, values))
    return found


def _recorded(
    model: Model, history: History, base: Shaking, ways: Ways, peak: float | None, placed: Mapping[str, Place]
) -> dict[str, FloatArray]:
    """The channels as the instruments record them; shares of contact stay as they are."""
    units = {quantity.name: quantity.unit for quantity in model.observables}
    around = Surroundings(base.time_step, _at(history, base, base.horizontal), peak, places=placed)
    signals = {name: x for name, x in history.channels.items() if units.get(name) != SHARE}
    return {**history.channels, **recorded_in_stages(signals, ways, around)}


def _at(history: History, read: Shaking, component: FloatArray) -> FloatArray:
    """A component of the base's motion at the times of a history."""
    return np.asarray(np.interp(history.time, read.time, component, left=0.0, right=0.0))


def _label(model: Model, history: History, read: Shaking, placed: Mapping[str, Place]) -> xr.Dataset:
    variables: dict[str, Any] = {}
    about: dict[str, Any]
    declared = {quantity.name: quantity for quantity in model.observables}
    for name, values in history.channels.items():
        if name in placed:
            place = placed[name]
            about = {"units": place.unit, "long_name": place.meaning, **attributes(place)}
            variables[name] = (("time",), values, about)
            continue
        quantity = declared[name]
        dims = ("time",) if values.ndim == 1 else ("level", "time")
        about = {"units": quantity.unit, "long_name": quantity.meaning}
        variables[name] = (dims, values, about)
    about = {"units": "m s-2", "long_name": "horizontal acceleration of the base, positive to the right"}
    about[BETWEEN] = BAND_LIMITED if read.band_limited else LINEAR
    variables["base_acceleration_x"] = (("time",), _at(history, read, read.horizontal), about)
    if read.vertical is not None:
        about = {"units": "m s-2", "long_name": "vertical acceleration of the base, positive up"}
        variables["base_acceleration_z"] = (("time",), _at(history, read, read.vertical), about)
    time = ("time", history.time, {"units": "s", "long_name": "time since the first sample"})
    return xr.Dataset({**variables, **_events(history.events)}, coords={"time": time})


def _events(events: tuple[Event, ...]) -> dict[str, Any]:
    kinds = np.array([EVENT_KINDS.index(event.kind) for event in events], dtype=np.int8)
    flags = {
        "flag_values": np.arange(len(EVENT_KINDS), dtype=np.int8),
        "flag_meanings": " ".join(EVENT_KINDS),
    }
    times = np.array([event.time for event in events], dtype=np.float64)
    bodies = np.array([event.body for event in events], dtype=np.int8)
    return {
        "event_time": ("event", times, {"units": "s", "long_name": "time of the event"}),
        "event_kind": ("event", kinds, {"units": "1", "long_name": "what happened", **flags}),
        "event_body": ("event", bodies, {"units": "1", "long_name": "body or joint, 1 is the lower one"}),
    }


NOT_VALID = {
    "not_converged": "the run did not converge",
    "outside_model": "the run left the range in which the model holds",
    "failed": "the run failed",
}
"""A sentence for every ending of `models.base.UNANSWERED`."""


def ending(history: xr.Dataset) -> str:
    """What became of a run, as the word of its `models.base.STATUS`."""
    return str(json.loads(history.attrs["outputs"])["status"])


def suspicions_of_ending(history: xr.Dataset) -> tuple[str, ...]:
    """A sentence about a run that is no answer."""
    said = NOT_VALID.get(ending(history))
    cure = "check the motion's unit and scale and the specimen's values, or use another model."
    return () if said is None else (f"{said}: its results are not valid, and the outputs are nan; {cure}",)


def write_history(history: xr.Dataset, out: str | Path) -> Path:
    """Write a history as netCDF, whole or not at all. Raises InputError unless ``out`` ends in .nc."""
    path = Path(out)
    if path.suffix != ".nc":
        raise InputError(f"cannot write a history to '{path.name}': end the name in .nc")
    clean = history.copy()
    clean.attrs = {name: attribute(value) for name, value in history.attrs.items()}

    def write(temporary: Path) -> None:
        with NETCDF_LOCK:
            clean.to_netcdf(temporary, engine="netcdf4", format="NETCDF4")

    write_whole(path, write)
    return path
