"""The shake table pitches in step with its own acceleration."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(pitch_per_acceleration=values["pitch_per_acceleration"], pitch_low_pass=values["low_pass_hz"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("table_pitch", pitch=values["pitch_per_acceleration"], pitch_low_pass=values["low_pass_hz"])


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(pitch_per_acceleration=values["pitch_per_acceleration"], pitch_low_pass=values["low_pass_hz"])


MECHANISM = Mechanism(
    name="table_pitch",
    effect_class="table_pitch",
    parameters=(
        MechanismParameter(
            "pitch_per_acceleration", "c_p", "rad s2 m-1", "clockwise pitch per base acceleration", -0.003, 0.003
        ),
        MechanismParameter(
            "low_pass_hz", "f_p", "Hz", "corner of the low-pass on the base acceleration", 3.0, 30.0,
            null=10.0, shape=True,
        ),
    ),
    equation="psi = c_p lowpass(a); a -> a - G psi, couple -(I + M h^2) psi''; rotations against the base",
    signature="everywhere, coherent with the base acceleration and its second derivative",
    sentence="the table pitches by {pitch_per_acceleration:+.2e} rad per m/s2 below {low_pass_hz:.0f} Hz",
    acts={"housner": on_housner, "stacked": on_stacked, "interface": on_interface},
    static_test="measure the pitch of the table with the block on it",
    source="rigid-body dynamics in the turning frame: models/pitch.py",
)  # fmt: skip
