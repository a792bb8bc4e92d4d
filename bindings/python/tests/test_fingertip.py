"""One reading at a time."""

import copy
import pickle
import threading

import fingertip
import numpy as np
import pytest
from conftest import RADIUS, SECTIONS
from fingertip import Fingertip, NoContactReason, Scene, SlipVerdict
from hypothesis import given, settings
from hypothesis import strategies as st

unit = st.floats(-1, 1)


@given(st.tuples(unit, unit, unit), st.tuples(unit, unit, unit), st.floats(0.1, 50))
@settings(max_examples=200, deadline=None)
def test_a_push_at_a_known_point_is_found_there(direction, other, size):
    normal = np.array(direction)
    if np.linalg.norm(normal) < 0.1:
        return
    normal /= np.linalg.norm(normal)
    sideways = 0.5 * np.cross(normal, other)
    force = size * (sideways - normal)
    tip = Fingertip(Scene.from_dict(SECTIONS))
    touch = tip.sense(np.hstack([force, np.cross(RADIUS * normal, force)]), 1e-3)
    # A line that is slightly off its direction moves by that over the cosine of incidence, which is above 0.8.
    assert np.linalg.norm(touch.point - RADIUS * normal) < 1e-14 + 1e-12 * RADIUS
    assert touch.normal_force == pytest.approx(size, rel=1e-12)
    assert np.linalg.norm(touch.tangential_force - size * sideways) < 1e-12 * size
    # The least change of force that slips: the distance to the cone.
    distance = size * (0.6 - np.linalg.norm(sideways)) / np.hypot(1, 0.6)
    assert touch.margin == pytest.approx(distance, rel=1e-9, abs=1e-12 * size)


@given(st.lists(st.floats(allow_nan=True, allow_infinity=True, width=64), min_size=6, max_size=6))
@settings(max_examples=300, deadline=None)
def test_no_reading_panics_and_none_that_is_not_finite_is_a_contact(reading):
    touch = Fingertip(Scene.from_dict(SECTIONS)).sense(reading, 1e-3)
    if not np.isfinite(reading).all():
        assert not touch
        assert touch.no_contact.reason is NoContactReason.NOT_FINITE


def test_what_is_not_there_is_none(scene):
    touch = Fingertip(Scene.from_dict({"surface": SECTIONS["surface"]})).sense([0, 0, -1, 0, 0, 0], 1e-3)
    assert touch and touch.margin is None and touch.slip is None and touch.spread is None
    nothing = Fingertip(scene).sense(np.zeros(6), 1e-3)
    assert not nothing and nothing.point is None and nothing.normal_force is None
    assert str(nothing.no_contact) == "the force of 0 N is below the threshold"
    assert nothing.slip is SlipVerdict.NOT_PRESSING


def test_the_convention_turns_the_sign_round(scene):
    reaction = Scene.from_dict({**SECTIONS, "input": {"convention": "reaction"}})
    load = np.array([0.1, 0.0, -1.0, 0.0, 1.3e-3, 0.0])
    there, here = Fingertip(reaction).sense(-load, 1e-3), Fingertip(scene).sense(load, 1e-3)
    assert np.array_equal(there.point, here.point) and np.array_equal(there.wrench, load)
    assert np.array_equal(Fingertip(reaction).sense_wrench(load, 1e-3).point, here.point)


@pytest.mark.parametrize("kind", [list, tuple, np.array, lambda x: np.array(x)[::-1][::-1], np.float32])
def test_readings_of_any_kind_are_the_same(scene, kind):
    load = [0.125, 0.0, -1.0, 0.0, 0.0078125, 0.0]
    assert Fingertip(scene).sense(kind(load), 1e-3) == Fingertip(scene).sense(load, 1e-3)


def test_strided_and_unaligned_readings_are_read_where_they_lie(scene):
    load = np.array([0.1, 0.0, -1.0, 0.0, 1.3e-3, 0.0])
    wide = np.zeros((6, 3))
    wide[:, 1] = load
    packed = np.frombuffer(b"x" + load.tobytes(), dtype=np.uint8)[1:].view("f8")
    swapped = load.astype(">f8")
    wanted = Fingertip(scene).sense(load, 1e-3)
    for other in (wide[:, 1], packed, swapped, load[::-1].copy()[::-1]):
        assert Fingertip(scene).sense(other, 1e-3) == wanted


