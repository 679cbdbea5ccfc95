"""What a plan or specimen says of joints, laws, shares and the vertical motion, held against its model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import models
from grids.plan import Plan, parse_plan
from grids.specimen import Specimen, parse_specimen
from grids.targets import Targets
from models.errors import InputError

WALL = {
    "wall_length": "0.72 m",
    "wall_height": "1.8 m",
    "wall_thickness": "0.138 m",
    "wall_density": "900 kg/m^3",
    "top_mass": "5 t",
    "top_length": "2 m",
    "top_height": "0.6 m",
}
RUBBER = {"layer_thickness": "10 mm", "layer_modulus": "4.5 MPa", "damping_ratio": 0.0544}
BASE = {"base_layer_thickness": "10 mm", "base_layer_modulus": "4.5 MPa", "base_damping_ratio": 0.05}
BUILDING = {"total_mass": "300 t", "bearing_stiffness": 1e6, "bearing_damping": 1.5e5}
PGA = "pga = { values = [0.1, 0.2], unit = 'g' }"


def lines(table: dict[str, str | float]) -> str:
    return "\n".join(f"{name} = {value!r}" for name, value in table.items())


def plan(
    parameters: dict[str, str | float], *, model: str = "interface", options: str = "", axes: str = PGA,
    motion: str = 'pulse = { shape = "sine", amplitude = "0.3 g", frequency = "1.5 Hz" }',
) -> Plan:  # fmt: skip
    text = f"[study]\nname = 'x'\nmodel = '{model}'\n[motion]\n{motion}\n[options]\n{options}\n"
    return parse_plan(f"{text}[axes]\n{axes}\n[parameters]\n{lines(parameters)}\n", Path.cwd())


def specimen(parameters: dict[str, str | float], rest: str = "", model: str = "interface") -> Specimen:
    return parse_specimen(f"title = 'x'\nmodel = '{model}'\n[parameters]\n{lines(parameters)}\n{rest}")


def test_a_bonded_joint_has_no_layer_to_crush() -> None:
    narrow = {**WALL, **RUBBER, "top_length": "0.05 m"}
    with pytest.raises(InputError, match="too soft to hold"):
        plan(narrow)
    assert plan(narrow, options="joints = 'base'").options["joints"] == "base"
    assert specimen(narrow, "[options]\njoints = 'base'").options["joints"] == "base"
    with pytest.raises(InputError, match="too soft to hold"):
        plan(narrow, axes=PGA + "\njoints = { values = ['base', 'both'] }")
    with pytest.raises(InputError, match="too soft to hold"):
        plan(narrow, options="joints = 'top'")


def test_names_of_one_joint_alone_need_the_option_that_bonds_the_other() -> None:
    for read in (plan, specimen):
        with pytest.raises(InputError, match=r"the top layer has no layer_thickness.*joints = 'base' in .options."):
            read({**WALL, **BASE})
    assert plan({**WALL, **BASE}, options="joints = 'base'").fixed["base_damping_ratio"] == 0.05
    specimen({**WALL, **BASE}, "[options]\njoints = 'base'")
    top = {name.replace("base", "top"): value for name, value in BASE.items()}
    with pytest.raises(InputError, match=r"joints = 'top' in .options."):
        plan({**WALL, **top})
    plan({**WALL, **top}, options="joints = 'top'")


@pytest.mark.parametrize("model", ["interface", "interface_linear"])
def test_what_is_given_for_a_joint_without_rubber_is_refused(model: str) -> None:
    """It would do nothing."""
    top = {"top_layer_thickness": "20 mm", "top_layer_modulus": "1 MPa", "top_damping_ratio": 0.05}
    both = {**WALL, **BASE, **top}
    specimen(both, model=model)
    sentence = r"^top_layer_modulus is given, but joints = 'base' leaves no rubber at the top: leave it out, or set"
    with pytest.raises(InputError, match=sentence):
        specimen({**WALL, **BASE, "top_layer_modulus": 1e6}, "[options]\njoints = 'base'", model)
    with pytest.raises(InputError, match="base_damping_ratio is given, but joints = 'top' leaves no rubber at the"):
        plan({**WALL, **top, "base_damping_ratio": 0.05}, model=model, options="joints = 'top'")
    with pytest.raises(InputError, match="top_damping_ratio is given, but joints = 'base'"):
        axes = f"{PGA}\ntop_damping_ratio = {{ values = [0.02, 0.05] }}"
        plan({**WALL, **BASE}, model=model, axes=axes, options="joints = 'base'")
    cells = plan(both, model=model, axes=f"{PGA}\njoints = {{ values = ['base', 'both'] }}")
    assert cells.fixed["top_damping_ratio"] == 0.05


@pytest.mark.parametrize(
    "mechanism",
    [
        "[mechanisms.maxwell]\narm_stiffness_ratio_top = 0.5\nrelaxation_time = 0.05",
        "[mechanisms.interface_shear]\nshear_over_normal_top = 0.5",
        "[mechanisms.contact_length]\nfrozen_top = 0.5",
        "[calibrate.mullins]\nsoftening_top = [0.0, 0.5]",
    ],
)
def test_what_a_mechanism_does_at_a_joint_without_rubber_is_refused(mechanism: str) -> None:
    specimen({**WALL, **RUBBER}, mechanism)
    with pytest.raises(InputError, match=r"_top is given, but joints = 'base' leaves no rubber at the top"):
        specimen({**WALL, **RUBBER}, f"[options]\njoints = 'base'\n{mechanism}")
    with pytest.raises(InputError, match="top_rubber_law is given, but joints = 'base' leaves no rubber at the top"):
        specimen({**WALL, **RUBBER}, "[options]\njoints = 'base'\ntop_rubber_law = 'linear'")


def test_numbers_of_a_law_that_its_joint_does_not_have_are_refused() -> None:
    laws = "[mechanisms.mullins]\nsoftening_top = 0.3\nsoftening_base = 0.2\nstrain = 0.3\n"
    specimen({**WALL, **RUBBER}, f"[options]\nbase_rubber_law = 'mullins'\n{laws}")
    sentence = "mullins.softening_base is given, but the law of the base layer is linear: leave it out, or set base_"
    with pytest.raises(InputError, match=sentence):
        specimen({**WALL, **RUBBER}, f"[options]\nrubber_law = 'mullins'\nbase_rubber_law = 'linear'\n{laws}")
    axes = f"{PGA}\nbase_rubber_law = {{ values = ['linear', 'mullins'] }}"
    values = {"'mullins.softening_top'": 0.3, "'mullins.softening_base'": 0.2, "'mullins.strain'": 0.3}
    plan({**WALL, **RUBBER, **values}, axes=axes)


@pytest.mark.parametrize("model", ["stacked", "interface", "interface_linear"])
def test_a_density_without_a_thickness_is_refused(model: str) -> None:
    stiffness = {"base_stiffness": 6.2e7, "top_stiffness": 6.2e7, "base_damping": 1e5, "top_damping": 1e5}
    layers = {} if model == "stacked" else {"layer_thickness": "10 mm", **stiffness}
    values = {**WALL, **layers}
    specimen(values, model=model)
    del values["wall_thickness"]
    for read in (plan, specimen):
        with pytest.raises(InputError, match="wall_density gives a mass only with wall_thickness: give both, or wall"):
            read(values, model=model)
    del values["wall_density"]
    specimen({**values, "wall_mass": 160.0}, model=model)


@pytest.mark.parametrize("name", ["storey_stiffness", "storey_damping"])
def test_storeys_of_a_building_without_levels_are_refused(name: str) -> None:
    """A body without levels is rigid: the number would do nothing."""
    sentence = f"{name} is given but levels is not: give levels, the slab included, or leave it out"
    for read in (plan, specimen):
        with pytest.raises(InputError, match=sentence):
            read({**BUILDING, name: 1e6}, model="isolated")
    storeys = {**BUILDING, "storey_stiffness": 1e8, "storey_damping": 1e5}
    specimen({**storeys, "levels": 1}, model="isolated")
    plan(storeys, model="isolated", axes=f"{PGA}\nlevels = {{ values = [1, 3] }}")


@pytest.mark.parametrize("name", models.MODELS)
def test_a_model_checks_and_derives_under_its_default_words(name: str) -> None:
    model = models.get(name)
    values = {
        "housner": {"height": 1.8, "width": 0.5, "mass": 300.0},
        "isolated": {"total_mass": 3e5, "bearing_stiffness": 1e6, "bearing_damping": 1.5e5},
    }.get(name) or {**plan({**WALL, **({} if name == "stacked" else RUBBER)}, model=name).fixed}
    words = {option: known[0] for option, known in model.options.items()}
    assert words.items() <= model.resolve_options(None).items()
    assert model.check(values) == model.check(values, words) == []
    plain, said = model.derive(values), model.derive(values, words)
    for quantity, value in plain.items():
        np.testing.assert_array_equal(value, said[quantity])


def test_a_law_without_its_parameters_is_refused_before_anything_runs() -> None:
    laws = "rubber_law = { values = ['linear', 'mullins'] }"
    with pytest.raises(InputError, match="mullins"):
        plan({**WALL, **RUBBER}, axes=f"{PGA}\n{laws}")
    plan({**WALL, **RUBBER, "mullins.softening": 0.2}, axes=f"{PGA}\n{laws}")
    with pytest.raises(InputError, match="the rubber law of the bearings is mullins"):
        plan({**BUILDING, "rubber_thickness": 0.1}, model="isolated", axes=f"{PGA}\n{laws}")


def test_a_specimen_with_the_parameters_of_a_law_not_in_use() -> None:
    mullins = "[mechanisms.mullins]\nsoftening = 0.3\nstrain = 0.3\n"
    with pytest.raises(InputError, match="rubber law mullins are given, but the law in use is 'linear'"):
        specimen({**WALL, **RUBBER}, f"[options]\nrubber_law = 'linear'\n{mullins}")
    for word in ("mullins", "as_given"):
        specimen({**WALL, **RUBBER}, f"[options]\nrubber_law = '{word}'\n{mullins}")
    specimen({**WALL, **RUBBER}, f"[options]\ntop_rubber_law = 'mullins'\n{mullins}")
    with pytest.raises(InputError, match="the law in use is 'bouc_wen' and 'linear'"):
        specimen({**WALL, **RUBBER}, f"[options]\ntop_rubber_law = 'bouc_wen'\n{mullins}")
    with pytest.raises(InputError, match="rubber law mullins are given"):
        bouc_wen = "[mechanisms.bouc_wen]\npost_yield_ratio = 0.3\nyield_compression = 0.005\n"
        specimen(BUILDING, f"[options]\nrubber_law = 'bouc_wen'\n{mullins}{bouc_wen}", "isolated")


@pytest.mark.parametrize("name", ["damping_ratio", "base_damping_ratio", "top_damping_ratio"])
def test_a_forgotten_per_cent(name: str) -> None:
    ratios = (
        {"damping_ratio": 0.05} if name == "damping_ratio" else {"base_damping_ratio": 0.05, "top_damping_ratio": 0.05}
    )
    wall: dict[str, str | float] = {**WALL, **RUBBER}
    del wall["damping_ratio"]
    meant = f"{name} = 5.44 .*at most 1 .*5.44 % is 0.0544"
    for read in (plan, specimen):
        read({**wall, **ratios})
        read({**wall, **ratios, name: "5.44 %"})
        with pytest.raises(InputError, match=meant):
            read({**wall, **ratios, name: 5.44})
    others = {key: value for key, value in ratios.items() if key != name}
    with pytest.raises(InputError, match=meant):
        plan({**wall, **others}, axes=f"{name} = {{ values = [0.02, 5.44] }}")


def test_a_value_just_beyond_its_bound_is_no_per_cent() -> None:
    restitution = Targets(models.get("housner")).find("restitution", "here")
    with pytest.raises(InputError, match=r"at most 1\.$"):
        restitution.number(1.2, "here")
    with pytest.raises(InputError, match=r"93 % is 0.93"):
        restitution.number(93.0, "here")


@pytest.mark.parametrize("model", models.MODELS)
def test_every_damping_ratio_and_coefficient_of_restitution_is_a_share(model: str) -> None:
    for parameter in models.get(model).parameters:
        if parameter.name.endswith(("damping_ratio", "restitution")):
            assert parameter.high == 1.0, parameter.name


@given(data=st.data(), number=st.floats(-200.0, 200.0))
def test_what_was_perhaps_meant_is_allowed(data: st.DataObject, number: float) -> None:
    model = models.get(data.draw(st.sampled_from(models.MODELS)))
    targets = Targets(model)
    names = [p.name for p in model.parameters]
    names += [f"{m.name}.{p.name}" for m in model.mechanisms.values() for p in m.parameters]
    target = targets.find(data.draw(st.sampled_from(names)), "here")
    try:
        target.bounded(number, "here")
    except InputError as error:
        if " % is " in str(error):
            assert target.unit == "1" and not target.low <= number <= target.high
            assert target.bounded(number / 100.0, "here") == number / 100.0


def test_a_model_that_is_shaken_horizontally_only() -> None:
    record = "files = ['ridgecrest_2019_clc']\ncomponent = 'north'"
    for asked in (record, 'pulse = { shape = "sine", amplitude = "0.3 g", frequency = "1.5 Hz" }'):
        with pytest.raises(InputError, match="'isolated' is shaken horizontally only"):
            plan(BUILDING, model="isolated", motion=f"{asked}\nvertical = true")
    with pytest.raises(InputError, match="'isolated' is shaken horizontally only"):
        specimen(BUILDING, "[motion]\nvertical = true", "isolated")
    for said in ("", "\nvertical = false"):
        (motion,) = plan(BUILDING, model="isolated", motion=record + said).motions
        assert motion.vertical is None and "vertical" not in motion.components
    (motion,) = plan({**WALL, **RUBBER}, motion=record).motions
    assert motion.vertical is not None
    specimen(BUILDING, "[motion]\nvertical = false", "isolated")
