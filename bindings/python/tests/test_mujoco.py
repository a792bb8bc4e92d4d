"""MuJoCo's own contacts against ours: physics that nobody here wrote."""

import fingertip
import numpy as np
import pytest
from conftest import skipped
from fingertip import Scene

try:
    import fingertip.mujoco
    import mujoco
except ImportError:  # pragma: no cover
    mujoco = None


@pytest.fixture(autouse=True)
def installed():
    if mujoco is None:
        skipped("MuJoCo is not installed: fingertip.mujoco is not tested")


GEOMS = {
    "sphere": ('type="sphere" size="0.013"', {"shape": "sphere", "radius_m": 0.013}),
    "ellipsoid": (
        'type="ellipsoid" size="0.008 0.010 0.013"',
        {"shape": "ellipsoid", "semi_axes_m": [0.008, 0.010, 0.013]},
    ),
    "capsule": ('type="capsule" size="0.008 0.010"', {"shape": "capsule", "radius_m": 0.008, "half_length_m": 0.010}),
    "cylinder": (
        'type="cylinder" size="0.010 0.020"',
        {"shape": "capped_cylinder", "radius_m": 0.010, "half_length_m": 0.020},
    ),
    "box": (
        'type="box" size="0.008 0.010 0.013"',
        {"shape": "rounded_box", "half_extents_m": [0.008, 0.010, 0.013], "rounding_m": 1e-6},
    ),
}

XML = """
<mujoco>
  <option timestep="0.0001" gravity="0 0 0" cone="elliptic"/>
  <worldbody>
    <body name="tip"><geom {geom} mass="1e-9" condim="{condim}" friction="0.8 0.005 0.0001" solref="0.0004 1" solimp="0.99 0.999 0.00001"/>
      <site name="tip" euler="0.3 0.2 0.1"/></body>
    <body name="ball" mocap="false" pos="0.1 0 0">
      <freejoint/>
      <geom type="sphere" size="0.006" mass="0.02" condim="{condim}" friction="0.8 0.005 0.0001" solref="0.0004 1" solimp="0.99 0.999 0.00001"/>
    </body>
  </worldbody>
  <sensor><force site="tip"/><torque site="tip"/></sensor>
</mujoco>
"""


@pytest.mark.parametrize("condim", [3, 4])
@pytest.mark.parametrize("geom", GEOMS)
def test_contacts_are_those_of_the_contact_list(geom, condim):
    size, shape = GEOMS[geom]
    model = mujoco.MjModel.from_xml_string(XML.format(geom=size, condim=condim))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    # The surface is that of the geom, in the frame of the site, which is turned in it.
    turn = data.site_xmat[0].reshape(3, 3).T.copy()
    angles = rotation_vector(turn)
    scene = Scene.from_dict(
        {
            "surface": shape,
            "pose": {"rotation_deg": angles},
            "contact": {"model": "soft_finger" if condim == 4 else "point", "least_force_N": 0.02},
        }
    )
    feel = fingertip.mujoco.Touch(model, "tip", scene)
    random = np.random.default_rng(3)
    points, forces, beside, missed, tried = [], [], [], 0, 0
    for _ in range(120):
        mujoco.mj_resetData(model, data)
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        data.qpos[:3] = direction * (reach(scene, turn, direction) + 0.0062)
        data.qvel[:3] = -direction * 0.05 + np.cross(direction, random.normal(size=3)) * 0.01
        data.qvel[3:6] = random.normal(size=3) * 20
        for _ in range(60):
            mujoco.mj_step(model, data)
            mujoco.mj_forward(model, data)
            if data.ncon != 1:
                continue
            contact = data.contact[0]
            load = np.zeros(6)
            mujoco.mj_contactForce(model, data, 0, load)
            frame = contact.frame.reshape(3, 3)
            sign = 1.0 if model.geom_bodyid[contact.geom[1]] == model.body("tip").id else -1.0
            force = sign * frame.T @ load[:3]
            if np.linalg.norm(force) < 0.05:
                continue
            tried += 1
            touch = feel(data)
            felt = turn.T @ touch.wrench[:3]
            assert np.allclose(felt, force, atol=1e-6 * np.linalg.norm(force) + 1e-7)
            if not touch:
                missed += 1
                continue
            point = turn.T @ touch.point
            # Its contacts lie in the middle of a penetration. Its normals are rough at edges, so the force line is what
            # is sure: how far it passes their point.
            along = force / np.linalg.norm(force)
            if geom != "box" or condim == 3 or np.abs(frame[0]).max() > 1 - 1e-12:
                # With a spin torque the force passes by the contact, and where it is hangs on the normal: on the box's
                # edges, where that is rough, nothing can be said.
                beside.append(np.linalg.norm(np.cross(point - contact.pos, along)))
            points.append(np.linalg.norm(point - contact.pos) - abs(contact.dist) / touch.contact.incidence)
            forces.append(abs(touch.normal_force - load[0]) / load[0])
    assert tried > 100 and missed <= 0.02 * tried, (tried, missed)
    assert len(beside) > 50 and (np.max(beside) < 1e-8 if condim == 3 else np.median(beside) < 1e-6)
    if geom != "box":
        assert np.median(points) < 0
        # The rim of a cylinder is an edge, too.
        assert geom == "cylinder" or np.quantile(points, 0.98) < 1e-6
        assert np.median(forces) < 1e-3
    print(f"{geom}, condim {condim}: {tried} contacts, {missed} missed, {np.median(beside):.2g} m beside its line")


