"""The cube: blocks streamed into one labelled netCDF file (CF-1.11).

Memory holds one block at a time. The file is written beside its place and put there in one step.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import models
from grids.entering import entering
from grids.netcdf_lock import NETCDF_LOCK, bounded_cache
from grids.plan import Plan
from models.base import MISSING, Quantity
from study.derived import derived_coordinates
from study.keys import Setting
from study.labels import Coordinate, axis_coordinates, describe, motion_coordinates
from study.manifest import Manifest
from study.provenance import as_json, attribute, commit, machine, now, sha256, source, versions
from study.refined import COMPUTED, Refined
from study.seal import seal
from study.status import FAILED, NOT_RUN
from study.store import COMPRESSION, BlockStore, DamagedBlock, write_whole

CHUNK_CELLS = 1 << 17
"""Cells in a chunk of the file, whatever the blocks were."""


def write_cube(
    plan: Plan,
    setting: Setting,
    manifest: Manifest,
    store: BlockStore,
    *,
    started: str,
    scheduler: str,
    refined: Refined | None = None,
) -> Path:
    """Write ``cube.nc`` from the finished blocks; cells of other blocks are flagged in ``status``.

    Of a ``refined`` study the values are its own, with the flag `computed` and the estimate of wrong cells in the
    attribute `refinement`. The file is sealed as ``cube.nc``. Raises DamagedBlock when a block's file is not what was
    written.
    """
    path = store.folder / "cube.nc"
    attributes = _attributes(plan, setting, path, started, scheduler)

    def write(temporary: Path) -> None:
        import netCDF4

        with NETCDF_LOCK, bounded_cache(), netCDF4.Dataset(temporary, "w") as dataset:
            dataset.setncatts({name: attribute(value) for name, value in attributes.items()})
            outputs = _define(dataset, plan, setting, [COMPUTED] if refined else [])
            if refined is None:
                _fill(dataset, outputs, plan, setting, manifest, store)
            else:
                dataset.refinement = as_json(refined.record())
                _fill_refined(dataset, outputs, plan, refined)
        seal(temporary, path.name)

    write_whole(path, write)
    return path


def _define(dataset: Any, plan: Plan, setting: Setting, more: Sequence[Quantity]) -> list[Quantity]:
    """Dimensions, coordinates and empty outputs; returns the outputs in their order."""
    model = models.get(setting.model)
    for axis in plan.axes:
        dataset.createDimension(axis.name, axis.size)
    coordinates = {c.name: c for c in derived_coordinates(plan, model)}
    coordinates |= {c.name: c for c in [*motion_coordinates(plan), *axis_coordinates(plan, model)]}
    dims = tuple(axis.name for axis in plan.axes)
    for coordinate in coordinates.values():
        _write_coordinate(dataset, coordinate)
    auxiliary = " ".join(name for name in coordinates if name not in dims)
    declared = {quantity.name: quantity for quantity in model.outputs}
    outputs = [*(declared[name] for name in setting.outputs), *more]
    chunk = _chunk(plan.grid.shape)
    for quantity in outputs:
        dtype = _dtype(quantity)
        variable = dataset.createVariable(
            quantity.name,
            dtype,
            dims,
            fill_value=_missing(quantity),
            chunksizes=chunk or None,
            **COMPRESSION,
        )
        variable.setncatts({name: attribute(value) for name, value in describe(quantity).items()})
        variable.coordinates = auxiliary
        if quantity.name != "status":
            variable.ancillary_variables = "status"
    return outputs


def _write_coordinate(dataset: Any, coordinate: Coordinate) -> None:
    values = coordinate.values
    words = values.dtype.kind in "OUS"
    variable = dataset.createVariable(coordinate.name, str if words else values.dtype, coordinate.dims)
    variable.setncatts({name: attribute(value) for name, value in coordinate.attributes.items()})
    if words and not coordinate.dims:
        variable[...] = str(values[()])
    else:
        variable[...] = np.array([str(v) for v in values.tolist()], dtype=object) if words else values


def _chunk(shape: Sequence[int]) -> list[int]:
    """Shape of a chunk of the file: the last axes whole, at most CHUNK_CELLS."""
    chunk, room = [], CHUNK_CELLS
    for size in reversed(shape):
        chunk.append(max(1, min(size, room)))
        room //= chunk[-1]
    return chunk[::-1]


def _dtype(quantity: Quantity) -> np.dtype[Any]:
    return np.dtype("int8" if quantity.dtype == "bool" else quantity.dtype)


def _missing(quantity: Quantity) -> Any:
    """Fill value of cells without a result; ``status`` has none, for every cell has one."""
    if quantity.name == "status":
        return False
    return np.nan if _dtype(quantity).kind == "f" else MISSING


def _fill(
    dataset: Any,
    outputs: Iterable[Quantity],
    plan: Plan,
    setting: Setting,
    manifest: Manifest,
    store: BlockStore,
) -> None:
    dataset.set_auto_mask(False)
    finished, failed = store.finished(), store.failures().keys()
    for key, block in manifest.blocks.items():
        places = plan.grid.positions(block)
        axes, done = store.read(key) if key in finished else ({}, {})
        if done and axes != dict(block.coordinates):
            raise DamagedBlock(f"{store.folder}: block {key} holds other cells than manifest.json says: run again")
        for quantity in outputs:
            values = done.get(quantity.name)
            if values is None:
                flag = FAILED if key in failed else NOT_RUN
                value = flag if quantity.name == "status" else _missing(quantity)
                values = np.full([len(p) for p in places], value, _dtype(quantity))
            _put(dataset[quantity.name], places, values)


def _fill_refined(dataset: Any, outputs: Iterable[Quantity], plan: Plan, refined: Refined) -> None:
    dataset.set_auto_mask(False)
    for quantity in outputs:
        values = refined.values(quantity, _missing(quantity), _dtype(quantity))
        dataset[quantity.name][...] = values.reshape(plan.grid.shape)


def _put(variable: Any, places: Sequence[NDArray[np.int64]], values: NDArray[Any]) -> None:
    """Write a block at its positions, one hyperslab per combination of neighbouring positions."""
    if not places:
        variable[...] = values
        return
    for runs in product(*(list(_runs(place)) for place in places)):
        starts = [int(place[a]) for place, (a, _) in zip(places, runs, strict=True)]
        target = tuple(slice(start, start + b - a) for start, (a, b) in zip(starts, runs, strict=True))
        variable[target] = values[tuple(slice(a, b) for a, b in runs)]


def _runs(place: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Ranges of positions that ascend by one."""
    breaks = np.flatnonzero(np.diff(place) != 1) + 1
    yield from pairwise([0, *breaks.tolist(), place.size])


