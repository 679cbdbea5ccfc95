"""The one error a user's mistake raises: a sentence with what, where, value and cure."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """Something the user gave cannot be used; the message is one sentence that says the cure.

    The command line prints the message and exits with 2.
    """


def nearest(word: str, known: Iterable[str]) -> str:
    """End of a sentence about an unknown name: the closest known one, else all of them.

    >>> nearest("widht", ["width", "height"])
    "did you mean 'width'?"
    """
    names = sorted(known)
    close = difflib.get_close_matches(word, names, n=1)
    if close:
        return f"did you mean '{close[0]}'?"
    return "known: " + (", ".join(names) if names else "none") + "."
