"""``posterior.nc``: samples of what was found, for studies (`[samples]` of a plan)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from models.base import FloatArray
from models.model import Model

Variables = Mapping[str, tuple[FloatArray, Mapping[str, str]]]
"""By name: samples (n,) and attributes."""
LEFT_OUT = {"of": "errors"}
"""Attributes of a variable that belongs to the recordings: a study passes it over."""


def write_posterior(found: Mapping[str, FloatArray], model: Model, title: str, path: Path) -> Path:
    """Write variables over ``sample``, named as in plans, with units; whole or not at all."""
    declared = {p.name: (p.unit, p.meaning) for p in model.parameters}
    for name, mechanism in model.mechanisms.items():
        declared |= {f"{name}.{p.name}": (p.unit, p.meaning) for p in mechanism.addressable(model.name)}
    variables = {
        name: (values, dict(zip(("units", "long_name"), declared[name], strict=True))) for name, values in found.items()
    }
    comment = "normal in the coordinates of the fit, within their bounds, with its covariance"
    return write_samples(variables, {"title": f"samples of what was found: {title}", "comment": comment}, path)


def write_samples(variables: Variables, attributes: Mapping[str, str], path: Path) -> Path:
    """The file; whole or not at all."""
    import xarray as xr

    from grids.netcdf_lock import NETCDF_LOCK
    from study.provenance import source
    from study.store import write_whole

    about = {**attributes, "Conventions": "CF-1.11", "source": source()}
    data = xr.Dataset({name: ("sample", *rest) for name, rest in variables.items()}, attrs=about)

    def write(temporary: Path) -> None:
        with NETCDF_LOCK:
            data.to_netcdf(temporary, engine="netcdf4", format="NETCDF4")

    write_whole(path, write)
    return path
