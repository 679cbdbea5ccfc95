"""Fuzz every reader and write the table: ``make fuzz``.

Readers that stand in the file already are kept, so that a broken off campaign goes on where it stopped. Inputs that
did harm are written beside the table, to be kept in ``tests/corpus``. Exit code 1 unless every column is zero.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import selectors
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.fuzz.readers import Reader, readers

OUT = Path("results/bench/fuzz.json")
COLUMNS = ("inputs", "ends", "tracebacks", "hangs", "over_memory", "silent")
SILENCE = 60.0
"""s without a word after which the process of a reader is taken for hung, in code that no signal reaches."""


def fuzz(reader: Reader, inputs: int, seed: int, corpus: Path) -> dict[str, Any]:
    """A row: processes are started until ``inputs`` are read, another one when an input has ended one."""
    row: dict[str, Any] = {"reader": reader.name, **dict.fromkeys(COLUMNS, 0), "seconds": 0.0, "notes": []}
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
                _keep(corpus, reader, (Path(folder) / reader.file).read_bytes())
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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=200_000, help="of all readers together")
    parser.add_argument("--only", default="", help="a part of the readers' names")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no reader after so long")
    parser.add_argument("--again", action="store_true", help="fuzz what the file has already")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=OUT)
    given = parser.parse_args()
    known = json.loads(given.out.read_text()) if given.out.exists() and not given.again else []
    rows = {row["reader"]: row for row in known}
    begun, all_readers = time.perf_counter(), list(readers())
    each = given.inputs / sum(reader.share for reader in all_readers)
    print(f"{'reader':<28}" + "".join(f"{name.replace('_', ' '):>13}" for name in COLUMNS))
    for reader in all_readers:
        if given.only not in reader.name:
            continue
        if reader.name not in rows and time.perf_counter() - begun < given.seconds:
            rows[reader.name] = fuzz(reader, round(each * reader.share) + 1, given.seed, given.out.with_suffix(""))
            given.out.parent.mkdir(parents=True, exist_ok=True)
            given.out.write_text(json.dumps(list(rows.values()), indent=1) + "\n")
        if reader.name in rows:
            print(f"{reader.name:<28}" + "".join(f"{rows[reader.name][name]:>13}" for name in COLUMNS), flush=True)
    bad = [row for row in rows.values() if any(row[name] for name in COLUMNS[2:])]
    for row in bad:
        print(f"\n{row['reader']}:", *row["notes"][:5], sep="\n  ")
    print(f"{sum(row['inputs'] for row in rows.values())} inputs, {len(bad)} readers with findings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
