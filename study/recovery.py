"""What of a study's folder can be relied on: blocks that are intact, and a manifest that fits them."""

from __future__ import annotations

from pathlib import Path

from grids.grid import Rectangle
from grids.plan import Plan
from models.errors import InputError
from study.keys import Setting, block_key
from study.manifest import DamagedManifest, Manifest
from study.store import BlockStore


def sound_manifest(plan: Plan, setting: Setting, folder: Path) -> Manifest | None:
    """The manifest of a folder if the plan continues it; None when there is none, or a damaged one.

    Raises InputError when the plan changes more than added axis values.
    """
    try:
        found = Manifest.load(folder)
    except DamagedManifest:
        return None
    if found is None:
        return None
    differences = found.differences(plan)
    if differences:
        raise InputError(
            f"{folder} holds a study that this plan changes; give the plan a new name or undo: "
            + "; ".join(differences)
        )
    return found if all(_fits(plan, setting, key, block) for key, block in found.blocks.items()) else None


def blocks_on_disk(plan: Plan, setting: Setting, store: BlockStore) -> dict[str, Rectangle]:
    """The intact blocks of a folder without a manifest, by key, from the coordinates in their files.

    Raises InputError when one of them belongs to another plan: nothing that was computed is given up unasked.
    """
    found = {}
    for key in sorted(store.finished()):
        if not store.is_intact(key):
            continue
        block = Rectangle(store.read(key)[0])
        if not _fits(plan, setting, key, block):
            raise InputError(
                f"{store.folder} has no readable manifest.json, and block {key} was computed for another plan or "
                "version: run the plan that the folder was started with (study.toml), or give this one a new name."
            )
        found[key] = block
    return found


def damaged_blocks(manifest: Manifest, store: BlockStore) -> list[str]:
    """Keys of blocks whose files are there but are not what was written."""
    return [key for key in sorted(manifest.blocks.keys() & store.finished()) if not store.is_intact(key)]


def _fits(plan: Plan, setting: Setting, key: str, block: Rectangle) -> bool:
    try:
        return block_key(plan, setting, block) == key
    except KeyError:  # an axis or a value that the plan does not have
        return False
