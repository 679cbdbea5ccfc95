"""Rubber laws in plans: a law's parameters belong to the law in use, or to its own cells of an axis."""

from pathlib import Path

import numpy as np
import pytest

from grids.plan import parse_plan
from models.errors import InputError
from study.evaluate import evaluate
from study.keys import Setting

PLAN = """
[study]
name = "laws"
model = "interface"
[motion]
pulse = { shape = "sine", amplitude = "0.2 g", duration = "0.8 s" }
[parameters]
wall_length = 0.72
wall_height = 1.8
wall_mass = 161.0
top_mass = 5000.0
top_length = 2.0
top_height = 0.6
layer_thickness = 0.01
base_stiffness = 6.2e7
top_stiffness = 6.2e7
damping_ratio = 0.05
"mullins.softening" = 0.4
[options]
%s
[axes]
%s
[outputs]
names = ["peak_rotation"]
[run]
tail = "1 s"
"""
PGA = "pga = { values = [1.0, 2.0] }"


def test_parameters_of_a_law_not_in_use_are_refused() -> None:
    with pytest.raises(InputError, match="rubber law mullins are given, but the law in use is 'linear'"):
        parse_plan(PLAN % ('rubber_law = "linear"', PGA), Path())
    for words in ("", 'rubber_law = "mullins"', 'top_rubber_law = "mullins"\nrubber_law = "linear"'):
        parse_plan(PLAN % (words, PGA), Path())


def test_an_axis_of_laws_gives_each_law_its_own_cells() -> None:
    plan = parse_plan(PLAN % ("", 'rubber_law = { values = ["linear", "mullins"] }\n' + PGA), Path())
    cells = {"rubber_law": np.array(["linear", "mullins"]), "pga": np.array([2.0, 2.0])}
    found = evaluate(Setting.of(plan), {plan.motions[0].name: plan.motions[0]}, cells)
    assert found["peak_rotation"][0] != found["peak_rotation"][1]
