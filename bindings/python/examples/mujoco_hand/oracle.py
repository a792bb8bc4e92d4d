"""What is true, from MuJoCo's contact list: it judges the grip, which never sees it."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from fingertip import HandError
from grip import GREATEST, LEAST, grasp_of
from world import ARM, KILOGRAM, Lift, Vector

Contacts = list[dict[str, Any] | None]
"""Of each fingertip its contact with the object."""


class Oracle:
    """Contacts, slip and the least grip of a state."""

    def __init__(self, model: mujoco.MjModel, lift: Lift) -> None:
        self.model, self.lift = model, lift
        self.hand, self.object = model.body("hand").id, model.body("object").id
        self.tips = [model.geom(f"tip{i}").id for i in range(len(lift.tips))]
        self.held = model.geom("object").id

    def contacts(self, data: mujoco.MjData) -> Contacts:
        """Of each fingertip its contact with the object, in the frame of the hand, as a `Grasp` takes it, with the
        normal force [N] and the share of the friction that is used."""
        found: Contacts = [None] * len(self.tips)
        turn, origin = data.xmat[self.hand].reshape(3, 3), data.xpos[self.hand]
        for index in range(data.ncon):
            contact = data.contact[index]
            pair = (contact.geom[0], contact.geom[1])
            if self.held not in pair:
                continue
            tip = pair[0] if pair[1] == self.held else pair[1]
            if tip not in self.tips:
                continue
            force = np.zeros(6)
            mujoco.mj_contactForce(self.model, data, index, force)
            # The first axis points from the first geom to the second.
            outward = turn.T @ contact.frame[:3] * (1.0 if pair[0] == tip else -1.0)
            friction = float(self.model.geom_friction[tip, 0])
            used = np.sqrt(force[1] ** 2 + force[2] ** 2 + (force[3] / ARM) ** 2) / friction
            found[self.tips.index(tip)] = {
                "point": turn.T @ (contact.pos - origin),
                "outward": outward,
                "friction": friction,
                "arm": ARM,
                "normal": force[0],
                "used": used / force[0] if force[0] > 1e-6 else 0.0,
            }
        return found

    def load(self, data: mujoco.MjData, poured: float) -> Vector:
        """Weight of the object and of what was poured in, and what the hand's acceleration adds, about the origin of
        the hand."""
        up = self.lift.mass * (KILOGRAM + data.joint("height").qacc[0]) + poured
        turn = data.xmat[self.hand].reshape(3, 3)
        return self._at_centre(data, turn.T @ np.array([0.0, 0.0, -up]))

    def _at_centre(self, data: mujoco.MjData, force: Vector) -> Vector:
        """The wrench of a force on the centre of mass, in the frame of the hand."""
        turn, origin = data.xmat[self.hand].reshape(3, 3), data.xpos[self.hand]
        return np.concatenate([force, np.cross(turn.T @ (data.xipos[self.object] - origin), force)])

    @staticmethod
    def least(contacts: Contacts, load: Vector, greatest: float | None = GREATEST) -> float | None:
        """The least sum of normal forces that holds a load [N]; `None` where fingers with these limits cannot."""
        try:
            grasp = grasp_of(contact for contact in contacts if contact is not None)
            return sum(normal for normal, *_ in grasp.least_grip(load, least=LEAST, greatest=greatest))
        except HandError:
            return None

    def holdable(self, data: mujoco.MjData, contacts: Contacts) -> bool:
        """Whether a controller that knows all could lift, fill and turn this, where the fingers touch it now."""
        contacts = [contact and {**contact, "friction": contact["friction"] * self.lift.wetted} for contact in contacts]
        weight, turned = self.load(data, 0.0), []
        for angle in np.linspace(0.0, self.lift.turn, 5):
            rotation = np.zeros(9)
            quaternion = np.zeros(4)
            mujoco.mju_axisAngle2Quat(quaternion, self.lift.axis, -angle)
            mujoco.mju_quat2Mat(rotation, quaternion)
            force = rotation.reshape(3, 3) @ weight[:3] * (1 + self.lift.poured)
            turned.append(self._at_centre(data, force))
        return None not in contacts and all(self.least(contacts, load) is not None for load in [weight, *turned])
