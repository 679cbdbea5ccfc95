"""What a worker must have before it computes a block: the code of the run, and the folder of the study.

The records of a study travel with its blocks; nothing else is needed.
"""

from __future__ import annotations

import os
import uuid
from dataclasses import dataclass
from pathlib import Path

from models.errors import InputError
from study.code import code_version
from study.provenance import machine

MARK = ".lock"
"""The file in the folder of a study that holds the mark of the run at work there."""


class UnfitWorker(InputError):
    """A worker lacks what the run needs of it."""


@dataclass(frozen=True)
class Needs:
    """``code`` of the run, the ``folder`` of its study, and the ``mark`` that the run has left there."""

    code: str
    folder: Path
    mark: str

    @classmethod
    def of_run(cls, folder: Path) -> Needs:
        """Leave a mark in the folder, which only this run holds."""
        mark = uuid.uuid4().hex
        with (folder / MARK).open("r+", encoding="ascii") as file:
            file.write(mark)
            file.flush()
            os.fsync(file.fileno())
        return cls(code_version(), folder, mark)

    def check(self) -> None:
        """Raise UnfitWorker unless this process runs the same code and reads and writes the same folder."""
        host = machine()["host"]
        if self.code != code_version():
            raise UnfitWorker(
                f"the worker on {host} runs another version of this program, or of numpy or numba: "
                "install the same on every machine and start its worker anew"
            )
        if not self._sees_the_folder():
            raise UnfitWorker(
                f"the worker on {host} does not see {self.folder} as this machine does: choose by --results a folder "
                "that all machines share under one path"
            )
        if not os.access(self.folder, os.W_OK):
            raise UnfitWorker(
                f"the worker on {host} may not write in {self.folder}: give its user the right to, or choose another "
                "folder by --results"
            )

    def _sees_the_folder(self) -> bool:
        try:
            return (self.folder / MARK).read_text("ascii") == self.mark
        except (OSError, UnicodeDecodeError):
            return False
