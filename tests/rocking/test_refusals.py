"""What a command refuses: the sentence names what was given on the command line, and its cure."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from rocking.commands import app

SPECIMEN = Path(__file__).parents[2] / "examples" / "from_a_data_logger" / "block.toml"
EXAMPLE = Path(__file__).parents[2] / "results" / "example.nc"


def refused(*words: object) -> str:
    """What a command says before it ends with 2."""
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 2, result.output
    return result.stderr


def simulated(*words: object) -> str:
    return refused("simulate", SPECIMEN, "--out", "history.nc", *words)


def test_a_pulse_of_any_length_is_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A text longer than the name of a file may be is read as the pulse that it is: this one has no such shape."""
    monkeypatch.chdir(tmp_path)
    pulse = f'pulse = {{ shape = "sinus", amplitude = "0.1{"0" * 250} g", frequency = "2 Hz" }}'
    assert "did you mean 'sine'" in simulated("--motion", pulse)


@pytest.mark.parametrize(("option", "value"), [("--scale", "3"), ("--component", "north")])
def test_options_of_a_motion_are_refused_without_one(option: str, value: str) -> None:
    assert f"a {option[2:]} without a motion has no effect" in simulated("--duration", 1, option, value)


def test_an_event_names_an_output_and_its_threshold_has_a_unit() -> None:
    def said(event: str) -> str:
        return refused("fragility", EXAMPLE, "--event", event)

    assert "'foo' is no output of this cube" in said("foo > 2 deg")
    assert "has no unit; write 'peak_rotation > 2 rad'" in said("peak_rotation > 2")