@pytest.mark.parametrize(
    ("reading", "sentence"),
    [
        (np.zeros(5), "`reading` must be 6 numbers, not 5"),
        ("push", "`reading` must be numbers in one dimension, not a str"),
        (np.zeros((6, 1)), "`reading` must be numbers in one dimension, not an array of"),
        (None, "`reading` must be"),
    ],
)
def test_what_is_no_reading_is_refused_in_a_sentence(scene, reading, sentence):
    with pytest.raises(fingertip.FingertipError, match=sentence):
        Fingertip(scene).sense(reading, 1e-3)


def test_slip_is_found_and_is_an_enumeration(scene):
    tip = Fingertip(scene)
    push = np.array([0.0, 0.0, -2.0, 0.0, 0.0, 0.0])
    pull = np.array([1.9, 0.0, -2.0, 0.0, 1.9 * RADIUS, 0.0])
    assert tip.sense(push, 1e-3).slip is SlipVerdict.HOLDING
    slipping = tip.sense(pull, 1e-3)
    assert slipping.slip is SlipVerdict.SLIPPING and slipping.margin < 0 and slipping.utilisation > 1


def test_everything_pickles_and_copies(scene):
    tip = Fingertip(scene)
    touch = tip.sense([0.1, 0, -1, 0, 1.3e-3, 0], 1e-3)
    for thing in (scene, touch, touch.contact, scene.surface, tip.sense(np.zeros(6), 1e-3).no_contact):
        assert pickle.loads(pickle.dumps(thing)) == thing
        assert copy.deepcopy(thing) == thing == copy.copy(thing)
    for error in (fingertip.SceneError("one"), fingertip.ReadingError("two")):
        assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_a_copy_keeps_what_a_detector_saw_and_a_pickle_begins_anew():
    sections = {**SECTIONS, "slip": {"detector": "drop", "noise_N": 0.01}}
    tip = Fingertip(Scene.from_dict(sections))
    holds = [np.array([x, 0, -2, 0, x * RADIUS, 0]) for x in np.linspace(0, 1.0, 300)]
    for reading in holds:
        tip.sense(reading, 1e-3)
    twin, fresh = copy.deepcopy(tip), pickle.loads(pickle.dumps(tip))
    falls = [np.array([x, 0, -2, 0, x * RADIUS, 0]) for x in np.linspace(0.9, 0.5, 30)]
    seen = [[one.sense(reading, 1e-3).slip for reading in falls] for one in (tip, twin, fresh)]
    assert seen[0] == seen[1] and SlipVerdict.SLIPPING in seen[0]
    assert seen[2] != seen[0]


def test_a_zero_is_taken_and_kept_by_pickles(scene):
    random = np.random.default_rng(2)
    offset = np.array([0.3, -0.2, 0.5, 1e-3, 2e-3, -1e-3])
    rest = offset + random.normal(0, 1, (400, 6)) * [0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4]
    tip = Fingertip(scene)
    noise = tip.tare(rest)
    assert np.allclose(noise, rest.std(axis=0, ddof=1), rtol=1e-9)
    load = np.array([0, 0, -1, 0, 0, 0.0])
    touch = tip.sense(load + rest.mean(axis=0), 1e-3)
    assert np.allclose(touch.wrench, load, atol=1e-12)
    assert pickle.loads(pickle.dumps(tip)).sense(load + rest.mean(axis=0), 1e-3) == touch
    with pytest.warns(UserWarning, match="may not have been at rest"):
        tip.tare(rest + np.linspace(0, 1, 400)[:, None])


def test_a_scene_may_wait_for_the_noise_of_a_rest():
    sections = {"surface": SECTIONS["surface"], "contact": {"least_force_deviations": 5.0}}
    tip = Fingertip(Scene.from_dict({**sections, "input": {"convention": "on_fingertip", "rest_s": 1.0}}))
    push = [0, 0, -0.2, 0, 0, 0]
    assert tip.awaits_noise and not tip.sense(push, 1e-3)
    tip.tare(np.random.default_rng(3).normal(0, 1, (400, 6)) * 0.01)
    assert not tip.awaits_noise and tip.sense(push, 1e-3)


