"""netCDF files of others, read in a process of their own so that a damaged one can do no harm."""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError

TIMES_THE_FILE, MORE_BYTES = 10, 100_000_000
"""Memory that reading may take: so many times the file's size, and so much more."""
LONGEST = 60.0
"""s after which an answer is given up, should the limit on computing time not hold."""


@dataclass(frozen=True)
class Variable:
    """A variable: ``values`` as float64 (nan where there is none), or ``text``; both None for other types."""

    dimensions: tuple[str, ...]
    attributes: Mapping[str, str]
    type: str
    values: NDArray[np.float64] | None
    text: tuple[str, ...] | None


@dataclass(frozen=True)
class NetcdfFile:
    """Global attributes and variables of a file."""

    attributes: Mapping[str, str]
    variables: Mapping[str, Variable]


def check_name(path: Path) -> None:
    """Raise InputError for a path that the netCDF library cannot open: a backslash is no letter to it."""
    text = str(path.absolute())
    if "\\" in text or text != text.encode("utf-8", "replace").decode("utf-8"):
        shown = text.encode("utf-8", "replace").decode("utf-8")
        raise InputError(
            f"{shown}: the netCDF library takes no path with a backslash or with letters that are not UTF-8; rename it"
        )


def read_netcdf(path: Path) -> NetcdfFile:
    """Everything in a netCDF file. Raises InputError without the name of the file when it cannot be read."""
    return _ask(path, True)


def read_attributes(path: Path) -> Mapping[str, str]:
    """The global attributes of a netCDF file of any size; raises InputError as `read_netcdf` does."""
    return _ask(path, False).attributes


def _ask(path: Path, variables: bool) -> NetcdfFile:
    check_name(path)
    try:
        size = path.stat().st_size
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror}): check the path and its rights") from None
    with _LOCK:
        return _reader().ask(path.absolute(), TIMES_THE_FILE * size + MORE_BYTES, variables)


def check_netcdf(path: Path) -> None:
    """Raise InputError when a process that reads the whole file does not survive it, or cannot read it."""
    done = subprocess.run([*_CHILD, str(path.absolute())], capture_output=True, env=_environment())
    if done.returncode:
        said = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["the netCDF library broke off"]
        raise InputError(f"not a readable netCDF file ({said[0]}); is it damaged or cut short?")


_CHILD = [sys.executable, "-P", "-m", "grids.netcdf_child"]
"""-P: a module of the current folder, where data lie, is not taken for a library."""


def _environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}


class Reader:
    """The process that reads, and the pipes to it."""

    def __init__(self) -> None:
        self.owner = os.getpid()
        self.process = subprocess.Popen(
            _CHILD,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=_environment(),
        )
        if self._answers.readline() != b"ready\n":
            self.stop()
            raise RuntimeError("the process that reads netCDF files does not start: is netCDF4 installed?")

    @property
    def usable(self) -> bool:
        return self.owner == os.getpid() and self.process.poll() is None

    @property
    def _answers(self) -> IO[bytes]:
        if self.process.stdout is None:
            raise RuntimeError("the process that reads netCDF files has no output")
        return self.process.stdout

    def ask(self, path: Path, most_bytes: int, variables: bool) -> NetcdfFile:
        timer = threading.Timer(LONGEST, self.process.kill)
        timer.start()
        try:
            request = json.dumps({"path": str(path), "bytes": most_bytes, "variables": variables}) + "\n"
            if self.process.stdin is not None:
                self.process.stdin.write(request.encode())
                self.process.stdin.flush()
            line = self._answers.readline()
            if not line.endswith(b"\n"):
                raise BrokenPipeError
            return self._contents(json.loads(line))
        except (BrokenPipeError, EOFError):
            self.stop()
            raise InputError(
                "not a readable netCDF file (the netCDF library broke off reading it); is it damaged or cut short?"
            ) from None
        except BaseException as error:
            if not isinstance(error, InputError):
                self.stop()  # between question and answer: the next one would read the rest of this one
            raise
        finally:
            timer.cancel()

    def _contents(self, answer: dict[str, Any]) -> NetcdfFile:
        if "error" in answer:
            raise InputError(f"not a readable netCDF file ({answer['error']}); is it damaged or cut short?")
        variables = {}
        for one in answer["variables"]:
            values = self._numbers(one["shape"]) if one.get("numbers") else None
            text = tuple(one["text"]) if "text" in one else None
            variables[one["name"]] = Variable(tuple(one["dimensions"]), one["attributes"], one["type"], values, text)
        return NetcdfFile(answer["attributes"], variables)

    def _numbers(self, shape: list[int]) -> NDArray[np.float64]:
        values = np.empty(shape)
        data = self._answers.read(values.nbytes)
        if len(data) != values.nbytes:
            raise EOFError
        return np.frombuffer(data, np.float64).reshape(shape).copy()

    def stop(self) -> None:
        if self.owner == os.getpid():
            self.process.kill()
            self.process.communicate()


_LOCK = threading.Lock()
_READERS: list[Reader] = []


def _reader() -> Reader:
    """The running process, or a new one."""
    if _READERS and not _READERS[0].usable:
        _READERS.pop().stop()
    if not _READERS:
        _READERS.append(Reader())
        atexit.register(_READERS[0].stop)
    return _READERS[0]
