"""What the server of commands imports: the program, the libraries behind it, and the kernels of the models."""

from __future__ import annotations

import os
from pathlib import Path

import distributed  # noqa: F401
import matplotlib.pyplot  # noqa: F401
import netCDF4  # noqa: F401

import rocking.commands  # noqa: F401
import study.check
import study.export
import study.figures.map_figure
import study.run  # noqa: F401
from benchmarks.faults.studies import MODELS, plan_text
from grids.plan import parse_plan
from study.evaluate import evaluate
from study.keys import Setting, motions_by_name
from study.provenance import commit, versions

for model in os.environ.get("FAULTS_MODELS", " ".join(MODELS)).split():
    _plan = parse_plan(plan_text(model, 2), Path.cwd())
    _cells = {axis.name: axis.values[:2] for axis in _plan.axes}
    evaluate(Setting.of(_plan), motions_by_name(_plan), _cells)
commit(), versions()
