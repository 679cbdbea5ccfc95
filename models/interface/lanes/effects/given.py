"""From the effects of walls to the tables of their lanes, and the energy of their joints."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.base import FloatArray
from models.interface.chain import masses
from models.interface.effects import BENDS, CELLS, FROZEN_OVER, LANDED, MEMORIES, STATES, Effects
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.rows import W
from models.interface.layered import LayeredWall
from models.interface.stored import static_compressions, stored
from models.interface.table import TABLES, merged
from models.lanes.tables import filled
from models.rubber import lanes as rubber
from models.tables import KNOTS

ACTS = {
    "table_pitch": e.PITCHES,
    "one_sided_stiffness": e.HALVES,
    "degradation": e.HALVES | e.WEARS,
    "bonded_layer": e.HALVES | e.BONDS,
    "contact_length": e.HALVES | e.FREEZES,
    "coulomb_damping": e.DRIES,
    "sliding": e.DRIES,
    "table_force": e.TABLES_ACT,
    "interface_shear": e.SHEARS,
}
"""The parts of a step that a mechanism needs beside those that always run."""


def given_effects(
    wall: LayeredWall, effects: Effects | None, initial: Mapping[str, FloatArray], rest: FloatArray
) -> More:  # fmt: skip
    """For n walls from ``initial`` by name; what is left out is as at ``rest`` (n, 8)."""
    effects = effects or Effects.none(wall.size)
    base, top = wall.joints != "top", wall.joints != "base"
    bends, slides = np.isfinite(effects.bending), np.isfinite(effects.friction) & base
    ratios = effects.shear_base, effects.shear_top
    shears = np.isfinite(ratios[0]) & base, np.isfinite(ratios[1]) & top
    held = [np.where(free, ratio, 0.0) for free, ratio in zip(shears, ratios, strict=True)]
    stiffness = np.where(bends, effects.bending, 0.0) * 2.0 * wall.base_stiffness * wall.base_half_width
    mass, inertia = masses(wall)
    compressions = static_compressions(wall)
    constants = {
        e.PITCH: effects.pitch, e.TOP_OFFSET: effects.top_offset, e.COUPLE_K: effects.couple_stiffness,
        e.COUPLE_GAP: effects.couple_gap, e.COUPLE_C: effects.couple_damping, e.DRY: effects.dry_couple,
        e.LEFT: effects.left, e.RIGHT: effects.right, e.FROZEN_B: effects.frozen_base, e.FROZEN_T: effects.frozen_top,
        e.LOSS: effects.final_loss, e.PER_CLOSING: 1.0 / effects.loss_cycles, e.TEARING: effects.tearing,
        e.SHEAR_B: held[0], e.SHEAR_T: held[1], e.FRICTION: np.where(slides, effects.friction, 0.0), e.SLIDES: slides,
        e.BEND: stiffness * wall.base_half_width**2 / 3.0, e.AXIAL: stiffness, e.FREE_X1: shears[0] | slides,
        e.FREE_X2: shears[1], e.FREE_M: bends, e.PER_OPENING_B: 1.0 / (FROZEN_OVER * compressions[0]),
        e.PER_OPENING_T: 1.0 / (FROZEN_OVER * compressions[1]), e.LENGTH: wall.height_1, e.HALF_MASS: mass[0],
        e.HALF_INERTIA: inertia[0],
    }  # fmt: skip
    table = filled(wall.size, e.N_GIVEN, {(row - e.PITCH) // W: values for row, values in constants.items()})
    lower = rest[:, 0]
    at_rest = {**dict(zip(STATES, rest[:, 4:].T, strict=False)), "bend": rest[:, 6] - lower, "rotation_1": lower}
    for k, name in enumerate(STATES):
        table[:, e.G_STATE + k] = initial.get(name, at_rest.get(name, 0.0))
        if of_lower := BENDS.get(name):
            table[:, e.G_STATE + k] += initial.get(of_lower, at_rest.get(of_lower, 0.0))
    half = np.where(effects.tearing > 0.0, wall.base_half_width, -wall.base_half_width)
    for k, (name, value) in enumerate(zip(MEMORIES, (0.0 * half, 0.0 * half, -half, half), strict=True)):
        table[:, e.G_MEMORY + k] = initial.get(name, value)
    for k, name in enumerate(LANDED):
        table[:, e.G_LANDED + k] = initial.get(name, 0.0)
    if effects.law:
        scales = TABLES.units(wall)
        reaches = [(KNOTS - 1) / effects.law[variable.reach] for variable in TABLES.variables.values()]
        values = [scales[one.port] * value for term, one in TABLES.terms.items() for value in merged(effects.law, term)]
        table[:, e.G_LAW :] = np.stack([*reaches, *values], axis=1)
    acts = 0
    for part in effects.parts:
        acts |= ACTS.get(part, 0)

    return More(table, np.zeros((wall.size, e.N_ENDED)), acts, effects.coordinates)


def energy(wall: LayeredWall, q: FloatArray, states: FloatArray, hidden: FloatArray | None) -> FloatArray:
    """Stored (J) in the joints (n, 2); q (n, 4) of the plain wall, ``states`` as `More.ended` has them."""
    whole = np.concatenate([q, states[:, :4]], axis=1)
    laws = {} if hidden is None else {
        joint: rubber.hidden_states(given, hidden[:, k])
        for k, joint in enumerate(("base", "top"))
        if (given := wall.laws_at(joint))
    }  # fmt: skip
    effects = wall.effects or Effects.none(wall.size)
    whole[:, 6] = np.where(np.isfinite(effects.bending), whole[:, 6], whole[:, 0])
    landed = states[:, 12:].reshape(-1, 2, CELLS)
    return stored(wall, whole, [states[:, 8], states[:, 10], states[:, 11]], landed, laws)
