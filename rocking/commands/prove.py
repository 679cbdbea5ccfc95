"""``rocking prove DIR``: the whole chain on concealed cases, answered before the key is opened."""

from __future__ import annotations

from os.path import realpath
from pathlib import Path
from typing import Annotated

import typer

from models.errors import InputError
from rocking.commands.base import number

SHIPPED = ("ridgecrest_2019_ccc", "ridgecrest_2019_clc")
"""Motions of cases where none are named."""
STEP = 0.005
"""s between samples of a case."""
MOST_NOISE = 0.2
CASES, SEED, NOISE = 24, 1, 0.01


def prove(
    folder: Annotated[Path, typer.Argument(help="Folder with case_01, case_02 ... and answers.json, the key.")],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of answers and scores.", show_default="results/prove/PARENT_DIR, half, model"),
    ] = None,
    half: Annotated[str, typer.Option(help="all, odd or even: which cases, by their numbers.")] = "all",
    model: Annotated[str | None, typer.Option(help="Only cases whose specimen is of this model.")] = None,
    jobs: Annotated[int, typer.Option(help="Cases at once, one core each.", min=1)] = 2,
    minutes: Annotated[float, typer.Option(help="Begin no case after this time.", min=0.0)] = 600.0,
    make: Annotated[
        Path | None, typer.Option(help="Make the cases first: of this specimen (TOML), shaken by each --motion.")
    ] = None,
    motion: Annotated[list[str] | None, typer.Option(help="With --make: motions, as often as needed.")] = None,
    cases: Annotated[
        int | None, typer.Option(help="With --make: how many cases.", min=1, show_default=str(CASES))
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="With --make: other cases for another seed.", min=0, show_default=str(SEED)),
    ] = None,
    noise: Annotated[
        float | None,
        typer.Option(help="With --make: noise over the peak of each channel.", parser=number, show_default=str(NOISE)),
    ] = None,
) -> None:
    """Diagnose concealed cases, hash the answers, then open the key and score them.

    Writes answers, their hashes, prove.json (every share with its binomial interval), a list of wrong answers, and
    figures: confusion matrix, evidence against the size of the effect, said against true intervals. It goes on
    where it stopped. The form of the key is checked first; it is read for scoring only when every case is answered.

    With --make the cases are made in DIR by the model of the specimen itself: drawn within its tolerances and
    ranges, moved by scaled motions, with nothing missing, one effect of the library or two, and white noise. They show
    what such recordings could tell, not that the model is right.
    """
    from diagnosis.prove.chain import prove as prove_folder
    from rocking.commands.diagnose import make_folder

    only_to_make = {"--motion": motion or None, "--cases": cases, "--seed": seed, "--noise": noise}
    if make is not None:
        chosen = (CASES if cases is None else cases, SEED if seed is None else seed, NOISE if noise is None else noise)
        make_cases(folder, make, motion or [], *chosen)
    elif given := [name for name, value in only_to_make.items() if value is not None]:
        raise InputError(f"{given[0]} makes cases: name their specimen with --make, or leave it out.")
    place = out or default_folder(folder, half, model)
    make_folder(place)
    if prove_folder(folder, place, half=half, model=model, jobs=jobs, minutes=minutes, say=typer.echo):
        typer.echo(f"written: {place / 'prove.json'} and figures", err=True)


def make_cases(folder: Path, specimen: Path, motions: list[str], cases: int, seed: int, noise: float) -> None:
    """Cases of a specimen under motions, at 200 Hz at most. Raises InputError."""
    from diagnosis.prove.made import make
    from grids.motions import read_motion
    from grids.specimen import read_specimen

    if not 0.0 < noise < MOST_NOISE:
        raise InputError(
            f"--noise {noise:g}: give the noise over the peak of a channel, above 0 and below {MOST_NOISE:g}."
        )
    wall = read_specimen(specimen)
    read = [read_motion(name, vertical=wall.vertical) for name in motions or SHIPPED]
    read = [one.resampled(STEP) if one.time_step < STEP else one for one in read]
    make(folder, wall, read, cases=cases, seed=seed, noise=noise, say=typer.echo)


def default_folder(folder: Path, half: str, model: str | None) -> Path:
    """Its own for each choice of cases; many folders of cases are called ``cases``, so the one above counts too."""
    whole = Path(realpath(folder))  # resolve raises RuntimeError for a link to itself
    words = [whole.parent.name, whole.name, *([half] if half != "all" else []), *([model] if model else [])]
    return Path("results/prove") / "_".join(word for word in words if word)
