"""Cubes of a set of motions whose truth is known: every motion overturns the wall from a lognormal capacity on."""

from __future__ import annotations

import numpy as np
import xarray as xr

from models.base import FloatArray
from study.status import OVERTURNED, REST, ROCKING

MEDIAN, DISPERSION = 3.0, 0.4
LEVELS = np.linspace(0.6, 9.0, 12)


def capacities(random: np.random.Generator, motions: int) -> FloatArray:
    return np.asarray(MEDIAN * np.exp(DISPERSION * random.standard_normal(motions)))


def cube_of(capacity: FloatArray, pga: FloatArray = LEVELS) -> xr.Dataset:
    """Over motion and pga; rotations grow as pga/capacity; the record's PGV is what decides: 1/capacity."""
    ratio = pga / capacity[:, None]
    status = np.where(ratio >= 1.0, OVERTURNED, np.where(ratio > 0.2, ROCKING, REST)).astype(np.int8)
    number = [f"record {k}" for k in range(capacity.size)]
    cube = xr.Dataset(
        {
            "status": (("motion", "pga"), status),
            "peak_rotation": (("motion", "pga"), np.where(ratio >= 1.0, np.pi / 2, 0.1 * ratio)),
        },
        coords={
            "motion": number,
            "pga": pga,
            "record_pga": ("motion", np.full(capacity.size, 2.0)),
            "record_pgv": ("motion", 2.0 / capacity),
            "record_duration": ("motion", np.arange(1.0, capacity.size + 1.0)),
        },
    )
    cube["pga"].attrs = {"units": "m s-2", "axis_of_study": "true"}
    cube["peak_rotation"].attrs = {"units": "rad"}
    cube["motion"].attrs = {"units": "1", "axis_of_study": "true"}
    return cube
