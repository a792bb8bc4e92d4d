"""A hand of two or three fingers over an object on a table, drawn at random, as a MuJoCo model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

TIME_STEP = 5e-4
ARM = 3e-3
"""Spin torque over tangential force at slip, of all fingertips [m]."""
KILOGRAM = 9.81
"""Weight of a kilogram [N]."""
FINGER_STIFFNESS, FINGER_MASS = 4000.0, 0.02
"""Of a finger's drive along its way [N/m], and what it moves [kg]."""
SIDEWAYS = 800.0
"""Stiffness of a finger across its way [N/m]."""
GAP = 0.003
"""Between an open finger and an object in the middle of the hand [m]."""
CONTACT = 'solref="0.003 1" solimp="0.97 0.99 0.0002"'
"""How stiff contacts are: less than 0.1 mm of penetration under 10 N."""


@dataclass(frozen=True)
class Tip:
    """Shape of a fingertip: as MuJoCo's geom, and as the surface of a scene, in the same frame."""

    geom: str
    surface: dict[str, Any]
    length: float
    """From its middle to its end, along the way of the finger [m]."""
    euler: tuple[float, float]
    """How it is turned in the finger, about x and y [rad]."""
    width: float
    """Half of it across the way of the finger, however it is turned [m]."""


@dataclass(frozen=True)
class Lift:
    """What is lifted, by whom. Of all this the controller is told the fingertips and where the fingers are."""

    tips: list[Tip]
    shape: str
    size: Vector
    """Half lengths of the object [m]."""
    mass: float
    friction: float
    turn: float
    """By how much the hand is tilted [rad], and about which horizontal axis:"""
    axis: Vector
    poured: float
    """Share of the weight that is poured in."""
    height: float
    """Of the fingers over the centre of mass [m]."""
    aside: Vector
    """Where the object stands, off the middle of the hand [m]."""
    fingers: list[tuple[float, float]]
    """Of each finger the angle around the object [rad] and how far aside its way is of the middle [m]."""
    wetted: float = 1.0
    """By what friction is multiplied once the object hangs in the air."""

    @property
    def grip_height(self) -> float:
        """Of the fingers over the table at the start [m]."""
        return float(self.size[2]) + self.height


def tip(random: np.random.Generator) -> Tip:
    """A ball, an egg or a capsule."""
    euler = tuple(random.uniform(-0.2, 0.2, 2))
    kind = random.choice(["sphere", "ellipsoid", "capsule"])
    if kind == "sphere":
        radius = random.uniform(0.007, 0.013)
        return Tip(f'type="sphere" size="{radius}"', {"shape": "sphere", "radius_m": radius}, radius, euler, radius)
    if kind == "ellipsoid":
        axes = random.uniform([0.007, 0.007, 0.008], [0.011, 0.011, 0.014])
        geom = 'type="ellipsoid" size="{} {} {}"'.format(*axes)
        return Tip(geom, {"shape": "ellipsoid", "semi_axes_m": axes.tolist()}, axes[2], euler, max(axes))
    radius, half = random.uniform(0.006, 0.010), random.uniform(0.004, 0.010)
    shape = {"shape": "capsule", "axis": [0.0, 0.0, 1.0], "radius_m": radius, "half_length_m": half}
    return Tip(f'type="capsule" size="{radius} {half}"', shape, radius + half, euler, radius + 0.3 * half)


def draw(random: np.random.Generator, fingers: int | None = None) -> Lift:
    """A lift at random: 20 to 400 g, friction 0.3 to 1."""
    count = int(random.integers(2, 4)) if fingers is None else fingers
    shape = str(random.choice(["box", "cylinder", "ellipsoid"]))
    size = random.uniform([0.018, 0.018, 0.025], [0.035, 0.035, 0.05])
    if shape != "box":
        size[1] = size[0]
    if shape == "ellipsoid":
        size[2] = size[0] * random.uniform(0.9, 1.2)
    if count == 2:
        places = [(0.0, 0.0), (np.pi, 0.0)]
    elif shape == "box":
        aside = size[1] * random.uniform(0.4, 0.7)
        places = [(0.0, 0.0), (np.pi, aside), (np.pi, -aside)]
    else:
        places = [(angle + random.uniform(-0.1, 0.1), 0.0) for angle in (0.0, 2 * np.pi / 3, 4 * np.pi / 3)]
    around = random.uniform(0, 2 * np.pi)
    tips = [tip(random) for _ in range(count)]
    if count == 3 and shape == "box":
        # Two fingers side by side have room for both.
        aside = max(aside, 0.5 * (tips[1].width + tips[2].width) + 1e-3)
        size[1] = max(size[1], aside + 3e-3)
        places[1:] = [(np.pi, aside), (np.pi, -aside)]
    return Lift(
        tips=tips,
        shape=shape,
        size=size,
        mass=float(np.exp(random.uniform(np.log(0.02), np.log(0.4)))),
        friction=random.uniform(0.3, 1.0),
        turn=np.radians(random.uniform(20, 60)),
        axis=np.array([np.cos(around), np.sin(around), 0.0]),
        poured=random.uniform(0.2, 0.6),
        height=random.uniform(0.0, 0.004),
        aside=random.uniform(-0.001, 0.001, 2),
        fingers=places,
    )


