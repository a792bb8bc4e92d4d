"""What the hand does, phase by phase: feel for the friction, lift, pour in, turn, put down."""

from __future__ import annotations

import mujoco
from grip import PERIOD, Grip
from world import KILOGRAM, Lift

CREEP, SLOW, RISE = 2e-4, 8e-3, 0.04
"""How fast the hand feels its way at first and then [m/s], and how far it lifts [m]."""
PHASES = {
    "settle": 0.15, "feel": 0.95, "lift": 0.5, "weigh": 0.15, "hold": 0.15, "pour": 0.6, "turn": 1.5, "lower": 0.5,
    "put": 0.7, "open": 0.3,
}  # fmt: skip
"""How long each lasts, at most [s]."""
IN_AIR = ("weigh", "hold", "pour", "turn")


def smooth(share: float) -> float:
    """From 0 to 1 without a jerk."""
    share = min(max(share, 0.0), 1.0)
    return share**3 * (10 - 15 * share + 6 * share**2)


class Script:
    """Moves the hand, and pours into the object."""

    def __init__(self, model: mujoco.MjModel, lift: Lift, grip: Grip) -> None:
        self.model, self.lift, self.grip = model, lift, grip
        self.object = model.body("object").id
        self.phases = list(PHASES)
        self.phase, self.since = "close", 0.0
        self.height, self.tilt = 0.0, 0.0
        self.poured = 0.0
        self.weight = 0.0

    def step(self, data: mujoco.MjData) -> None:
        """What is commanded for the next millisecond."""
        if self.phase == "close":
            if self.grip.gripping or data.time > 2.0:
                self._next(data)
        else:
            self._move(data)
            self.since += PERIOD
            landed = self.phase == "put" and self.grip.borne < 0.3 * self.weight
            if self.phase != "over" and (self.since >= PHASES[self.phase] or landed):
                self._next(data)
        data.ctrl[: self.grip.count] = self.grip.step(data, self.phase)
        data.ctrl[self.grip.count :] = self.height, self.tilt
        data.xfrc_applied[self.object, 2] = -self.poured

    def _next(self, data: mujoco.MjData) -> None:
        self.phase = self.phases.pop(0) if self.phases else "over"
        self.since = 0.0
        self.start = self.height
        if self.phase == "feel":
            self.grip.feel_friction()
        elif self.phase == "hold":
            fingers = [self.model.geom(f"tip{i}").id for i in range(self.grip.count)]
            self.model.geom_friction[fingers, :2] *= self.lift.wetted
        elif self.phase == "lower":
            self.weight = self.grip.borne

    def _move(self, data: mujoco.MjData) -> None:
        share = self.since / PHASES.get(self.phase, 1.0)
        if self.phase == "feel":
            # Little way while the fingers loosen their first grip.
            if self.since < 0.3:
                self.height = CREEP * self.since
            else:
                self.height += SLOW * PERIOD
        elif self.phase == "lift":
            self.height = self.start + (RISE - self.start) * smooth(share)
        elif self.phase == "pour":
            self.poured = self.lift.poured * self.lift.mass * KILOGRAM * smooth(share)
        elif self.phase == "turn":
            self.tilt = self.lift.turn * (smooth(3 * share) - smooth(3 * share - 2))
        elif self.phase == "lower":
            self.height = self.start + (0.006 - self.start) * smooth(share)
        elif self.phase == "put":
            self.height -= 0.012 * PERIOD
