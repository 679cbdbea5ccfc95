"""The base layer is glued: it pulls until it tears."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.interface.layered import LayeredWall


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("bonded_layer", tearing=np.asarray(values["tearing_strain"]) * wall.base_thickness)


MECHANISM = Mechanism(
    name="bonded_layer",
    effect_class="bonded_layer",
    parameters=(
        MechanismParameter("tearing_strain", "eps_t", "1", "extension over thickness at which it tears", 0.0, 0.3),
    ),
    equation="stress -(k w + c w') where the layer has never been extended by more than eps_t e, pulled or pressed",
    signature="at the first uplift; nothing of it is left where the layer has torn",
    sentence="the base layer holds the wall down until it tears at a strain of {tearing_strain:.3f}",
    acts={"interface": on_interface},
    static_test="lift one edge of the wall and read the force",
    source="linear layer with a limit of extension: models/interface/strip.py",
)
