"""Writers of small motion files in the formats that users bring, independent of the readers."""

from __future__ import annotations

from pathlib import Path

import netCDF4
import numpy as np
import pytest

STEP = 0.01
TIME = np.arange(600) * STEP
NORTH = 0.31 * np.sin(2 * np.pi * 1.7 * TIME) * np.exp(-(((TIME - 3.0) / 1.2) ** 2))
EAST = 0.22 * np.sin(2 * np.pi * 2.3 * TIME) * np.exp(-(((TIME - 2.5) / 1.0) ** 2))
UP = 0.15 * np.sin(2 * np.pi * 4.1 * TIME) * np.exp(-(((TIME - 2.0) / 0.8) ** 2))


class MotionFiles:
    """Writes into one folder; every method returns the path. Samples are given in the file's unit."""

    north, east, up, step = NORTH, EAST, UP, STEP

    def __init__(self, folder: Path):
        self.folder = folder

    def text(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def at2(self, name, values, component, *, npts=None, header=None, step=STEP, units="UNITS OF G"):
        count = len(values) if npts is None else npts
        head = header or f"NPTS=  {count:5d}, DT=   {step:.4f} SEC,"
        lines = ["PEER NGA STRONG MOTION DATABASE RECORD", f"Somewhere-01, 1/2/1990, A Station, {component}"]
        lines += [f"ACCELERATION TIME SERIES IN {units}", head]
        lines += ["".join(f"{v:15.7E}" for v in values[i : i + 5]) for i in range(0, len(values), 5)]
        return self.text(name, "\n".join(lines) + "\n")

    def at2_record(self, down=False):
        first = self.at2("RSN7_SOME_STA000.AT2", NORTH, "000")
        self.at2("RSN7_SOME_STA090.AT2", EAST[:-7], "090")
        self.at2(f"RSN7_SOME_STA{'DWN' if down else '-UP'}.AT2", -UP if down else UP, "DOWN" if down else "UP")
        return first

    def v2a(self, name="x.V2A", components=(("N10E", NORTH), ("N80W", EAST), ("Up", UP)), lie=0.0):
        def block(values):
            return ["".join(f"{v:8.1f}" for v in values[i : i + 10]) for i in range(0, len(values), 10)]

        lines = []
        for component, g in components:
            values = 9806.65 * g
            text = [f"Corrected accelerogram text {i}" for i in range(16)]
            text[12] = f"Component {component}  Accelerometer Axis"
            text[13] = f"Acceleration:  peak {np.max(np.abs(values)) + lie:8.1f} mm/s/s at  3.00 sec  rms 1.0 mm/s/s"
            integers, reals = np.zeros(40, int), np.zeros(60)
            integers[33:36] = len(values)
            reals[25] = STEP
            lines += text + ["".join(f"{i:8d}" for i in integers[r : r + 10]) for r in range(0, 40, 10)]
            lines += ["".join(f"{x:8.4f}" for x in reals[r : r + 10]) for r in range(0, 60, 10)]
            lines += block(values) * 3
        return self.text(name, "\n".join(lines) + "\n")

    def v1(self, name="x.V1", channels=(("90", EAST), ("360", NORTH), ("Up", UP)), unit="g"):
        lines = []
        for number, (component, values) in enumerate(channels, 1):
            lines += ["Uncorrected Accelerogram Data", "Rcrd of some day", "", "", "", "A Station"]
            lines += [f"Chan  {number}: {component:>3} Deg", " -999 -999"]
            lines += [f" {len(values)} Accelerogram points at 100 pts/sec in units of {unit}.  Format: (8f9.6)"]
            lines += ["".join(f"{v:9.6f}" for v in values[i : i + 8]) for i in range(0, len(values), 8)]
            lines += [f"/&  ----------  End of Data for Station Channel   {number}  ----------"]
        return self.text(name, "\n".join(lines) + "\n")

    def netcdf(self, name="x.nc", variables=None, times=TIME, units="m s-2", time_units="s"):
        path = self.folder / name
        chosen = {"acceleration_north": NORTH, "acceleration_up": UP} if variables is None else variables
        with netCDF4.Dataset(path, "w") as data:
            data.createDimension("time", len(times))
            for key, values in {"time": times, **chosen}.items():
                variable = data.createVariable(key, "f8", ("time",))
                variable[:] = values
                if stated := (time_units if key == "time" else units):
                    variable.units = stated
        return path

    def npz(self, name="x.npz", toml='time_step = "0.01 s"\nunit = "g"\n', **arrays):
        path = self.folder / name
        np.savez(path, **(arrays or {"q_sta_NS": NORTH, "q_sta_EW": EAST, "q_sta_UD": UP}))
        if toml:
            path.with_suffix(".toml").write_text(toml)
        return path

    def csv(self, name="x.csv", toml=None, rows=None):
        table = np.column_stack([TIME, 100 * NORTH, UP])
        lines = rows or ["t,n_cm,u_m", *(",".join(f"{v:.9e}" for v in row) for row in table)]
        path = self.text(name, "\n".join(lines) + "\n")
        self.text(
            Path(name).with_suffix(".toml").name,
            toml
            or 'time = { column = "t", unit = "s" }\n[columns]\n'
            'north = { column = "n_cm", unit = "cm/s2", sign = -1 }\n'
            'up = { column = 3, unit = "m/s2" }\n',
        )
        return path


@pytest.fixture
def files(tmp_path):
    return MotionFiles(tmp_path)
