"""``rocking predict-outcomes ANSWER --outcomes TABLE --out FILE``: further runs from a saved answer."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.commands.outputs import in_answer, keep_inputs, keep_others
from rocking.commands.recordings import stages


def predict_outcomes(
    answer: Annotated[Path, typer.Argument(help="Folder that rocking diagnose --outcomes wrote.")],
    outcomes: Annotated[Path, typer.Option(help="Description (TOML) of the runs, outcomes known or not.")],
    out: Annotated[Path | None, typer.Option(help="Table (CSV) to write; printed without it.")] = None,
) -> None:
    """Predict which further runs overturn the specimen, with the chance of each.

    Where the description names a column of outcomes, the accuracy of the prediction is printed.
    """
    from diagnosis.outcomes import predict_outcomes as predict
    from diagnosis.outcomes.files import prediction_text, read_answer
    from diagnosis.outcomes.scores import scores
    from grids.files import parse_toml, read_text
    from grids.recordings.outcomes import read_outcomes
    from study.store import write_text

    if out is not None:
        described = parse_toml(read_text(outcomes, "description of outcomes"))
        table = outcomes.parent / str(described.get("table", ""))
        keep_inputs([out], [outcomes, table, *in_answer(answer)])
        keep_others(out)
    specimen, posterior = read_answer(answer)
    runs = read_outcomes(outcomes)
    with stages("stopped; nothing was written") as progress:
        found = predict(specimen, posterior, runs, lambda _, share: progress("predicting the runs", share))
    text = prediction_text(found)
    if out is None:
        typer.echo(text, nl=False)
    else:
        write_text(out, text)
        typer.echo(f"written: {out}", err=True)
    if runs.overturned is not None:
        figures = scores(found.chance, runs.overturned.astype(float), runs.groups)
        a, loss = figures.accuracy, figures.log_loss
        typer.echo(
            f"accuracy {a.value:.3f} ({a.low95:.3f} to {a.high95:.3f}), log-loss {loss.value:.3f}; "
            f"{figures.false_stands} fell against the prediction, {figures.false_falls} stood",
            err=True,
        )
