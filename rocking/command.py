"""The command ``rocking``."""

from __future__ import annotations

import sys

from rocking.interrupts import end_at_once


def main() -> None:
    """Start the command line, unless another package has taken the name of one of ours."""
    end_at_once()
    from rocking.rooms import find_intruder

    intruder = find_intruder()
    if intruder is not None:
        print(f"error: {intruder}", file=sys.stderr)
        sys.exit(2)
    from rocking.commands import app

    app()
