"""``cube.rocking``: maps and slices on an xarray Dataset that holds a cube."""

from __future__ import annotations

import json
from typing import Any

import xarray as xr

from study import maps


@xr.register_dataset_accessor("rocking")  # type: ignore[no-untyped-call]
class RockingAccessor:
    """Maps, slices and provenance of a cube; selections are keywords as in `study.selection`.

    >>> cube.rocking.overturning_map(x="aspect_ratio", y="top_mass", restitution=0.9)  # doctest: +SKIP
    >>> cube.rocking.slices("peak_rotation", x="top_mass", pga="0.3 g")  # doctest: +SKIP
    """

    def __init__(self, cube: xr.Dataset) -> None:
        self._cube = cube

    def overturning_map(
        self, x: str | None = None, y: str | None = None, *, nearest: bool = False, **at: Any
    ) -> xr.DataArray:
        """See `study.maps.overturning_map`; names with a dot go as ``**{"mechanism.parameter": 0.1}``."""
        return maps.overturning_map(self._cube, x, y, at, nearest=nearest)

    def onset_map(
        self, x: str | None = None, y: str | None = None, *, nearest: bool = False, **at: Any
    ) -> xr.DataArray:
        """See `study.maps.onset_map`."""
        return maps.onset_map(self._cube, x, y, at, nearest=nearest)

    def output_map(
        self, output: str, x: str | None = None, y: str | None = None, *, nearest: bool = False, **at: Any
    ) -> xr.DataArray:
        """See `study.maps.output_map`."""
        return maps.output_map(self._cube, output, x, y, at, nearest=nearest)

    def slices(self, output: str, x: str, *, nearest: bool = False, **at: Any) -> xr.DataArray:
        """See `study.maps.slices`."""
        return maps.slices(self._cube, output, x, at, nearest=nearest)

    @property
    def provenance(self) -> dict[str, Any]:
        """Plan, versions, commit, host, times and input hashes."""
        found: dict[str, Any] = json.loads(self._cube.attrs["provenance"])
        return found