def half_width(lift: Lift) -> float:
    """How far the object's surface is from its axis, where fingers come [m]."""
    if lift.shape == "ellipsoid":
        return float(lift.size[0] * np.sqrt(max(0.0, 1 - (lift.height / lift.size[2]) ** 2)))
    return float(lift.size[0])


def finger(index: int, lift: Lift) -> str:
    """A finger: a drive along its way, springs across it, and at its end a tip on a force/torque sensor."""
    (angle, aside), shape = lift.fingers[index], lift.tips[index]
    outward = np.array([np.cos(angle), np.sin(angle), 0.0])
    across = np.array([-np.sin(angle), np.cos(angle), 0.0])
    start = outward * (half_width(lift) + shape.length + GAP) + across * aside
    # The finger's z points inward, its y up.
    x_axis = np.cross([0, 0, 1], -outward)
    axes = " ".join(map(str, [*x_axis, 0, 0, 1]))
    damping = 2 * 0.7 * np.sqrt(SIDEWAYS * 0.08)
    turned = " ".join(map(str, [*shape.euler, 0.0]))
    return f"""
      <body name="finger{index}" pos="{start[0]} {start[1]} 0" xyaxes="{axes}" gravcomp="1">
        <inertial pos="0 0 0" mass="{FINGER_MASS}" diaginertia="1e-5 1e-5 1e-5"/>
        <joint name="way{index}" type="slide" axis="0 0 1"/>
        <joint type="slide" axis="1 0 0" stiffness="{SIDEWAYS}" damping="{damping}"/>
        <joint type="slide" axis="0 1 0" stiffness="{SIDEWAYS}" damping="{damping}"/>
        <body name="tip{index}" euler="{turned}">
          <geom name="tip{index}" {shape.geom} mass="1e-6" condim="4" priority="1"
            friction="{lift.friction} {lift.friction * ARM} 1e-5" {CONTACT}/>
          <site name="tip{index}"/>
        </body>
      </body>"""


def xml(lift: Lift) -> str:
    """The model."""
    count = len(lift.tips)
    drive = 2 * np.sqrt(FINGER_STIFFNESS * FINGER_MASS)
    ways = "".join(
        f'<position joint="way{i}" kp="{FINGER_STIFFNESS}" kv="{drive}" ctrlrange="-0.05 0.05"/>' for i in range(count)
    )
    sensors = "".join(f'<force site="tip{i}"/><torque site="tip{i}"/>' for i in range(count))
    # MuJoCo's cylinders and ellipsoids have two and three sizes.
    size = {"box": lift.size, "cylinder": lift.size[[0, 2]], "ellipsoid": lift.size}[lift.shape]
    written, axis = " ".join(map(str, size)), " ".join(map(str, lift.axis))
    return f"""
<mujoco>
  <compiler angle="radian"/>
  <option timestep="{TIME_STEP}" integrator="implicitfast" cone="elliptic" impratio="30" noslip_iterations="3"/>
  <visual><headlight ambient="0.5 0.5 0.5"/></visual>
  <worldbody>
    <geom name="table" type="plane" size="0.5 0.5 0.1" condim="4" friction="0.6 0.005 1e-4" {CONTACT}/>
    <body name="hand" pos="0 0 {lift.grip_height}" gravcomp="1">
      <inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
      <joint name="height" type="slide" axis="0 0 1"/>
      <joint name="tilt" type="hinge" axis="{axis}"/>
      {"".join(finger(i, lift) for i in range(count))}
    </body>
    <body name="object" pos="{lift.aside[0]} {lift.aside[1]} {lift.size[2]}">
      <freejoint/>
      <geom name="object" type="{lift.shape}" size="{written}" mass="{lift.mass}" condim="4" {CONTACT}/>
    </body>
  </worldbody>
  <actuator>{ways}<position joint="height" kp="40000" kv="400"/><position joint="tilt" kp="400" kv="5"/></actuator>
  <sensor>{sensors}</sensor>
</mujoco>"""


def model(lift: Lift) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(xml(lift))
