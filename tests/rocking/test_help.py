"""What the help of a command promises is what the command does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import xarray as xr

from rocking.commands.diagnose import diagnose
from rocking.commands.map import map_
from rocking.commands.motions import motions
from rocking.commands.outputs import ANSWER
from rocking.commands.simulate import simulate
from study.figures.save import check_suffix
from study.maps import default_axes


def test_every_file_of_an_answer_is_named() -> None:
    assert diagnose.__doc__ is not None
    assert not [name for name in ANSWER if name not in diagnose.__doc__]


@pytest.mark.parametrize("command", [simulate, motions])
def test_the_endings_of_figures_are_accepted_and_those_of_the_refusal(command: object) -> None:
    with pytest.raises(ValueError, match=r"end the name in") as refused:
        check_suffix(Path("figure.nothing"))
    named = re.findall(r"\.(?:png|pdf|svg|jpg)", str(command.__annotations__["figure"]))
    assert named == re.findall(r"\.(?:png|pdf|svg|jpg)", str(refused.value))
    for ending in named:
        check_suffix(Path(f"figure{ending}"))


def test_pga_is_an_axis_of_a_map_only_where_no_other_is_left() -> None:
    assert "only where no other is left" in str(map_.__annotations__["y"])
    two = xr.Dataset(coords={"pga": [1.0, 2.0], "height": [1.0, 2.0]})
    assert default_axes(two, None, None) == ("height", "pga")
    three = two.assign_coords(width=[1.0, 2.0])
    assert default_axes(three, None, None) == ("height", "width")
