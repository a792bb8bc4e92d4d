"""The loop at 1 kHz: from what the force/torque sensors read to where the fingers shall go.

It knows the shapes of its fingertips, where its joints are, and what its fingers can give. It does not know what it
holds: neither the shape, nor the weight, nor the friction. That it learns at the table, where slip costs nothing: the
fingers press lightly, the hand moves up, and where the force stops to grow with the way, they slide (`IncipientSlip`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import fingertip.mujoco
import mujoco
import numpy as np
from fingertip import Grasp, HandController, IncipientSlip, ObjectWeight, Scene, SlipVerdict
from world import ARM, FINGER_STIFFNESS, KILOGRAM, Tip, Vector

PERIOD = 1e-3
FORCE_NOISE, TORQUE_NOISE = 2e-3, 15e-6
"""Standard deviations of the sensors' components [N, N·m]: the resolution of an ATI Nano17."""
LEAST, GREATEST = 0.1, 12.0
"""What a finger can be told to press with [N]."""
FIRST_TOUCH = 0.4
"""With what the fingers press before the hand feels for the friction [N]."""
UNKNOWN_FRICTION = 1.1
"""What friction is taken to be before a slip has taught better: more than is to be expected, so that it does slip."""
SAFETY = 1.2
"""Over the least grip that holds."""
SCATTER = 0.02
"""How break-away scatters, as a share: MuJoCo's friction does not."""
FALL = 3.0
"""How fast commands shrink [N/s]."""
BANDWIDTH = 100.0
"""How fast normal forces follow their commands [1/s]."""
CLOSING = 0.01
"""How fast fingers close, and open [m/s]."""
STRETCH = 3e-5
"""Way over which the growth of the force is told [m]."""
MISSING = 0.04
"""Share of the weight that the fingers lack when the object is said to slide away in the air."""


def grasp_of(contacts: Iterable[dict[str, Any]]) -> Grasp:
    """The grasp of contacts that have more than it takes."""
    keys = ("point", "outward", "friction", "arm")
    return Grasp([{key: contact[key] for key in keys} for contact in contacts])


