"""python -m benchmarks.diagnosis: concealed cases of our own, made, answered, scored."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.diagnosis.suite import EVALUATION_SEED


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.diagnosis", description=__doc__)
    parser.add_argument(
        "what", nargs="?", default="diagnosis",
        choices=("diagnosis", "laboratory", "processed", "beginnings", "walls", "stacks", "bases", "nameless", "power",
                 "methods", "same"),
        help="cases with white noise (default), with a laboratory's errors, processed after recording, with effects "
        "that begin, of walls on rubber, of two stacked blocks or of wrong base models, where single effects are found "
        "without a name, what estimating the errors costs in power, what other methods say of the first, or whether "
        "two runs over them agree",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, default=Path("results/bench"), help="folder of the results")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--minutes", type=float, default=600.0, help="begin no case after this time")
    parser.add_argument("--run", default="answers", help="name of this run: another one answers anew")
    parser.add_argument("--against", default="before", help="of same: the run that --run is compared with")
    parser.add_argument("--cases", type=int, help="only the first so many of our own cases")
    parser.add_argument(
        "--kind", choices=("null", "mismatch", "single", "pair", "open"), help="only cases of this kind of a benchmark"
    )
    parser.add_argument("--seed", type=int, default=EVALUATION_SEED, help="of our own cases")
    given = parser.parse_args()
    common = {"jobs": given.jobs, "minutes": given.minutes, "run": given.run, "say": say}
    if given.what == "methods":
        from benchmarks.diagnosis.methods import compare

        compare(given.out, seed=given.seed, cases=given.cases, **common)
    elif given.what in ("nameless", "power"):
        from benchmarks.diagnosis.nameless import nameless
        from benchmarks.diagnosis.power import power

        measured = {"nameless": nameless, "power": power}[given.what]
        measured(given.out, seed=given.seed, cases=given.cases, jobs=given.jobs, say=say)
    elif given.what == "same":
        from benchmarks.diagnosis.same import same

        if not same(given.out, seed=given.seed, run=given.run, against=given.against, say=say):
            raise SystemExit(1)
    else:
        from benchmarks.diagnosis.bench import bench

        bench(given.what, given.out, seed=given.seed, cases=given.cases, kind=given.kind, **common)


def say(text: str) -> None:
    print(text, flush=True)


if __name__ == "__main__":
    main()
