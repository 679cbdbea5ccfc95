"""One run of a specimen as a labelled history: observables over time, events with CF flags."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import models
from grids.netcdf_lock import NETCDF_LOCK
from grids.specimen import Specimen
from models.base import Event, History, Model
from models.errors import InputError, nearest
from models.shaking import Shaking
from study.provenance import as_json, attribute, commit, machine, now, versions
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
) -> xr.Dataset:
    """Every observable (and the base acceleration) over ``time``, the events over ``event``.

    ``scale`` multiplies the shaking; ``duration`` (s) fixes the length of the run, else it lasts
    the record and at most ``tail`` s of free motion. Raises InputError for a specimen without a
    value for every parameter and for an unknown integrator.
    """
    model = models.get(specimen.model)
    if specimen.calibrate:
        raise InputError(
            f"specimen '{specimen.title}': {', '.join(specimen.calibrate)} has a range in [calibrate] and no "
            "value; give it one in [parameters], or calibrate first."
        )
    if integrator not in model.integrators:
        raise InputError(f"integrator '{integrator}' is not known: {nearest(integrator, model.integrators)}")
    values: dict[str, float] = dict(specimen.parameters)
    for mechanism, parameters in specimen.mechanisms.items():
        values |= {f"{mechanism}.{name}": value for name, value in parameters.items()}
    history = model.simulate(
        values,
        shaking,
        scale=scale,
        initial=dict(specimen.initial) or None,
        duration=duration,
        tail=tail,
        options=dict(specimen.options),
        integrator=integrator,
    )
    dataset = _label(model, history, shaking, scale)
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": specimen.title,
        "source": f"rocking-study {versions()['rocking-study']}, {model.name} {model.version}, {integrator}",
        "history": f"{now()} rocking simulate",
        "provenance": as_json(
            {
                "values": values,
                "options": model.words(specimen.options),
                "versions": versions(),
                "commit": commit(),
                "time": now(),
                **machine(),
            }
        ),
        "outputs": as_json(dict(history.outputs)),
    }
    return dataset


def _label(model: Model, history: History, shaking: Shaking, scale: float) -> xr.Dataset:
    variables: dict[str, Any] = {}
    declared = {quantity.name: quantity for quantity in model.observables}
    for name, values in history.channels.items():
        quantity = declared[name]
        dims = ("time",) if values.ndim == 1 else ("level", "time")
        about = {"units": quantity.unit, "long_name": quantity.meaning}
        variables[name] = (dims, values, about)
    sampled = np.arange(shaking.horizontal.size) * shaking.time_step
    for name, component, direction in (
        (
            "base_acceleration_x",
            shaking.horizontal,
            "horizontal acceleration of the base, positive to the right",
        ),
        ("base_acceleration_z", shaking.vertical, "vertical acceleration of the base, positive up"),
    ):
        if component is not None:
            values = np.interp(history.time, sampled, scale * component, left=0.0, right=0.0)
            variables[name] = (("time",), values, {"units": "m s-2", "long_name": direction})
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
