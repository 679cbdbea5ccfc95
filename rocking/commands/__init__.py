"""The commands, one file each."""

from __future__ import annotations

import typer

from rocking.commands import (
    calibrate,
    check,
    cloud,
    diagnose,
    export,
    fragility,
    ida,
    map,
    motions,
    plan,
    predict_outcomes,
    prove,
    run,
    sensitivity,
    simulate,
    slices,
    spectra,
    status,
    verify,
)
from rocking.commands.base import Commands

COMMANDS = (
    plan.plan,
    run.run,
    status.status,
    check.check,
    export.export,
    map.map_,
    slices.slices,
    fragility.fragility,
    ida.ida,
    cloud.cloud,
    spectra.spectra,
    sensitivity.sensitivity,
    motions.motions,
    simulate.simulate,
    calibrate.calibrate,
    diagnose.diagnose,
    predict_outcomes.predict_outcomes,
    prove.prove,
    verify.verify,
)

app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Parameter studies, maps and simulations of rocking walls.",
)
for command in COMMANDS:
    app.command(command.__name__.rstrip("_").replace("_", "-"))(command)
