"""How far a study is, from its folder alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from study.manifest import Manifest
from study.recovery import damaged_blocks
from study.store import BlockStore
from study.tally import tally, tally_line


@dataclass(frozen=True)
class State:
    """``damaged``: keys of blocks whose files have changed; ``failures``: the reason by block key; ``tally``:
    cells of the cube by what became of them, None without one."""

    folder: Path
    cells: int
    cells_done: int
    blocks: int
    blocks_done: int
    damaged: tuple[str, ...]
    failures: Mapping[str, str]
    tally: Mapping[str, int] | None

    def __str__(self) -> str:
        cube = (
            "no cube yet: run the plan to go on"
            if self.tally is None
            else f"cube.nc is written; {tally_line(self.tally)}"
        )
        if self.cells:
            done = f"{self.blocks_done} of {self.blocks} blocks, {self.cells_done} of {self.cells} cells"
            done += f" ({self.cells_done / self.cells:.1%})"
        else:  # refined: its blocks follow from what was found
            done = f"refined study, {self.blocks_done} blocks"
        lines = [f"{self.folder}: {done}", f"failed blocks: {len(self.failures)}", cube]
        if self.damaged:
            lines.append(f"damaged blocks: {len(self.damaged)} ({', '.join(self.damaged[:3])}): run the plan again")
        lines += [f"  failed/{key}.txt: {text.strip().splitlines()[-1]}" for key, text in self.failures.items()]
        return "\n".join(lines)


def state(folder: str | Path) -> State:
    """How far the study of a folder is. Raises InputError when it holds none."""
    folder = Path(folder)
    manifest = Manifest.of(folder)
    store = BlockStore(folder)
    damaged = damaged_blocks(manifest, store)
    done = (manifest.blocks.keys() & store.finished()).difference(damaged)
    return State(
        folder=folder,
        cells=manifest.cells,
        cells_done=sum(manifest.blocks[key].size for key in done),
        blocks=len(manifest.blocks),
        blocks_done=len(done) if manifest.blocks else len(store.finished()),
        damaged=tuple(damaged),
        failures=store.failures(),
        tally=tally(folder) if (folder / "cube.nc").exists() else None,
    )
