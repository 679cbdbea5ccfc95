"""Inputs for one reader, in a process of its own: ``python -m benchmarks.fuzz.campaign READER N SEED FOLDER``.

An input that ends where none has ended before (the lines of our code that its refusal passed through, or the sentence
without its numbers) joins the corpus that later inputs are made of. The input being read lies in FOLDER, so that it is
known if it ends the process; what went wrong is a line of JSON each.
"""

from __future__ import annotations

import json
import os
import random
import re
import resource
import signal
import sys
import time
import traceback
import warnings
from contextlib import suppress
from pathlib import Path
from types import FrameType

import psutil

from benchmarks.fuzz.mutate import mutate
from benchmarks.fuzz.readers import Reader, readers
from grids.netcdf_file import MORE_BYTES, TIMES_THE_FILE
from models.errors import InputError

LONGEST, WAITS = 5.0, 60.0
"""s of computing, by this process and those that it has started, and s by the clock, after which an input hangs."""
MOST_KEPT = 400
SAYS_EVERY = 5.0
"""s between two lines on how far it is: a silent process is taken for hung."""


class Hang(BaseException):
    """No code that is read catches this."""


def computed() -> float:
    """s of computing by this process and by those that it has started."""
    own = os.getpid()
    try:
        children = [int(word) for word in Path(f"/proc/{own}/task/{own}/children").read_text().split()]
    except OSError:  # not every kernel lists them; looking through all processes is slower
        children = [process.pid for process in psutil.Process().children()]
    used = 0.0
    for process in (own, *children):
        with suppress(psutil.NoSuchProcess):
            used += sum(psutil.Process(process).cpu_times()[:4])
    return used


class Alarm:
    """Raises Hang in what takes too long; on a busy machine a clock alone would tell the others' work."""

    def __init__(self) -> None:
        signal.signal(signal.SIGALRM, self._look)

    def set(self) -> None:
        self.begun, self.since = time.monotonic(), computed()
        signal.setitimer(signal.ITIMER_REAL, LONGEST, 1.0)

    def off(self) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0.0)

    def _look(self, number: int, frame: FrameType | None) -> None:
        if computed() - self.since > LONGEST or time.monotonic() - self.begun > WAITS:
            raise Hang


def peak_bytes() -> int:
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def attempt(reader: Reader, folder: Path, data: bytes, alarm: Alarm) -> tuple[str, str]:
    """Read one input: what went wrong ("" if nothing did) and where it ended."""
    (folder / reader.file).write_bytes(data)
    before = peak_bytes()
    alarm.set()
    wrong = where = ""
    try:
        said = reader.check(reader.read(folder))
        wrong, where = ("silent", said) if said else ("", "accepted")
    except InputError as error:
        lines = [f"{frame.filename}:{frame.lineno}" for frame in traceback.extract_tb(error.__traceback__)]
        where = " ".join(lines[-3:]) + re.sub(r"\d+|'.*'", "", str(error))[:60]
    except OSError as error:  # of the path: the command line turns it into a sentence
        wrong, where = ("", "path") if error.filename else ("tracebacks", traceback.format_exc())
    except Hang:
        wrong, where = "hangs", traceback.format_exc()
    except Exception:
        wrong, where = "tracebacks", traceback.format_exc()
    finally:
        alarm.off()
    if not wrong and peak_bytes() - before > TIMES_THE_FILE * len(data) + MORE_BYTES:
        wrong, where = "over_memory", f"{(peak_bytes() - before) / 1e6:.0f} MB for {len(data)} bytes"
    return wrong, where


def prepare(reader: Reader, folder: Path) -> None:
    """What lies beside the input."""
    (folder / reader.file).parent.mkdir(parents=True, exist_ok=True)
    for name, content in reader.beside.items():
        (folder / name).write_bytes(content)


def main() -> None:
    name, inputs, seed, place = sys.argv[1:]
    reader = next(reader for reader in readers() if reader.name == name)
    folder, draw = Path(place), random.Random(f"{name} {seed}")
    prepare(reader, folder)
    alarm = Alarm()
    warnings.simplefilter("error")
    corpus, seen = list(reader.seeds), set[str]()
    for data in reader.seeds:
        attempt(reader, folder, data, alarm)
    begun = said = time.perf_counter()
    for k in range(int(inputs)):
        source = draw.choice(corpus[-20:] if draw.random() < 0.3 else corpus)
        data = mutate(source, corpus, draw, reader.binary)
        wrong, where = attempt(reader, folder, data, alarm)
        if where not in seen:
            seen.add(where)
            if len(corpus) < MOST_KEPT:
                corpus.append(data)
            if wrong:
                print(json.dumps({"wrong": wrong, "where": where[-1500:], "input": data.hex()}), flush=True)
        elif wrong:
            print(json.dumps({"wrong": wrong}), flush=True)
        if time.perf_counter() - said > SAYS_EVERY:
            said = time.perf_counter()
            print(json.dumps({"inputs": k + 1, "ends": len(seen), "seconds": said - begun}), flush=True)
    print(json.dumps({"inputs": int(inputs), "ends": len(seen), "seconds": time.perf_counter() - begun}), flush=True)


if __name__ == "__main__":
    main()
