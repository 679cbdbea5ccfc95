"""The report page: self-contained, complete, well formed, the same twice."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial
from html.parser import HTMLParser
from pathlib import Path
from typing import get_args

import pytest

from diagnosis.answer.result import Diagnosis, OtherModel, Verdict
from diagnosis.forces.constancy import BLOW, FOR_A_WHILE, Constancy
from diagnosis.report.figures import plot_raster
from diagnosis.report.page import report_page
from diagnosis.report.pictures import drawings
from diagnosis.report.svg import Picture, picture
from tests.diagnosis.report.example import diagnosis, recordings, specimen

VOID = {"meta", "br", "hr", "img", "link", "input"}


class Outline(HTMLParser):
    """Checks that tags close in their order, and collects ids, references and the text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.references: list[str] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        self._note(attributes)

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self._note(attributes)

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open[-1] == tag, (tag, self.open[-3:])
        self.open.pop()

    def handle_data(self, data: str) -> None:
        if "style" not in self.open:
            self.text.append(data)

    def _note(self, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name == "id" and value:
                self.ids.append(value)
            if name in ("href", "src", "xlink:href") and value:
                self.references.append(value)


def render(found: Diagnosis, drawn: dict[str, Picture] | None = None) -> str:
    *train, test = recordings()
    if drawn is None:
        drawn = dict.fromkeys(pictures_of(found), Picture("<svg></svg>", "<svg></svg>"))
    return report_page(found, specimen(), train, [test], drawn)


def pictures_of(found: Diagnosis) -> list[str]:
    return list(drawings(found, specimen(), recordings()))


def outline(page: str) -> Outline:
    parsed = Outline()
    parsed.feed(page)
    parsed.close()
    assert not parsed.open
    return parsed


def test_page_stands_alone(answer: Path) -> None:
    page = (answer / "report.html").read_text("utf-8")
    parsed = outline(page)
    assert all(reference.startswith("#") for reference in parsed.references)
    assert not re.search(r"https?://(?!www\.w3\.org)|url\((?!#)|@import|<script", page)
    assert len(parsed.ids) == len(set(parsed.ids))
    assert {reference[1:] for reference in parsed.references} <= set(parsed.ids)
    assert len(page) < 500_000


def test_page_follows_a_dark_screen(answer: Path) -> None:
    page = (answer / "report.html").read_text("utf-8")
    assert "prefers-color-scheme: dark" in page
    assert not re.findall(r"(?:fill|stroke): ?#", page)


@pytest.mark.parametrize("verdict", get_args(Verdict))
def test_page_says_what_was_found(verdict: Verdict) -> None:
    found = diagnosis(verdict)
    words = " ".join(outline(render(found)).text)
    assert found.statement in words
    for effect in found.effects:
        assert effect.name.replace("_", " ") in words
        assert "0.1161 to 0.1247" in words
    for rival in found.rivals:
        assert rival.name.replace("_", " ") in words
    if found.next_experiment:
        assert found.next_experiment["static_test"] in words and "46" in words
    assert ("extended.toml" in words) and ("Traceback" not in words) and ("None" not in words)
    if found.missing_force:
        assert "depends on the rotation" in words
    assert ("What does not stay the same" in words) == bool(found.constancy)


@pytest.mark.parametrize(("nearest", "drawn"), [([None, 0.1], True), ([None, None], False), (None, False)])
def test_the_caption_names_a_dashed_curve_only_where_one_is_drawn(
    nearest: list[float | None] | None, drawn: bool
) -> None:
    """A force on the upper block of a wall has none."""
    found = diagnosis("not_in_library")
    assert found.missing_force is not None
    terms = [{**term, "nearest": nearest} for term in found.missing_force["terms"]]
    words = " ".join(outline(render(replace(found, missing_force={**found.missing_force, "terms": terms}))).text)
    assert "The law in a table with its 95 % band" in words
    assert ("dashed what the nearest mechanism, added stiffness," in words) is drawn


def test_page_says_that_shaking_again_would_not_tell() -> None:
    found = diagnosis("cannot_tell_apart")
    alone = {
        "separates": ["tilt", "eccentricity"],
        "recording": None,
        "sensor": None,
        "static_test": "weigh the corners",
    }
    words = " ".join(" ".join(outline(render(replace(found, next_experiment=alone))).text).split())
    assert "weigh the corners" in words and "under 1" in words and "as well" not in words


def test_page_says_when_it_was_stopped() -> None:
    assert "stopped before its end" in render(replace(diagnosis(), finished=False))
    assert "stopped before its end" not in render(diagnosis())


def test_page_lists_no_commit_where_none_is_known() -> None:
    known = diagnosis("missing")
    unknown = replace(known, provenance={**known.provenance, "commit": None})
    assert "<dt>commit</dt>" in render(known) and "<dt>commit</dt>" not in render(unknown)


def test_page_of_a_search_stopped_at_once_has_its_own_next_step() -> None:
    found = replace(diagnosis("cannot_tell_apart"), effects=(), rivals=(), next_experiment=None, p_value=None)
    words = " ".join(" ".join(outline(render(replace(found, finished=False))).text).split())
    assert "Stopped before anything was found" in words and "not tested" in words and "Run it again" in words
    assert "or a rival" not in words and "with  switched on" not in words and "hold all the same" not in words


def test_page_without_held_out_recordings_or_screen() -> None:
    found = replace(diagnosis("nothing_missing"), holdout=None, screen=(), prediction_horizon={})
    words = " ".join(outline(render(found)).text)
    assert "held-out" not in words and "What could be missing" not in words


def test_page_tells_the_levels_of_a_building_apart() -> None:
    """A channel that would tell rivals apart may be of a level that no recording holds."""
    wider = {f"level_displacement_x_{level}": {"bearing_stiffness": 2.5} for level in (0, 1)}
    offered = {
        "separates": ["bouc_wen", "mullins"],
        "recording": None,
        "sensor": {"channel": "level_acceleration_x_2", "noise": "1% of its peak", "expected_evidence": 40.0},
        "static_test": "",
    }
    page = render(replace(diagnosis("cannot_tell_apart"), channels=wider, next_experiment=offered))
    words = " ".join(" ".join(outline(page).text).split())
    assert "horizontal displacement of level 0" in words and "horizontal displacement of level 1" in words
    assert "Record the absolute horizontal acceleration of level 2 as well" in words


def test_words_of_a_user_are_no_markup() -> None:
    page = render(replace(diagnosis(), statement="a < b & <b>bold</b>"))
    assert "a &lt; b &amp; &lt;b&gt;bold&lt;/b&gt;" in page


def test_drawn_twice_is_the_same() -> None:
    first, second = (picture(partial(plot_raster, diagnosis().windows), "raster") for _ in range(2))
    assert first == second


def test_page_says_what_each_channel_adds() -> None:
    wider = {"rotation_1": {"width": 3.25, "height": float("inf")}, "displacement_1_x": {"width": 1.5, "height": 1.0}}
    page = render(replace(diagnosis(), channels=wider))
    section = page.partition("What each channel adds")[2].partition("</section>")[0]
    assert "×3.25" in section
    assert "not told" in section


def test_page_says_what_was_not_tried_and_why() -> None:
    assert "was not tried" not in render(diagnosis("missing"))
    page = render(replace(diagnosis("missing"), not_tried={"table_pitch": "no channel that it shows in"}))
    assert "table pitch: no channel that it shows in" in " ".join(outline(page).text)


@pytest.mark.parametrize("other", [None, OtherModel("second_body", "stacked", {}, {}, 80.0, (), True, False)])
def test_what_is_left_over_is_named_whichever_model_explains_the_recordings(other: OtherModel | None) -> None:
    """A blow is no force of any model; another base model has forces of its own."""
    port = "viscous_damping_top" if other else BLOW
    left = Constancy(port, FOR_A_WHILE, 84.0, "from 2.52 s of shake_1")
    page = render(replace(diagnosis("not_in_library"), constancy=(left,), other_model=other))
    assert "from 2.52 s of shake_1" in page
