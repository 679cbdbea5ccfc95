"""Figures and tables of the pages on the rubber study and the rubber laws, read from their cubes.

    rocking run studies/rubber_interface.toml
    rocking run studies/rubber_locking.toml
    rocking run studies/rubber_laws.toml
    python docs/make_rubber_pages.py [RESULTS]

Writes ``docs/_static/rubber_*.png`` and ``docs/tables/rubber_*.md``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from grids.motions.spectrum import response_spectrum
from grids.plan import read_plan
from models import get
from study.figures import plot_onset_map, plot_overturning_map, plot_slices, save_figure
from study.figures.style import COLOURS, set_log_ticks
from study.open import open_study
from study.status import OVERTURNED, ROCKING
from study.wording import GRAVITY

HERE = Path(__file__).parent
FIGURES, TABLES, STUDIES = HERE / "_static", HERE / "tables", HERE.parent / "studies"
HEAVY = {"top_mass": 5000.0, "damping_ratio": 0.0544}
"""The paper's mass and the damping ratio of its short wall."""
SHORT = {**HEAVY, "aspect_ratio": 0.4}
MODERATE = {"pga": 0.31 * GRAVITY}
SHAPE = ("aspect_ratio", "top_mass", "layer_modulus", "damping_ratio")
WORDS = {
    "linear": "linear",
    "hardening": "hardening",
    "maxwell": "Maxwell",
    "bouc_wen": "Bouc-Wen",
    "mullins": "Mullins",
}


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    lines = [list(head), *([str(cell) for cell in row] for row in rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def write(name: str, text: str) -> None:
    TABLES.mkdir(exist_ok=True)
    (TABLES / f"{name}.md").write_text(text)


def predicted_onset(cube: xr.Dataset) -> xr.DataArray:
    """PGA at which the first mode of the record's spectrum reaches the moment that lifts the base, W b/3.

    S_a(f_1, xi) = g b/(3 h_c), h_c the height of the mass centre of wall and top mass.
    """
    plan = read_plan(STUDIES / "rubber_interface.toml")
    (motion,), fixed = plan.motions, plan.fixed
    height, top = fixed["wall_height"], cube["top_mass"]
    length = cube["aspect_ratio"] * height
    wall = fixed["wall_density"] * fixed["wall_thickness"] * length * height
    centre = (wall * height / 2 + top * (height + fixed["layer_thickness"] + fixed["top_height"] / 2)) / (wall + top)
    periods = np.geomspace(0.02, 3.0, 150)
    shares = []
    for xi in cube["damping_ratio"].values:
        spectrum = response_spectrum(motion.horizontal, motion.time_step, periods, float(xi))
        shares.append(
            xr.apply_ufunc(partial(np.interp, xp=periods, fp=spectrum.pseudo_acceleration), 1 / cube["frequency_1"])
        )
    response = xr.concat(shares, "damping_ratio").assign_coords(damping_ratio=cube["damping_ratio"])
    return GRAVITY * length / 2 / (3 * centre) / (response / motion.pga)


def found_onset(cube: xr.Dataset) -> xr.DataArray:
    """Smallest PGA of the grid that lifts a joint; nan where it is the grid's first (the true one may lie below)."""
    lifts = cube["status"].isin((ROCKING, OVERTURNED))
    first = lifts.argmax("pga")
    return cube["pga"].isel(pga=first).where(lifts.any("pga") & (first > 0)).drop_vars("pga")


def plot_prediction(found: xr.DataArray, predicted: xr.DataArray) -> Axes:
    ax = plt.figure(figsize=(5.4, 4.4), layout="constrained").add_subplot()
    wide = np.broadcast_to(found["aspect_ratio"].values[:, None, None, None], found.shape)
    # the grid rounds up: spread each level over its step, or points hide each other
    spread = found.values / GRAVITY - np.random.default_rng(0).uniform(0.0, 0.02, found.shape)
    dots = ax.scatter(
        predicted.values.ravel() / GRAVITY, spread.ravel(), c=wide.ravel(), s=5, cmap="cividis", linewidths=0
    )
    ax.plot([0.03, 0.4], [0.03, 0.4], color=COLOURS[1], linewidth=1.0, label="equal")
    for which, scale in (("x", ax.set_xscale), ("y", ax.set_yscale)):
        scale("log")
        set_log_ticks(ax.xaxis if which == "x" else ax.yaxis)
    ax.set(xlim=(0.03, 0.4), ylim=(0.03, 0.4), aspect="equal")
    ax.set_xlabel("from the response spectrum [g]")
    ax.set_ylabel("PGA at which a joint lifts in the study [g]")
    ax.legend(frameon=False)
    ax.grid(alpha=0.3)
    ax.figure.colorbar(dots, ax=ax, label="aspect ratio")
    return ax


def rubber_interface(cube: xr.Dataset) -> None:
    draw = {
        "rubber_onset": partial(plot_onset_map, cube, "aspect_ratio", "layer_modulus", HEAVY),
        "rubber_overturning": partial(plot_overturning_map, cube, "layer_modulus", "pga", SHORT),
        "rubber_overturning_damping": partial(
            plot_overturning_map, cube, "layer_modulus", "damping_ratio", {"aspect_ratio": 0.4, "top_mass": 5000.0}
        ),
        "rubber_uplift": partial(plot_slices, cube, "uplift_duration", "layer_modulus", {**HEAVY, **MODERATE}),
    }
    found, predicted = found_onset(cube).transpose(*SHAPE), predicted_onset(cube).transpose(*SHAPE)
    draw["rubber_spectrum"] = partial(plot_prediction, found, predicted)
    for name, figure in draw.items():
        save_figure(figure, FIGURES / f"{name}.png")

    status = cube["status"]
    over, never = status == OVERTURNED, status < ROCKING
    cells = status.size // status.sizes["aspect_ratio"]
    aspects = [f"{value:.1f}" for value in cube["aspect_ratio"].values]
    others = [d for d in status.dims if d != "aspect_ratio"]
    counts = table(
        ["aspect ratio", *aspects, "all"],
        [
            [word, *(f"{100 * n / cells:.1f} %" for n in where.sum(others).values), int(where.sum())]
            for word, where in (("no joint lifts", never), ("overturns", over))
        ],
    )
    moduli = cube["layer_modulus"].values[::3]
    heads = [f"{value / 1e6:.3g} MPa" for value in moduli]
    heavy = cube.sel(**HEAVY, method="nearest")
    onset = cube.rocking.onset_map(x="layer_modulus", y="aspect_ratio", **HEAVY) / GRAVITY
    lowest = float(cube["pga"].min()) / GRAVITY
    lifts = table(
        ["aspect ratio", *heads],
        [
            [f"{a:.1f}", *(("≤ " if v <= lowest else "") + f"{v:.2f}" for v in onset.sel(aspect_ratio=a).values[::3])]
            for a in onset["aspect_ratio"].values[::2]
        ],
    )
    peak = (1e3 * heavy["peak_rotation"].where(heavy["status"] != OVERTURNED)).sel(**MODERATE, method="nearest")
    peaks = table(
        ["aspect ratio", *heads],
        [
            [f"{a:.1f}", *(f"{v:.1f}" for v in peak.sel(aspect_ratio=a).values[::3])]
            for a in cube["aspect_ratio"].values[::2]
        ],
    )
    short = over.sel(aspect_ratio=0.4, method="nearest")
    by_damping = [100 * float(short.sel(damping_ratio=d).mean()) for d in cube["damping_ratio"].values]
    by_mass = [100 * float(short.sel(top_mass=m).mean()) for m in cube["top_mass"].values]
    shares = (
        table(
            ["damping ratio", *(f"{100 * d:.3g} %" for d in cube["damping_ratio"].values)],
            [["overturns", *(f"{v:.1f} %" for v in by_damping)]],
        )
        + "\n"
        + table(
            ["top mass", *(f"{m / 1e3:.0f} t" for m in cube["top_mass"].values)],
            [["overturns", *(f"{v:.1f} %" for v in by_mass)]],
        )
    )
    ratio = (found / predicted).values
    ratio = ratio[np.isfinite(ratio)]
    both = np.isfinite(found.values)
    correlation = np.corrcoef(np.log(found.values[both]), np.log(predicted.values[both]))[0, 1]
    low, middle, high = np.quantile(ratio, [0.05, 0.5, 0.95])
    spectrum = table(
        [
            "walls that lift above the lowest PGA",
            "correlation of the logarithms",
            "study over spectrum: 5 %",
            "median",
            "95 %",
        ],
        [[int(both.sum()), f"{correlation:.3f}", f"{low:.2f}", f"{middle:.2f}", f"{high:.2f}"]],
    )
    above = (over.cumsum("pga") > 0) & ~over
    again = int((above.any("pga")).sum())
    islands = table(
        ["walls that overturn at some PGA", "of these: stand again at a higher PGA of the grid"],
        [[int(over.any("pga").sum()), again]],
    )
    for name, text in (
        ("counts", counts), ("lifts", lifts), ("peaks", peaks), ("shares", shares), ("spectrum", spectrum),
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


def overturned_share(cube: xr.Dataset, aspect: float) -> xr.DataArray:
    """Share of the cells at one aspect ratio that overturn, over the layer modulus, in per cent."""
    over = (cube["status"] == OVERTURNED).sel(aspect_ratio=aspect, method="nearest")
    return 100 * over.mean([d for d in over.dims if d != "layer_modulus"])


def plot_overturned_shares(cubes: dict[str, xr.Dataset]) -> Axes:
    ax = plt.figure(figsize=(6.4, 4.0), layout="constrained").add_subplot()
    for k, (name, cube) in enumerate(cubes.items()):
        for aspect, style in ((0.4, "-"), (0.5, "--")):
            share = overturned_share(cube, aspect)
            label = f"{name} layers, aspect ratio {aspect}"
            ax.plot(share["layer_modulus"] / 1e6, share, "os"[k] + style, color=COLOURS[k], label=label)
    ax.set_xscale("log")
    set_log_ticks(ax.xaxis)
    ax.set_ylim(0.0)
    ax.set_xlabel("unstressed layer modulus [MPa]")
    ax.set_ylabel("cells that overturn [%]")
    ax.legend(frameon=False)
    ax.grid(alpha=0.3)
    return ax


def rubber_locking(linear: xr.Dataset, locking: xr.Dataset) -> None:
    """The same study on linear and on locking layers."""
    cubes = {"linear": linear, "locking": locking}
    save_figure(partial(plot_overturned_shares, cubes), FIGURES / "rubber_locking.png")
    fixed, aspect = read_plan(STUDIES / "rubber_locking.toml").fixed, {"aspect_ratio": 0.4}
    moduli = linear["layer_modulus"].values
    some = slice(None, None, 2)
    wall = {**fixed, **aspect, **HEAVY, "layer_modulus": moduli}
    lock = fixed["locking.lock_strain"]
    rest = {}
    for name in cubes:
        own = {key: value for key, value in wall.items() if name == "locking" or "." not in key}
        rest[name] = get("interface").derive(own)["static_compression_base"] / fixed["layer_thickness"]
    tangent = moduli / (1.0 - rest["locking"] / lock) ** 2
    rows: list[list[str]] = [
        *([f"strain at rest, {name}", *(f"{v:.2f}" for v in rest[name][some])] for name in cubes),
        ["tangent modulus at rest, locking [MPa]", *(f"{v / 1e6:.2f}" for v in tangent[some])],
    ]
    for name, cube in cubes.items():
        onset = cube.rocking.onset_map(x="layer_modulus", y="aspect_ratio", **HEAVY)
        lifts = onset.sel(aspect_ratio=0.4, method="nearest").values / GRAVITY
        rows.append([f"PGA that lifts a joint, {name} [g]", *(f"{v:.2f}" for v in lifts[some])])
    for ratio in (0.4, 0.5):
        for name, cube in cubes.items():
            shares = overturned_share(cube, ratio).values
            rows.append([f"overturns, aspect ratio {ratio}, {name}", *(f"{v:.1f} %" for v in shares[some])])
    both = xr.align(*(cube["peak_rotation"].where(cube["status"] == ROCKING) for cube in cubes.values()))
    ratios = (both[1] / both[0]).transpose("layer_modulus", ...).values.reshape(moduli.size, -1)
    low, middle, high = np.nanquantile(ratios, [0.1, 0.5, 0.9], axis=1)
    spread = [f"{m:.2f} ({a:.2f} to {b:.2f})" for a, m, b in zip(low[some], middle[some], high[some], strict=True)]
    rows.append(["peak rotation, locking over linear: median (10 to 90 %)", *spread])
    edge = locking["peak_strain_base"].where(locking["status"] == ROCKING).transpose("layer_modulus", ...)
    largest = np.nanmax(edge.values.reshape(moduli.size, -1), axis=1)
    rows.append(["largest strain of the base's edge, locking", *(f"{v:.3f}" for v in largest[some])])
    write("rubber_locking", table(["layer modulus, MPa", *(f"{e / 1e6:.3g}" for e in moduli[some])], rows))
    counts = [
        [name, int((c["status"] == OVERTURNED).sum()), int((c["status"] > OVERTURNED).sum())]
        for name, c in cubes.items()
    ]
    write("rubber_locking_counts", table(["layers", "cells that overturn", "cells without an answer"], counts))


def main(results: Path) -> None:
    interface = open_study(results / "rubber_interface")
    rubber_interface(interface)
    locking = open_study(results / "rubber_locking")
    same = interface.sel(aspect_ratio=locking["aspect_ratio"], method="nearest")
    rubber_locking(same.assign_coords(aspect_ratio=locking["aspect_ratio"]), locking)
    rubber_laws(open_study(results / "rubber_laws"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
