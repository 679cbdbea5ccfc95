"""What Ctrl-C does: it ends the command at once while nothing has begun, and is an exception afterwards."""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

STOPPED = "stopped"
INTERRUPTED = 130
"""What Ctrl-C says and the exit code, where a command has nothing of its own to say."""


def end_at_once() -> None:
    """Until `raise_interrupts`, Ctrl-C ends the process: an exception inside an import may be reported as another."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _stop)


def raise_interrupts() -> None:
    """From here on Ctrl-C is an exception, which a command may take."""
    if signal.getsignal(signal.SIGINT) is _stop:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _stop(*_: Any) -> None:
    print(STOPPED, file=sys.stderr, flush=True)
    os._exit(INTERRUPTED)