def reach(scene, turn, direction):
    """How far the surface is from the middle in a direction [m]."""
    return max(along for along, *_ in scene.surface.crossings(np.zeros(3), turn @ direction))


def rotation_vector(turn):
    """Axis times angle of a rotation [°]."""
    angle = np.arccos((np.trace(turn) - 1) / 2)
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.degrees(angle * axis / np.linalg.norm(axis)).tolist()


def test_many_environments_are_each_for_itself():
    model = mujoco.MjModel.from_xml_string(XML.format(geom=GEOMS["ellipsoid"][0], condim=3))
    data = mujoco.MjData(model)
    feel = fingertip.mujoco.Touch(model, "tip", Scene.from_dict({"surface": GEOMS["ellipsoid"][1]}))
    random = np.random.default_rng(4)
    rows = random.normal(size=(500, model.nsensordata)) * [1, 1, 1, 1e-3, 1e-3, 1e-3]
    many = feel.many(rows)
    for row, point in zip(rows, many.point, strict=True):
        data.sensordata[:] = row
        touch = feel(data)
        assert bool(touch) == bool(point.any())
        if touch:
            assert np.allclose(touch.point, point, atol=1e-15)


def test_a_weight_is_taken_off():
    xml = XML.replace('gravity="0 0 0"', 'gravity="0 0 -9.81"').replace('mass="1e-9"', 'mass="0.1"')
    model = mujoco.MjModel.from_xml_string(xml.format(geom=GEOMS["sphere"][0], condim=3))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene = Scene.from_dict({"surface": GEOMS["sphere"][1], "contact": {"least_force_N": 0.01}})
    assert np.linalg.norm(fingertip.mujoco.Touch(model, "tip", scene).wrench(data)) > 0.9
    assert np.linalg.norm(fingertip.mujoco.Touch(model, "tip", scene, body="tip").wrench(data)) < 1e-9


def test_what_is_missing_is_named():
    model = mujoco.MjModel.from_xml_string(XML.format(geom=GEOMS["sphere"][0], condim=3))
    scene = Scene.from_dict({"surface": GEOMS["sphere"][1]})
    with pytest.raises(fingertip.FingertipError, match="no site 'thumb'"):
        fingertip.mujoco.Touch(model, "thumb", scene)
    with pytest.raises(fingertip.FingertipError, match="needs one force sensor, and has 0"):
        fingertip.mujoco.Touch(model, "tip", scene, force="other")
    with pytest.raises(fingertip.FingertipError, match="no body 'thumb'"):
        fingertip.mujoco.Touch(model, "tip", scene, body="thumb")
