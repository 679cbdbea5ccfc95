"""A figure as SVG: inside a page its colours are the page's and its text is text."""

from __future__ import annotations

import io
import re
from dataclasses import asdict, dataclass
from typing import Protocol

from matplotlib import rc_context
from matplotlib.axes import Axes

from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import NARROW, WIDE, figure_of

ROLES = {"#000001": "ink", "#000002": "before", "#000003": "accent", "#000004": "faint", "#000005": "band"}
"""Colours that stand for the page's custom properties while a figure is drawn."""
DRAWN = Palette(*ROLES)
NAMESPACES = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


class Draw(Protocol):
    """A figure function of `diagnosis.report.figures` that has its data."""

    def __call__(self, *, width: float = ..., palette: Palette = ...) -> Axes | tuple[Axes, ...]: ...


@dataclass(frozen=True)
class Picture:
    """A figure drawn for a desk and for a telephone, colours still open."""

    wide: str
    narrow: str

    def page(self) -> str:
        """Both for a page, whose style shows the one that fits."""
        return f'<div class="wide">{_of_page(self.wide)}</div><div class="narrow">{_of_page(self.narrow)}</div>'

    def file(self) -> str:
        """The wide one as a file of its own, for paper."""
        text = self.wide
        for colour, role in ROLES.items():
            text = text.replace(colour, asdict(PAPER)[role])
        style = "<style>text{font-family:Helvetica,Arial,sans-serif}</style>"
        return re.sub(r"(<svg[^>]*?)>", rf"\1 {NAMESPACES}>{style}", text, count=1) + "\n"


def picture(draw: Draw, name: str) -> Picture:
    """Draw a figure twice; ``name`` keeps the ids inside apart from those of other figures."""
    return Picture(_svg(draw, WIDE, f"{name}-wide"), _svg(draw, NARROW, f"{name}-narrow"))


def _svg(draw: Draw, width: float, salt: str) -> str:
    drawn = draw(width=width, palette=DRAWN)
    written = io.StringIO()
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": salt, "path.simplify_threshold": 0.6}):
        figure_of(drawn[0] if isinstance(drawn, tuple) else drawn).savefig(written, format="svg")
    return _stripped(written.getvalue())


def _of_page(text: str) -> str:
    for colour, role in ROLES.items():
        text = text.replace(colour, f"var(--{role})")
    return text


def _stripped(text: str) -> str:
    """Without what a page has no use for: metadata, sizes and names of the drawing program, long decimals."""
    text = text[text.index("<svg") :].rstrip()
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->|<style.*?</style>", "", text, flags=re.DOTALL)
    text = re.sub(r"<svg[^>]*(viewBox=\"[^\"]*\")[^>]*>", r"<svg \1>", text, count=1)
    text = re.sub(r'<g id="[^"]*"', "<g", text)
    text = re.sub(r' transform="rotate\(-0 [^"]*"', "", text)
    text = re.sub(r"font-family: [^;\"]*;? ?", "", text)
    text = re.sub(r' (?:d|x|y|transform)="[^"]*"', lambda found: _tenths_only(found[0]), text)
    text = re.sub(r"\s*\n\s*", "\n", text)
    return re.sub(r'\bd="([MLz\s\d.-]+)"', lambda found: f'd="{relative(found[1])}"', text)


def _tenths_only(attribute: str) -> str:
    return re.sub(r"(\d+\.\d)\d+", r"\1", attribute)


def relative(path: str) -> str:
    """A path of straight lines as steps from point to point, in tenths without drift: two thirds of its length."""
    parts = []
    x, y = 0, 0
    for command, rest in re.findall(r"([MLz])([^MLz]*)", path):
        if command == "z":
            parts.append("z")
            continue
        new_x, new_y = (round(10 * float(number)) for number in rest.split())
        parts.append(
            f"M{_tenths(new_x)} {_tenths(new_y)}l" if command == "M" else f"{_tenths(new_x - x)} {_tenths(new_y - y)} "
        )
        x, y = new_x, new_y
    return "".join(parts).replace(" -", "-").replace(" z", "z").rstrip("l ")


def _tenths(number: int) -> str:
    return f"{number / 10:.1f}".removesuffix(".0").replace("0.", ".", 1) if abs(number) < 10 else f"{number / 10:g}"
