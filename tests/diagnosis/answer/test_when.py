"""When an effect acts, in words, in the extended specimen and in recordings that were not learned from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diagnosis.answer.heldout import compare
from diagnosis.answer.result import EffectStage, HeldStage
from diagnosis.answer.when import LASTS, held_text, when_text
from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.setup import base_fit, measure
from diagnosis.report.extended import extend
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation
from diagnosis.search.refit import extend as with_candidate
from diagnosis.search.spells import Spell
from grids.specimen import read_specimen
from grids.stages import intervals
from grids.write_specimen import specimen_text
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.report.example import diagnosis

NEVER = (0.0, 0.0)
ALWAYS = (0.0, LASTS)


@pytest.mark.parametrize(
    ("spans", "words"),
    [
        ([NEVER, (4.2, LASTS)], "from 4.2 s of b on, and stays"),
        ([NEVER, ALWAYS], "from b on and stays"),
        ([ALWAYS, (0.0, 3.0)], "until 3.0 s of b, and is gone then"),
        ([ALWAYS, NEVER], "in a only"),
        ([NEVER, ALWAYS, NEVER], "in b only"),
        ([(2.0, 5.0), NEVER], "from 2.0 s to 5.0 s of a only"),
        ([(2.0, LASTS), (0.0, 3.0)], "from 2.0 s of a to 3.0 s of b"),
        ([(2.0, LASTS), NEVER], "from 2.0 s of a to the end of a"),
    ],
)
def test_in_words(spans: list[tuple[float, float]], words: str) -> None:
    assert when_text([EffectStage(name, *span) for name, span in zip("abc", spans, strict=False)]) == words


def test_an_interval_is_said_beside_the_instant() -> None:
    stages = [EffectStage("a", 2.04, LASTS, begins_low95=1.9, begins_high95=2.3)]
    assert when_text(stages) == "from 2.0 s (1.9 to 2.3 s) of a on, and stays"


def test_the_extended_specimen_holds_the_stages(tmp_path: Path) -> None:
    found = diagnosis()
    stages = (EffectStage("a", 0.0, 0.0), EffectStage("b", 4.2, LASTS, 4.0, 4.4))
    name = found.effects[0].name
    written = extend(SPECIMEN, replace(found, effects=(replace(found.effects[0], stages=stages),)))
    path = tmp_path / "extended.toml"
    path.write_text(specimen_text(written))
    read = read_specimen(path)
    assert intervals(read.stages[name], "a") == ()
    assert intervals(read.stages[name], "b") == ((4.2, LASTS),)
    assert intervals(read.stages[name], None) != ()


def test_a_held_out_recording_of_what_came_and_went_has_its_own_interval() -> None:
    """A gain that was switched on and off again: found where the held-out recording has it, not where it has not."""
    switched = {"gain": {"gain": 0.1}}
    training = [recording("a", 1, switched), recording("b", 2)]
    measured = measure(SPECIMEN, training)
    base = Explanation((), base_fit(SPECIMEN, measured))
    [gain] = [c for c in candidates(measured, SPECIMEN) if c.name == "gain"]
    came = replace(gain, spell=Spell(0, 2.0, 0, None))
    explained = with_candidate(base, came, np.array([came.unknowns[0].coordinate(0.1)]))
    errors = estimate(base.fitted, disturbance_about(base.fitted))
    held = measure(SPECIMEN, [recording("c", 4, switched), recording("d", 5)], measured.reference_peak)
    shown = compare(base, explained, held, errors)
    there, not_there = shown.held_stages
    assert there.found_there and there.begins == 0.0 and there.ends == LASTS
    assert not_there.ends == not_there.begins == 0.0
    stays = with_candidate(base, replace(gain, spell=Spell(1, 2.0, 1, None)), came.null)
    assert all(not one.found_there and one.ends == LASTS for one in compare(base, stays, held, errors).held_stages)
    assert compare(base, explained, measured, errors).held_stages == ()


def test_the_state_of_a_held_out_recording_is_said() -> None:
    said = held_text(
        [HeldStage("gain", "c", 0.0, LASTS, False), HeldStage("gain", "d", 2.0, 4.0, True),
         HeldStage("gain", "e", 0.0, 0.0, True)]
    )  # fmt: skip
    assert "last recording learned from" in said[0]
    assert "from 2.0 s to 4.0 s" in said[1] and "found there" in said[1]
    assert "without it" in said[2]
