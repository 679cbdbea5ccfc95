"""Fuzz every reader and write the table: ``make fuzz``.

Readers that stand in the file already are kept, so that a broken off campaign goes on where it stopped. Inputs that
did harm are written beside the table, to be kept in ``tests/corpus``. Exit code 1 unless every column is zero.
"""

from __future__ import annotations

import hashlib
import json
import selectors
import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.by_row import Row, fill, parser
from benchmarks.fuzz.readers import Reader, readers

OUT = Path("results/bench/fuzz.json")
COLUMNS = ("inputs", "ends", "tracebacks", "hangs", "over_memory", "silent")
SILENCE = 60.0
"""s without a word after which the process of a reader is taken for hung, in code that no signal reaches."""


def fuzz(reader: Reader, inputs: int, seed: int, corpus: Path) -> Row:
    """A row: processes are started until ``inputs`` are read, another one when an input has ended one."""
    row: Row = {"reader": reader.name, **dict.fromkeys(COLUMNS, 0), "seconds": 0.0, "notes": []}
    attempts = 0
    while row["inputs"] < inputs and attempts < 20:
        with TemporaryDirectory(prefix="fuzz-") as folder:
            words = [reader.name, str(inputs - row["inputs"]), f"{seed} {attempts}", folder]
            done, hung = _campaign(words)
            progress = [line for line in done if "inputs" in line]
            last = progress[-1] if progress else {"inputs": 0, "ends": 0, "seconds": 0.0}
            row["inputs"] += last["inputs"]
            row["ends"] = max(row["ends"], last["ends"])
            row["seconds"] += round(last["seconds"], 1)
            for line in done:
                if "wrong" in line:
                    row[line["wrong"]] += 1
                    if "input" in line:
                        row["notes"].append(f"{line['wrong']}: {line['where']}")
                        _keep(corpus, reader, bytes.fromhex(line["input"]))
            if row["inputs"] < inputs:
                row["hangs" if hung else "tracebacks"] += 1
                row["notes"].append("hung where no signal reaches" if hung else "the process ended")
                read = Path(folder) / reader.file
                if read.is_file():  # not where it ended before the first input
                    _keep(corpus, reader, read.read_bytes())
        attempts += 1
    return row


def _campaign(words: list[str]) -> tuple[list[dict[str, Any]], bool]:
    """What the process of a reader printed, and whether it was killed because it fell silent."""
    command = [sys.executable, "-m", "benchmarks.fuzz.campaign", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        lines, hung = [], False
        with selectors.DefaultSelector() as waiting:
            waiting.register(process.stdout, selectors.EVENT_READ)
            while True:
                if not waiting.select(SILENCE):
                    process.kill()
                    hung = True
                line = process.stdout.readline()
                if not line:
                    return lines, hung
                lines.append(json.loads(line))


def _keep(corpus: Path, reader: Reader, data: bytes) -> None:
    folder = corpus / reader.name.replace(" ", "_").replace(",", "")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / hashlib.sha256(data).hexdigest()[:12]).write_bytes(data)


def main() -> int:
    """Print the table row by row."""
    asked = parser(__doc__, OUT)
    asked.add_argument("--inputs", type=int, default=200_000, help="of all readers together")
    given = asked.parse_args()
    all_readers = list(readers())
    each, corpus = given.inputs / sum(reader.share for reader in all_readers), given.out.with_suffix("")
    makers = {r.name: partial(fuzz, r, round(each * r.share) + 1, given.seed, corpus) for r in all_readers}
    return fill(given, "reader", COLUMNS, COLUMNS[2:], makers)


if __name__ == "__main__":
    sys.exit(main())
