"""``fit.nc``: every curve and number behind the report, for those who draw their own figures."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnosis.answer.result import Diagnosis, Trace, Windows

if TYPE_CHECKING:
    import xarray as xr


def group_name(recording: str) -> str:
    """The group of a recording: its name with ``_`` for what a netCDF name may not hold, begun by a letter or digit."""
    plain = re.sub(r"[^\w.+-]", "_", recording)
    return plain if plain[0].isalnum() else f"r{plain}"


def fit_datasets(diagnosis: Diagnosis) -> dict[str, xr.Dataset]:
    """The groups of the file: "/" holds parameters and suspects; one group a recording its curves (`group_name`).

    A recording's group has ``<channel>_measured``, ``_before``, ``_after`` (and ``_from_rest_before``,
    ``_from_rest_after``) over ``time``, and the residuals of its windows over ``window_<channel>``.
    """
    groups: dict[str, list[Any]] = {}
    for trace in diagnosis.traces:
        groups.setdefault(trace.recording, []).append(_curves(trace))
    for strip in diagnosis.windows:
        groups.setdefault(strip.recording, []).append(_residuals(strip))
    found = {"/": _root(diagnosis)}
    for name, parts in groups.items():
        own = group_name(name)
        while own in found:
            own += "_"
        found[own] = _joined(name, parts, diagnosis)
    return found


def write_fit(diagnosis: Diagnosis, path: Path) -> Path:
    """Write the file, whole or not at all."""
    from grids.netcdf_lock import NETCDF_LOCK
    from study.store import write_whole

    groups = fit_datasets(diagnosis)

    def write(temporary: Path) -> None:
        with NETCDF_LOCK:
            for k, (name, data) in enumerate(groups.items()):
                packed = {v: {"zlib": True, "complevel": 1} for v in data if data[v].dtype.kind == "f"}
                data.to_netcdf(
                    temporary, mode="a" if k else "w", group=name, engine="netcdf4", format="NETCDF4", encoding=packed
                )

    write_whole(path, write)
    return path


def _root(diagnosis: Diagnosis) -> xr.Dataset:
    import xarray as xr

    from study.provenance import attribute

    fitted = {**diagnosis.base}
    for effect in diagnosis.effects:
        fitted |= {f"{effect.name}.{name}": value for name, value in effect.parameters.items()}
    screen = diagnosis.screen
    gains = [np.nan if s.gain is None else s.gain for s in screen]
    about = {
        "estimate": "fitted value",
        "low95": "lower end of the 95 % interval",
        "high95": "upper end of the 95 % interval",
    }
    variables: dict[str, Any] = {
        name: ("parameter", np.array([getattr(v, name) for v in fitted.values()], float), {"long_name": text})
        for name, text in about.items()
    }
    variables["unit"] = ("parameter", _texts(v.unit for v in fitted.values()))
    variables["at_bound"] = ("parameter", _texts(v.at_bound for v in fitted.values()))
    unit = {"units": "1"}
    variables["score"] = (
        "suspect", np.array([s.score for s in screen], float), {**unit, "long_name": "score, without a refit"},
    )  # fmt: skip
    variables["gain"] = (
        "suspect", np.array(gains, float), {**unit, "long_name": "gain in 2 log likelihood of the refit"},
    )  # fmt: skip
    coordinates = {"parameter": _texts(fitted), "suspect": _texts(s.name for s in screen)}
    attributes = {
        "Conventions": "CF-1.11",
        "verdict": diagnosis.verdict,
        "statement": diagnosis.statement,
        "null_band": diagnosis.null_band,
        "p_value": diagnosis.p_value,
        "finished": diagnosis.finished,
        "provenance": diagnosis.provenance,
    }
    return xr.Dataset(variables, coordinates, {name: attribute(value) for name, value in attributes.items()})


def _curves(trace: Trace) -> xr.Dataset:
    import xarray as xr

    kinds = {
        "measured": "as measured",
        "before": "predicted by the base model from each window's start",
        "after": "predicted by the extended model from each window's start",
        "from_rest_before": "simulated by the base model from rest",
        "from_rest_after": "simulated by the extended model from rest",
    }
    words = trace.channel.replace("_", " ")
    variables = {
        f"{trace.channel}_{kind}": (
            "time", getattr(trace, kind), {"units": trace.unit, "long_name": f"{words}, {text}"},
        )
        for kind, text in kinds.items()
        if getattr(trace, kind) is not None
    }  # fmt: skip
    return xr.Dataset(variables, {"time": ("time", trace.time, {"units": "s", "long_name": "time"})})


def _residuals(strip: Windows) -> xr.Dataset:
    import xarray as xr

    dimension = f"window_{strip.channel}"
    columns: Mapping[str, tuple[str, str]] = {
        "start": ("s", "start of the window"),
        "end": ("s", "end of the window"),
        "before": ("1", "rms residual of the base model over the noise"),
        "after": ("1", "rms residual of the extended model over the noise"),
    }
    return xr.Dataset(
        {
            f"{dimension}_{name}": (dimension, getattr(strip, name), {"units": unit, "long_name": text})
            for name, (unit, text) in columns.items()
        }
    )


def _joined(name: str, parts: list[xr.Dataset], diagnosis: Diagnosis) -> xr.Dataset:
    import xarray as xr

    group = xr.merge(parts, join="exact", compat="no_conflicts")
    horizon = diagnosis.prediction_horizon.get(name)
    if horizon is not None:
        group.attrs |= {"prediction_horizon_before_s": horizon[0], "prediction_horizon_after_s": horizon[1]}
    held = {t.recording for t in diagnosis.traces if t.held_out}
    held |= {w.recording for w in diagnosis.windows if w.held_out}
    group.attrs["recording"] = name
    group.attrs["held_out"] = "true" if name in held else "false"
    return group


def _texts(words: Any) -> np.ndarray:
    return np.array(list(words), dtype=object)
