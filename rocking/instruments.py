"""Specimens with instruments: their sensor mechanisms are known here, above the room that reads files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from models.shaking import Shaking

if TYPE_CHECKING:
    import xarray as xr

    from grids.specimen import Specimen

UNRECORDED = ("contact_1", "contact_2")
"""Observables of a model that no instrument writes down."""


def read_specimen(path: str | Path) -> Specimen:
    """Read and check a specimen file, with the mechanisms of the wall and of its instruments.

    Raises InputError with one sentence: file, key, value, cure.
    """
    from diagnosis.sensors import SENSORS
    from grids.specimen import read_specimen as read

    return read(path, sensors=SENSORS)


def simulate_recorded(specimen: Specimen, measured: Shaking, scale: float, **run: Any) -> xr.Dataset:
    """The history of a specimen as its instruments write it down.

    ``measured`` is what the accelerometers of the base say, times ``scale``; the base moves as the
    specimen's sensor mechanisms tell. ``run`` goes on to `study.history.simulate_specimen`.
    """
    from diagnosis.sensors import SENSORS, moved, recorded
    from study.history import simulate_specimen
    from study.provenance import as_json

    instruments = {name: values for name, values in specimen.mechanisms.items() if name in SENSORS}
    if not instruments:
        return simulate_specimen(specimen, measured, scale=scale, **run)
    own = {name: values for name, values in specimen.mechanisms.items() if name not in SENSORS}
    vertical = None if measured.vertical is None else scale * measured.vertical
    said = Shaking(measured.time_step, scale * measured.horizontal, vertical)
    history = simulate_specimen(replace(specimen, mechanisms=own), moved(said, instruments), **run)
    time = history["time"].values
    sampled = np.arange(said.horizontal.size) * said.time_step
    for name, component in (("base_acceleration_x", said.horizontal), ("base_acceleration_z", said.vertical)):
        if component is not None:
            history[name].values[:] = np.interp(time, sampled, component, left=0.0, right=0.0)
    responses = [
        str(name)
        for name, values in history.data_vars.items()
        if "time" in values.dims and not str(name).startswith("base_") and name not in UNRECORDED
    ]
    written = recorded(
        {name: history[name].values for name in responses},
        instruments,
        measured.time_step,
        history["base_acceleration_x"].values,
    )
    for name in responses:
        history[name].values[:] = written[name]
    history.attrs["instruments"] = as_json(instruments)
    return history
