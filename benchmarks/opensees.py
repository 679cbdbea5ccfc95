"""A wall on no-tension fibre strips in OpenSeesPy: one or two rigid blocks, a layer of fibres under each.

The blocks are stiff corotational beams: the bodies turn through large angles. A layer is written in one of
two ways, both with the material ENT (elastic, no tension), both in ground axes:

- ``springs``: zero-length elements between the ends of stiff arms, whose levers are exact at any angle;
- ``section``: one zero-length fibre section, the cheaper one, which takes theta for sin theta and x for x cos theta.

The layer's midpoint is held laterally. The dashpot is stiffness-proportional with the last committed tangent:
it acts where the fibre touched at the end of the last step and may pull (dashpot law A).
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.interface import modes
from models.interface.layered import LayeredWall
from models.shaking import Shaking

BODY, ARM = (10.0, 1e10, 1.0), (10.0, 1e10, 0.1)
"""Area, modulus and second moment of the bodies and of the fibres' arms: far stiffer than any layer, yet not
so stiff that short arms spoil the system of equations."""
GROUND = 1
"""The node under the base layer."""
RELEASE = 1e-5
"""s: a first step after a release, so short that nothing moves: it sets the accelerations, which OpenSees starts
at zero and which would else be missing from half a step."""
WAYS = ("springs", "section")


def available() -> bool:
    """Whether OpenSeesPy (extra ``proof``) can be loaded here."""
    try:
        import openseespy.opensees  # noqa: F401
    except (ImportError, RuntimeError):
        return False
    return True


def static(ops: Any, load_steps: int = 10) -> None:
    """Apply the loads given so far in equal steps, then keep them."""
    solver(ops)
    ops.integrator("LoadControl", 1.0 / load_steps)
    ops.analysis("Static")
    if ops.analyze(load_steps) != 0:
        raise RuntimeError("OpenSees did not converge under gravity")
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()


def solver(ops: Any) -> None:
    """Newton to 1e-8 m or rad, for the small systems of these walls."""
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-8, 50)
    ops.algorithm("Newton")


def shake(ops: Any, shaking: Shaking, scale: float) -> None:
    """The base's motion as a uniform excitation, and Newmark's constant average acceleration."""
    components = ((1, shaking.horizontal), (2, shaking.vertical))
    for direction, samples in components:
        if samples is not None:
            ops.timeSeries("Path", 10 + direction, "-dt", shaking.time_step, "-values", *(scale * samples).tolist())
            ops.pattern("UniformExcitation", 10 + direction, direction, "-accel", 10 + direction)
    solver(ops)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def layer(
    ops: Any, tag: int, nodes: tuple[int, int], half_width: float, k: float, c: float, fibres: int, way: str
) -> None:
    """A strip of equal ``fibres`` over 2 ``half_width`` between two nodes, k and c per metre of contact."""
    width = 2.0 * half_width / fibres
    places = (-half_width + width * (np.arange(fibres) + 0.5)).tolist()
    if way == "section":
        ops.uniaxialMaterial("ENT", tag, k)
        ops.section("Fiber", tag)
        for place in places:
            ops.fiber(place, 0.0, width, tag)
        elements = [tag]
        ops.element("zeroLengthSection", tag, *nodes, tag, "-orient", 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, "-doRayleigh", 1)
    else:
        ops.uniaxialMaterial("ENT", tag, k * width)
        elements = []
        for number, place in enumerate(places):
            ends = [1000 * (2 * tag + side) + number for side in range(2)]
            for node, end in zip(nodes, ends, strict=True):
                ops.node(end, place, ops.nodeCoord(node, 2))
                if node == GROUND:
                    ops.fix(end, 1, 1, 1)
                else:
                    ops.element("elasticBeamColumn", end, node, end, *ARM, 1)
            elements.append(10_000 * tag + number)
            ops.element("zeroLength", elements[-1], *ends, "-mat", tag, "-dir", 2, "-doRayleigh", 1)
    ops.region(tag, "-ele", *elements, "-rayleigh", 0.0, 0.0, 0.0, c / k)


def build(wall: LayeredWall, fibres: int, way: str) -> dict[str, int]:
    """One wall (of one lane) in OpenSees; returns the node of each body's mass centre and foot.

    ``joints`` both: two bodies. ``joints`` base: one body, of both masses.
    """
    import openseespy.opensees as ops

    one = wall.one()
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    top = one.height_1 + one.top_thickness_in_height
    if wall.joints == "both":
        # the upper body is held laterally where the compressed layer puts it
        top += float(modes.static_state(wall)[0, 3])
    places = {GROUND: 0.0, 2: 0.0, 3: one.centre_1, 4: top}
    for node, height in places.items():
        ops.node(node, 0.0, height)
    ops.fix(GROUND, 1, 1, 1)
    ops.fix(2, 1, 0, 0)
    ops.mass(3, one.mass_1, one.mass_1, one.inertia_1)
    layer(ops, 1, (GROUND, 2), one.base_half_width, one.base_stiffness, one.base_damping, fibres, way)
    beams = [(2, 3), (3, 4)]
    if wall.joints == "both":
        ops.node(5, 0.0, top)
        ops.node(6, 0.0, top + one.centre_2)
        ops.equalDOF(4, 5, 1)
        layer(ops, 2, (4, 5), one.top_half_width, one.top_stiffness, one.top_damping, fibres, way)
        beams.append((5, 6))
    else:
        ops.node(6, 0.0, top + one.centre_2)
        beams.append((4, 6))
    ops.mass(6, one.mass_2, one.mass_2, one.inertia_2)
    for number, (i, j) in enumerate(beams, start=11):
        ops.element("elasticBeamColumn", number, i, j, *BODY, 1)
    ops.timeSeries("Constant", 1)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 1, 2)
    ops.load(3, 0.0, -one.mass_1 * one.gravity, 0.0)
    ops.load(6, 0.0, -one.mass_2 * one.gravity, 0.0)
    return {"wall": 3, "top": 6, "foot": 2}


def history(
    wall: LayeredWall,
    shaking: Shaking,
    scale: float,
    *,
    step: float,
    steps: int,
    fibres: int,
    way: str,
    rotation: float = 0.0,
) -> tuple[NDArray[np.float64], float]:
    """Clockwise rotations of both bodies ``(2, steps + 1)`` at every step, and the seconds it took.

    ``rotation``: the wall (with what it carries) is turned so far, in vertical balance, and let go.
    """
    import openseespy.opensees as ops

    nodes = build(wall, fibres, way)
    bodies = (nodes["wall"], nodes["top"])
    static(ops)
    if rotation:
        turn(ops, nodes["foot"], rotation)
    shake(ops, shaking, scale)
    if rotation and ops.analyze(1, RELEASE) != 0:
        raise RuntimeError("OpenSees did not converge at the release")
    found = np.zeros((2, steps + 1))
    found[:, 0] = [-ops.nodeDisp(node, 3) for node in bodies]
    began = time.perf_counter()
    for k in range(1, steps + 1):
        if ops.analyze(1, step) != 0:
            raise RuntimeError(f"OpenSees did not converge at {k * step:.4f} s")
        found[:, k] = [-ops.nodeDisp(node, 3) for node in bodies]
    took = time.perf_counter() - began
    ops.wipe()
    return found, took


def turn(ops: Any, foot: int, rotation: float, load_steps: int = 200) -> None:
    """Turn the foot by ``rotation`` under the loads that act, and release it."""
    ops.timeSeries("Linear", 3)
    ops.pattern("Plain", 3, 3)
    ops.sp(foot, 3, -rotation)
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-12, 100)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 1.0 / load_steps)
    ops.analysis("Static")
    if ops.analyze(load_steps) != 0:
        raise RuntimeError("OpenSees did not converge while the wall was turned")
    ops.wipeAnalysis()
    ops.remove("loadPattern", 3)
    ops.setTime(0.0)


def frequencies(wall: LayeredWall, fibres: int, way: str) -> NDArray[np.float64]:
    """Natural frequencies of all modes in Hz, ascending, under gravity and with all fibres touching."""
    import openseespy.opensees as ops

    build(wall, fibres, way)
    static(ops)
    solver(ops)
    squares = ops.eigen("-fullGenLapack", 2 if wall.joints == "base" else 4)
    found: NDArray[np.float64] = np.sqrt(np.array(squares)) / (2.0 * np.pi)
    ops.wipe()
    return found


def moments(
    half_width: float, k: float, weight: float, rotations: Sequence[float], fibres: int, way: str
) -> list[float]:
    """Restoring moments of one strip under a constant weight, at ascending clockwise ``rotations``."""
    import openseespy.opensees as ops

    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    for node in (GROUND, 2):
        ops.node(node, 0.0, 0.0)
    ops.fix(GROUND, 1, 1, 1)
    ops.fix(2, 1, 0, 0)
    layer(ops, 1, (GROUND, 2), half_width, k, 0.0, fibres, way)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 1, 2)
    ops.load(2, 0.0, -weight, 0.0)
    static(ops)
    found, before = [], 0.0
    ops.timeSeries("Linear", 3)
    ops.pattern("Plain", 3, 3)
    ops.load(2, 0.0, 0.0, -1.0)
    for rotation in rotations:
        solver(ops)
        ops.integrator("DisplacementControl", 2, 3, -(rotation - before) / 50.0)
        ops.analysis("Static")
        if ops.analyze(50) != 0:
            raise RuntimeError(f"OpenSees did not converge at a rotation of {rotation} rad")
        found.append(abs(ops.getLoadFactor(3)))
        before = rotation
        ops.wipeAnalysis()
    ops.wipe()
    return found


def steps_per_second(
    wall: LayeredWall, shaking: Shaking, scale: float, step: float, fibres: int, steps: int, way: str
) -> float:
    """Steps per second of processor time of one wall, reading nothing."""
    import openseespy.opensees as ops

    build(wall, fibres, way)
    static(ops)
    shake(ops, shaking, scale)
    began = time.thread_time()
    if ops.analyze(steps, step) != 0:
        raise RuntimeError("OpenSees did not converge")
    took = time.thread_time() - began
    ops.wipe()
    return steps / took