def _attributes(plan: Plan, setting: Setting, path: Path, started: str, scheduler: str) -> dict[str, Any]:
    """The global attributes: provenance stands here and nowhere else."""
    model = models.get(setting.model)
    inputs = {
        motion.name: {
            "fingerprint": motion.fingerprint,
            "pga": motion.pga,
            "components": motion.components,
            "notes": motion.notes,
            **motion.source,
        }
        for motion in plan.motions
    }
    entries = entering(plan)
    provenance = {
        "plan": plan.text,
        "plan_sha256": sha256(plan.text),
        "setting": setting.record(),
        "values": {e.name: {"value": e.value, "unit": e.unit, "source": e.source} for e in entries},
        "inputs": inputs,
        "versions": versions(),
        "commit": commit(),
        "started": started,
        "finished": now(),
        "scheduler": scheduler,
        **machine(),
    }
    return {
        "Conventions": "CF-1.11",
        "title": f"{plan.name}: {model.title}",
        "source": f"{source()}, model {setting.model} {setting.version}",
        "model": setting.model,
        "fixed_values": "; ".join(map(str, entries)),
        "history": "\n".join([*_old_history(path), f"{now()} rocking run {plan.name}"]),
        "provenance": as_json(provenance),
    }


def _old_history(path: Path) -> list[str]:
    """History lines of the cube that is about to be replaced."""
    if not path.exists():
        return []
    import netCDF4

    try:
        with NETCDF_LOCK, netCDF4.Dataset(path) as dataset:
            return str(dataset.history).splitlines()
    except (OSError, AttributeError):
        return []
