"""Every block of code of README and documentation is one that works: run, read or parsed as a reader would."""

from __future__ import annotations

import importlib
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import typer.main
import xarray as xr
from typer.testing import CliRunner

from grids.files import check, parse_toml
from grids.plan import parse_plan, read_plan
from grids.recordings import read_recording
from grids.recordings.outcomes import OutcomeFile
from grids.specimen import parse_specimen
from rocking.commands import app
from study.selection import on_grid

ROOT = Path(__file__).resolve().parents[1]
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.S | re.M)
WALL = '[study]\nname = "a"\nmodel = "housner"\n[parameters]\nwidth = 0.4\nheight = 1.8\nmass = 500\n'


@dataclass(frozen=True)
class Block:
    """A fenced block: the page, its language, its text."""

    page: str
    language: str
    text: str


def blocks(*languages: str) -> list[Block]:
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    found = [Block(page.name, *match) for page in pages for match in FENCE.findall(page.read_text("utf-8"))]
    return [block for block in found if block.language in languages]


def named(block: Block) -> str:
    return f"{block.page}: {block.text.strip().splitlines()[0]}"


def commands(block: Block) -> Iterator[list[str]]:
    """The words behind ``rocking`` of every line that calls it."""
    for line in block.text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] == ["rocking"]:
            yield words[1:]


@pytest.mark.slow
@pytest.mark.parametrize("block", blocks("python"), ids=named)
def test_python_runs_as_printed(block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a folder with the plans of the repository, which are thinned to at most four values an axis."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "studies").mkdir()
    for plan in (ROOT / "studies").glob("*.toml"):
        thin = re.sub(r"((?:lin|geom)space = \[[^,\]]+, [^,\]]+), \d+\]", r"\1, 4]", plan.read_text("utf-8"))
        (tmp_path / "studies" / plan.name).write_text(thin)
    exec(compile(block.text, block.page, "exec"), {})


@pytest.mark.parametrize("block", blocks("toml"), ids=named)
def test_toml_is_read(block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example = ROOT / "examples" / "from_a_data_logger"
    if "[columns]" in block.text:
        (table,) = (other.text for other in blocks("text") if other.page == block.page)
        *head, row, _ = table.splitlines()
        rows = [row.replace("0;", f"{5 * k};", 1) for k in range(20)]
        (tmp_path / "run.csv").write_text("\n".join([*head, *rows]).replace("#N/A", "0,0"))
        (tmp_path / "run.toml").write_text(block.text)
        assert len(read_recording(tmp_path / "run.csv").responses) == 2
    elif block.text.startswith("title"):
        assert parse_specimen(block.text).title
    elif block.text.startswith("table"):
        assert check(OutcomeFile, parse_toml(block.text)).motion
    else:
        text = block.text if "[study]" in block.text else WALL + block.text
        found = "[mechanisms.pivot_inset]\ninset_over_half_width = 0.05"
        answer = f"{(example / 'block.toml').read_text('utf-8')}\n{found}"
        (tmp_path / "answer").mkdir()
        (tmp_path / "answer" / "extended.toml").write_text(re.sub(r"\[calibrate\].*?(?=\n\[)", "", answer, flags=re.S))
        samples = {"pivot_inset.inset_over_half_width": ("sample", np.full(1000, 0.05), {"units": "1"})}
        xr.Dataset(samples).to_netcdf(tmp_path / "answer" / "posterior.nc")
        for recording in example.glob("shake_*"):
            (tmp_path / recording.name).symlink_to(recording)
        assert parse_plan(text, tmp_path).grid.size > 0


@pytest.mark.parametrize("block", [b for b in blocks("sh") if list(commands(b))], ids=named)
def test_commands_are_ones_that_exist(block: Block) -> None:
    """Names and options are parsed; what is selected from a study of the repository lies on its grid."""
    group = typer.main.get_command(app)
    for name, *words in commands(block):
        command = group.get_command(None, name)  # type: ignore[attr-defined]
        assert command is not None, name
        context = command.make_context(name, list(words))
        folder = Path(context.params.get("folder") or "")
        file = ROOT / "studies" / f"{folder.name}.toml"
        if (selected := context.params.get("select")) and file.exists():
            plan = read_plan(file)
            cube = xr.Dataset(coords={a.name: (a.name, a.values, {"units": a.unit}) for a in plan.axes})
            nearest = bool(context.params.get("nearest"))
            on_grid(cube, dict(entry.split("=", 1) for entry in selected), nearest=nearest)


def test_targets_of_make_are_ones_that_exist() -> None:
    """Those that pages, README and the changelog name, and those that are no files."""
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").glob("*.md")]
    named = {name for page in pages for name in re.findall(r"`make ([a-z-]+)`", page.read_text("utf-8"))}
    rules = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"^([a-z-]+):", rules, re.M))
    (phony,) = re.findall(r"^\.PHONY: (.+)$", rules, re.M)
    assert {"walls-bench", "stacks-bench"} <= named <= targets == set(phony.split())


def test_links_to_files_lead_to_files_of_the_repository() -> None:
    """Those that Sphinx does not follow; the pages are built with the gallery at the same place."""
    pages = [page.read_text("utf-8") for page in (ROOT / "docs").glob("*.md")]
    targets = [target for page in pages for target in re.findall(r'<a href="([^"#:]+)"', page)]
    assert targets and not [target for target in targets if not (ROOT / "docs" / target).is_file()]


def test_pages_leave_the_contents_to_the_theme(monkeypatch: pytest.MonkeyPatch) -> None:
    """Furo prints an error in place of a table of contents; it has its own beside every page."""
    monkeypatch.syspath_prepend(ROOT / "docs")
    declared = importlib.import_module("declared")
    pages = [page.read_text("utf-8") for page in (ROOT / "docs").glob("*.md")]
    assert not any("{contents}" in page for page in (*pages, declared.models_page(), declared.mechanisms_page()))


@pytest.mark.slow
def test_the_page_on_bearings_runs_as_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (plan,) = (block.text for block in blocks("toml") if block.page == "isolated.md")
    (tmp_path / "isolated.toml").write_text(plan)
    for block in blocks("sh"):
        if block.page == "isolated.md":
            for words in commands(block):
                result = CliRunner().invoke(app, words)
                assert result.exit_code == 0, result.output
    assert (tmp_path / "results" / "isolated" / "peak_bearing_displacement_map.png").stat().st_size > 5000
    with xr.open_dataset(tmp_path / "results" / "isolated" / "cube.nc") as cube:
        assert cube["status"].size == 432 and np.all(cube["peak_bearing_displacement"] > 0.0)
