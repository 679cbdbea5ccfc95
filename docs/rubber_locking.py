"""Figures and tables of the study on layers that lock beside the same one on linear layers (make_rubber_pages.py)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from rubber_tables import (
    FIGURES,
    HEAVY,
    SHORT,
    STUDIES,
    spectrum_numbers,
    standing_again,
    table,
    write,
)

from grids.plan import read_plan
from models import get
from study.figures import save_figure
from study.figures.style import COLOURS, set_log_ticks
from study.status import OVERTURNED, REST, ROCKING, UNKNOWN
from study.wording import GRAVITY

Cubes = dict[str, xr.Dataset]
"""By the word for their layers, over the same axes: linear, locking."""
SOME = (0.4, 0.55, 0.7)
"""Aspect ratios of which numbers are given."""
LOCK = 0.7
"""The lock strain of studies/rubber_locking.toml."""


def overturned_share(cube: xr.Dataset, **at: float) -> xr.DataArray:
    """Share of the cells ``at`` some values that overturn, over the layer modulus, in per cent."""
    over = (cube["status"] == OVERTURNED).sel(at, method="nearest")
    return 100 * over.mean([d for d in over.dims if d != "layer_modulus"])


def onset(cube: xr.Dataset, aspect: float) -> xr.DataArray:
    """PGA (g) that lifts a joint of heavy walls over the layer modulus."""
    found = cube.rocking.onset_map(x="layer_modulus", y="aspect_ratio", **HEAVY)
    return found.sel(aspect_ratio=aspect, method="nearest") / GRAVITY


def over_modulus(label: str) -> Axes:
    ax = plt.figure(figsize=(6.4, 4.0), layout="constrained").add_subplot()
    ax.set_xscale("log")
    ax.set_xlabel("unstressed layer modulus [MPa]")
    ax.set_ylabel(label)
    ax.grid(alpha=0.3)
    return ax


def plot(
    cubes: Cubes, label: str, curve: Callable[[xr.Dataset, float], xr.DataArray], aspects: tuple[float, ...]
) -> Axes:
    """``curve(cube, aspect_ratio)`` of every cube at some aspect ratios."""
    ax = over_modulus(label)
    for k, (name, cube) in enumerate(cubes.items()):
        for aspect, style in zip(aspects, ("-", "--"), strict=True):
            values = curve(cube, aspect)
            legend = f"{name} layers, aspect ratio {aspect}"
            ax.plot(
                values["layer_modulus"] / 1e6, values, "os"[k] + style, color=COLOURS[k], label=legend, markersize=4
            )
    set_log_ticks(ax.xaxis)
    ax.set_ylim(0.0)
    ax.legend(frameon=False, fontsize="small", handlelength=3.5)
    return ax


def by_aspect(cubes: Cubes) -> str:
    """What becomes of the cells, over the aspect ratio."""
    rows = []
    for word, chosen in (("overturns", lambda s: s == OVERTURNED), ("no joint lifts", lambda s: s == REST)):
        for name, cube in cubes.items():
            where = chosen(cube["status"])
            others = [d for d in where.dims if d != "aspect_ratio"]
            shares = [f"{100 * share:.1f} %" for share in where.mean(others).values]
            rows.append([f"{word}, {name}", *shares, int(where.sum())])
    aspects = [f"{value:.2f}" for value in next(iter(cubes.values()))["aspect_ratio"].values]
    return table(["aspect ratio", *aspects, "cells"], rows)


def by_modulus(cubes: Cubes) -> str:
    """Static state, uplift, overturning, peaks and strains over the layer modulus."""
    fixed = read_plan(STUDIES / "rubber_locking.toml").fixed
    moduli = cubes["linear"]["layer_modulus"].values
    wall = {**fixed, **SHORT, "layer_modulus": moduli}
    rest = {}
    for name in cubes:
        own = {key: value for key, value in wall.items() if name == "locking" or "." not in key}
        rest[name] = get("interface").derive(own)["static_compression_base"] / fixed["layer_thickness"]
    tangent = moduli / (1.0 - rest["locking"] / fixed["locking.lock_strain"]) ** 2
    rows = [
        *([f"strain at rest, {name}", *(f"{v:.2f}" for v in rest[name])] for name in cubes),
        ["tangent modulus at rest, locking [MPa]", *(f"{v / 1e6:.2f}" for v in tangent)],
    ]
    for name, cube in cubes.items():
        rows.append([f"PGA that lifts a joint, {name} [g]", *(f"{v:.2f}" for v in onset(cube, 0.4).values)])
    for aspect in (0.4, 0.6):
        for name, cube in cubes.items():
            shares = overturned_share(cube, aspect_ratio=aspect).values
            rows.append([f"overturns, aspect ratio {aspect}, {name}", *(f"{v:.1f} %" for v in shares)])
    stands = [cube["peak_rotation"].where(cube["status"] == ROCKING) for cube in cubes.values()]
    ratios = (stands[1] / stands[0]).transpose("layer_modulus", ...).values.reshape(moduli.size, -1)
    low, middle, high = np.nanquantile(ratios, [0.1, 0.5, 0.9], axis=1)
    spread = [f"{m:.2f} ({a:.2f} to {b:.2f})" for a, m, b in zip(low, middle, high, strict=True)]
    rows.append(["peak rotation, locking over linear: median (10 to 90 %)", *spread])
    for name, cube in cubes.items():
        edge = cube["peak_strain_base"].where(cube["status"] == ROCKING).transpose("layer_modulus", ...)
        largest = np.nanmax(edge.values.reshape(moduli.size, -1), axis=1)
        rows.append([f"largest strain of the base's edge, {name}", *(f"{v:.2f}" for v in largest)])
    return table(["layer modulus, MPa", *(f"{e / 1e6:.3g}" for e in moduli)], rows)


def _two_shares(over: xr.DataArray, axis: str, values: tuple[float, float]) -> str:
    """Shares of the cells that overturn at two values of an axis."""
    shares = (100 * float(over.sel({axis: value}, method="nearest").mean()) for value in values)
    return ", ".join(f"{share:.1f} %" for share in shares)


def trends(cubes: Cubes) -> str:
    """What the page concludes from the linear layers, by number, on both."""
    columns = []
    for cube in cubes.values():
        walls, correlation, low, middle, high = spectrum_numbers(cube)
        fall, again = standing_again(cube)
        walls_fall = (cube["status"] == OVERTURNED).any("pga")
        soft = int(walls_fall.where(cube["layer_modulus"] < 4e6, False).sum())
        stands = cube["status"].isin((REST, ROCKING))
        edge = cube["peak_strain_base"].where(stands)
        beyond = 100 * float((edge > LOCK).sum() / stands.sum())
        at_some = [(cube["status"] == OVERTURNED).sel(aspect_ratio=a, method="nearest") for a in SOME]
        damped = [_two_shares(over, "damping_ratio", (0.0167, 0.1)) for over in at_some]
        loaded = [_two_shares(over, "top_mass", (2500.0, 5000.0)) for over in at_some]
        peak = 1e3 * cube["peak_rotation"].where(cube["status"] == ROCKING)
        medians = [float(peak.sel(aspect_ratio=a, method="nearest").median()) for a in SOME]
        columns.append([
            walls, correlation, f"{middle} ({low} to {high})", f"{fall}", f"{soft}", f"{again}",
            *damped, *loaded,
            ", ".join(f"{m:.1f}" for m in medians), f"{beyond:.1f} %, {float(edge.max()):.2f}",
            str(int(cube["status"].isin(UNKNOWN).sum())),
        ])  # fmt: skip
    what = (
        "walls that lift above the lowest PGA", "correlation with the spectrum's estimate (logarithms)",
        "PGA that lifts over the spectrum's: median (5 to 95 %)", "walls that overturn at some PGA",
        "of these: on layers below 4 MPa", "of these: stand again at a higher PGA",
        *(f"overturns at aspect ratio {a}: 1.67 %, 10 % damping" for a in SOME),
        *(f"overturns at aspect ratio {a}: 2.5 t, 5 t on top" for a in SOME),
        f"peak rotation of walls that rock and stand, median at aspect ratio {', '.join(map(str, SOME))} [mrad]",
        "cells that stand and press the base's edge beyond a strain of .7, largest strain", "cells without an answer",
    )  # fmt: skip
    return table(["", *cubes], zip(what, *columns, strict=True))


def strains(cube: xr.Dataset) -> str:
    """Largest compression of the joints' edges over the layer's thickness, of cells that do not overturn."""
    stands = cube["status"].isin((REST, ROCKING))
    modulus, slender = cube["layer_modulus"] / 1e6, np.isclose(cube["aspect_ratio"], 0.4)
    slender = xr.DataArray(slender, coords={"aspect_ratio": cube["aspect_ratio"]})
    groups = (
        ("base, all", "base", stands), ("base, 2 and 2.5 MPa", "base", stands & (modulus < 3.0)),
        ("the same, aspect ratio .4", "base", stands & (modulus < 3.0) & slender),
        ("base, 3.15 to 5 MPa", "base", stands & (modulus > 3.0) & (modulus < 6.0)),
        ("base, from 6.3 MPa", "base", stands & (modulus > 6.0)), ("top, all", "top", stands),
    )  # fmt: skip
    rows = []
    for name, joint, chosen in groups:
        strain = cube[f"peak_strain_{joint}"].where(chosen).values
        strain = strain[np.isfinite(strain)]
        over = [f"{100 * np.mean(strain > limit):.2g} %" for limit in (0.3, 0.5, 1.0)]
        rows.append([name, str(strain.size), *over, f"{strain.max():.1f}"])
    return table(["layers", "cells", "over .3", "over .5", "over 1", "largest"], rows)


def rubber_locking(interface: xr.Dataset, locking: xr.Dataset) -> None:
    """The study on linear layers, and the cells that were run on locking layers too on both."""
    cubes = {"linear": interface.sel({str(d): locking[d].values for d in locking.dims}), "locking": locking}
    shares = partial(plot, cubes, "cells that overturn [%]", lambda cube, a: overturned_share(cube, aspect_ratio=a))
    save_figure(partial(shares, (0.4, 0.6)), FIGURES / "rubber_locking.png")
    lifts = partial(plot, cubes, "PGA that lifts a joint [g]", onset)
    save_figure(partial(lifts, (0.4, 0.7)), FIGURES / "rubber_locking_onset.png")
    write("rubber_strains", strains(interface))
    write("rubber_locking_counts", by_aspect(cubes))
    write("rubber_locking", by_modulus(cubes))
    write("rubber_locking_trends", trends(cubes))
