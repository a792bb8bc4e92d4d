"""Scenes."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import fingertip
import numpy as np
import pytest
from conftest import SECTIONS
from fingertip import Scene, SceneError, Surface

SCENES = Path(__file__).resolve().parents[3] / "examples" / "scenes"
COMMAND = [sys.executable, "-m", "fingertip._command"]


def test_every_example_is_read_pickled_and_told():
    files = sorted(SCENES.glob("*.toml"))
    assert len(files) > 5
    for file in files:
        scene = Scene.from_file(file)
        assert pickle.loads(pickle.dumps(scene)) == scene
        assert scene.meaning() and scene.name
        fingertip.Fingertip(scene), fingertip.Fingertip(scene, np.float32)


BAD = [
    "version = 2\n[input]\nconvention = 'both'\n",
    "version = 9\n",
    "[input]\n",
    "version = 2\n[input]\nconvention = 'reaction'\n[surface]\nshape = 'sphere'\nradius_m = -1.0\n",
    "version = 2\n[input]\nconvention = 'reaction'\n[surface]\nshape = 'spheer'\n",
    "version = 2\n[input]\nconvention = 'reaction'\n[surface]\nshape = 'plane'\npoint_m = [0, 0]\n",
    "version = 2\n[input]\nconvention = 'reaction'\n[sensor]\ncalibration = 'none.toml'\n"
    "[surface]\nshape = 'sphere'\nradius_m = 0.01\n",
]


@pytest.mark.parametrize("text", BAD)
def test_exceptions_say_what_the_command_says(tmp_path, text):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    with pytest.raises(SceneError) as raised:
        Scene.from_file(file)
    (tmp_path / "r.csv").write_text("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,0,0,0,0\n")
    run = subprocess.run(
        [*COMMAND, "analyze", str(tmp_path / "r.csv"), "--scene", str(file)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 1
    assert run.stderr.strip() == f"error: {raised.value}"


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(SceneError, match="cannot read the scene .*none.toml: No such file"):
        Scene.from_file(tmp_path / "none.toml")


def test_a_calibration_travels_within_a_pickle(tmp_path):
    loads = np.random.default_rng(1).uniform(-1, 1, (60, 6)) * [10, 10, 10, 0.1, 0.1, 0.1]
    signals = loads / [10, 10, 10, 0.1, 0.1, 0.1] + 1e-5 * np.random.default_rng(2).normal(size=(60, 6))
    file = tmp_path / "tip.toml"
    fingertip.calibrate(loads, signals).save(file)
    scene = Scene.from_dict(SECTIONS).calibrated_by(file)
    assert [str(path) for path in scene.files()] == [str(file)] and Scene.from_dict(SECTIONS).files() == []
    pickled = pickle.dumps(scene)
    os.remove(file)
    tip = fingertip.Fingertip(pickle.loads(pickled))
    assert tip.channels == 6
    assert np.allclose(tip.sense(signals[0], 1e-3).wrench, loads[0], atol=1e-2)


def test_every_choice_of_the_registry_makes_a_scene():
    choices = Scene.choices()
    shapes = [choice for choice in choices if choice["section"] == "surface"]
    assert len(shapes) > 15
    for choice in shapes:
        text = f'version = 2\n[input]\nconvention = "on_fingertip"\n[surface]\nshape = "{choice["name"]}"\n'
        scene = Scene.from_toml(text + choice["example"])
        assert pickle.loads(pickle.dumps(scene.surface)) == scene.surface


def test_a_surface_answers_as_its_equation_does():
    axes = np.array([0.008, 0.010, 0.013])
    body = Surface("ellipsoid", semi_axes_m=axes.tolist())
    random = np.random.default_rng(3)
    for _ in range(50):
        point, direction = random.uniform(-0.004, 0.004, 3), random.normal(size=3)
        found = body.crossings(point, direction)
        assert len(found) == 2 and found[0][0] < found[1][0]
        for along, place, normal, active in found:
            assert active and np.sum((place / axes) ** 2) == pytest.approx(1, abs=1e-12)
            assert np.allclose(place, point + along * direction / np.linalg.norm(direction), atol=1e-15)
            gradient = place / axes**2
            assert np.allclose(normal, gradient / np.linalg.norm(gradient), atol=1e-12)
            assert np.allclose(body.normal(place), normal, atol=1e-12)
            # The shape operator is the change of the normal along the surface, by differences.
            tangent = np.cross(normal, [0.3, 0.5, 0.7])
            step = 1e-7 * tangent
            changed = (body.normal(place + step) - body.normal(place - step)) / 2e-7
            bent = body.shape_operator(place) @ tangent
            assert np.allclose(changed - normal * (normal @ changed), bent, atol=1e-4 * np.linalg.norm(bent))
    assert body.contains([0, 0, 0.0129]) and not body.contains([0, 0, 0.0131])
    gap, place, normal, _ = body.closest_approach([0.02, 0, 0], [0, 1, 0])
    assert gap == pytest.approx(0.012) and np.allclose(place, [0.008, 0, 0]) and np.allclose(normal, [1, 0, 0])
    centre, radius = body.extent()
    assert np.allclose(centre, 0) and radius >= 0.013
    value, gradient, hessian = body.level([0.008, 0, 0])
    assert value == pytest.approx(0, abs=1e-12) and gradient[0] > 0 and np.allclose(hessian, hessian.T)


def test_wrong_numbers_of_a_shape_are_refused_in_a_sentence():
    with pytest.raises(SceneError, match="the radius of a sphere must be a positive finite length"):
        Surface("sphere", radius_m=-1.0)
    with pytest.raises(SceneError, match="radius"):
        Surface("sphere", radius=1.0)
    with pytest.raises(fingertip.FingertipError, match="`direction` must be finite and not zero"):
        Surface("sphere", radius_m=0.01).crossings([0, 0, 0], [0, 0, 0])


def test_the_map_of_a_scene_keeps_areas_of_the_sphere():
    scene = Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.01, "pole": [0.0, 0.0, 1.0]}})
    right, up = scene.project([[0, 0, 0.01], [0.01, 0, 0]])
    assert (right[0], up[0]) == (0.0, 0.0)
    assert np.hypot(right[1], up[1]) == pytest.approx(np.sqrt(2))
