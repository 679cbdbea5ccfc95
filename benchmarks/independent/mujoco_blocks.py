"""Rigid blocks on a rigid base in MuJoCo: planar bodies, soft contacts as stiff as the step allows.

Each body is a box that slides in x and z and turns about y; boxes touch at their corners. The base's
motion acts as a body acceleration (-a, -(g + a_z)) on everything, which is the same as a moving base seen
from it. Elliptic friction cones, friction high enough to exclude sliding. A contact is a spring and dashpot
along its normal (reference acceleration -2 zeta v/T - r/T^2 of its depth r and rate v): critically damped,
with T twice the step, the stiffest that MuJoCo takes for stable.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

FRICTION = 20.0
STIFFEST = 2.0
"""Time constant of the stiffest contact over the step."""
HALF_DEPTH = 0.5


@dataclass(frozen=True)
class Body:
    """A solid rectangle: half width and half height in m, mass in kg."""

    half_width: float
    half_height: float
    mass: float

    @property
    def inertia(self) -> float:
        """About its centre, in kg m2."""
        return self.mass * (self.half_width**2 + self.half_height**2) / 3.0


def available() -> bool:
    """Whether MuJoCo (extra ``proof``) can be loaded here."""
    try:
        import mujoco  # noqa: F401
    except ImportError:
        return False
    return True


def model(bodies: tuple[Body, ...], step: float, contact: float, damping: float) -> Any:
    """The bodies on top of each other, at rest at x = 0."""
    import mujoco

    text, below = "", 0.0
    for body in bodies:
        b, h, m, inertia = body.half_width, body.half_height, body.mass, body.inertia
        text += f"""
        <body pos="0 0 {below + h}">
          <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
          <inertial pos="0 0 0" mass="{m}" diaginertia="{inertia} {inertia} {inertia}"/>
          <geom type="box" size="{b} {HALF_DEPTH} {h}"/>
        </body>"""
        below += 2.0 * h
    return mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <option timestep="{step}" cone="elliptic" impratio="100" integrator="implicitfast" iterations="100"
              tolerance="1e-12" gravity="0 0 0"/>
      <default><geom friction="{FRICTION} 0 0" condim="3"
                     solref="{contact} {damping}" solimp="0.999 0.9999 1e-5"/></default>
      <worldbody><geom type="plane" size="50 50 1"/>{text}
      </worldbody>
    </mujoco>""")


def run(
    bodies: tuple[Body, ...],
    acceleration: NDArray[np.float64],
    step: float,
    gravity: float,
    *,
    rotation: float = 0.0,
    settle: float = 0.0,
    contact: float | None = None,
    damping: float = 1.0,
) -> NDArray[np.float64]:
    """Clockwise rotations and their rates ``(2, n_bodies, n + 1)`` under a base acceleration ``(n,)`` a step.

    ``rotation``: the first body starts turned about its right corner; ``settle`` (s) of rest go before.
    ``contact`` (s) and ``damping``: time constant T (default: the stiffest) and damping ratio of contacts.
    """
    import mujoco

    made = model(bodies, step, STIFFEST * step if contact is None else contact, damping)
    data = mujoco.MjData(made)
    if rotation:
        b, h = bodies[0].half_width, bodies[0].half_height
        s, c = np.sin(rotation), np.cos(rotation)
        data.qpos[:3] = [b - b * c + h * s, b * s + h * c - h, rotation]
    made.opt.gravity[:] = (0.0, 0.0, -gravity)
    for _ in range(round(settle / step)):
        mujoco.mj_step(made, data)
    angles = np.arange(2, made.nq, 3)
    found = np.zeros((2, len(bodies), acceleration.size + 1))
    found[:, :, 0] = data.qpos[angles], data.qvel[angles]
    for k, a in enumerate(acceleration.tolist(), start=1):
        made.opt.gravity[0] = -a
        mujoco.mj_step(made, data)
        found[0, :, k], found[1, :, k] = data.qpos[angles], data.qvel[angles]
    return found
