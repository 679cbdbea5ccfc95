"""Which cells belong to which block: fixed at the first start, kept in ``manifest.json``.

An axis that grows adds blocks for the new cells only; the old ones stay as they are.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from grids.changes import compare, describe
from grids.grid import Rectangle
from grids.plan import Plan
from models.errors import InputError
from study.keys import Setting, block_key
from study.provenance import as_json, sha256
from study.store import write_text

FORMAT = 2


class DamagedManifest(InputError):
    """``manifest.json`` is not what a run wrote."""


@dataclass(frozen=True)
class Manifest:
    """What decides the cells of a study (see `grids.changes.describe`), and its blocks by key.

    ``plan_folder``: where the paths in the frozen plan start.
    """

    description: Mapping[str, Any]
    blocks: Mapping[str, Rectangle]
    plan_folder: str

    @classmethod
    def start(
        cls, plan: Plan, most_cells: int, plan_folder: str, finished: Mapping[str, Rectangle] | None = None
    ) -> Manifest:
        """The manifest of a study: ``finished`` blocks, the other cells in blocks of at most ``most_cells``."""
        return cls({}, finished or {}, plan_folder).extended(plan, most_cells)

    def differences(self, plan: Plan) -> tuple[str, ...]:
        """What the plan changes beyond adding axis values; empty: the study can go on."""
        return compare(self.description, _through_json(describe(plan))).differences

    @property
    def cells(self) -> int:
        return sum(block.size for block in self.blocks.values())

    def extended(self, plan: Plan, most_cells: int) -> Manifest:
        """The manifest with blocks for the axis values that the plan adds."""
        added = plan.grid.new_rectangles(list(self.blocks.values()), most_cells)
        return replace(self, description=describe(plan), blocks={**self.blocks, **_keyed(plan, added)})

    def save(self, folder: Path) -> None:
        """Write ``manifest.json`` whole or not at all."""
        record = {
            "format": FORMAT,
            "plan_folder": self.plan_folder,
            "description": self.description,
            "blocks": {key: block.as_json() for key, block in self.blocks.items()},
        }
        record["sha256"] = checksum(record)
        write_text(folder / "manifest.json", as_json(record) + "\n")

    @classmethod
    def load(cls, folder: Path) -> Manifest | None:
        """The manifest of a folder; None when it has none. Raises DamagedManifest."""
        path = folder / "manifest.json"
        if not path.is_file():  # a pipe would be waited for
            return None
        try:
            record = json.loads(path.read_text("utf-8"))
            if record.pop("sha256") != checksum(record) or record["format"] != FORMAT:
                raise ValueError("its checksum or format is another")
            blocks = {key: Rectangle.from_json(block) for key, block in record["blocks"].items()}
            return cls(record["description"], blocks, record["plan_folder"])
        except (KeyError, TypeError, AttributeError, RecursionError, ValueError) as error:
            raise DamagedManifest(
                f"{path} is damaged ({error}): run the plan again, it is made anew from the plan and the blocks"
            ) from None

    @classmethod
    def of(cls, folder: Path) -> Manifest:
        """The same; InputError where there is none."""
        found = cls.load(folder)
        if found is not None:
            return found
        if (folder / "blocks").is_dir():
            raise InputError(
                f"{folder}: manifest.json is lost: run the plan again, it is made anew and finished blocks are kept"
            )
        raise InputError(f"{folder} holds no study: give a folder under results/ that a run has written")


def _keyed(plan: Plan, blocks: Iterable[Rectangle]) -> dict[str, Rectangle]:
    setting = Setting.of(plan)
    return {block_key(plan, setting, block): block for block in blocks}


def checksum(record: Mapping[str, Any]) -> str:
    """The sha256 of a manifest's content, by its keys in order."""
    return sha256(as_json(record, sort_keys=True))


def _through_json(description: Mapping[str, Any]) -> Any:
    """The description as it reads back from a file, so that both sides compare alike."""
    return json.loads(as_json(description))
