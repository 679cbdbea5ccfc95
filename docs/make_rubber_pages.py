"""Figures and tables of the pages on the rubber study and the rubber laws, read from their cubes.

    rocking run studies/rubber_interface.toml
    rocking run studies/rubber_locking.toml
    rocking run studies/rubber_laws.toml
    python docs/make_rubber_pages.py [RESULTS]

Writes ``docs/_static/rubber_*.png`` and ``docs/tables/rubber_*.md``.
"""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from rubber_locking import rubber_locking
from rubber_tables import (
    FIGURES,
    HEAVY,
    MODERATE,
    SHAPE,
    SHORT,
    STUDIES,
    first_overturning,
    found_onset,
    median_over,
    predicted_onset,
    rigid_onset,
    spectrum_numbers,
    standing_again,
    table,
    write,
)

from grids.plan import read_plan
from models import get
from study.figures import plot_onset_map, plot_overturning_map, plot_slices, save_figure
from study.figures.style import COLOURS, set_log_ticks
from study.open import open_study
from study.status import OVERTURNED, ROCKING
from study.wording import GRAVITY

WORDS = {
    "linear": "linear",
    "hardening": "hardening",
    "maxwell": "Maxwell",
    "bouc_wen": "Bouc-Wen",
    "mullins": "Mullins",
}


def plot_prediction(found: xr.DataArray, predicted: xr.DataArray, step: float) -> Axes:
    """Every wall by both; ``step``: the factor from one PGA of the grid to the next."""
    ax = plt.figure(figsize=(6.4, 4.6), layout="constrained").add_subplot()
    wide = np.broadcast_to(found["aspect_ratio"].values[:, None, None, None], found.shape)
    # the grid rounds up: spread each level over its step, or points hide each other
    spread = found.values / GRAVITY * step ** -np.random.default_rng(0).uniform(0.0, 1.0, found.shape)
    dots = ax.scatter(
        predicted.values.ravel() / GRAVITY, spread.ravel(), c=wide.ravel(), s=5, cmap="cividis", linewidths=0
    )
    limits = (0.025, 0.3)
    ax.plot(limits, limits, color=COLOURS[1], linewidth=1.0, label="equal")
    for which, scale in (("x", ax.set_xscale), ("y", ax.set_yscale)):
        scale("log")
        set_log_ticks(ax.xaxis if which == "x" else ax.yaxis)
    ax.set(xlim=limits, ylim=limits, aspect="equal")
    ax.set_xlabel("from the response spectrum [g]")
    ax.set_ylabel("PGA that lifts a joint, study [g]")
    ax.legend(frameon=False)
    ax.grid(alpha=0.3)
    ax.figure.colorbar(dots, ax=ax, label="aspect ratio")
    return ax


def rubber_figures(cube: xr.Dataset) -> None:
    found, predicted = found_onset(cube).transpose(*SHAPE), predicted_onset(cube).transpose(*SHAPE)
    step = float((cube["pga"][-1] / cube["pga"][0]) ** (1 / (cube["pga"].size - 1)))
    draw = {
        "rubber_onset": partial(plot_onset_map, cube, "aspect_ratio", "layer_modulus", HEAVY),
        "rubber_capacity": partial(plot_overturning_map, cube, "aspect_ratio", "layer_modulus", HEAVY),
        "rubber_overturning": partial(plot_overturning_map, cube, "layer_modulus", "pga", SHORT),
        "rubber_overturning_damping": partial(
            plot_overturning_map, cube, "layer_modulus", "damping_ratio", {"aspect_ratio": 0.4, "top_mass": 5000.0}
        ),
        "rubber_uplift": partial(plot_slices, cube, "uplift_duration", "layer_modulus", {**HEAVY, **MODERATE}),
        "rubber_spectrum": partial(plot_prediction, found, predicted, step),
    }
    for name, figure in draw.items():
        save_figure(figure, FIGURES / f"{name}.png")


