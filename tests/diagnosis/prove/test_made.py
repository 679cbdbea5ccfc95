"""Concealed cases made from a specimen: as the key says, the same by seed, telling nothing, and gone on with."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from diagnosis.prove import drawn, made
from diagnosis.prove.chain import KEY, prove
from diagnosis.prove.drawn import BASE_NOISE, CHANGES, REST, SCALES, Scene, draw
from grids.motions import Motion, read_motion
from grids.recordings import read_recording
from grids.specimen import Specimen, parse_specimen, read_specimen, with_mechanism, with_values
from models.errors import InputError
from rocking.commands import app
from study.history import simulate_specimen

TEXT = """
title = "Block B"
model = "housner"
[parameters]
width = "0.25 m"
height = "1 m"
mass = "500 kg"
[tolerance]
width = 0.003
[calibrate]
restitution = [0.75, 0.97]
"""
BUILDING = """
title = "Rigid building"
model = "isolated"
[parameters]
levels = 1
total_mass = "1 kg"
rubber_thickness = "0.2 m"
[calibrate]
bearing_stiffness = [1, 60]
bearing_damping = [0.05, 5]
"""
NOISE, SEED, CASES = 0.01, 3, 6


@pytest.fixture(scope="module")
def block() -> Specimen:
    return parse_specimen(TEXT)


@pytest.fixture(scope="module")
def motion() -> Motion:
    return read_motion("ridgecrest_2019_ccc", vertical=False).resampled(0.01).cut(10.0, 22.0)


def make(folder: Path, block: Specimen, motion: Motion, **changed: Any) -> list[str]:
    said: list[str] = []
    made.make(folder, block, [motion], **{"cases": CASES, "seed": SEED, "noise": NOISE, "say": said.append, **changed})
    return said


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, block: Specimen, motion: Motion) -> Path:
    where = tmp_path_factory.mktemp("made") / "cases"
    make(where, block, motion)
    return where


def entries(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / KEY).read_text())["cases"]
    return found


def truth(entry: dict[str, Any], known: Specimen) -> Specimen:
    specimen = with_values(known, entry["true_parameters"])
    for effect in entry["effects"]:
        specimen = with_mechanism(specimen, effect["name"], effect["parameters"])
    return replace(specimen, tolerance={}, measured={}, calibrate={})


def rested(motion: Motion) -> Motion:
    rest = np.zeros(round(REST / motion.time_step))
    return replace(motion, horizontal=np.concatenate([rest, motion.horizontal]))


def test_recordings_are_those_of_the_key_and_noise(folder: Path, motion: Motion) -> None:
    for name, entry in entries(folder).items():
        known = read_specimen(folder / name / "specimen.toml")
        for run, note in entry["recordings"].items():
            with xr.open_dataset(folder / name / f"{run}.nc") as read:
                history = simulate_specimen(truth(entry, known), rested(motion).shaking(), scale=note["scale"])
                for channel, share in (("rotation_1", NOISE), ("base_acceleration_x", BASE_NOISE)):
                    true = np.asarray(history[channel])
                    error = np.asarray(read[channel]) - true
                    assert error.std() == pytest.approx(share * np.abs(true).max(), rel=0.15), (name, run, channel)


def test_cases_are_null_single_and_pair_in_turn_and_effects_change_a_recording(
    folder: Path, block: Specimen, motion: Motion
) -> None:
    found = entries(folder)
    assert [entry["kind"] for entry in found.values()] == list(made.KINDS)
    assert [len(entry["effects"]) for entry in found.values()] == [drawn.EFFECTS[kind] for kind in made.KINDS]
    classes = [effect["class"] for effect in found["case_06"]["effects"]]
    assert len(set(classes)) == 2
    entry = found["case_01"]
    known, scale = read_specimen(folder / "case_01" / "specimen.toml"), entry["recordings"]["train_1"]["scale"]
    with_it, without = (
        np.asarray(simulate_specimen(truth(one, known), rested(motion).shaking(), scale=scale)["rotation_1"])
        for one in (entry, {**entry, "effects": []})
    )
    count = min(with_it.size, without.size)
    change = np.sqrt(np.mean((with_it[:count] - without[:count]) ** 2)) / (NOISE * np.abs(without).max())
    assert CHANGES[0] <= change <= CHANGES[1]
    assert entry["recordings"]["train_1"]["strength"] == pytest.approx(change, rel=1e-6)
    assert found["case_02"]["recordings"]["train_1"]["strength"] == 0.0


def test_nothing_but_the_key_tells_what_is_hidden(folder: Path, block: Specimen) -> None:
    names = {effect["name"] for entry in entries(folder).values() for effect in entry["effects"]}
    for case in sorted(folder.glob("case_*")):
        text = (case / "specimen.toml").read_text()
        assert not any(re.search(rf"\b{name}\b", text) for name in names)
        known = read_specimen(case / "specimen.toml")
        assert known.parameters == block.parameters and known.calibrate == block.calibrate
        for path in case.glob("*.nc"):
            with xr.open_dataset(path) as read:
                assert set(read.attrs) == {"Conventions"}
                assert set(read.data_vars) == {"rotation_1", "base_acceleration_x"}


def test_what_was_begun_goes_on_with_the_same_cases_and_settings(
    folder: Path, block: Specimen, motion: Motion, tmp_path: Path
) -> None:
    copy = tmp_path / "cases"
    shutil.copytree(folder, copy)
    assert make(copy, block, motion) == []
    key = json.loads((copy / KEY).read_text())
    shutil.rmtree(copy / "case_05")
    lost = key["cases"].pop("case_05")
    (copy / KEY).write_text(json.dumps(key))
    assert make(copy, block, motion) == [f"making 1 of {CASES} cases"]
    assert entries(copy)["case_05"] == lost
    for run in made.RUNS:
        paths = [where / "case_05" / f"{run}.nc" for where in (copy, folder)]
        with xr.open_dataset(paths[0]) as one, xr.open_dataset(paths[1]) as other:
            xr.testing.assert_equal(one, other)
    with pytest.raises(InputError, match="made with another noise"):
        make(copy, block, motion, noise=0.02)
    with pytest.raises(InputError, match="holds other files"):
        make(tmp_path, block, motion)


def test_a_specimen_that_no_motion_moves_is_said(block: Specimen, motion: Motion) -> None:
    with pytest.raises(InputError, match=f"does not move or falls under .*, scaled by {SCALES[0]:g}"):
        Scene.of(block, [motion.scaled(1e-3)], NOISE)


@pytest.fixture(scope="module")
def scene(block: Specimen, motion: Motion) -> Scene:
    return Scene.of(block, [motion], NOISE)


def only(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    known = drawn.candidates
    monkeypatch.setattr(drawn, "candidates", lambda *how: [one for one in known(*how) if one.name in names])
    monkeypatch.setattr(drawn, "DRAWS", 3)


def test_effects_of_a_pair_are_of_two_classes(monkeypatch: pytest.MonkeyPatch, scene: Scene) -> None:
    only(monkeypatch, "tilt", "accelerometer_offset")
    monkeypatch.setattr(drawn, "CHANGES", (0.0, np.inf))
    monkeypatch.setattr(drawn, "DRAWS", 15)
    with pytest.raises(InputError, match=r"no case \(pair\) could be drawn"):
        draw(scene, "pair", made.RUNS, np.random.default_rng(1))


def test_effects_that_the_noise_hides_are_not_drawn(monkeypatch: pytest.MonkeyPatch, scene: Scene) -> None:
    only(monkeypatch, "tilt")
    assert draw(scene, "single", made.RUNS, np.random.default_rng(1)).entry["effects"][0]["name"] == "tilt"
    monkeypatch.setattr(drawn, "CHANGES", (1e6, 1e7))
    with pytest.raises(InputError, match="less than 1e\\+06 or more than 1e\\+07 times their noise"):
        draw(scene, "single", made.RUNS, np.random.default_rng(1))


def test_the_second_effect_of_a_pair_changes_what_the_first_one_left(
    monkeypatch: pytest.MonkeyPatch, scene: Scene
) -> None:
    only(monkeypatch, "tilt", "viscous_damping")
    seen: list[tuple[xr.Dataset, xr.Dataset]] = []
    measured = drawn._change

    def watched(before: xr.Dataset, after: xr.Dataset, sigma: dict[str, float]) -> float:
        seen.append((before, after))
        return measured(before, after, sigma)

    monkeypatch.setattr(drawn, "_change", watched)
    monkeypatch.setattr(drawn, "DRAWS", 15)
    draw(scene, "pair", made.RUNS, np.random.default_rng(1))
    *of_effects, (before_second, _) = seen[: -len(made.RUNS)]  # the last ones are of the recordings, for the key
    assert any(before_second.equals(after) for _, after in of_effects)


def test_what_is_over_the_peak_is_over_that_of_the_specimen(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, motion: Motion
) -> None:
    only(monkeypatch, "offset")
    case = draw(scene, "single", made.RUNS, np.random.default_rng(1))
    (effect,) = case.entry["effects"]
    (share,) = effect["parameters"].values()
    for read in case.recordings.values():  # nothing moves at first
        rest = np.asarray(read["rotation_1"])[: round(0.8 * REST / motion.time_step)]
        assert case.specimen.reference_peak is not None
        error = 4.0 * NOISE * float(np.abs(read["rotation_1"]).max()) / np.sqrt(rest.size)
        assert rest.mean() == pytest.approx(share * case.specimen.reference_peak, abs=error)


def test_a_building_is_recorded_level_by_level(motion: Motion, tmp_path: Path) -> None:
    building = parse_specimen(BUILDING)
    made.make(tmp_path / "cases", building, [motion], cases=1, seed=SEED, noise=NOISE, say=lambda _: None)
    for run in made.RUNS:
        read = read_recording(tmp_path / "cases" / "case_01" / f"{run}.nc")
        assert read.responses == ("level_displacement_x",) and read.channels["level_displacement_x"].shape[0] == 1


def test_made_cases_are_proved(folder: Path, tmp_path: Path) -> None:
    """By an answer that says nothing: right in the cases in which nothing is hidden, and in no other."""
    keys = entries(folder)
    figures = prove(folder, tmp_path, jobs=1, say=lambda _: None, answering=silent)
    nulls = sum(entry["kind"] == "null" for entry in keys.values())
    assert figures["by_kind"] == {"null": nulls, "single": CASES - nulls - 1, "pair": 1}
    assert figures["false_alarm"] == figures["class_first"] == figures["pairs_both"] == 0.0


def silent(folder: Path) -> dict[str, Any]:
    return {
        "verdict": "nothing_missing", "effects": [], "rivals": [], "located": [], "constancy": [], "base": {},
        "fit": {"holdout": {"share_of_achievable": None}},
    }  # fmt: skip


def test_the_command_makes_and_proves(tmp_path: Path) -> None:
    specimen = tmp_path / "block.toml"
    specimen.write_text(TEXT)
    how = ["prove", str(tmp_path / "cases"), "--minutes", "0", "--out", str(tmp_path / "out")]
    with_make = [*how, "--make", str(specimen), "--motion", "ridgecrest_2019_ccc", "--cases", "1"]
    run = CliRunner().invoke(app, with_make)
    assert run.exit_code == 0, run.output
    assert "making 1 of 1 cases" in run.output and "0 of 1 cases were answered before" in run.output
    refused = CliRunner().invoke(app, [*with_make, "--noise", "0"])
    assert refused.exit_code == 2


@pytest.mark.parametrize(
    "words", [("--motion", "ridgecrest_2019_ccc"), ("--cases", "3"), ("--seed", "0"), ("--noise", "0.02")]
)
def test_what_makes_cases_is_refused_without_their_specimen(tmp_path: Path, words: tuple[str, str]) -> None:
    run = CliRunner().invoke(app, ["prove", str(tmp_path / "cases"), *words])
    assert run.exit_code == 2
    assert f"{words[0]} makes cases: name their specimen with --make" in run.output
