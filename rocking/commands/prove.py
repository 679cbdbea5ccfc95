"""``rocking prove DIR``: the whole chain on concealed cases, answered before the key is opened."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def prove(
    folder: Annotated[Path, typer.Argument(help="Folder with case_01, case_02 ... and answers.json, the key.")],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of answers and scores.  [default: results/prove/PARENT_DIR, with half and model]"),
    ] = None,
    half: Annotated[str, typer.Option(help="all, odd or even: which cases, by their numbers.")] = "all",
    model: Annotated[str | None, typer.Option(help="Only cases whose specimen is of this model.")] = None,
    jobs: Annotated[int, typer.Option(help="Cases at once, one core each.", min=1)] = 2,
    minutes: Annotated[float, typer.Option(help="Begin no case after this time.", min=0.0)] = 600.0,
) -> None:
    """Diagnose concealed cases, hash the answers, then open the key and score them.

    Writes answers, their hashes, prove.json (every share with its binomial interval), a list of wrong answers, and
    figures: confusion matrix, evidence against the size of the effect, said against true intervals. It goes on
    where it stopped. The form of the key is checked first; it is read for scoring only when every case is answered.
    """
    from diagnosis.prove.chain import prove as prove_folder
    from rocking.commands.diagnose import make_folder

    place = out or default_folder(folder, half, model)
    make_folder(place)
    if prove_folder(folder, place, half=half, model=model, jobs=jobs, minutes=minutes, say=typer.echo):
        typer.echo(f"written: {place / 'prove.json'} and figures", err=True)


def default_folder(folder: Path, half: str, model: str | None) -> Path:
    """Its own for each choice of cases; many folders of cases are called ``cases``, so the one above counts too."""
    whole = folder.resolve()
    words = [whole.parent.name, whole.name, *([half] if half != "all" else []), *([model] if model else [])]
    return Path("results/prove") / "_".join(word for word in words if word)
