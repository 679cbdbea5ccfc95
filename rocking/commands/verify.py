"""``rocking verify``: the oracles and fingerprints on this machine."""

from __future__ import annotations

import typer

from rocking.commands.base import FAILURES


def verify() -> None:
    """Find known numbers of every model and say how many digits agree (exit code 1: too few somewhere)."""
    from study.provenance import machine, versions
    from study.verify import verify as verify_all

    typer.echo(", ".join(f"{name} {what}" for name, what in {**machine(), **versions()}.items()))
    report = verify_all(lambda line: typer.echo(str(line)))
    typer.echo(str(report))
    if not report.passed:
        raise typer.Exit(FAILURES)
