"""Touch from a MuJoCo model: ``pip install fingertip[mujoco]``."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from fingertip import Fingertip, FingertipError, Scene, Touches
from fingertip import Touch as Felt

__all__ = ["Touch"]


class Touch:
    """What a fingertip of a MuJoCo model feels, from a force and a torque sensor at its site.

    MuJoCo's sensors read what the body of the site does to its parent's side, the reaction; a sensor counts all that
    acts on the fingertip's body, its own weight and inertia too, so give the fingertip no mass to speak of, or take its
    weight off by `gravity`.

    Parameters
    ----------
    model : mujoco.MjModel
    site : str
        Of the fingertip. The scene's surface is in the frame of this site.
    scene : Scene
        Its convention is not asked: the signs of MuJoCo are known.
    force, torque : str, optional
        Names of the sensors, if the site has several.
    body : str, optional
        Whose weight is taken off; none by default.

    Examples
    --------
    >>> import mujoco, fingertip, fingertip.mujoco
    >>> model = mujoco.MjModel.from_xml_string('''
    ... <mujoco><worldbody>
    ...   <body name="tip" pos="0 0 0.0125"><geom type="sphere" size="0.013" mass="1e-6"/><site name="tip"/></body>
    ...   <geom type="plane" size="1 1 0.1"/>
    ... </worldbody>
    ... <sensor><force site="tip"/><torque site="tip"/></sensor></mujoco>''')
    >>> data = mujoco.MjData(model)
    >>> mujoco.mj_forward(model, data)
    >>> scene = fingertip.Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.013}})
    >>> touch = fingertip.mujoco.Touch(model, "tip", scene)
    >>> touch(data).point.shape
    (3,)
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        site: str,
        scene: Scene,
        *,
        force: str | None = None,
        torque: str | None = None,
        body: str | None = None,
    ) -> None:
        self.scene = scene
        self.site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, site)
        if self.site < 0:
            raise FingertipError(f"the model has no site {site!r}")
        self._force = self._sensor(model, mujoco.mjtSensor.mjSENS_FORCE, "force", force)
        self._torque = self._sensor(model, mujoco.mjtSensor.mjSENS_TORQUE, "torque", torque)
        self._time_step = float(model.opt.timestep)
        self._mass = 0.0
        self._gravity = np.array(model.opt.gravity)
        self._body = -1
        if body is not None:
            self._body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
            if self._body < 0:
                raise FingertipError(f"the model has no body {body!r}")
            self._mass = float(model.body_subtreemass[self._body])
        self.fingertip = Fingertip(scene)

    def _sensor(self, model: mujoco.MjModel, kind: Any, what: str, name: str | None) -> slice:
        found = [
            sensor
            for sensor in range(model.nsensor)
            if model.sensor_type[sensor] == kind
            and model.sensor_objid[sensor] == self.site
            and (name is None or model.sensor(sensor).name == name)
        ]
        if len(found) != 1:
            raise FingertipError(f"the site needs one {what} sensor, and has {len(found)}; name it by `{what}`")
        start = int(model.sensor_adr[found[0]])
        return slice(start, start + 3)

    def wrench(self, data: mujoco.MjData) -> npt.NDArray[np.float64]:
        """The load on the fingertip, in the frame of its site [N, N·m], shape (6,)."""
        load = -np.concatenate([data.sensordata[self._force], data.sensordata[self._torque]])
        if self._body >= 0:
            turn = data.site_xmat[self.site].reshape(3, 3)
            weight = turn.T @ (self._mass * self._gravity)
            arm = turn.T @ (data.subtree_com[self._body] - data.site_xpos[self.site])
            load -= np.concatenate([weight, np.cross(arm, weight)])
        return load

    def __call__(self, data: mujoco.MjData, time_step: float | None = None) -> Felt:
        """What the fingertip feels in a state, a time step of the model (or another one [s]) after the last."""
        step = self._time_step if time_step is None else time_step
        return self.fingertip.sense_wrench(self.wrench(data), step)

    def reset(self) -> None:
        """Forget all samples, as at the start of an episode."""
        self.fingertip.reset()

    def many(self, sensordata: npt.NDArray[np.float64], time_step: float = 0.0) -> Touches:
        """What fingertips of many environments feel at once, each for itself.

        Parameters
        ----------
        sensordata : ndarray, shape (environments, nsensordata)
            As of each environment's `MjData`.
        """
        loads = -np.concatenate([sensordata[:, self._force], sensordata[:, self._torque]], axis=1)
        anew = np.ones(len(loads), np.bool_)
        plain = Fingertip(self.scene)
        if self.scene.has_sensor:
            raise FingertipError("the scene has a [sensor], and MuJoCo gives wrenches: take it out")
        return plain.sense_all(loads * plain.sign, time_step, anew=anew)
