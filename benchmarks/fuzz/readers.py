"""Every reader: the file that is mutated, what lies beside it, and what an accepted input must satisfy."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import netCDF4
import numpy as np

from grids.law_table import law_text, read_law
from grids.motions import Motion, read_motion
from grids.plan import read_plan
from grids.recordings import Recording, read_recording
from grids.recordings.outcomes import read_outcomes
from grids.specimen import read_specimen
from models.mechanisms.table_force import MECHANISM, TABLES
from models.tables import KNOTS, SIDES, row
from study.manifest import Manifest
from study.open import open_study
from study.run import run
from study.seal import SIZE
from study.store import BlockStore
from tests.grids.motions.conftest import NORTH, UP, MotionFiles
from tests.study.plans import plan_text, small_plan

SHORT = slice(150, 450, 6)
PULSE = 'pulse = { shape = "sine", amplitude = "0.3 g", frequency = "2 Hz" }'
SPECIMEN = """title = "block"
model = "housner"
[parameters]
width = "0.25 m"
height = 1.1
mass = 120.0
[tolerance]
width = "2 mm"
height = 0.01
[calibrate]
restitution = [0.8, 1.0]
[motion]
vertical = false
[initial]
rotation_1 = 0.0
[mechanisms.pivot_inset]
inset_over_half_width = 0.05
[[mechanisms.pivot_inset.stages]]
recording = "shake_2"
begins = 4.21
ends = inf
"""
RECORDING = """time_step = "0.01 s"
title = "run"
[columns]
base_acceleration_x = { column = "acc", unit = "g", sign = -1 }
rotation_1 = { column = 2, unit = "mrad" }
"""
OUTCOMES = 'table = "runs.csv"\nrun = "run"\nmotion = "{file:0>3}.csv"\noverturned = "fell"\ngroup = "set"\n'
RUNS = "run,file,fell,set\n" + "".join(f"r{k},1,{k % 2},g{k % 3}\n" for k in range(8))


@dataclass(frozen=True)
class Reader:
    """``read(folder)`` reads ``file``, whose mutations start from ``seeds``; ``beside`` lies there unchanged.

    ``check(result)`` says what is wrong with an accepted input; ``share`` of the inputs of a campaign.
    """

    name: str
    file: str
    seeds: tuple[bytes, ...]
    read: Callable[[Path], Any]
    check: Callable[[Any], str] = lambda result: ""
    beside: Mapping[str, bytes] = field(default_factory=dict)
    binary: bool = False
    share: float = 1.0


def of_motion(motion: Motion) -> str:
    whole = all(np.all(np.isfinite(v)) for v in (motion.horizontal, motion.vertical) if v is not None)
    return "" if whole and 0.0 < motion.time_step < 10.0 else "a motion with samples or a step of no sense"


def of_recording(recording: Recording) -> str:
    whole = all(np.all(np.isfinite(v)) and v.shape[-1] == recording.time.size for v in recording.channels.values())
    return "" if whole and recording.time_step > 0.0 else "a recording with samples or a step of no sense"


def of_plan(plan: Any) -> str:
    values = [*plan.fixed.values(), plan.tail, plan.block_seconds]
    return "" if plan.grid.size > 0 and not any(np.isnan(v) for v in values) else "a plan with nan"


def of_law(law: Mapping[str, float]) -> str:
    return "" if all(np.isfinite(v) for v in law.values()) else "a law with values of no sense"


def unchanged(whole: Any, same: Callable[[Any, Any], bool]) -> Callable[[Any], str]:
    """Of sealed files: accepted only as they were written."""
    return lambda result: "" if result is None or same(result, whole) else "accepted although it has changed"


def readers() -> Iterator[Reader]:
    """All readers, those whose seeds take long to make last."""
    for group in (_motions, _recordings, _tables, _study):
        yield from group()


def _motions() -> list[Reader]:
    with TemporaryDirectory() as folder:
        write = MotionFiles(Path(folder))
        short = {"north": NORTH[SHORT], "up": UP[SHORT]}
        at2 = [write.at2("RSN1_a_000.AT2", short["north"], "000").read_bytes()]
        at2.append(write.at2("b.AT2", short["up"], "UP", header="   50   0.0100   NPTS, DT").read_bytes())
        v2a = write.v2a(components=(("N10E", short["north"]), ("Up", short["up"]))).read_bytes()
        v1 = write.v1(channels=(("90", short["north"]), ("Up", short["up"]))).read_bytes()
        npz = write.npz(q_sta_NS=short["north"], q_sta_UD=short["up"]).read_bytes()
        beside_npz = {"m.toml": Path(folder, "x.toml").read_bytes()}
        table = write.csv(
            rows=["t,n_cm,u_m", *(f"{k / 100},{v:.4f},{v / 2:.4f}" for k, v in enumerate(short["north"]))]
        )
        csv, layout = table.read_bytes(), table.with_suffix(".toml").read_bytes()
        files = _netcdf_files(Path(folder))
    return [
        Reader("motion AT2", "m.AT2", tuple(at2), lambda f: read_motion(f / "m.AT2"), of_motion, {"n.AT2": at2[1]}),
        Reader("motion V2A", "m.V2A", (v2a,), lambda f: read_motion(f / "m.V2A"), of_motion),
        Reader("motion V1", "m.V1", (v1,), lambda f: read_motion(f / "m.V1"), of_motion),
        Reader("motion CSV", "m.csv", (csv,), lambda f: read_motion(f / "m.csv"), of_motion, {"m.toml": layout}),
        Reader(
            "motion CSV, its TOML", "m.toml", (layout,), lambda f: read_motion(f / "m.csv"), of_motion, {"m.csv": csv},
        ),
        Reader(
            "motion npz", "m.npz", (npz,), lambda f: read_motion(f"{f / 'm.npz'}:q_sta_NS"), of_motion, beside_npz,
            binary=True,
        ),
        Reader("motion netCDF", "m.nc", files, lambda f: read_motion(f / "m.nc"), of_motion, binary=True, share=0.3),
    ]  # fmt: skip


def _netcdf_files(folder: Path) -> tuple[bytes, ...]:
    """Motions and recordings of every format of the library, and of types that no record has."""
    found = []
    path = folder / "seed.nc"
    for kind in ("NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF4_CLASSIC"):
        with netCDF4.Dataset(path, "w", format=kind) as data:
            data.createDimension("time", None if kind == "NETCDF4_CLASSIC" else 50)
            columns = {"time": np.arange(50) * 0.01, "base_acceleration_x": NORTH[SHORT], "rotation_1": UP[SHORT]}
            for name, values in columns.items():
                variable = data.createVariable(name, "f8", ("time",), **({"zlib": True} if kind == "NETCDF4" else {}))
                variable[:] = values
                variable.units = {"time": "s", "rotation_1": "rad"}.get(name, "m s-2")
        found.append(path.read_bytes())
    for units, dtype in (("g", "i2"), ("cm s-2", "f4"), ("", str)):
        with netCDF4.Dataset(path, "w") as data:
            data.createDimension("time", 50)
            data.createDimension("level", 2)
            data.createVariable("time", "f8", ("time",))[:] = np.arange(50) * 0.01
            variable = data.createVariable("acceleration_north", dtype, ("time",))
            variable[:] = np.array([str(k) for k in range(50)], object) if dtype is str else np.arange(50) % 7
            variable.units = units
            variable.scale_factor = "two" if units == "g" else 0.1
            data.createVariable("level_displacement_x", "f8", ("level", "time"))[:] = 1.0
        found.append(path.read_bytes())
    return tuple(found)


def _recordings() -> list[Reader]:
    csv = ("acc,rot\n" + "".join(f"{v:.5f},{v / 3:.5f}\n" for v in NORTH[SHORT])).encode()
    layout = RECORDING.encode()
    with TemporaryDirectory() as folder:
        files = _netcdf_files(Path(folder))

    def read(folder: Path) -> Recording:
        return read_recording(folder / "r.csv")

    return [
        Reader("recording CSV", "r.csv", (csv,), read, of_recording, {"r.toml": layout}),
        Reader("recording CSV, its TOML", "r.toml", (layout,), read, of_recording, {"r.csv": csv}),
        Reader(
            "recording netCDF", "r.nc", files, lambda f: read_recording(f / "r.nc"), of_recording, binary=True,
            share=0.3,
        ),
    ]  # fmt: skip


def _tables() -> list[Reader]:
    """Plans, specimens, laws, outcomes."""
    law = (
        MECHANISM.nulls
        | {"reach_rotation": 0.05}
        | {row("rotation", s, k): 0.004 * k for s in SIDES for k in range(KNOTS)}
    )
    table = law_text(law, TABLES).encode()
    plans = (plan_text(motion=PULSE), plan_text(motion=PULSE).replace("[outputs]", "[options]\n[outputs]"))
    motion = {"001.csv": b"t,a\n" + b"".join(b"%.2f,%.3f\n" % (k / 100, v) for k, v in enumerate(NORTH[SHORT]))}
    motion["001.toml"] = b'time_step = 0.01\n[columns]\nx = { column = "a", unit = "g" }\n'

    def outcomes(folder: Path) -> Any:
        return read_outcomes(folder / "o.toml")

    return [
        Reader(
            "plan", "p.toml", tuple(p.encode() for p in plans), lambda f: read_plan(f / "p.toml"), of_plan, share=0.5,
        ),
        Reader("specimen", "s.toml", (SPECIMEN.encode(),), lambda f: read_specimen(f / "s.toml")),
        Reader("law in a table", "law.csv", (table,), lambda f: read_law(f / "law.csv", TABLES), of_law),
        Reader(
            "outcomes", "o.toml", (OUTCOMES.encode(),), outcomes, share=0.5,
            beside={"runs.csv": RUNS.encode(), **motion},
        ),
        Reader(
            "outcomes, their table", "runs.csv", (RUNS.encode(),), outcomes, share=0.5,
            beside={"o.toml": OUTCOMES.encode(), **motion},
        ),
    ]  # fmt: skip


def _study() -> list[Reader]:
    """What a run writes, changed by a failing disk or by somebody."""
    with TemporaryDirectory() as results:
        folder = run(small_plan(motion=PULSE, tail="0.1 s"), results=results, scheduler="synchronous").folder
        manifest, cube = ((folder / name).read_bytes() for name in ("manifest.json", "cube.nc"))
        block = next((folder / "blocks").glob("*.nc"))
        stored, key = block.read_bytes(), block.stem
        whole = (Manifest.load(folder), open_study(folder), BlockStore(folder).read(key))
        shutil.rmtree(folder)

    def same_block(one: Any, other: Any) -> bool:
        equal = (np.array_equal(one[1][name], other[1][name], equal_nan=True) for name in other[1])
        return json.dumps(one[0]) == json.dumps(other[0]) and all(equal)

    return [  # the last two start a process an input
        Reader("manifest", "manifest.json", (manifest,), Manifest.load, unchanged(whole[0], lambda a, b: a == b)),
        Reader(
            "block", f"blocks/{key}.nc", (stored,), lambda f: BlockStore(f).read(key), unchanged(whole[2], same_block),
            binary=True,
        ),
        Reader(
            "cube", "cube.nc", (cube,), open_study, unchanged(whole[1], lambda a, b: a.identical(b)), binary=True,
            share=0.05,
        ),
        Reader("cube without its seal", "cube.nc", (cube[:-SIZE],), open_study, binary=True, share=0.02),
    ]  # fmt: skip
