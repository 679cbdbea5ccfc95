"""Fit what a specimen leaves to be calibrated to some runs of the building by least squares; the errors of all runs.

python least_squares.py SPECIMEN.toml RUN.nc RUN.nc --left-out RUN.nc [--levels 6] [--high-pass 0.134]

The sum over the runs of (rms error over the rms of the recording)^2 is least, of the displacement of the slab and, with
storeys, of the accelerations of all levels too. Numbers are searched on a logarithmic scale from the middle of their
ranges. ``--levels``: storeys in the place of the rigid body, whose stiffness and dashpot are fitted, with all else that
the specimen holds (the laws of an answer's extended.toml) as it is. ``--high-pass``: corner (Hz) of the filter that the
displacements went through, where the specimen does not hold it.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from show import error

import rocking

FILTER = "integrated_displacement"
STOREYS = {"storey_stiffness": (50.0, 5000.0), "storey_damping": (0.05, 20.0)}
"""Ranges, N/m and N s/m for each kg of the building."""
BEARINGS = {"bearing_stiffness": (1.0, 60.0), "bearing_damping": (0.05, 5.0)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("specimen", type=Path)
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--left-out", type=Path, nargs="*", default=[])
    parser.add_argument("--levels", type=int, default=1)
    parser.add_argument("--high-pass", type=float, default=0.134)
    given = parser.parse_args()
    specimen = rocking.read_specimen(given.specimen)
    ranges = BEARINGS | (STOREYS if given.levels > 1 else {})
    mechanisms = {FILTER: {"high_pass_hz": given.high_pass}} | dict(specimen.mechanisms)
    known = {**specimen.parameters, "levels": float(given.levels)}
    runs = {path.stem: rocking.read_recording(path) for path in (*given.runs, *given.left_out)}

    def simulated(u: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of the slab and accelerations of all levels."""
        parameters = {**known, **dict(zip(ranges, np.exp(u), strict=True))}
        one, recording = replace(specimen, parameters=parameters, calibrate={}, mechanisms=mechanisms), runs[name]
        ran = rocking.simulate(one, recording, duration=float(recording.time[-1]))
        samples, measured = recording.time.size, recording.channels["level_acceleration_x"]
        levels = np.broadcast_to(ran.level_acceleration_x.values[:, :samples], measured.shape)
        return ran.level_displacement_x.values[0, :samples], levels

    def measured(name: str) -> tuple[np.ndarray, np.ndarray]:
        channels = runs[name].channels
        return channels["level_displacement_x"][0], channels["level_acceleration_x"]

    def residuals(u: np.ndarray) -> np.ndarray:
        found = []
        for path in given.runs:
            pairs = list(zip(simulated(u, path.stem), measured(path.stem), strict=True))
            compared = pairs if given.levels > 1 else pairs[:1]
            found += [((one - seen) / np.sqrt(np.sum(seen**2))).ravel() for one, seen in compared]
        return np.concatenate(found)

    ends = np.log(np.array(list(ranges.values())))
    start = ends.mean(axis=1)
    fitted = least_squares(residuals, start, bounds=tuple(ends.T), diff_step=1e-3, x_scale=0.1)
    print(", ".join(f"{name} {value:.4g}" for name, value in zip(ranges, np.exp(fitted.x), strict=True)))
    print(f"{'run':<10}{'displacement':>14}{'acceleration':>14}")
    for name in runs:
        errors = [error(one, seen) for one, seen in zip(simulated(fitted.x, name), measured(name), strict=True)]
        print(f"{name:<10}{errors[0]:>14.3f}{errors[1]:>14.3f}")


if __name__ == "__main__":
    main()