class Grip:
    """A gripping hand in a MuJoCo model: `step` for each millisecond."""

    def __init__(self, model: mujoco.MjModel, tips: list[Tip], random: np.random.Generator) -> None:
        self.hand = model.body("hand").id
        self.count = len(tips)
        self.random = random
        contact = {"model": "soft_finger", "least_force_N": 10 * FORCE_NOISE, "spin_noise_Nm": 3 * TORQUE_NOISE}
        self.touches = [
            fingertip.mujoco.Touch(model, f"tip{i}", Scene.from_dict({"surface": tip.surface, "contact": contact}))
            for i, tip in enumerate(tips)
        ]
        self.control = HandController(
            safety=SAFETY,
            fall=FALL,
            least=FIRST_TOUCH,
            greatest=GREATEST,
            friction_noise=FORCE_NOISE,
            friction_scatter=SCATTER,
        )
        self.incipient = [IncipientSlip(FORCE_NOISE, STRETCH, 0.65) for _ in tips]
        self.weight = ObjectWeight()
        self.ways = np.zeros(self.count)
        self.fingers: list[dict[str, Any] | str | None] = [None] * self.count
        self.verdicts = [SlipVerdict.HOLDING] * self.count
        self.normal = [FIRST_TOUCH] * self.count
        self.load = np.zeros(6)
        self.gripping = False

    def step(self, data: mujoco.MjData, phase: str) -> Vector:
        """Where the drives of the fingers shall be [m]. The phase is what the script of the hand is about to do."""
        self._feel(data)
        if phase == "open":
            self.ways = self.ways - CLOSING * PERIOD
        elif not self.gripping:
            self._close()
        else:
            load = self._slip(data, phase)
            implausible = [False] * self.count
            # What the table does to an object that is put down need not be held.
            if phase != "put":
                self.normal, _, implausible = self.control.command(self.fingers, PERIOD, load=load)
            self._squeeze(implausible)
        return self.ways

    def feel_friction(self) -> None:
        """From now on fingers may press as lightly as they can."""
        self.control.set_limits(least=LEAST, greatest=GREATEST)

    @property
    def borne(self) -> float:
        """How much the fingers bear of the object [N]."""
        return float(self.load[:3] @ self.down)

    @property
    def friction(self) -> float | None:
        """The least coefficient that a finger has learnt."""
        return min((learnt[0] for learnt in self.control.friction if learnt is not None), default=None)

    def _feel(self, data: mujoco.MjData) -> None:
        turn, origin = data.xmat[self.hand].reshape(3, 3), data.xpos[self.hand]
        self.down = -turn[2]
        friction = self.friction
        known = UNKNOWN_FRICTION if friction is None else (1 - 2 * SCATTER) * friction
        self.load = np.zeros(6)
        for i, touch in enumerate(self.touches):
            noise = np.concatenate([self.random.normal(0, FORCE_NOISE, 3), self.random.normal(0, TORQUE_NOISE, 3)])
            wrench = touch.wrench(data) + noise
            rotation = turn.T @ data.site_xmat[touch.site].reshape(3, 3)
            place = turn.T @ (data.site_xpos[touch.site] - origin)
            felt = touch.fingertip.sense_wrench(wrench, PERIOD)
            self.fingers[i] = felt.finger(rotation, place, known, ARM)
            force = rotation @ wrench[:3]
            self.load += np.concatenate([force, rotation @ wrench[3:] + np.cross(place, force)])

    def _close(self) -> None:
        """Each finger closes until it touches."""
        touching = [isinstance(finger, dict) for finger in self.fingers]
        self.ways = self.ways + np.where(touching, 0.0, CLOSING * PERIOD)
        self.gripping = all(touching)

    def _slip(self, data: mujoco.MjData, phase: str) -> Vector | None:
        """What each finger is told of slip. The load, where the fingers do not feel all of it."""
        load = None
        self.verdicts = [SlipVerdict.HOLDING] * self.count
        if phase == "feel" and self.friction is None:
            height = np.array([0.0, 0.0, data.joint("height").qpos[0]])
            for i, (finger, watch) in enumerate(zip(self.fingers, self.incipient, strict=True)):
                if isinstance(finger, dict):
                    self.verdicts[i] = watch.update(finger["normal"], finger["tangential"], height)
        elif phase in ("weigh", "hold", "pour"):
            load = self._fall(phase)
        for finger, verdict in zip(self.fingers, self.verdicts, strict=True):
            if isinstance(finger, dict):
                finger["slip"] = verdict
        return load

    def _fall(self, phase: str) -> Vector | None:
        """What falls is not borne: in the air, too little weight is slip. A finger that slides feels no more of it than
        friction lets through; what is to be held is the whole weight."""
        if phase == "weigh":
            # Torques are about the middle of the hand, half a decimetre from the sensors.
            variances = [FORCE_NOISE**2] * 3 + [TORQUE_NOISE**2 + (0.05 * FORCE_NOISE) ** 2] * 3
            self.weight.observe(self.load, self.count * np.diag(variances), KILOGRAM * self.down)
            return None
        estimate = self.weight.estimate()
        if estimate is None:
            return None
        weight = estimate[0] * KILOGRAM
        if weight - self.borne > max(MISSING * weight, 6 * np.sqrt(self.count) * FORCE_NOISE):
            self.verdicts = [SlipVerdict.SLIPPING] * self.count
            return self.load * (weight / self.borne) if self.borne > 0.2 * weight else None
        return None

    def _squeeze(self, implausible: list[bool]) -> None:
        """Each drive moves by what its finger lacks, as far as that squeezes and does not push the object about."""
        believed = {
            i: finger for i, finger in enumerate(self.fingers) if isinstance(finger, dict) and not implausible[i]
        }
        ways = self.ways.copy()
        if len(believed) >= 2:
            lacks = [(self.normal[i] - contact["normal"], [0.0, 0.0, 0.0], 0.0) for i, contact in believed.items()]
            _, internal = grasp_of(believed.values()).split(lacks)
            for i, (lack, *_) in zip(believed, internal, strict=True):
                ways[i] += BANDWIDTH / FINGER_STIFFNESS * lack * PERIOD
        for i, finger in enumerate(self.fingers):
            if finger is None:
                # It has lost the object, and goes after it.
                ways[i] += CLOSING * PERIOD
        self.ways = ways
