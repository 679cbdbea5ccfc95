"""Progress that is shown, and stages after the search: a Ctrl-C there costs the stage under way, not the answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

from models.errors import InputError

T = TypeVar("T")
Progress = Callable[[str, float], None]
"""Called with what is being done and the share of the whole that is done."""


def silent(text: str, share: float) -> None:
    """No progress shown."""


@dataclass
class Stages:
    """``stopped``: someone pressed Ctrl-C, so nothing that can be left out is begun; ``skipped`` names it.

    ``failed``: by stage that can be left out, why it could not be done; it costs that stage and not the answer.
    """

    stopped: bool = False
    skipped: list[str] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)

    def optional(self, what: str, stage: Callable[[], T], instead: Callable[[], T]) -> T:
        """The result of ``stage``, or of ``instead`` once a Ctrl-C was pressed and where it raises InputError."""
        if not self.stopped:
            try:
                return stage()
            except InputError as error:
                self.failed[what] = str(error)
                return instead()
            except KeyboardInterrupt:
                self.stopped = True
        self.skipped.append(what)
        return instead()

    def needed(self, stage: Callable[[], T]) -> T:
        """The result of ``stage``, without which there is no answer: begun anew after a first Ctrl-C."""
        if self.stopped:
            return stage()
        try:
            return stage()
        except KeyboardInterrupt:
            self.stopped = True
            return stage()
