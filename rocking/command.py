"""The command ``rocking``."""

from __future__ import annotations

import sys

from rocking.rooms import find_intruder


def main() -> None:
    """Start the command line, unless another package has taken the name of one of ours."""
    intruder = find_intruder()
    if intruder is not None:
        print(f"error: {intruder}", file=sys.stderr)
        sys.exit(2)
    from rocking.commands import app

    app()
