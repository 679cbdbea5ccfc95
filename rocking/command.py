"""The command ``rocking``."""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

STOPPED = "stopped"
INTERRUPTED = 130
"""What Ctrl-C says and the exit code, where a command has nothing of its own to say."""


def main() -> None:
    """Start the command line, unless another package has taken the name of one of ours."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _stop)
    from rocking.rooms import find_intruder

    intruder = find_intruder()
    if intruder is not None:
        print(f"error: {intruder}", file=sys.stderr)
        sys.exit(2)
    from rocking.commands import app

    app()


def raise_interrupts() -> None:
    """From here on Ctrl-C is an exception, which a command may take."""
    if signal.getsignal(signal.SIGINT) is _stop:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _stop(*_: Any) -> None:
    """End at once: nothing has begun, and an exception in the midst of an import may be told as something else."""
    print(STOPPED, file=sys.stderr, flush=True)
    os._exit(INTERRUPTED)
