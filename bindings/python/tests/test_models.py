"""Contact models, friction, hands and channels, against formulas that are not the library's."""

import copy
import pickle

import numpy as np
import pytest

import fingertip
from fingertip import ContactModel, FrictionLimit, Grasp, SlipVerdict, Surface

RADIUS = 0.013
BALL = Surface("sphere", radius_m=RADIUS)
EGG = Surface("ellipsoid", semi_axes_m=[0.008, 0.010, 0.013])


def pushes(count, surface, spin=0.0, seed=1):
    """Wrenches at known points, by the surface's own normals."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        direction = random.normal(size=3)
        _, point, normal, _ = surface.crossings([0, 0, 0], direction)[-1]
        sideways = np.cross(normal, random.normal(size=3)) * 0.3
        force = random.uniform(0.5, 3) * (sideways - normal)
        yield point, normal, np.hstack([force, np.cross(point, force) + spin * normal])


@pytest.mark.parametrize("surface", [BALL, EGG])
@pytest.mark.parametrize(("model", "spin"), [("point", 0.0), ("soft_finger", 2e-4)])
def test_contacts_and_their_derivatives_are_those_of_differences(surface, model, spin):
    contacts = ContactModel(surface, model)
    assert pickle.loads(pickle.dumps(contacts)) == contacts
    for point, _, wrench in pushes(20, surface, spin):
        contact = contacts.resolve(wrench)
        assert np.linalg.norm(contact.point - point) < 1e-9
        assert contact.spin_torque == pytest.approx(spin, abs=1e-9)
        jacobian = contacts.jacobian(contact, wrench)
        differences = np.empty((3, 6))
        for axis, step in enumerate([1e-6] * 3 + [1e-8] * 3):
            change = np.zeros(6)
            change[axis] = step
            above, below = contacts.resolve(wrench + change), contacts.resolve(wrench - change)
            differences[:, axis] = (above.point - below.point) / (2 * step)
        assert np.allclose(jacobian.point, differences, atol=1e-4 * np.abs(differences).max())
        # The covariance of the point is J Σ Jᵀ, and its ellipse that of the eigenvalues in the tangent plane.
        noise = np.diag([1e-4] * 3 + [1e-8] * 3)
        spread = jacobian.covariance(noise)
        assert np.allclose(spread.point, jacobian.point @ noise @ jacobian.point.T, rtol=1e-9, atol=1e-18)
        axes, directions = spread.ellipse(0.95)
        greatest = np.sqrt(np.linalg.eigvalsh(spread.position)[::-1] * -2 * np.log(0.05))
        assert np.allclose(axes, greatest, rtol=1e-6) and abs(directions[0] @ directions[1]) < 1e-12
        assert np.allclose(spread.normal_force, (jacobian.local @ noise @ jacobian.local.T)[2, 2])


def test_the_worst_case_holds_what_noise_within_it_does():
    contacts = ContactModel(BALL)
    random = np.random.default_rng(2)
    worst = np.array([0.01] * 3 + [1e-5] * 3)
    for _, _, wrench in pushes(20, BALL):
        contact = contacts.resolve(wrench)
        components, distance, _, _ = contacts.jacobian(contact, wrench).worst_case(worst)
        bound = contacts.worst_distance(wrench, np.linalg.norm(worst[:3]), np.linalg.norm(worst[3:]))
        for _ in range(100):
            other = contacts.resolve(wrench + random.uniform(-1, 1, 6) * worst)
            moved = other.point - contact.point
            assert np.linalg.norm(moved) <= bound
            assert np.linalg.norm(moved) <= 1.1 * distance and (np.abs(moved) <= 1.1 * components + 1e-9).all()
    bounds = fingertip.paper_bounds(RADIUS, 0.01, [0.0, 0.0, -1.0], [0.0, 0.0, 0.0])
    assert bounds.shape == (3,) and (bounds >= 0).all() and 0.01 * RADIUS < bounds.max() < 0.1 * RADIUS


def test_an_offset_of_the_surface_moves_the_contact():
    contacts = ContactModel(BALL)
    larger = ContactModel(Surface("sphere", radius_m=RADIUS + 1e-6))
    for _, _, wrench in pushes(10, BALL):
        contact = contacts.resolve(wrench)
        moved = (larger.resolve(wrench).point - contact.point) / 1e-6
        offset = contacts.jacobian(contact, wrench).offset
        tangential = moved - contact.normal * (moved @ contact.normal)
        assert np.allclose(offset - contact.normal * (offset @ contact.normal), tangential, atol=1e-3)


def test_the_model_that_weighs_evidence_chooses():
    contacts = ContactModel(BALL, "auto", force_noise_N=0.01, torque_noise_Nm=1e-5)
    point = np.array([0, 0, RADIUS])
    force = np.array([0.1, 0, -1.0])
    without = np.hstack([force, np.cross(point, force)])
    assert contacts.choice(without)[0] == "point"
    with_spin = without + [0, 0, 0, 0, 0, 1e-3]
    name, pitch, deviation = contacts.choice(with_spin)
    assert name == "soft_finger" and abs(pitch) > 3 * deviation
    assert contacts.resolve(with_spin).spin_torque == pytest.approx(1e-3, rel=1e-2)
    assert ContactModel(BALL).choice(without) is None


def test_a_skin_gives_way():
    skin = {"law": "linear", "stiffness_N_per_m": 1000.0, "radius_m": RADIUS}
    soft = ContactModel(BALL, skin=skin)
    sunk = soft.resolve([0, 0, -2.0, 0, 0, 0])
    assert sunk.point[2] == pytest.approx(RADIUS - 2.0 / 1000.0, rel=1e-6)


def test_coulomb_is_a_cone_and_a_soft_finger_an_ellipse():
    cone = FrictionLimit(static_coefficient=0.5)
    newtons, used = cone.margin(2.0, [0.3, 0.4, 0.0])
    assert newtons == pytest.approx((0.5 * 2 - 0.5) / np.hypot(1, 0.5)) and used == pytest.approx(0.5)
    assert cone.least_normal_force([0.3, 0.4, 0.0], safety=2.0) == pytest.approx(2.0)
    direction, spin = cone.slip_direction(2.0, [0.3, 0.4, 0.0])
    assert abs(direction @ [0.6, 0.8, 0]) == pytest.approx(1) and spin == 0
    soft = FrictionLimit("soft_finger", static_coefficient=0.5, torque_arm_m=0.003)
    _, used = soft.margin(2.0, [0.6, 0.0, 0.0], 0.8 * 0.5 * 2 * 0.003)
    assert used == pytest.approx(1.0)
    unsure = FrictionLimit("uncertain", static_coefficient=0.5, deviation=0.05)
    assert unsure.slip_probability(2.0, [1.0, 0, 0]) == pytest.approx(0.5, abs=0.02)
    assert cone.slip_probability(2.0, [1.0, 0, 0]) is None and cone.coefficient == 0.5
    for limit in (cone, soft, unsure):
        assert pickle.loads(pickle.dumps(limit)) == limit
    with pytest.raises(fingertip.SceneError, match="friction coefficient"):
        FrictionLimit(static_coefficient=-1.0)


def test_the_limit_curve_of_a_uniform_pressure_meets_its_ends():
    curve = fingertip.limit_curve("uniform", 50)
    assert curve.shape == (50, 3)
    force, torque = curve[:, 0], curve[:, 1]
    assert force.min() == pytest.approx(0, abs=1e-9) and force.max() == pytest.approx(1)
    assert torque.max() == pytest.approx(1) and (force**2 + torque**2 > 0.8).all()
    with pytest.raises(fingertip.FrictionError, match="uniform, hertz or winkler"):
        fingertip.limit_curve("square", 3)


@pytest.mark.parametrize("detector", ["drop", "threshold", "likelihood_ratio", "stick_slip", "adaptive_drop"])
def test_detectors_find_a_slip(detector):
    watch = fingertip.SlipDetector(detector, static_coefficient=0.5 if detector == "threshold" else None, noise_N=0.01)
    ratios = np.concatenate([np.linspace(0, 0.6, 600), np.full(100, 0.35)])
    noise = np.random.default_rng(3).normal(0, 0.005, len(ratios))
    verdicts = [watch.update(2.0, [2.0 * ratio + more, 0, 0], 1e-3) for ratio, more in zip(ratios, noise, strict=True)]
    assert all(isinstance(verdict, SlipVerdict) for verdict in verdicts)
    # Falls that come again are not one fall; noise that is to be learnt takes longer than this.
    if detector not in ("stick_slip", "adaptive_drop"):
        assert SlipVerdict.SLIPPING in verdicts[450:] and SlipVerdict.SLIPPING not in verdicts[:400]
    twin, fresh = copy.deepcopy(watch), pickle.loads(pickle.dumps(watch))
    assert twin.update(2.0, [0.7, 0, 0], 1e-3) == watch.update(2.0, [0.7, 0, 0], 1e-3)
    assert fresh.update(2.0, [0.7, 0, 0], 1e-3) in SlipVerdict


def test_a_contact_that_gives_way_warns():
    watch = fingertip.IncipientSlip(0.005, 2e-5, 0.5)
    verdicts = []
    for step in range(400):
        moved = step * 1e-6
        force = 1.2 * (1 - np.exp(-moved / 8e-5))
        verdicts.append(watch.update(2.0, [-force, 0, 0], [moved, 0, 0]))
    assert verdicts[30] is not SlipVerdict.WARNING and SlipVerdict.WARNING in verdicts[60:]


@pytest.mark.parametrize("law", ["dahl", "lugre", "elasto_plastic", "stribeck"])
def test_bristles_bend_and_then_slide(law):
    bristle = fingertip.BristleFriction(law, stiffness=1e4, kinetic=0.4)
    bristle.set_load(2.0)
    first, _ = bristle.step([1e-6, 0.0], 1e-3)
    # Bent by half a nanometre on average; the law without creep is integrated by its end.
    bent = 1e-9 if law == "stribeck" else 0.5e-9
    assert first[0] == pytest.approx(1e4 * 2.0 * bent, rel=0.05)
    for _ in range(2000):
        mean, end = bristle.step([0.01, 0.0], 1e-3)
    assert np.linalg.norm(end) == pytest.approx(0.4 * 2.0, rel=1e-3) and mean[0] > 0
    assert np.linalg.norm(bristle.deflection) == pytest.approx(0.4 / 1e4, rel=1e-2)
    assert bristle.greatest == pytest.approx(0.4)
    bristle.reset()
    # A body under less than friction holds stays; under more it goes.
    velocity = np.zeros(2)
    for _ in range(500):
        velocity, friction = bristle.step_body(velocity, 0.1, [0.5, 0.0], 1e-3)
    assert np.linalg.norm(velocity) < 1e-2 and friction[0] == pytest.approx(0.5, rel=0.1)


def test_lines_meet_where_the_contact_is():
    point = np.array([0.004, 0.003, 0.012])
    meeting = fingertip.LineMeeting()
    random = np.random.default_rng(5)
    noise = np.diag([1e-4] * 3 + [1e-10] * 3)
    with pytest.raises(fingertip.FingertipError):
        meeting.find()
    for _ in range(200):
        force = random.normal([0, 0, -2], 0.5)
        wrench = np.hstack([force, np.cross(point, force)]) + random.normal(0, 1, 6) * np.sqrt(np.diag(noise))
        assert meeting.add(wrench, noise)
    found, covariance, _ = meeting.find()
    error = found - point
    assert len(meeting) == 200 and error @ np.linalg.solve(covariance, error) < 20
    assert np.linalg.norm(error) < 1e-3


def test_what_happens_is_told():
    events = fingertip.ContactEvents(0.01, 0.06)
    told = [events.observe([0, 0, -force], 1e-3) for force in [0.0] * 20 + [0.5] * 20 + [0.0] * 40]
    assert not told[19].touching and told[25].touching and not told[-1].touching
    assert sum(one.touch is not None for one in told) == 1 == sum(one.release is not None for one in told)
    # A force that falls by 1/e in 0.1 s is a blow to those who wait for it.
    swing = [0.0] * 20 + [3.0 * np.exp(-k / 100) for k in range(480)]
    for longest, blows in [(0.05, 0), (0.2, 1)]:
        events = fingertip.ContactEvents(0.01, 0.06, longest_impact=longest)
        told = [events.observe([0, 0, -force], 1e-3).impact for force in swing]
        assert [blow.peak for blow in told if blow] == pytest.approx([3.0] * blows)
    with pytest.raises(ValueError, match="longest impact"):
        fingertip.ContactEvents(0.01, 0.06, longest_impact=-1.0)


def test_wrench_and_array_are_fused():
    point = np.array([0.0, 0.0, RADIUS])
    force = np.array([0.2, 0.0, -1.0])
    wrench = np.hstack([force, np.cross(point, force)])
    reading = {
        "centroid": point + [2e-3, 0, 0],
        "centroid_covariance": np.eye(3) * 4e-6,
        "normal_force": 1.1,
        "normal_deviation": 0.3,
    }
    noise = np.diag([1e-4] * 3 + [1e-10] * 3)
    [contact], disagreement = fingertip.fuse(BALL, wrench, noise, [reading], 0.6)
    assert np.linalg.norm(contact["point"] - point) < 2e-4 and contact["grip"] == "sticks"
    assert np.allclose(contact["force"], force, atol=0.02) and disagreement < 5
    with pytest.raises(fingertip.FingertipError):
        fingertip.fuse(BALL, wrench, noise, [], 0.6)


def test_a_scene_fuses_as_the_function_does():
    sections = {
        "surface": {"shape": "sphere", "radius_m": RADIUS},
        "uncertainty": {"force_noise_N": 0.01, "torque_noise_Nm": 1e-5},
        "fusion": {"position_deviation_m": 2e-3, "normal_deviation_N": 0.3, "static_coefficient": 0.6},
    }
    point, force = np.array([0.0, 0.0, RADIUS]), np.array([0.2, 0.0, -1.0])
    wrench = np.hstack([force, np.cross(point, force)])
    centroid = point + [2e-3, 0, 0]
    reading = {
        "centroid": centroid,
        "centroid_covariance": np.eye(3) * 4e-6,
        "normal_force": 1.1,
        "normal_deviation": 0.3,
    }
    [expected], chi = fingertip.fuse(BALL, wrench, np.diag([1e-4] * 3 + [1e-10] * 3), [reading], 0.6)
    for dtype, within in [("float64", 1e-9), ("float32", 1e-3)]:
        tip = fingertip.Fingertip(fingertip.Scene.from_dict(sections), dtype)
        tip.sense_wrench(wrench, 1e-3)
        [contact], disagreement = tip.fuse([[*centroid, 1.1]])
        assert np.allclose(contact["force"], expected["force"], atol=within)
        assert np.allclose(contact["point"], expected["point"], atol=within)
        assert contact["grip"] == expected["grip"] and abs(disagreement - chi) < 1e3 * within
    for readings in [[], [[0.0, 0.0, RADIUS]], [[0.0, 0.0, RADIUS, 1.0]] * 5]:
        with pytest.raises(fingertip.FingertipError):
            tip.fuse(readings)
    bare = fingertip.Fingertip(fingertip.Scene.from_dict({"surface": sections["surface"]}))
    with pytest.raises(fingertip.ReadingError, match="no \\[fusion\\]"):
        bare.fuse([[0.0, 0.0, RADIUS, 1.0]])


def three(friction=0.6):
    outward = [np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in (0.0, 2.1, 4.2)]
    return Grasp([{"point": 0.04 * o, "outward": -o, "friction": friction, "arm": 2e-3} for o in outward])


def test_the_least_grip_bears_the_load_within_friction():
    grasp = three()
    load = np.array([0.0, 0.0, -2.94, 0.0, 0.0147, 0.0])
    forces = grasp.least_grip(load)
    assert np.allclose(grasp.wrench(forces), -load, atol=1e-6) or np.allclose(grasp.wrench(forces), load, atol=1e-6)
    for normal, tangential, spin in forces:
        assert np.hypot(np.linalg.norm(tangential), spin / 2e-3) <= 0.6 * normal * (1 + 1e-6)
    # No grip with one per cent less holds, since the limits are cones: only a larger one can.
    total = sum(normal for normal, _, _ in forces)
    firmer = sum(normal for normal, _, _ in grasp.least_grip(load, least=5.0))
    assert total < firmer and firmer == pytest.approx(15.0, rel=0.2)
    assert all(margin >= -1e-6 for margin, _ in grasp.slip_margins(forces))
    bearing, internal = grasp.split(forces)
    assert np.allclose(grasp.wrench(internal), 0, atol=1e-9)
    assert np.allclose(grasp.wrench(bearing), grasp.wrench(forces), atol=1e-9)
    with pytest.raises(fingertip.HandError, match="cannot be held"):
        grasp.least_grip(load * 100, greatest=1.0)


def pinch():
    sides = [{"point": [x, 0, 0], "outward": [-x, 0, 0], "friction": 0.5, "arm": 3e-3} for x in (-0.02, 0.02)]
    return Grasp(sides)


def test_joints_and_costs_limit_each_finger():
    # A hinge along y, 8 cm below the line of the fingers: 0.08 N·m for a newton of normal force, and what hangs on the finger
    # adds 0.02 N·m a newton.
    hinge = np.array([[0.08, 0, 0, 0, 1, 0]]).T
    load = np.array([0, 0, -4.0, 0, 0, 0])
    plain = pinch().least_grip(load)
    assert [normal for normal, _, _ in plain] == pytest.approx([4.0, 4.0], rel=1e-5)

    def torque(side, force):
        normal, tangential, _ = force
        point, outward = np.array([0.02 * side, 0, 0]), np.array([-side, 0, 0])
        on_tip = tangential - normal * outward
        return hinge[:, 0] @ np.hstack([on_tip, np.cross(point, on_tip)])

    needed = [torque(side, force) for side, force in zip((-1, 1), plain)]
    most = max(abs(number) for number in needed)
    enough, little = [(hinge, [most * 1.01])] * 2, [(hinge, [most * 0.8])] * 2
    assert [f[0] for f in pinch().least_grip(load, joints=enough)] == pytest.approx([4.0, 4.0], rel=1e-4)
    with pytest.raises(fingertip.HandError, match="cannot be held"):
        pinch().least_grip(load, joints=little)
    # Twice as much can be borne with twice the torques, and not more.
    times = pinch().reach([0] * 6, load, joints=[(hinge, [2 * most])] * 2)
    assert times == pytest.approx(2.0, rel=1e-3)
    assert pinch().reach([0] * 6, load, greatest=[8.0, 100.0]) == pytest.approx(2.0, rel=1e-4)
    # A dear finger beside the right one is spared.
    side = {"outward": [-1, 0, 0], "friction": 0.5, "arm": 3e-3}
    doubled = Grasp([{**side, "point": [-0.02, 0, 0], "outward": [1, 0, 0]}, *[{**side, "point": [0.02, 0, 0]}] * 2])
    dear = doubled.least_grip(load, cost=[1.0, 1.0, 20.0])
    assert [force[0] for force in dear] == pytest.approx([4.0, 4.0, 0.0], abs=1e-3)
    grasp, weight = three(), [0, 0, -2.94, 0, 0, 0]
    for wrong, says in [
        ({"least": [1.0]}, "`least` has 1 entries, for 3 fingers"),
        ({"greatest": [1.0, -2.0, 1.0]}, "finger 1: the greatest normal force"),
        ({"cost": [1.0, 1.0, 0.0]}, "finger 2: the cost"),
        ({"joints": [(hinge, [1.0])]}, "`joints` has 1 entries"),
        ({"joints": [(hinge, [1.0, 2.0]), None, None]}, "a column for each torque, 6 at most, not 6 × 1 for 2"),
        ({"joints": [None, (hinge, [-1.0]), None]}, "finger 1: the greatest torque of a joint"),
        ({"joints": [None, None, (hinge * np.nan, [1.0])]}, "finger 2: the Jacobian"),
    ]:
        with pytest.raises(fingertip.HandError, match=says):
            grasp.least_grip(weight, **wrong)


def test_a_controller_keeps_to_joints_that_turn():
    hand, twin = fingertip.HandController(safety=1.0, rise=1e4), None
    fingers = [
        {"point": [x, 0, 0], "outward": [-x, 0, 0], "friction": 0.5, "arm": 3e-3, "normal": 4.0, "tangential": [0, 0, -1.0]}
        for x in (-0.02, 0.02)
    ]
    drive = np.array([[1.0, 0, 0, 0, 0, 0]]).T
    assert hand.command(fingers, 1e-3)[:2] == (pytest.approx([2.0, 2.0], rel=1e-4), True)
    hand.set_limits(joints=[(drive, [1.5]), (drive, [1.5])])
    normal, holds, _ = hand.command(fingers, 1e-3)
    assert holds is False and normal == pytest.approx([2.0, 2.0], rel=1e-4)
    # A pickle has the limits that were set last.
    twin = pickle.loads(pickle.dumps(hand))
    assert twin.command(fingers, 1e-3)[1] is False
    hand.set_limits(joints=[(drive, [2.5])] * 2)
    assert hand.command(fingers, 1e-3)[1] is True


def test_what_holds_without_safety_is_commanded_and_said():
    hand = fingertip.HandController(safety=1.3, rise=1e4, greatest=2.3)
    assert hand.state is None

    def command(weight):
        fingers = [
            {"point": [x, 0, 0], "outward": [-x, 0, 0], "friction": 0.5, "arm": 3e-3, "normal": 4.0, "tangential": [0, 0, -1.0]}
            for x in (-0.02, 0.02)
        ]
        normal, holds, _ = hand.command(fingers, 1e-3, load=[0, 0, -weight, 0, 0, 0])
        return pytest.approx(normal, rel=1e-4), holds, hand.state

    assert command(1.5) == ([1.95, 1.95], True, "holding")
    # 2.6 N with safety, of 2.3 N that there are, and 2 N without.
    assert command(2.0) == ([2.3, 2.3], True, "without_safety")
    assert command(2.5) == ([2.3, 2.3], False, "cannot_hold")
    assert command(np.nan)[1:] == (None, "blind")
    assert hand.command(["unexplained", None], 1e-3)[1] is None and hand.state == "blind"
    assert copy.copy(hand).state == "blind" and pickle.loads(pickle.dumps(hand)).state is None


def test_the_quality_of_a_grasp_is_told():
    grasp = three()
    assert grasp.force_closure is True and grasp.rank == 6 and not grasp.freedoms() and len(grasp) == 3
    certified, found, weakest = grasp.ball(0.04)
    assert 0 < certified <= found and weakest.shape == (6,)
    times = grasp.reach([0, 0, -1.0, 0, 0, 0], [0, 0, -1.0, 0, 0, 0], greatest=10.0)
    assert times > 1 and grasp.reach([0, 0, -1.0, 0, 0, 0], [0, 0, -1.0, 0, 0, 0]) == np.inf
    one = Grasp([{"point": [0, 0, 0.01], "outward": [0, 0, 1], "friction": 0.5}])
    assert one.force_closure is False and one.rank == 3 and len(one.freedoms()) == 3
    assert pickle.loads(pickle.dumps(grasp)).least_grip([0, 0, -1.0, 0, 0, 0])
    with pytest.raises(fingertip.HandError, match="needs `friction`"):
        Grasp([{"point": [0, 0, 0], "outward": [0, 0, 1]}])
    with pytest.raises(fingertip.HandError, match="at most 5"):
        Grasp([{"point": [0, 0, 0], "outward": [0, 0, 1], "friction": 0.5}] * 6)


def test_a_controller_presses_as_firmly_as_it_must():
    outward = [np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in (0.0, 2.1, 4.2)]
    hand, normal = fingertip.HandController(greatest=15.0), [0.3] * 3
    weight = np.array([0.0, 0.0, -2.94, 0.0, 0.0, 0.0])
    for step in range(300):
        # Lifting takes the weight over in 0.1 s.
        load = weight * min(step / 100, 1)
        fingers = [
            {"point": 0.04 * o, "outward": -o, "friction": 0.6, "arm": 2e-3, "normal": n, "tangential": load[:3] / 3,
             "slip": SlipVerdict.SLIPPING if (step, i) == (250, 1) else SlipVerdict.HOLDING}
            for i, (o, n) in enumerate(zip(outward, normal, strict=True))
        ]  # fmt: skip
        # What is known of the load, and what the fingers feel, are one.
        normal, holds, implausible = hand.command(fingers, 1e-3, load=load if step % 2 else None)
        if step == 249:
            before = normal
    assert holds is True and not any(implausible)
    least = [n for n, _, _ in three().least_grip(weight)]
    assert np.allclose(before, np.array(least) * 1.3, rtol=0.3) and sum(normal) > sum(before)


def test_a_controller_learns_the_friction_of_its_fingers():
    def finger(side, ratio, slip):
        inward = np.array([-side, 0.0, 0.0])
        return {"point": -0.02 * inward, "outward": inward, "friction": 0.9, "arm": 2e-3, "normal": 2.0,
                "tangential": [0.0, 0.0, -2.0 * ratio], "slip": slip}  # fmt: skip

    trusting, learning = (
        fingertip.HandController(safety=1.0, rise=1e4, greatest=20.0, friction_noise=noise) for noise in (None, 0.01)
    )
    for hand in (trusting, learning):
        for step in range(100):
            ratio = 0.004 * step
            hand.command([finger(side, ratio, SlipVerdict.HOLDING) for side in (-1, 1)], 1e-3)
        normal, holds, _ = hand.command([finger(side, 0.4, SlipVerdict.SLIPPING) for side in (-1, 1)], 1e-3)
        assert holds
        # 0.8 N on each: by a coefficient of 0.8 · 0.9, or by what a slip at 0.4 has taught.
        expected = (0.8 / 0.72) if hand is trusting else 0.8 / 0.355
        assert normal[0] == pytest.approx(expected, rel=0.05)
    assert trusting.friction == [None] * 5
    (coefficient, deviation), *_ = learning.friction
    assert coefficient == pytest.approx(0.4, rel=0.05) and 0.0 < deviation < 0.05
    learning.forget_friction()
    assert learning.friction == [None] * 5
    with pytest.raises(fingertip.HandError, match="number of a verdict, 0 to 3, not 4"):
        trusting.command([finger(side, 0.1, 4) for side in (-1, 1)], 1e-3)
    with pytest.raises(fingertip.HandError, match="probability of less friction"):
        fingertip.HandController(friction_noise=0.01, friction_probability=0.7)


def test_a_finger_that_reads_what_cannot_be_drives_no_other():
    scene = fingertip.Scene.from_dict(
        {"surface": {"shape": "sphere", "radius_m": 0.01}, "contact": {"model": "soft_finger", "least_force_N": 0.05}}
    )
    angles = (0.0, 2.1, 4.2)
    # The third axis of each sensor points at the middle of the object.
    turns = [np.array([[np.sin(a), 0, -np.cos(a)], [-np.cos(a), 0, -np.sin(a)], [0, 1, 0]]) for a in angles]
    origins = [-0.05 * turn[:, 2] for turn in turns]
    hand = fingertip.HandController(greatest=15.0)
    tips = [fingertip.Fingertip(scene) for _ in turns]

    def felt(turn, tip, normal):
        force = np.array([0.0, -1.0, -normal])
        touch = tip.sense_wrench([*force, *np.cross([0, 0, 0.01], force)], 1e-3)
        return touch.finger(turn, -0.05 * turn[:, 2], 0.6, 2e-3)

    for _ in range(100):
        fingers = [felt(turn, tip, 3.0) for turn, tip in zip(turns, tips, strict=True)]
        normal, holds, implausible = hand.command(fingers, 1e-3)
    assert holds and not any(implausible) and all(1.0 < n < 5.0 for n in normal)
    for finger, turn, origin in zip(fingers, turns, origins, strict=True):
        assert np.allclose(finger["point"], origin + 0.01 * turn[:, 2]) and np.allclose(finger["outward"], turn[:, 2])
        assert np.isclose(finger["normal"], 3.0) and np.allclose(finger["tangential"], [0, 0, -1.0])
    wrong = tips[2].sense_wrench([0, 0, 15.0, 0.3, 0, 0], 1e-3).finger(turns[2], origins[2], 0.6, 2e-3)
    assert wrong == "unexplained"
    assert tips[2].sense_wrench([0] * 6, 1e-3).finger(turns[2], origins[2], 0.6) is None
    for bad in (wrong, {**fingers[2], "normal": 0.1, "tangential": [0, 0, -15.0]}):
        for _ in range(50):
            assert hand.command([*fingers[:2], bad], 1e-3) == (normal, None, [False, False, True])
    # Where what two of them bear is known otherwise, they hold it without the third.
    forces = [f["tangential"] - f["normal"] * f["outward"] for f in fingers[:2]]
    borne = np.sum([[*f, *np.cross(g["point"], f)] for f, g in zip(forces, fingers, strict=False)], axis=0)
    assert hand.command([*fingers[:2], wrong], 1e-3, load=borne)[1:] == (True, [False, False, True])
    with pytest.raises(fingertip.HandError, match="unexplained"):
        hand.command(["odd"], 1e-3)


def test_an_object_is_weighed():
    mass, centre = 0.3, np.array([0.005, 0.0, -0.02])
    weight, random = fingertip.ObjectWeight(), np.random.default_rng(6)
    noise = np.diag([4e-4] * 3 + [4e-8] * 3)
    for tilt in np.linspace(0, 1.0, 200):
        gravity = 9.81 * np.array([-np.sin(tilt), 0.3 * np.sin(3 * tilt), -np.cos(tilt)])
        force = mass * gravity
        load = np.hstack([force, np.cross(centre, force)]) + random.normal(size=6) * np.sqrt(np.diag(noise))
        weight.observe(load, noise, gravity)
    found, deviation, middle, covariance = weight.estimate()
    assert abs(found - mass) < 5 * deviation < 0.01
    assert (middle - centre) @ np.linalg.solve(covariance, middle - centre) < 25
    gravity = np.array([0, 0, -9.81])
    load = np.hstack([mass * gravity, np.cross(centre, mass * gravity)])
    assert weight.touches_elsewhere(load, noise, gravity) is False
    assert weight.touches_elsewhere(load + [0, 0, 1.0, 0, 0, 0], noise, gravity) is True
    # A push of another at a place: the line passes it, and its pitch is none; a twist makes a pitch.
    place, push = np.array([0.03, -0.01, 0.02]), np.array([0.4, 1.0, -0.3])
    other = weight.elsewhere(load + np.hstack([push, np.cross(place, push)]), noise, gravity)
    assert np.allclose(other["wrench"][:3], push, atol=0.05) and other["statistic"] > 100
    line, unit = other["line"], push / np.linalg.norm(push)
    assert np.allclose(line["direction"], unit, atol=0.05) and abs(line["point"] @ line["direction"]) < 1e-12
    assert np.linalg.norm(np.cross(place - line["point"], line["direction"])) < 1e-3 and abs(line["pitch"]) < 1e-3
    twisted = weight.elsewhere(load + np.hstack([push, np.cross(place, push) + 0.01 * push]), noise, gravity)
    assert twisted["line"]["pitch"] == pytest.approx(0.01, abs=1e-3)
    assert np.all(np.linalg.eigvalsh(other["covariance"]) > 4e-8 * 0.99)
    assert fingertip.ObjectWeight().elsewhere(load, noise, gravity) is None


def test_channels_are_watched():
    watch = fingertip.ChannelMonitor([0.0] * 3, [5.0] * 3)
    random = np.random.default_rng(7)
    for _ in range(2000):
        assert watch.update([2.5 + random.normal(0, 0.1), 1.2 + random.normal(0, 0.05), 2.0]) is not None
    # The noise is a low quantile of that of blocks, since what moves only adds to it.
    assert watch.noise[0] == pytest.approx(0.1, rel=0.2) and watch.noise[1] == pytest.approx(0.05, rel=0.2)
    for _ in range(500):
        faults = watch.update([2.5 + random.normal(0, 0.1), 1.234, 5.0])
    assert faults == [None, fingertip.ChannelFault.STUCK, "saturated_high"]
    assert watch.update([np.nan, 1.0, 2.0])[0] == "not_finite"
    with pytest.raises(fingertip.FingertipError, match="3 numbers, not 2"):
        watch.update([1.0, 2.0])
    with pytest.raises(fingertip.FingertipError, match="as many"):
        fingertip.ChannelMonitor([0.0], [1.0, 2.0])


def test_conditioning_and_worst_errors_are_those_of_numpy():
    random = np.random.default_rng(8)
    nominal = np.array([10, 10, 10, 0.1, 0.1, 0.1])
    for gauges in (6, 8):
        matrix = np.vstack([np.eye(6)] * 2)[:gauges] + 0.2 * random.standard_normal((gauges, 6))
        singular, number, worst = fingertip.conditioning(matrix, nominal)
        assert np.allclose(singular, np.linalg.svd(matrix)[1]) and number == pytest.approx(np.linalg.cond(matrix))
        assert worst is None or worst.shape == (6,)
        signals = matrix @ random.uniform(-1, 1, 6)
        bound = fingertip.worst_errors(matrix, nominal, signals, 1e-3)
        inverse = np.linalg.pinv(matrix) * nominal[:, None]
        assert np.allclose(bound, np.abs(inverse).sum(axis=1) * 1e-3, rtol=1e-6)
    with pytest.raises(fingertip.FingertipError, match="6 to 10 or 12 gauges"):
        fingertip.conditioning(np.eye(5), nominal)


def test_rolling_over_a_ball_tells_its_radius():
    # A sphere rolls over a fixed ball of twice its radius: the contact moves over the finger at ω r R/(r + R).
    radius, other = RADIUS, 2 * RADIUS
    model, rolling = ContactModel(BALL), fingertip.RollingCurvature(radius)
    sections = {
        "surface": {"shape": "sphere", "radius_m": radius},
        "contact": {"least_force_N": 0.05},
        "uncertainty": {"force_noise_N": 1e-4, "torque_noise_Nm": 1e-7},
        "tracking": {"speed_m_per_s": 0.005, "turns_within_s": 0.1},
    }
    tip = fingertip.Fingertip(fingertip.Scene.from_dict(sections))
    noise = np.diag([1e-8] * 3 + [1e-14] * 3)
    with pytest.raises(fingertip.FingertipError, match="has not rolled in two directions"):
        rolling.find()
    # Directions in the sensor frame, in which the fingertip rests and the ball rolls around it.
    normal, step, found = np.array([0.0, 0.0, 1.0]), 1e-3, None
    for sample in range(400):
        axis = np.array([0.0, 1.0, 0.0]) if sample < 200 else np.array([1.0, 0.0, 0.0])
        turning = 0.5 * (axis - normal * (axis @ normal))
        # While the finger turns by ω, the contact's normal moves against the turning, by the object's share of curvature.
        way = np.cross(normal, turning) * radius * other / (radius + other)
        normal = normal + way * step / radius
        normal /= np.linalg.norm(normal)
        point, force = radius * normal, -2.0 * normal
        wrench = np.hstack([force, np.cross(point, force)])
        contact = model.resolve(wrench)
        tracked = tip.sense(wrench, step).tracked
        # The finger turns about the contact, where its velocity is none.
        linear = -np.cross(turning, point)
        rolling.roll(
            tracked, contact, model.jacobian(contact, wrench), noise, linear, turning, np.eye(2) / radius, step
        )
    found, covariance, tangents = rolling.find()
    assert np.allclose(found, np.eye(2) / other, atol=0.1 / other), found * other
    assert (np.diag(covariance) > 0).all() and abs(tangents[0] @ tangents[1]) < 1e-9


def test_a_ball_is_found_by_its_touches(tmp_path):
    random = np.random.default_rng(7)
    model, surface = ContactModel(BALL), fingertip.Surface("sphere", radius_m=RADIUS)
    noise = np.diag([1e-4] * 3 + [1e-8] * 3)
    centre, radius, off = np.array([0.2, -0.1, 0.4]), 0.03, (1e-4, 1e-3)
    parts = []
    for _ in range(60):
        out = random.normal(size=3)
        out /= np.linalg.norm(out)
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.linalg.det(turn)
        # Where the sensor is, and where its pose is said to be.
        origin = centre + (radius + RADIUS) * out
        force = turn.T @ out
        wrench = np.hstack([force, np.cross(-RADIUS * force, force)])
        wrench += np.hstack([random.normal(size=3) * 1e-2, random.normal(size=3) * 1e-4])
        contact = model.resolve(wrench)
        covariance = model.jacobian(contact, wrench).covariance(noise).point
        bend = surface.shape_operator(contact.point)
        said = origin + random.normal(size=3) * off[0]
        lean = random.normal(size=3) * off[1]
        skew = np.array([[0, -lean[2], lean[1]], [lean[2], 0, -lean[0]], [-lean[1], lean[0], 0]])
        told, _ = np.linalg.qr(turn + skew @ turn)
        told *= np.sign(np.sum(told * turn, axis=0))
        parts.append((told, said, contact.point, contact.normal, covariance, bend))
    touches = fingertip.ObjectTouches.of_contacts(*(np.array(part) for part in zip(*parts, strict=True)))
    fit = fingertip.fit_object("sphere", touches, pose_noise=off)
    assert abs(fit.radius - radius) < 2 * fit.half_widths[0] < 1e-4
    assert (np.abs(fit.point - centre) < 2 * fit.half_widths[1:]).all()
    assert not fit.concave and fit.direction is None and 0.7 < fit.noise_scale < 1.3
    # A probability of one deviation is about 68 %.
    narrow = fingertip.fit_object("sphere", touches, pose_noise=off, probability=0.6827)
    assert np.allclose(narrow.half_widths, fit.deviations, rtol=0.01)
    touches.save(tmp_path / "ball.ply")
    text = (tmp_path / "ball.ply").read_text()
    rows = np.array([line.split() for line in text.split("end_header\n")[1].splitlines()], dtype=float)
    assert np.allclose(rows[:, :3], touches.points, atol=1e-8) and np.allclose(rows[:, 3:6], touches.normals, atol=1e-8)
    assert [path.name for path in tmp_path.iterdir()] == ["ball.ply"]
    for wrong, said in [({"probability": 1.0}, "probability"), ({"pose_noise": (0.0, 1e-3)}, "above zero")]:
        with pytest.raises(fingertip.FingertipError, match=said):
            fingertip.fit_object("sphere", touches, **wrong)
    with pytest.raises(fingertip.FingertipError, match="not known"):
        fingertip.fit_object("cone", touches)
    with pytest.raises(ValueError, match="covariances"):
        fingertip.ObjectTouches(touches.points, touches.normals, np.eye(2), np.eye(3))
    few = fingertip.ObjectTouches(np.eye(3)[:1], np.eye(3)[:1], np.eye(3), np.eye(3))
    with pytest.raises(fingertip.FingertipError, match="too few"):
        fingertip.fit_object("sphere", few)


def test_all_that_watches_is_copied_and_pickled():
    force = [0.3, 0.0, 0.0]
    made = [
        (fingertip.BristleFriction("lugre", stiffness=1e4, kinetic=0.4, breakaway=0.6), lambda one: one.set_load(1.0) or one.step([0.01, 0], 1e-3)),
        (fingertip.ChannelMonitor([0.0, 0.0], [5.0, 5.0]), lambda one: one.update([2.5, 5.0])),
        (fingertip.ContactEvents(0.01, 0.06), lambda one: one.observe([0, 0, -0.3], 1e-3).touching),
        (fingertip.IncipientSlip(0.005, 2e-5, 0.5), lambda one: one.update(2.0, force, [1e-6, 0, 0])),
        (fingertip.HandController(safety=1.5, greatest=10.0), lambda one: one.command([None], 1e-3, load=[0, 0, -1.0, 0, 0, 0])),
    ]
    for watch, ask in made:
        fresh, twin = pickle.loads(pickle.dumps(watch)), copy.copy(watch)
        first = ask(watch)
        for other in (fresh, twin, copy.deepcopy(twin)):
            assert str(ask(other)) == str(first) or isinstance(other, type(twin))
        # What it saw stays with a copy, and not with a pickle.
        again, same = copy.deepcopy(watch), pickle.loads(pickle.dumps(watch))
        assert str(ask(again)) == str(ask(watch)) and str(ask(same)) == str(first)
    judge = fingertip.MotionJudge(0.01, 1e-3, 1e-2)
    assert pickle.loads(pickle.dumps(judge)) == judge == copy.deepcopy(judge)


def test_what_was_learnt_stays_with_copies_and_pickles():
    weight, meeting = fingertip.ObjectWeight(), fingertip.LineMeeting()
    noise = np.diag([1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8])
    point = np.array([0.002, -0.001, 0.012])
    random = np.random.default_rng(6)
    for _ in range(20):
        gravity = random.normal(size=3)
        gravity *= 9.81 / np.linalg.norm(gravity)
        weight.observe([*(0.2 * gravity), *np.cross([0.01, 0, 0.02], 0.2 * gravity)], noise, gravity)
        force = random.normal(size=3)
        meeting.add([*force, *np.cross(point, force)], noise)
    for kept in (pickle.loads(pickle.dumps(weight)), copy.copy(weight), copy.deepcopy(weight)):
        assert str(kept.estimate()) == str(weight.estimate()) and kept.estimate()[0] == pytest.approx(0.2)
    for kept in (pickle.loads(pickle.dumps(meeting)), copy.copy(meeting)):
        assert len(kept) == 20 and np.allclose(kept.find()[0], point, atol=1e-5)
    rolling = pickle.loads(pickle.dumps(fingertip.RollingCurvature(0.01)))
    with pytest.raises(fingertip.FingertipError):
        rolling.find()


def test_how_sure_a_contact_is_pickles():
    model = fingertip.ContactModel(fingertip.Surface("sphere", radius_m=0.013), "soft_finger")
    push = [0.1, 0.05, -1.0, 1e-4, 2e-4, 1e-4]
    jacobian = model.jacobian(model.resolve(push), push)
    covariance = jacobian.covariance(np.eye(6) * 1e-4)
    for thing in (jacobian, covariance):
        assert pickle.loads(pickle.dumps(thing)) == thing == copy.deepcopy(thing)
    assert np.array_equal(pickle.loads(pickle.dumps(jacobian)).local, jacobian.local)
