"""Readers of ground motion, one file each; adding one touches that file and `READERS`."""

from __future__ import annotations

from grids.motions.readers.at2 import AT2
from grids.motions.readers.base import Reader
from grids.motions.readers.csmip_v1 import CSMIP_V1
from grids.motions.readers.csv_toml import CSV
from grids.motions.readers.geonet_v2a import GEONET_V2A
from grids.motions.readers.netcdf import NETCDF
from grids.motions.readers.npz import NPZ

READERS: tuple[Reader, ...] = (AT2, GEONET_V2A, CSMIP_V1, NETCDF, NPZ, CSV)

__all__ = ["READERS", "Reader"]
