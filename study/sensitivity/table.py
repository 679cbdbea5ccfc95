"""The table "what to tune first"."""

from __future__ import annotations

import numpy as np
import xarray as xr

from study.sensitivity.analysis import LEADING

HEADS = {
    "saltelli": ("parameter", "share of the variance", "alone", "lowest fifth", "highest fifth", "matters"),
    "morris": ("parameter", "mu*", "sigma", "lowest fifth", "highest fifth", "matters"),
}
LEAST = {"saltelli": 0.05, "morris": 0.1}
"""What matters: more than this share of the variance; a mu* of more than this share of the largest."""


def what_to_tune(found: xr.Dataset, output: str, motions: str | None = None) -> list[tuple[str, ...]]:
    """Head and rows, the strongest parameter first: its total index (or mu*) with its interval, its index alone (or
    sigma), the mean of the output at both ends of its range, and whether it matters: the whole interval above `LEAST`
    ("yes"), below it ("little"), or neither ("cannot tell")."""
    kind = str(found.attrs["kind"])
    one = found.sel(output=output).sel(motions=motions) if motions else found.sel(output=output).isel(motions=0)
    leading = LEADING[kind]
    least = LEAST[kind] * (1.0 if kind == "saltelli" else float(one[leading].max()))
    rows: list[tuple[str, ...]] = [HEADS[kind]]
    for k in np.argsort(-one[leading].values):
        row = one.isel(parameter=int(k))
        value, low, high = (float(row[f"{leading}{end}"]) for end in ("", "_low", "_high"))
        if kind == "saltelli":
            first = f"{float(row['first']):.2f} ({float(row['first_low']):.2f} to {float(row['first_high']):.2f})"
            leads = f"{value:.2f} ({low:.2f} to {high:.2f})"
        else:
            first = f"{float(row['sigma']):.3g}"
            leads = f"{value:.3g} ({low:.3g} to {high:.3g})"
        matters = "yes" if low > least else "little" if high < least else "cannot tell"
        ends = (f"{float(row[name]):.3g}" for name in ("at_low", "at_high"))
        rows.append((str(row["parameter"].values), leads, first, *ends, matters))
    return rows
