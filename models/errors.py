"""The one error a user's mistake raises: a sentence with what, where, value and cure."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """Something the user gave cannot be used; the message is one sentence that says the cure.

    The command line prints the message and exits with 2.
    """


def nearest(word: str, known: Iterable[str], listed: Iterable[str] | None = None) -> str:
    """End of a sentence about an unknown name: the closest known one in any case, else all, or those ``listed``.

    >>> nearest("WIDHT", ["width", "height"])
    "did you mean 'width'?"
    """
    names = sorted(known)
    lowered = [name.lower() for name in names]
    close = difflib.get_close_matches(word.lower(), lowered, n=1)
    if close:
        return f"did you mean '{names[lowered.index(close[0])]}'?"
    return "known: " + (", ".join(names if listed is None else listed) or "none") + "."
