"""Files of others are data: nothing in them is executed, and what they name is not written elsewhere."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

from diagnosis.report.page import environment
from grids.netcdf_file import Reader
from grids.plan import parse_plan
from models.errors import InputError
from tests.sources import FILES, ORDER, ROOT, nodes, place
from tests.study.plans import plan_text

EXECUTES = {
    "eval", "exec", "compile", "__import__", "pickle.load", "pickle.loads", "marshal.load", "marshal.loads",
    "shelve.open",    "os.system",
    "os.popen", "yaml.load", "joblib.load", "cloudpickle.load", "cloudpickle.loads", "np.fromregex",
}  # fmt: skip
LISTENS = {"socket.socket", "http.server", "socketserver", "flask", "tornado", "bokeh", "aiohttp", "uvicorn"}
KNOWN = {("models/lanes/sealed_cache.py", "pickle.loads")}
"""Machine code that this user compiled, from a folder that only this user can write, after its checksum."""


def calls(paths: Iterable[Path]) -> Iterator[tuple[Path, str, ast.Call]]:
    """Every call by the name it has in the text, beside its file."""
    for path, node in nodes(paths):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute):
            yield path, ast.unparse(node.func), node


@pytest.mark.parametrize("room", ORDER)
def test_no_data_is_executed(room: str) -> None:
    for path, called, call in calls(FILES[room]):
        said = f"{place(path)}: {called}"
        assert called not in EXECUTES or (place(path), called) in KNOWN, said
        words = {keyword.arg: ast.unparse(keyword.value) for keyword in call.keywords}
        assert words.get("shell") != "True", said
        if called in ("np.load", "numpy.load"):
            assert words.get("allow_pickle") == "False", said
        if called in ("subprocess.run", "subprocess.Popen"):  # a list of words, never one line for a shell
            assert not isinstance(call.args[0], ast.Constant | ast.JoinedStr), said


@pytest.mark.parametrize("room", ORDER)
def test_nothing_listens(room: str) -> None:
    """No page is served: reports are files that open without a network."""
    for path, node in nodes(FILES[room]):
        named = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        named += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        assert not any(module.startswith(tuple(LISTENS)) for module in named), f"{place(path)}: {named}"
        assert not (isinstance(node, ast.Attribute) and ast.unparse(node) in LISTENS), place(path)


@pytest.mark.parametrize("module", ["json", "netCDF4", "numpy"])
def test_a_module_beside_the_data_is_not_imported(module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder of recordings may hold a file that is called like a library."""
    (tmp_path / f"{module}.py").write_text("import pathlib; pathlib.Path('executed').touch()\n")
    monkeypatch.chdir(tmp_path)
    reader = Reader()
    reader.stop()
    assert not (tmp_path / "executed").exists()


@pytest.mark.parametrize("name", ["..", "../x", "a/b", "/x", ".hidden", "", "a\\b", "x\n", "é/..", "con\0"])
def test_the_name_of_a_study_stays_in_the_folder_of_results(name: str) -> None:
    quoted = name.replace("\\", "\\\\").replace("\n", "\\n").replace("\0", "\\u0000")
    with pytest.raises(InputError, match="becomes a folder"):
        parse_plan(plan_text(name=quoted, motion='pulse = { shape = "sine" }'), Path.cwd())


def test_templates_escape_whatever_they_are_given() -> None:
    """Only pictures that this program drew are put in as they are; text in them is escaped where it is drawn."""
    pages = environment()
    assert pages.from_string("{{ x }}").render(x="<script>") != "<script>"
    folder = ROOT / "diagnosis" / "report" / "templates"
    for template in folder.glob("*.j2"):
        text = template.read_text("utf-8")
        assert callable(pages.autoescape) and pages.autoescape(template.name)
        assert text.count("safe") == (template.name == "macros.html.j2"), template.name
        assert "http://" not in text and "https://" not in text and "<script" not in text
