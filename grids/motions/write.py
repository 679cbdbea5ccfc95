"""A motion as netCDF, which `read_motion` reads back to the same samples."""

from __future__ import annotations

import os
import re
from pathlib import Path
from tempfile import NamedTemporaryFile

from grids.motions.base import FloatArray, Motion
from grids.netcdf_lock import NETCDF_LOCK
from grids.writer import WRITTEN
from models.errors import InputError


def write_motion(motion: Motion, path: Path | str) -> Path:
    """Write ``acceleration_<component>`` and ``acceleration_up`` (m s-2) over ``time`` (s); zlib, CF-1.11.

    The file appears whole or not at all; one of the same name is replaced. Raises InputError.
    """
    import netCDF4

    target = Path(path)
    if target.suffix != ".nc":
        raise InputError(f"{target}: a motion is written as netCDF: give a name that ends with .nc")
    if not target.parent.is_dir():
        raise InputError(f"{target}: the folder {target.parent} does not exist: make it first")
    horizontal = re.sub(r"\W", "_", motion.components.get("horizontal", "horizontal"))
    channels: dict[str, tuple[FloatArray, str]] = {
        "time": (motion.time, "time"),
        f"acceleration_{horizontal}": (motion.horizontal, f"ground acceleration, {horizontal}"),
    }
    if motion.vertical is not None:
        channels["acceleration_up"] = motion.vertical, "ground acceleration, up"
    with NamedTemporaryFile(dir=target.parent, prefix=f".{target.stem}-", suffix=".nc", delete=False) as file:
        hidden = Path(file.name)
    try:
        with NETCDF_LOCK, netCDF4.Dataset(hidden, "w", format="NETCDF4") as data:
            data.createDimension("time", motion.horizontal.size)
            for name, (values, meaning) in channels.items():
                variable = data.createVariable(name, "f8", ("time",), zlib=True, complevel=5, shuffle=True)
                variable.units = "s" if name == "time" else "m s-2"
                variable.long_name = meaning
                variable[:] = values
            data.setncatts(_attributes(motion))
        os.replace(hidden, target)
    finally:
        hidden.unlink(missing_ok=True)
    return target


def _attributes(motion: Motion) -> dict[str, str]:
    """Global attributes: what the source states, and what was done."""
    stated = {k: str(v) for k, v in motion.source.items() if k in ("title", "license", "processing") and v}
    stated.setdefault("title", motion.name)
    if "licence" in motion.source:
        stated["license"] = str(motion.source["licence"])
    files = ", ".join(motion.source.get("files", ()))
    source = "; ".join(str(p) for p in (motion.source.get("source"), motion.source.get("format"), files) if p)
    done = "; ".join(motion.notes)
    return {
        "Conventions": "CF-1.11",
        **stated,
        "source": source,
        "history": WRITTEN,
        "notes": done,
        "fingerprint": motion.fingerprint,
    }
