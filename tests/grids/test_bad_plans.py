"""Plans that cannot be meant: one sentence each, with key, value, unit and cure."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from grids.plan import read_plan
from models.errors import InputError
from tests.grids.fakes import FakeWall

GOOD = """
[study]
name = "try"
model = "fake_wall"
[motion]
pulse = { shape = "half_sine", amplitude = "0.5 g", duration = "0.5 s" }
[parameters]
width = "0.3 m"
height = 1.8
mass = 500
cover = "2 mm"
[axes]
pga = { linspace = [0.1, 0.5, 5], unit = "g" }
[outputs]
names = ["peak_rotation", "overturned"]
[run]
tail = "10 s"
"""
PGA = 'pga = { linspace = [0.1, 0.5, 5], unit = "g" }'


BAD: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "not TOML": ('name = "try"', 'name = "try', ('name = "try', "line 3", "correct")),
    "no study": ("[study]", "[stud]", ("stud is not known", "did you mean 'study'")),
    "unknown table": ("[run]", "[runs]", ("runs", "did you mean 'run'")),
    "unknown key": ("tail =", "tial =", ("[run] tial", "did you mean 'tail'")),
    "unknown key of the outputs": ("names =", "name =", ("[outputs] name is not known", "did you mean 'names'")),
    "unknown key of a table left out": ("[run]", "[refine]\nbudgt = 5\n[run]", ("budgt", "did you mean 'budget'")),
    "unknown key of samples": ("[run]", "[samples]\ncout = 5\n[run]", ("[samples] cout", "did you mean 'count'")),
    "name of a folder": ('"try"', '"../try"', ("name", "../try", "letters")),
    "unknown model": ("fake_wall", "housnr", ("housnr", "did you mean 'housner'")),
    "model and specimen": ("model =", 'specimen = "x.toml"\nmodel =', ("both", "exactly one")),
    "neither": ('model = "fake_wall"', "", ("neither", "exactly one")),
    "missing specimen": ('model = "fake_wall"', 'specimen = "x.toml"', ("x.toml", "does not exist")),
    "unknown parameter": ("width =", "widht =", ("widht", "fake_wall", "did you mean 'width'")),
    "missing parameter": ('cover = "2 mm"', "", ("cover", "thickness of the cover", "m)", "missing")),
    "half of an alternative": ('width = "0.3 m"', "", ("'height'", "width and height", "aspect_ratio")),
    "both alternatives": ("width =", "aspect_ratio = 0.2\nwidth =", ("'aspect_ratio'", "exactly one of")),
    "wrong dimension": ('"0.3 m"', '"0.3 kg"', ("width", "0.3 kg", "'m' is needed")),
    "a decimal comma": ('"0.3 m"', '"0,3 m"', ("width = '0,3 m'", "decimal point, '0.3 m'")),
    "a name in capitals": ("pga =", "PGA =", ("PGA is not a parameter", "did you mean 'pga'")),
    "a name like no other": ("pga =", "qqqq =", ("qqqq", "known: ", "width, and parameters of mechanisms as")),
    "no unit": ('"0.3 m"', '"0.3"', ("width", "0.3 m", "without quotes")),
    "below its bound": ('"0.3 m"', '"-0.3 m"', ("width = -0.3 m", "greater than 0 m")),
    "above its bound": ('"2 mm"', '"0.2 m"', ("cover = 0.2 m", "at most 0.1 m")),
    "not a number": ("mass = 500", "mass = nan", ("mass", "nan", "in kg")),
    "infinite": ("mass = 500", "mass = inf", ("mass = inf kg", "at least 0 kg")),
    "true": ("mass = 500", "mass = true", ("mass = True", "in kg")),
    "a list as a fixed value": ("mass = 500", "mass = [400, 500]", ("[400, 500]", "[axes]")),
    "fixed twice": (
        PGA,
        "mass = { values = [1, 2] }",
        ("'mass'", "[parameters]", "[axes] mass", "leave one"),
    ),
    "varied twice": (
        PGA,
        "pga = { values = [1] }\ncase = { cases = [{ pga = 2 }] }",
        ("'pga'", "[axes] pga", "[axes] case"),
    ),
    "two scales": (PGA, PGA + "\nmotion_scale = { values = [1, 2] }", ("'pga'", "'motion_scale'", "one of")),
    "no such mechanism": (
        "[axes]",
        "pivot_insert.x = 0.1\n[axes]",
        ("pivot_insert", "did you mean 'pivot_inset'"),
    ),
    "no such mechanism, dotted": ("[axes]", '"pivot_inse.x" = 0.1\n[axes]', ("did you mean 'pivot_inset'",)),
    "no such mechanism parameter": (
        "[axes]",
        "pivot_inset.inset = 0.1\n[axes]",
        ("pivot_inset", "'inset'", "known: inset_over_half_width"),
    ),
    "a mechanism alone": (
        "[axes]",
        "pivot_inset = 0.1\n[axes]",
        ("name its parameter", "inset_over_half_width"),
    ),
    "beyond a mechanism's range": (
        "[axes]",
        '"slip.friction" = 2\n[axes]',
        ("slip.friction = 2", "at most 1.5", "inf for no effect"),
    ),
    "a sensor": ("[axes]", "gain.gain = 0.1\n[axes]", ("gain", "instruments", "simulate")),
    "two handles": (
        "[axes]",
        'restitution = 0.9\n"restitution.factor_on_housner" = 0.9\n[axes]',
        ("'restitution'", "'restitution.factor_on_housner'", "the one or the other"),
    ),
    "only the shape of an effect": ("[axes]", "stop.gap = 0.01\n[axes]", ("'stop.gap'", "'stop.stiffness'")),
    "vertical twice": (
        "[parameters]",
        "vertical = true\n[parameters]\nvertical_acceleration.kappa = 0.5",
        ("vertical_acceleration.kappa", "vertical = false"),
    ),
    "an option among parameters": ("[axes]", 'formulation = "linear"\n[axes]', ("formulation", "[options]")),
    "unknown option": ("[axes]", '[options]\nform = "linear"\n[axes]', ("[options] form", "formulation")),
    "unknown word": (
        "[axes]",
        '[options]\nformulation = "liner"\n[axes]',
        ("'liner'", "did you mean 'linear'"),
    ),
    "a bare value as an axis": (PGA, "pga = 0.3", ("pga = 0.3", "values = [...]")),
    "no kind": (PGA, 'pga = { unit = "g" }', ("[axes] pga", "exactly one of linspace")),
    "two kinds": (
        PGA,
        "pga = { values = [1], linspace = [1, 2, 3] }",
        ("linspace and values", "exactly one"),
    ),
    "unknown key of an axis": (
        PGA,
        "pga = { values = [1], units = 'g' }",
        ("'units'", "did you mean 'unit'"),
    ),
    "empty axis": (PGA, "pga = { values = [] }", ("pga", "[]", "at least one")),
    "repeated value": (PGA, "pga = { values = [1, 2, '2 m/s2'] }", ("pga", "2 m s-2", "twice")),
    "NaN in an axis": (PGA, "pga = { values = [1, nan] }", ("pga", "nan", "m s-2")),
    "axis out of bounds": (PGA, "pga = { linspace = [-1, 1, 3] }", ("pga = -1 m s-2", "at least 0 m s-2")),
    "falling span": (PGA, "pga = { linspace = [3, 1, 5] }", ("[3, 1, 5]", "swap")),
    "span of two": (PGA, "pga = { linspace = [3, 1] }", ("[3, 1]", "[low, high, count]")),
    "broken count": (PGA, "pga = { linspace = [1, 3, 2.5] }", ("2.5", "whole number")),
    "ratio from next to nothing": (
        PGA,
        "pga = { geomspace = [1e-320, 1, 5] }",
        ("1e-320", "beyond any size"),
    ),
    "ratio from zero": (PGA, "pga = { geomspace = [0, 1, 5] }", ("starts at 0 m s-2", "above zero")),
    "axis in another unit": (PGA, "pga = { values = [1], unit = 'm' }", ("pga", "'m'", "'m s-2' is needed")),
    "unknown axis": (PGA, "pgaa = { values = [1] }", ("pgaa", "did you mean 'pga'")),
    "numbers for words": (PGA, "formulation = { values = [1] }", ("formulation", "1", "linear")),
    "a span of words": (PGA, "formulation = { linspace = [1, 2, 3] }", ("formulation", "values = [...]")),
    "words with a unit": (PGA, "formulation = { values = ['linear'], unit = 'm' }", ("formulation", "unit")),
    "repeated word": (PGA, "formulation = { values = ['linear', 'linear'] }", ("'linear'", "twice")),
    "no seed": (PGA, "s = { sobol = 8, parameters = { pga = [1, 2] } }", ("seed", "missing", "repeated")),
    "no balance": (PGA, "s = { sobol = 9, seed = 1, parameters = { pga = [1, 2] } }", ("9", "8 or 16")),
    "nothing to sample": (PGA, "s = { sobol = 8, seed = 1 }", ("s", "parameters", "[low, high]")),
    "an odd range": (
        PGA,
        "s = { latin_hypercube = 8, seed = 1, parameters = { pga = [2, 1] } }",
        ("pga", "[2, 1]", "swap"),
    ),
    "log from zero": (
        PGA,
        "s = { sobol = 8, seed = 1, parameters = { pga = { range = [0, 1], spacing = 'log' } } }",
        ("pga", "above zero"),
    ),
    "a sample with a taken name": (
        PGA,
        "peak_rotation = { sobol = 8, seed = 1, parameters = { pga = [1, 2] } }",
        ("peak_rotation", "taken", "'case'"),
    ),
    "cases called as maps call what is unknown": (
        PGA,
        "unknown = { cases = [{ label = 'A', pga = 1 }] }",
        ("unknown", "taken", "'case'"),
    ),
    "cases called as a measure of a motion": (
        PGA,
        "record_pga = { cases = [{ label = 'A', pga = 1 }] }",
        ("record_pga", "taken", "'case'"),
    ),
    "no cases": (PGA, "case = { cases = [] }", ("case", "at least one")),
    "a unit of motions": (
        PGA,
        "motion = { values = ['ridgecrest_2019_clc'], unit = 'g' }",
        ("motions have no unit", "leave unit out"),
    ),
    "cases that differ": (
        PGA,
        "case = { cases = [{ pga = 1 }, { top_mass = 1 }] }",
        ("case 2", "same names"),
    ),
    "cases with one label": (
        PGA,
        "case = { cases = [{ label = 'A', pga = 1 }, { label = 'A', pga = 2 }] }",
        ("'A'", "twice"),
    ),
    "cases in no file": (PGA, "case = { cases = 'walls.csv' }", ("walls.csv", "does not exist")),
    "a bad value in a case": (
        PGA,
        "case = { cases = [{ label = 'A', pga = '1 kg' }] }",
        ("'A' pga", "1 kg", "'m s-2' is needed"),
    ),
    "too many cells": (
        PGA,
        "pga = { linspace = [0, 1, 100000] }\ntop_mass = { linspace = [0, 1, 100000] }",
        ("1e+10 cells", "thin an axis"),
    ),
    "no motion": ("pulse = {", "# ", ("no motion", "[motion] files")),
    "motions in two places": (PGA, "motion = { values = ['ridgecrest_2019_clc'] }", ("both name motions",)),
    "no such record": (
        'pulse = { shape = "half_sine", amplitude = "0.5 g", duration = "0.5 s" }',
        'files = ["ridgecrest_2019_cld"]',
        ("ridgecrest_2019_cld", "ridgecrest_2019_clc"),
    ),
    "a record twice": (
        'pulse = { shape = "half_sine", amplitude = "0.5 g", duration = "0.5 s" }',
        'files = ["ridgecrest_2019_clc", "ridgecrest_2019_clc.nc"]',
        ("ridgecrest_2019_clc", "two motions"),
    ),
    "a silent record": ('"0.5 g"', '"0 g"', ("0",)),
    "vertical is no word": ("[parameters]", 'vertical = "yes"\n[parameters]', ("vertical", "'yes'", "bool")),
    "unknown output": ('"overturned"', '"overturns"', ("overturns", "did you mean 'overturned'")),
    "an output twice": ('"overturned"', '"peak_rotation"', ("peak_rotation", "twice")),
    "no outputs": (
        'names = ["peak_rotation", "overturned"]',
        "names = []",
        ("[outputs] names is empty", "at least 1"),
    ),
    "negative tail": ('"10 s"', '"-1 s"', ("tail = -1 s", "zero or more")),
    "a tail without end": ('"10 s"', "inf", ("tail = inf s", "finite")),
    "a tail in metres": ('"10 s"', '"10 m"', ("tail", "10 m", "'s' is needed")),
    "blocks of no time": ("tail =", "block_seconds = 0\ntail =", ("block_seconds = 0 s", "above zero")),
    "unknown integrator": ("tail =", 'integrator = "lane"\ntail =', ("lane", "did you mean 'lanes'")),
    "a block that cannot rock": (
        PGA,
        "top_mass = { values = [0, 100] }\n" + PGA + "\n[options]",
        ("restitution", "does not rock"),
    ),
}


@pytest.mark.parametrize("kind", BAD)
def test_one_sentence(kind: str, fake_wall: FakeWall, written: Callable[[str, str], Path]) -> None:
    old, new, words = BAD[kind]
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    if kind == "a block that cannot rock":
        text = text.replace('"0.3 m"', '"3 m"')
    with pytest.raises(InputError) as error:
        read_plan(written("plan.toml", text))
    sentence = str(error.value)
    assert all(word in sentence for word in ("plan.toml", *words)), sentence
    assert "\n" not in sentence and len(sentence) < 400, sentence


def test_the_good_plan_is_good(fake_wall: FakeWall, written: Callable[[str, str], Path]) -> None:
    assert read_plan(written("plan.toml", GOOD)).grid.size == 5


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("label,pga\n\n\nA,1\nB,1,2\n", "line 5 of walls.csv has 3 fields"),
        ("label;pga\nA;1\n", "header of walls.csv is one cell; part its cells by commas"),
    ],
)
def test_a_slip_in_a_table_of_cases(
    table: str, said: str, fake_wall: FakeWall, written: Callable[[str, str], Path]
) -> None:
    written("walls.csv", table)
    with pytest.raises(InputError, match=said):
        read_plan(written("plan.toml", GOOD.replace(PGA, "case = { cases = 'walls.csv' }")))


def test_missing_and_unreadable_files(tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"plan\.toml is not UTF-8"):
        read_plan(tmp_path / "plan.toml")
    with pytest.raises(InputError, match=r"plam\.toml does not exist; did you mean 'plan.toml'"):
        read_plan(tmp_path / "plam.toml")
