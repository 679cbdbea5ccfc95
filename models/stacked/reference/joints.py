"""One wall at its events: what opens, closes and stays closed; the plain reference's route."""

from __future__ import annotations

import math

from models.base import Event
from models.stacked import account as acc
from models.stacked.configuration import BASE, JOINTS, TOP, State
from models.stacked.declaration import REST_VELOCITY
from models.stacked.equation import Ground, System, held, motion
from models.stacked.reference.choice import choose
from models.stacked.reference.impact import closed, impact, kinetic_energy
from models.stacked.reference.ledger import Ledger
from models.stacked.stack import Stack

Pair = tuple[float, float]
REST = State((0, 0), (0.0, 0.0), (0.0, 0.0))


class Joints:
    """The configuration of one wall and how it changes."""

    def __init__(self, stack: Stack, linear: bool, ledger: Ledger) -> None:
        p, p2 = float(stack.frequency_parameter[0]), float(stack.frequency_parameter_2[0])
        self.calm = (
            REST_VELOCITY * p * float(stack.slenderness[0]),
            REST_VELOCITY * p2 * float(stack.slenderness_2[0]),
        )
        self.stack, self.linear, self.ledger = stack.one(), linear, ledger
        self.state = REST

    def system(self, corners: tuple[int, int], state: State, ground: Ground, way: int) -> System:
        return motion(self.stack, *corners, state.q, state.rate, ground, self.linear, float(way))

    def pull(self, joint: int, corner: int, state: State, ground: Ground) -> float:
        """Moment (N m) by which a closed joint would open about ``corner``; <= 0: it stays closed.

        Of a wall that friction holds: by which it would turn the way ``corner``.
        """
        if joint == BASE:
            m = self.system((state.sides[0] or corner, state.corners[1]), state, ground, corner)
        else:
            m = self.system((state.corners[0], corner), state, ground, state.way)
        x1, x2 = held(m, *state.free)
        return corner * float(m.r1 - m.m12 * x2 if joint == BASE else m.r2 - m.m12 * x1)

    def _settled(self, state: State, ground: Ground, moving: bool = False) -> State:
        """What the closed joints of ``state`` do under these forces, and a wall that friction may hold."""
        s1, s2 = state.sides
        stops = s1 != 0 and state.rate[0] == 0.0 and float(self.stack.coulomb) > 0.0
        going = 0 if state.rate[0] == 0.0 else 1 if state.rate[0] > 0.0 else -1

        def system(c1: int, c2: int) -> System:
            return self.system((s1 or c1, s2 or c2), state, ground, going or c1)

        n1, n2 = choose(system, 0 if stops else s1, s2, moving=moving)
        return state._replace(sides=(s1, n2), way=n1) if stops else state._replace(sides=(n1, n2), way=going or n1 or 1)

    def _go(self, state: State, time: float) -> None:
        """Go over to ``state``; the first uplift of a joint is its onset."""
        before, self.state = self.state, state
        self.ledger.mark_configuration(state.sides)
        for joint, column in zip(JOINTS, (acc.ONSET_BASE, acc.ONSET_TOP), strict=True):
            if state.sides[joint] and not before.sides[joint] and math.isnan(self.ledger.account[column]):
                self.ledger.account[column] = time

    def settle(self, ground: Ground, time: float, moving: bool = False) -> None:
        """The closed joints answer to ``ground``; ``moving``: at a threshold, rest is left out."""
        self._go(self._settled(self.state, ground, moving), time)

    def open(self, joint: int, side: int, time: float) -> None:
        """A closed joint opens without impact, or friction lets the wall go the way ``side``."""
        s1, s2 = self.state.sides
        if joint == BASE and s1:
            self.state = self.state._replace(way=side)
            return
        state = self.state._replace(way=side) if joint == BASE else self.state
        self._go(state._replace(sides=(side, s2) if joint == BASE else (s1, side)), time)
        self.ledger.events.append(Event(time, "change_of_pattern", joint + 1))

    def stop(self, ground: Ground, time: float) -> None:
        """The wall turns: dry friction changes its sign, or holds it."""
        self.state = self.state._replace(rate=(0.0, self.state.rate[1]))
        self.settle(ground, time)

    def land(self, joint: int, ground: Ground, time: float) -> None:
        """``joint`` closes: the impact, and what stays closed after it."""
        q1, q2 = self.state.q
        before = self.state._replace(q=(0.0, q2) if joint == BASE else (q1, 0.0))
        after = self._after(joint, before, ground)
        lost = kinetic_energy(self.stack, before, self.linear) - kinetic_energy(self.stack, after, self.linear)
        self.ledger.account[(acc.LOST_BASE, acc.LOST_TOP)[joint]] += lost
        self.ledger.account[(acc.IMPACTS_BASE, acc.IMPACTS_TOP)[joint]] += 1
        self.ledger.events.append(Event(time, "impact", joint + 1))
        self._go(after, time)
        if not any(after.sides):
            self.ledger.events.append(Event(time, "rest"))

    def _after(self, joint: int, before: State, ground: Ground) -> State:
        """Rates so small that the swing ahead does not matter end, if the forces keep the joint closed.

        Where the wall is up, friction has to hold it.
        """
        landing = impact(self.stack, joint, before, self.linear)
        calm = [abs(landing.rate[j]) < self.calm[j] for j in JOINTS]
        if before.q == (0.0, 0.0) and all(calm) and not any(self._settled(REST, ground).sides):
            return REST
        if joint == TOP and before.sides[BASE] and all(calm):
            trial = self._settled(State((before.sides[BASE], 0), before.q, (0.0, 0.0)), ground)
            if trial.way == 0 and not trial.sides[TOP]:
                return trial
        if landing.sides[joint] and calm[joint]:
            trial = self._settled(closed(self.stack, joint, before, self.linear), ground)
            if not trial.sides[joint]:
                return trial
        return self._settled(landing, ground)
