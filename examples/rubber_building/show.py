"""Hold a specimen against recordings of the building: errors of every run, and the loops of the bearings.

python show.py SPECIMEN.toml RECORDING.nc ... [--figure loops.png]

Displacements are written as the laboratory made them if the specimen has [mechanisms.integrated_displacement]. Errors
are rms errors over the rms of the recording, at the recording's own samples: displacement of the slab above the
bearings, and absolute acceleration of all levels (a rigid body has one for all of them).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rocking


def error(found: np.ndarray, measured: np.ndarray) -> float:
    return float(np.sqrt(np.mean((found - measured) ** 2) / np.mean(measured**2)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("specimen", type=Path)
    parser.add_argument("recordings", type=Path, nargs="+")
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    figure, axes = plt.subplots(1, len(given.recordings), figsize=(4 * len(given.recordings), 3.6), squeeze=False)
    print(f"{'run':<10}{'displacement':>14}{'acceleration':>14}{'peak model/measured':>21}")
    for path, ax in zip(given.recordings, axes[0], strict=True):
        recording = rocking.read_recording(path)
        samples = recording.time.size
        ran = rocking.simulate(given.specimen, recording, duration=float(recording.time[-1]))
        x, a = (recording.channels[f"level_{what}_x"] for what in ("displacement", "acceleration"))
        slab = ran.level_displacement_x.values[0, :samples]
        levels = np.broadcast_to(ran.level_acceleration_x.values[:, :samples], a.shape)
        peaks = np.max(np.abs(slab)) / np.max(np.abs(x[0]))
        print(f"{path.stem:<10}{error(slab, x[0]):>14.3f}{error(levels, a):>14.3f}{peaks:>21.2f}")
        # base shear over the mass: the mean of equal levels' accelerations
        ax.plot(1e3 * x[0], -a.mean(axis=0), color="0.6", lw=0.8, label="measured")
        ax.plot(1e3 * slab, -levels.mean(axis=0), color="C3", lw=0.8, label="model")
        ax.set(title=path.stem, xlabel="slab displacement (mm)", ylabel="base shear/mass (m s$^{-2}$)")
    axes[0, 0].legend()
    figure.tight_layout()
    if given.figure:
        figure.savefig(given.figure, dpi=110)


if __name__ == "__main__":
    main()