def rubber_interface(cube: xr.Dataset) -> None:
    rubber_figures(cube)
    status = cube["status"]
    over, never = status == OVERTURNED, status < ROCKING
    cells = status.size // status.sizes["aspect_ratio"]
    aspects = [f"{value:.2f}" for value in cube["aspect_ratio"].values]
    others = [d for d in status.dims if d != "aspect_ratio"]
    first, rigid = first_overturning(cube), rigid_onset(cube) / GRAVITY
    lifting = found_onset(cube) / GRAVITY
    medians = (
        ("rigid wall begins to rock [g]", rigid.broadcast_like(first), ".2f"),
        ("a joint lifts [g]", lifting.fillna(0.0), ".3g"),
        ("overturns [g]", first, ".3g"),
        ("overturns, over the rigid wall's rocking", first / rigid, ".1f"),
    )
    counts = table(
        ["aspect ratio", *aspects],
        [
            *(
                [f"cells: {word}", *(f"{100 * n / cells:.1f} %" for n in where.sum(others).values)]
                for word, where in (("no joint lifts", never), ("overturns", over))
            ),
            *(
                [f"median PGA: {word}", *(f"{v:{form}}" for v in values.median(SHAPE[1:]).values)]
                for word, values, form in medians
            ),
        ],
    )
    moduli = cube["layer_modulus"].values
    heads = [f"{value / 1e6:.3g} MPa" for value in moduli]
    some = cube["aspect_ratio"].values[::2]
    heavy = cube.sel(**HEAVY, method="nearest")
    onset = cube.rocking.onset_map(x="layer_modulus", y="aspect_ratio", **HEAVY) / GRAVITY
    lowest = float(cube["pga"].min()) / GRAVITY
    lifts = table(
        ["aspect ratio", *heads],
        [
            [f"{a:.1f}", *(("≤ " if v <= lowest else "") + f"{v:.3g}" for v in onset.sel(aspect_ratio=a).values)]
            for a in some
        ],
    )
    peak = (1e3 * heavy["peak_rotation"].where(heavy["status"] != OVERTURNED)).sel(**MODERATE, method="nearest")
    peaks = table(
        ["aspect ratio", *heads],
        [
            [f"{a:.1f}", *("overturns" if np.isnan(v) else f"{v:.1f}" for v in peak.sel(aspect_ratio=a).values)]
            for a in some
        ],
    )
    capacity = "\n".join(
        table(
            ["aspect ratio", *(f"{factor * v:.3g} {unit}" for v in first[axis].values)],
            [[f"{a:.1f}", *median_over(first, axis, a)] for a in some],
        )
        for axis, factor, unit in (
            ("damping_ratio", 100.0, "% damping"),
            ("top_mass", 1e-3, "t on top"),
            ("layer_modulus", 1e-6, "MPa"),
        )
    )
    spectrum = table(
        [
            "walls that lift above the lowest PGA",
            "correlation of the logarithms",
            "study over spectrum: 5 %",
            "median",
            "95 %",
        ],
        [spectrum_numbers(cube)],
    )
    islands = table(
        ["walls", "overturn at some PGA", "of these: stand again at a higher PGA of the grid"],
        [[first.size, *standing_again(cube)]],
    )
    for name, text in (
        ("counts", counts), ("lifts", lifts), ("peaks", peaks), ("capacity", capacity), ("spectrum", spectrum),
        ("islands", islands),
    ):  # fmt: skip
        write(f"rubber_{name}", text)


def plot_law_onsets(onset: xr.DataArray) -> Axes:
    ax = plt.figure(figsize=(6.4, 4.0), layout="constrained").add_subplot()
    for k, name in enumerate(onset["rubber_law"].values):
        values = onset.sel(rubber_law=name)
        ax.plot(values["layer_modulus"] / 1e6, values, "osD^v"[k] + "-", color=COLOURS[k], label=WORDS[name])
    ax.set_xscale("log")
    set_log_ticks(ax.xaxis)
    ax.set_ylim(0.0)
    ax.set_xlabel("unstressed layer modulus [MPa]")
    ax.set_ylabel("PGA at which a joint lifts [g]")
    ax.legend(frameon=False)
    ax.grid(alpha=0.3)
    return ax


def rubber_laws(cube: xr.Dataset) -> None:
    onset = cube.rocking.onset_map(x="layer_modulus", y="rubber_law") / GRAVITY
    save_figure(partial(plot_law_onsets, onset), FIGURES / "rubber_laws_onset.png")
    at = {"layer_modulus": 4e6}
    save_figure(partial(plot_slices, cube, "peak_rotation", "pga", at), FIGURES / "rubber_laws_peak.png")
    moduli = cube["layer_modulus"].values[::2]
    fixed = read_plan(STUDIES / "rubber_laws.toml").fixed
    peak = cube["peak_rotation"].where(cube["status"] != OVERTURNED)
    strong = peak.where(cube["pga"] > 0.2 * GRAVITY)
    lift = cube["uplift_duration"].sel(pga=0.34 * GRAVITY, method="nearest")
    rows = []
    for name in WORDS:
        own = {key: value for key, value in fixed.items() if "." not in key or key.startswith(f"{name}.")}
        compressed = 1e3 * get("interface").derive({**own, "layer_modulus": moduli})["static_compression_base"]
        ratio = (strong / strong.sel(rubber_law="linear")).sel(rubber_law=name).values
        low, middle, high = np.nanquantile(ratio, [0.1, 0.5, 0.9])
        rows.append(
            [
                WORDS[name],
                *(f"{u:.2f}" for u in compressed),
                *(f"{v:.2f}" for v in onset.sel(rubber_law=name).values[::2]),
                *(f"{v:.1f}" for v in lift.sel(rubber_law=name).values[::2]),
                "1" if name == "linear" else f"{middle:.2f} ({low:.2f} to {high:.2f})",
            ]
        )
    heads = [f"{e / 1e6:.0f}" for e in moduli]
    first = len(heads)

    def part(start: int, stop: int) -> str:
        return table(["law, MPa", *heads], [[row[0], *row[start:stop]] for row in rows])

    write("rubber_laws_compression", part(1, 1 + first))
    write("rubber_laws_lifts", part(1 + first, 1 + 2 * first))
    write("rubber_laws_uplift", part(1 + 2 * first, 1 + 3 * first))
    write(
        "rubber_laws_peaks",
        table(
            ["law", "peak rotation over the linear layer's: median (10 to 90 %)"], [[row[0], row[-1]] for row in rows]
        ),
    )


def main(results: Path) -> None:
    interface = open_study(results / "rubber_interface")
    rubber_interface(interface)
    rubber_locking(interface, open_study(results / "rubber_locking"))
    rubber_laws(open_study(results / "rubber_laws"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
