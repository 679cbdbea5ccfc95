"""The cache of machine code: stale code is never taken, and nobody else's is run."""

import os
import shutil
from functools import lru_cache
from pathlib import Path

import numba
import numpy as np
import pytest

import models
from models.lanes import compiler
from models.lanes.chunks import CHUNK, extremes

ROOT = Path(models.__file__).parent.parent
KERNELS = [f"models.{name}.lanes.advance" for name in models.MODELS]
OWN = ("carry.py", "centres.py")
"""Kernels of their own beside the one that advances."""


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    shutil.copytree(ROOT / "models", tmp_path / "models", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


@pytest.mark.parametrize("module", KERNELS)
def test_a_change_of_any_source_of_a_kernel_is_another_hash(
    copied: Path, module: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of every file that is loaded with the kernel and defines what it calls."""
    monkeypatch.setattr(compiler.ast, "parse", lru_cache(maxsize=None)(compiler.ast.parse))
    before = compiler.source_hash(module, copied)
    assert before == compiler.source_hash(module, ROOT)
    made_of = compiler.sources(module, copied)
    model = module.split(".")[1]
    compiled_in = {copied / path.relative_to(ROOT) for path in (ROOT / "models" / model / "lanes").rglob("*.py")}
    compiled_in = {
        path for path in compiled_in if path.name not in OWN and "from models.lanes.compiler import" in path.read_text()
    }
    assert compiled_in <= set(made_of), "every piece of the kernel belongs to it"
    assert copied / "models" / "lanes" / "compiler.py" in made_of
    for path in made_of:
        kept = path.read_bytes()
        path.write_bytes(kept + b"\n# changed\n")
        assert compiler.source_hash(module, copied) != before, path.name
        path.write_bytes(kept)


def test_kernels_optimised_more_or_less_are_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """`make test` compiles at a lower level: a study must not meet these."""
    found = set()
    for level in (1, 3):
        monkeypatch.setattr(numba.config, "OPT", level)
        found.add(compiler.source_hash(KERNELS[0]))
    assert len(found) == 2


def test_what_no_kernel_is_made_of_changes_nothing(copied: Path) -> None:
    before = compiler.source_hash(KERNELS[0], copied)
    (copied / "models" / "housner" / "model.py").write_text("changed = True\n")
    assert compiler.source_hash(KERNELS[0], copied) == before


def test_the_cache_is_the_users_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = compiler.cache_folder(KERNELS[0])
    assert folder.parent == tmp_path / "rocking-study"
    for path in (folder, folder.parent):
        assert path.stat().st_mode & 0o777 == 0o700 and path.stat().st_uid == os.getuid()


@pytest.mark.parametrize("how", ["others can write", "another user's", "a link"])
def test_a_folder_that_others_reach_is_refused(how: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache, spare = tmp_path / "cache", tmp_path / "spare"
    bad = cache / "rocking-study"
    spare.mkdir()
    bad.parent.mkdir()
    if how == "a link":
        bad.symlink_to(spare, target_is_directory=True)
    else:
        bad.mkdir()
        bad.chmod(0o777 if how == "others can write" else 0o700)
    if how == "another user's":
        if os.getuid() != 0:
            pytest.skip("only root can give a folder away")
        os.chown(bad, 12345, 12345)
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    monkeypatch.setattr(compiler.tempfile, "gettempdir", lambda: str(tmp_path))
    found = compiler.cache_folder(KERNELS[0])
    assert bad not in found.parents and spare not in found.parents
    assert found.is_dir() and found.stat().st_mode & 0o777 == 0o700


def test_a_user_without_a_home_has_a_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)

    def unknown() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(compiler.Path, "home", unknown)
    monkeypatch.setattr(compiler.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = compiler.cache_folder(KERNELS[0])
    assert folder.is_dir() and folder.parent.parent == tmp_path


def test_extremes_of_chunks_bound_every_step_of_them() -> None:
    channels = np.random.default_rng(1).standard_normal((3, 5 * CHUNK + 7))
    found = extremes(channels)
    assert found.shape == (3, 5)
    for c in range(5):
        inside = np.abs(channels[:, c * CHUNK : (c + 1) * CHUNK + 1])
        np.testing.assert_array_equal(found[:, c], inside.max(axis=1))
    np.testing.assert_array_equal(extremes(channels[:, : CHUNK - 1]), np.zeros((3, 1)))
