"""What a kind of fault did: one row of the table."""

from __future__ import annotations

from dataclasses import dataclass, field

HELPFUL = ("error:", "stopped", "cells recomputed:")
"""One of these stands in what a command says when it does not do its work."""


@dataclass
class Row:
    """Counts of one kind; ``notes`` say what was found, ``seconds`` what it took."""

    kind: str
    injections: int = 0
    blocks_lost: int = 0
    wrong_cells: int = 0
    unreadable: int = 0
    unclear_messages: int = 0
    seconds: float = 0.0
    notes: list[str] = field(default_factory=list)

    @property
    def clean(self) -> bool:
        return not (self.blocks_lost or self.wrong_cells or self.unreadable or self.unclear_messages)

    def heard(self, code: int, said: str) -> None:
        """Judge what a command printed: no traceback ever, and a sentence where it did not do its work."""
        silent = code > 0 and not any(word in said for word in HELPFUL)
        if "Traceback" in said or silent:
            self.unclear_messages += 1
            self.notes.append(f"exit code {code}: {said.strip()[-400:]}")

    def finished(self, code: int, said: str) -> None:
        """Judge a command that has to succeed."""
        self.heard(code, said)
        if code:
            self.unreadable += 1
            self.notes.append(f"does not go on, exit code {code}: {said.strip()[-400:]}")
