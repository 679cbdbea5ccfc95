"""Channels at positions on the bodies: written, read back, and refused in a sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import models
from grids.recordings import read_recording
from grids.recordings.placed import attributes, read_place
from grids.specimen import parse_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from models.kinematics import Place
from rocking.simulation import simulate

TABLE = {"quantity": "displacement", "position_x": "-12 cm", "direction": "z"}


def test_a_csv_with_a_table_for_its_gauge(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("a,w\n" + "0.1,2.5\n" * 20)
    (tmp_path / "run.toml").write_text(
        'time_step = "5 ms"\n[columns]\nbase_acceleration_x = { column = "a", unit = "g" }\n'
        'lvdt_left = { column = "w", unit = "mm", sign = -1 }\n'
        '[channels.lvdt_left]\nquantity = "displacement"\nposition_x = "-12 cm"\ndirection = "z"\n'
    )
    read = read_recording(tmp_path / "run.csv")
    assert read.places["lvdt_left"] == Place("displacement", 1, -0.12, 0.0, "z", "base")
    np.testing.assert_allclose(read.channels["lvdt_left"], -2.5e-3)
    assert read.responses == ("lvdt_left",)


@pytest.mark.parametrize(
    "place",
    (
        Place("displacement", 2, -0.1, 0.3, "along", "body_below"),
        Place("acceleration", 1, 0.0, 1.8, "across", "absolute"),
        Place("angular_velocity", 2),
        Place("uplift", 1, 0.125),
    ),
)
def test_attributes_say_all_of_a_place(place: Place) -> None:
    assert read_place("gauge", attributes(place)) == place


@pytest.mark.parametrize("quantity", ["uplift", "compression"])
@pytest.mark.parametrize(("layer", "body"), [("base_layer", 1), ("top_layer", 2)])
def test_a_layer_is_the_joint_under_its_body(quantity: str, layer: str, body: int) -> None:
    named = read_place("gauge", {"quantity": quantity, "body": layer, "position_x": 0.1})
    assert named == Place(quantity, body, 0.1) and read_place("gauge", attributes(named)) == named


@pytest.mark.parametrize("joint", ["base", "top"])
def test_a_gauge_in_a_layer_reads_how_far_it_is_compressed(joint: str) -> None:
    text = 'title = "w"\nmodel = "interface"\n[parameters]\nwall_length = 0.72\nwall_height = 1.8\nwall_mass = 161.0\n'
    text += "top_mass = 5000.0\ntop_length = 0.72\ntop_height = 0.6\nlayer_thickness = 0.01\nbase_stiffness = 5e7\n"
    text += "top_stiffness = 5e7\nbase_damping = 6e5\ntop_damping = 5e5\n[initial]\nrotation_1 = 0.002\n"
    ran = simulate(
        parse_specimen(f'{text}[channels.gauge]\nquantity = "compression"\nbody = "{joint}_layer"\n'), duration=0.3
    )
    read, layer = ran["gauge"].values, ran[f"compression_{joint}"].values
    assert np.ptp(layer) > 1e-7  # m
    np.testing.assert_allclose(read - read[0], layer - layer[0], atol=1e-12)


@pytest.mark.parametrize("name", ["top", "oben_ä"])
def test_a_specimen_with_channels_is_written_and_read_back(name: str) -> None:
    text = 'title = "b"\nmodel = "housner"\n[parameters]\nwidth = 0.4\nheight = 1.6\nmass = 1000.0\n'
    text += f'[channels."{name}"]\nquantity = "acceleration"\nposition_z = "1.6 m"\ndirection = "across"\n'
    specimen = parse_specimen(text)
    assert specimen.places[name].relative_to == "absolute"
    assert parse_specimen(specimen_text(specimen)) == specimen


@pytest.mark.parametrize(
    ("changed", "said"),
    (
        ({"quantity": "displacment"}, "displacement"),
        ({"quantity": "force", "position_x": "10 mm"}, "whole joint"),
        ({"quantity": "force", "position_x": 0, "position_z": 0, "relative_to": "", "direction": "along"}, "along"),
        ({"body": 13}, "body = 13"),
        ({"body": "base_layer"}, "body = 'base_layer'; it is 1 (the lower, or the only one), 2"),
        ({"quantity": "uplift", "direction": "", "body": "middle"}, "may also be of base_layer or top_layer"),
        ({"direction": "up"}, "direction"),
        ({"relative_to": "absolute"}, "subtract"),
        ({"position_x": "12 kg"}, "position_x"),
        ({"position_x": -200.0}, "'-200 mm'"),
        ({"quantity": "uplift"}, "no direction"),
        ({"poition_x": 1.0}, "position_x"),
    ),
)
def test_what_is_wrong_is_said_with_the_channel_and_a_cure(changed: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match="channel lvdt_left") as error:
        read_place("lvdt_left", {**TABLE, **changed})
    assert said in str(error.value)


BLOCK = 'title = "b"\nmodel = "housner"\n[parameters]\nwidth = 0.5\nheight = 2.0\nmass = 1000.0\n'


def test_no_channel_is_named_like_anything_else_in_a_history() -> None:
    specimen = parse_specimen(f"{BLOCK}[initial]\nrotation_1 = 0.1\n")
    history = simulate(specimen, duration=0.1)
    taken = [str(name) for name in history.variables]
    assert {"time", "event_time", "rotation_1"} < set(taken)
    for name in (*taken, "event", "level"):
        with pytest.raises(InputError, match=rf"^\[channels\.{name}\]: "):
            parse_specimen(f'{BLOCK}[channels.{name}]\nquantity = "displacement"\n')


def test_no_channel_is_named_like_a_quantity_of_the_model() -> None:
    place = Place("compression", 1, 0.1)
    models.get("housner").check_place("compression_base", place, {})
    with pytest.raises(InputError, match=r"channel compression_base: model interface computes .* rename the channel"):
        models.get("interface").check_place("compression_base", place, {})


@pytest.mark.parametrize(
    ("mechanism", "quantity", "predicted"),
    [
        ("table_pitch]\npitch_per_acceleration = 0.003\nlow_pass_hz = 30", "acceleration", False),
        ("table_pitch]\npitch_per_acceleration = 0.003\nlow_pass_hz = 30", "force", False),
        ("table_pitch]\npitch_per_acceleration = 0.003\nlow_pass_hz = 30", "displacement", True),
        ("crushing]\ninset_per_rotation = 3.0", "uplift", False),
        ("crushing]\ninset_per_rotation = 3.0", "rotation", True),
        ("pivot_inset]\ninset_over_half_width = 0.3", "uplift", True),
    ],
)
def test_what_a_channel_is_not_predicted_with_is_refused(mechanism: str, quantity: str, predicted: bool) -> None:
    """A base that turns moves what stands on it; pivots that move are not those of the reading."""
    block = f"{BLOCK}[initial]\nrotation_1 = 0.1\n[mechanisms.{mechanism}\n"
    specimen = parse_specimen(f'{block}[channels.sensor]\nquantity = "{quantity}"\n')
    if predicted:
        assert simulate(specimen, duration=0.1)["sensor"].size > 10
        return
    name = mechanism.partition("]")[0]
    with pytest.raises(InputError, match=f"sensor is not predicted with {name}: .*; leave the channel or {name} out"):
        simulate(specimen, duration=0.1)


@pytest.mark.parametrize(("slip", "meant"), [("positon_x", "position_x"), ("Relative_to", "relative_to")])
def test_a_misspelt_attribute_is_refused_and_a_foreign_one_is_not(tmp_path: Path, slip: str, meant: str) -> None:
    """Passed over, it would leave the channel in the middle of the body."""
    time = 0.01 * np.arange(200)
    held = {
        "base_acceleration_x": ("time", np.sin(9.0 * time), {"units": "m s-2"}),
        "lvdt": ("time", 0.01 * np.sin(5.0 * time), {"units": "m", "quantity": "displacement", "positive": "up"}),
    }
    recording = xr.Dataset(held, coords={"time": ("time", time, {"units": "s"})})
    recording.to_netcdf(tmp_path / "sound.nc")
    assert "lvdt" in read_recording(tmp_path / "sound.nc").places
    recording["lvdt"].attrs[slip] = "base"
    recording.to_netcdf(tmp_path / "slip.nc")
    with pytest.raises(InputError, match=f"channel lvdt: attribute '{slip}' is not known; did you mean '{meant}'"):
        read_recording(tmp_path / "slip.nc")