def test_single_precision_is_near_double(scene):
    load = np.array([0.1, 0.2, -1.0, 1e-3, 1.3e-3, 0.0])
    single, double = Fingertip(scene, np.float32), Fingertip(scene)
    assert single.dtype == np.float32 and double.dtype == np.float64
    assert np.abs(single.sense(load, 1e-3).point - double.sense(load, 1e-3).point).max() < 1e-8
    with pytest.raises(TypeError, match="float64 or float32"):
        Fingertip(scene, np.int32)


def test_a_payload_needs_the_motion():
    payload = {"mass_kg": 0.05, "centre_of_mass_m": [0.0, 0.0, 0.01]}
    tip = Fingertip(Scene.from_dict({**SECTIONS, "payload": payload}))
    with pytest.raises(fingertip.ReadingError, match="without the motion of the sensor"):
        tip.sense([0, 0, -1, 0, 0, 0], 1e-3)
    gravity = np.array([0.0, 0.0, -9.80665])
    hanging = tip.sense(np.hstack([0.05 * gravity, np.zeros(3)]), 1e-3, gravity=gravity)
    assert not hanging and np.allclose(hanging.wrench, 0, atol=1e-12)


def test_a_payload_in_motion_needs_its_inertial_unit():
    payload = {"mass_kg": 0.05, "centre_of_mass_m": [0.0, 0.0, 0.01]}
    sections = {**SECTIONS, "payload": payload, "inertial_unit": {"time_constant_s": 0.002}}
    # Shaken along x: what the accelerometer reads is what the body leans against.
    for dtype in (np.float64, np.float32):
        tip = Fingertip(Scene.from_dict(sections), dtype)
        for k in range(200):
            read = np.array([5.0 * np.sin(0.05 * k), 0.0, 9.80665])
            force = -0.05 * read
            load = np.hstack([force, np.cross([0.0, 0.0, 0.01], force)])
            felt = tip.sense(load, 1e-3, acceleration=read, angular_velocity=np.zeros(3))
            assert not felt and np.allclose(felt.wrench, 0, atol=1e-6)
    with pytest.raises(ValueError, match="angular_velocity"):
        tip.sense(load, 1e-3, acceleration=read)
    with pytest.raises(ValueError, match="in the place of gravity"):
        tip.sense(load, 1e-3, acceleration=read, angular_velocity=np.zeros(3), gravity=-read)
    with pytest.raises(fingertip.ReadingError):
        tip = Fingertip(Scene.from_dict({**SECTIONS, "payload": payload}))
        tip.sense(load, 1e-3, acceleration=read, angular_velocity=np.zeros(3))


def test_two_threads_on_one_fingertip_are_told_so_or_served(scene):
    tip, wrong = Fingertip(scene), []

    def work():
        for _ in range(2000):
            try:
                tip.sense([0, 0, -1, 0, 0, 0], 1e-3)
            except RuntimeError:
                pass
            except BaseException as error:
                wrong.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert not wrong


def test_what_a_scene_asks_for_beside_is_told():
    sections = {
        **SECTIONS,
        "uncertainty": {"force_noise_N": 0.01, "torque_noise_Nm": 1e-4},
        "tracking": {"speed_m_per_s": 0.01, "turns_within_s": 0.1, "least_touch_N": 0.2},
        "grip": {"least_N": 0.5, "greatest_N": 10.0, "rise_N_per_s": 50.0, "fall_N_per_s": 1.0},
        "estimate": {"noise_N": 0.01},
    }
    tip = Fingertip(Scene.from_dict(sections))
    touch = [tip.sense([0.1, 0, -1, 0, 1.3e-3, 0], 1e-3) for _ in range(20)][-1]
    assert touch.spread.semi_axes[0] >= touch.spread.semi_axes[1] > 0
    assert touch.spread.normal_force == pytest.approx(0.01, rel=0.1)
    assert pickle.loads(pickle.dumps(touch)) == touch
    assert np.linalg.norm(touch.tracked.point - touch.point) < 1e-3
    assert touch.tracked.continuity is fingertip.Continuity.FOLLOWED and touch.happened.touching
    # The same press again and again: nothing is found elsewhere than expected.
    assert touch.tracked.innovation.shape == (2,) and np.abs(touch.tracked.innovation).max() < 1e-6
    moved = tip.sense([0.1, 0, -1, 0, 1.2e-3, 0], 1e-3).tracked
    assert np.linalg.norm(moved.innovation) > 1e-5 and moved.surprise > touch.tracked.surprise
    assert 0.5 <= touch.grip_force <= 10.0 and touch.static_friction is None
