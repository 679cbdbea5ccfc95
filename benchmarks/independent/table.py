"""A comparison as rows that print as a table and go to JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """One number by both programs; ``setting``: what the other program was set to."""

    what: str
    unit: str
    setting: str
    ours: float
    theirs: float

    @property
    def difference(self) -> float:
        """Relative to ours, or absolute where ours is 0."""
        return (self.theirs - self.ours) / abs(self.ours) if self.ours else self.theirs

    def as_dict(self) -> dict[str, Any]:
        return {**asdict(self), "difference": self.difference}


def show(title: str, rows: list[Row]) -> None:
    """Print the rows as a Markdown table."""
    print(f"\n### {title}\n")
    print("| what | unit | setting | this program | other | difference |\n|---|---|---|---|---|---|")
    for row in rows:
        print(
            f"| {row.what} | {row.unit} | {row.setting} | {row.ours:.7g} | {row.theirs:.7g} | {row.difference:+.1e} |"
        )
