"""Every value of a plan's cells, defaults included, with where it comes from."""

from __future__ import annotations

from pathlib import Path

import pytest

import models
from grids.entering import entering
from grids.plan import parse_plan
from models.errors import InputError

WALL = """
[study]
name = "a"
model = "interface"
[parameters]
aspect_ratio = 0.4
wall_height = "1.8 m"
wall_thickness = "0.138 m"
wall_density = 900
top_mass = "5 t"
top_length = "2 m"
top_height = "0.6 m"
layer_thickness = "10 mm"
layer_modulus = "4.5 MPa"
damping_ratio = 0.05
"""
MOTION = '[motion]\nfiles = ["ridgecrest_2019_clc"]\n'


def found(text: str, folder: Path = Path()) -> dict[str, tuple[float | str, str]]:
    return {entry.name: (entry.value, entry.source) for entry in entering(parse_plan(text, folder))}


def test_a_mechanism_in_use_brings_its_defaults() -> None:
    pga = '[axes]\npga = { values = [1, 2], unit = "m/s^2" }\n'
    plain = found(WALL + MOTION + pga)
    assert plain["gravity"] == (9.80665, "default") and plain["top_mass"] == (5000.0, "plan")
    assert plain["dashpot"] == ("B", "default") and plain["tail"] == (10.0, "default")
    assert not any("." in name for name in plain) and "pga" not in plain
    softened = found(WALL + '"mullins.softening" = 0.3\n' + MOTION + pga)
    strain = models.get("interface").mechanisms["mullins"].parameter("strain").null
    assert softened["mullins.softening"] == (0.3, "plan") and softened["mullins.strain"] == (strain, "default")
    apart = '"mullins.softening" = 0.3\n"mullins.strain_base" = 0.4\n"mullins.strain_top" = 0.5\n'
    both = found(WALL + apart + MOTION + pga)
    assert both["mullins.strain_base"] == (0.4, "plan") and "mullins.strain" not in both
    varied = found(WALL + MOTION + '[axes]\n"mullins.softening" = { values = [0.1, 0.3] }\n')
    assert "mullins.softening" not in varied and varied["mullins.strain"] == (strain, "default")


@pytest.mark.parametrize("own", [True, False])
def test_a_value_of_the_specimen_is_said_to_be_its(own: bool, tmp_path: Path) -> None:
    (tmp_path / "wall.toml").write_text(
        'title = "w"\nmodel = "housner"\n[parameters]\nwidth = 0.4\nheight = 1.8\nmass = 500\n'
        "[mechanisms.tilt]\ntilt = 0.01\n"
    )
    text = '[study]\nname = "a"\nspecimen = "wall.toml"\n' + MOTION
    text += f"{'[parameters]' if own else '[axes]'}\nmass = {600 if own else '{ values = [500, 700] }'}\n"
    values = found(text, tmp_path)
    assert values["width"] == (0.4, "specimen") and values["tilt.tilt"] == (0.01, "specimen")
    assert values.get("mass") == ((600.0, "plan") if own else None)


def test_what_decides_an_effect_and_has_no_natural_default_is_asked_for() -> None:
    bouc_wen = '"bouc_wen.post_yield_ratio" = 0.4\n'
    with pytest.raises(InputError, match=r"'bouc_wen.yield_compression' \(.*, m\) is missing"):
        found(WALL + bouc_wen + MOTION)
    given = found(WALL + bouc_wen + '"bouc_wen.yield_compression" = "2 mm"\n' + MOTION)
    assert given["bouc_wen.yield_compression"] == (0.002, "plan") and given["bouc_wen.exponent"] == (1.0, "default")
