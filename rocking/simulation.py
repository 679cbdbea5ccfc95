"""Simulate one specimen under a motion, a recording's base motion, or none."""

from __future__ import annotations

import math
from os.path import isfile  # False for the words of a pulse, which are too long for a file
from pathlib import Path
from typing import TYPE_CHECKING

from models.errors import InputError
from models.shaking import Shaking

if TYPE_CHECKING:
    import xarray as xr

    from grids.motions import Motion
    from grids.recordings import Recording
    from grids.specimen import Specimen

FREE_TIME_STEP = 1e-3
"""s, step of a history without shaking."""
LARGEST_SCALE = 1e6


def simulate(
    specimen: Specimen | str | Path,
    motion: Motion | Recording | str | Path | None = None,
    *,
    duration: float | str | None = None,
    integrator: str = "lanes",
    component: str | None = None,
    scale: float = 1.0,
) -> xr.Dataset:
    """History of a specimen: every observable over ``time``, events over ``event``.

    ``specimen`` and ``motion`` are what the readers return, or what they read: a specimen file; a
    shipped motion, a motion file, or a recording, whose measured base motion is used. Of arrays make a
    motion, ``rocking.Motion("name", time_step, horizontal)`` in s and m s-2, with ``vertical`` if need be. Without a
    motion, ``duration`` (in s, or "3 s") of free motion from the specimen's initial state. The specimen
    says whether the vertical component acts (default: the model's). Its instruments act on what is
    written; the motion is then what the accelerometers of the base read. Mechanisms with stages act as
    they say for a recording of that name. Channels at positions on the bodies are those of the specimen and of a
    recording. Raises InputError.
    """
    from grids.arrays import real_number
    from grids.given import specimen_of
    from grids.recordings import Recording
    from grids.recordings.checked import checked
    from grids.units import to_si
    from study.history import simulate_specimen

    specimen = specimen_of(specimen)
    if duration is not None:
        length = to_si(duration, "s", "duration") if isinstance(duration, str) else real_number(duration)
        if length is None or not 0.0 < length < math.inf:
            raise InputError(f"duration is {duration!r} s: give a positive time")
        duration = length
    factor = real_number(scale)
    if factor is None:
        raise InputError(f"scale is {scale!r}: give a number, the factor on the motion")
    scale = factor
    if scale == 0.0:
        raise InputError("scale 0 leaves no motion; for free motion leave the motion out and give a duration")
    if not abs(scale) <= LARGEST_SCALE:
        raise InputError(f"scale is {scale!r}: give a factor on the motion, at most {LARGEST_SCALE:g}")
    if motion is None:
        if component is not None or scale != 1.0:
            acting = "a component" if component is not None else "a scale"
            raise InputError(f"{acting} without a motion has no effect: name the motion, or leave it out")
        if duration is None:
            raise InputError("no motion and no duration: name a motion, or give the time of free motion in s")
        _check_steps(duration, FREE_TIME_STEP)
        shaking = Shaking.silence(duration, FREE_TIME_STEP)
    else:
        if isinstance(motion, str | Path):
            motion = recording_of(motion) or motion
        elif isinstance(motion, Recording):
            motion = checked(motion)
        shaking = _shaking(specimen, motion, component)
        if duration is not None:
            _check_steps(duration, shaking.time_step)
    name = motion.name if isinstance(motion, Recording) else None
    places = motion.places if isinstance(motion, Recording) else None
    return simulate_specimen(
        specimen, shaking, scale=scale, duration=duration, integrator=integrator, recording=name, places=places
    )


def _check_steps(duration: float, step: float) -> None:
    from models.lanes.record import MOST_STEPS

    if not 1.0 <= duration / step <= MOST_STEPS:
        raise InputError(
            f"duration is {duration:g} s: give from {step:g} s (one step of the motion) to {MOST_STEPS * step:g} s"
        )


def _shaking(specimen: Specimen, motion: Motion | Recording | str | Path, component: str | None) -> Shaking:
    import models
    from grids.motions import Motion, read_motion
    from grids.recordings import Recording

    model = models.get(specimen.model)
    vertical = specimen.vertical
    acts = "vertical_acceleration" not in specimen.mechanisms
    if not acts:
        # the mechanism applies the vertical motion that the base model leaves out
        if vertical:
            raise InputError(
                "[mechanisms.vertical_acceleration] stands for a vertical motion that is left out; "
                "set [motion] vertical = false or leave the mechanism out."
            )
        vertical = True
    if isinstance(motion, Recording):
        if component is not None:
            raise InputError(f"recording {motion.name}: its base motion has one component: leave '{component}' out")
        if vertical is None:
            vertical = model.vertical_by_default and "base_acceleration_z" in motion.channels
        return motion.shaking(vertical, vertical_acts=acts)
    if component is not None and isinstance(motion, Motion):
        raise InputError(f"motion {motion.name} was read with its component: leave '{component}' out, or name the file")
    if not isinstance(motion, Motion):
        wanted = vertical if vertical is not None or model.vertical_by_default else False
        motion = read_motion(motion, component=component, vertical=wanted)
    use = model.vertical_by_default if vertical is None else vertical
    return (motion if use else motion.without_vertical()).shaking(vertical_acts=acts)


def recording_of(motion: str | Path) -> Recording | None:
    """The motion of the base of a recording, found where motions are; None of what is no recording."""
    from grids.motions.locate import locate
    from grids.motions.made import parse_made
    from grids.recordings import read_recording

    if parse_made(str(motion)) is not None:  # a text of any length, which may be none as the name of a file
        return None
    path = Path(motion)
    if not isfile(path):
        try:
            path = locate(str(motion))[0]
        except InputError:
            return None  # the motion reader says what was looked for, or makes the motion
    return read_recording(path, base_only=True) if is_recording(path) else None


def is_recording(path: Path) -> bool:
    """Whether a file holds the measured base motion under its standard name."""
    from grids.files import read_text
    from grids.netcdf_file import read_netcdf
    from grids.recordings import csv_toml, netcdf
    from grids.recordings.base import REQUIRED

    ending = path.suffix.lower()
    if ending in (*csv_toml.SUFFIXES, ".toml"):
        beside = path.with_suffix(".toml")
        return beside.is_file() and REQUIRED in read_text(beside, "the description of the columns")
    if ending not in netcdf.SUFFIXES or not path.is_file():
        return False
    try:
        return REQUIRED in read_netcdf(path).variables
    except InputError:
        return False  # the motion reader says what is wrong with the file
