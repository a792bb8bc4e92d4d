"""Many readings at once."""

import threading
import time

import fingertip
import numpy as np
import pytest
from conftest import RADIUS, SECTIONS
from fingertip import Fingertip, Scene, SlipVerdict, Touches
from hypothesis import given, settings
from hypothesis import strategies as st

SHAPES = [
    {"shape": "sphere", "radius_m": RADIUS},
    {"shape": "plane", "point_m": [0.0, 0.0, 0.01], "normal": [0.0, 0.0, 1.0]},
    {"shape": "capsule", "radius_m": 0.008, "half_length_m": 0.01},
    {"shape": "torus", "ring_radius_m": 0.007, "tube_radius_m": 0.004},
]


def one_by_one(scene, rows, steps, dtype=np.float64):
    tip, found = Fingertip(scene, dtype), Touches(len(rows), dtype)
    for row, (reading, step) in enumerate(zip(rows, steps, strict=True)):
        touch = tip.sense(reading, float(step))
        found.slip[row] = touch.slip if touch.slip is not None else 0
        if touch:
            found.point[row] = touch.point
            found.normal_force[row] = touch.normal_force
            found.tangential_force[row] = touch.tangential_force
            found.margin[row] = touch.margin if touch.margin is not None else 0
            found.utilisation[row] = touch.utilisation if touch.utilisation is not None else 0
    return found


def assert_same(one, other, tolerance):
    for a, b in zip(one._parts(), other._parts(), strict=True):
        assert np.allclose(a, b, rtol=tolerance, atol=tolerance), np.nanmax(np.abs(a - b))


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape["shape"])
@pytest.mark.parametrize("detector", ["threshold", "drop"])
def test_all_at_once_is_one_by_one(wrenches, shape, detector):
    slip = {"detector": detector, "noise_N": 0.01}
    scene = Scene.from_dict({**SECTIONS, "surface": shape, "slip": slip})
    wanted = one_by_one(scene, wrenches, np.full(len(wrenches), 1e-3))
    # A loop in vectors rounds as it likes, and does not mend what a flat angle makes of rounding.
    assert_same(Fingertip(scene).sense_all(wrenches, 1e-3), wanted, 1e-8)
    steps = np.random.default_rng(4).uniform(1e-4, 2e-3, len(wrenches))
    exactly = one_by_one(scene, wrenches, steps)
    assert Fingertip(scene).sense_all(wrenches, steps) == exactly


def test_layouts_and_types_of_columns_do_not_matter(scene, wrenches):
    wanted = Fingertip(scene).sense_all(np.asfortranarray(wrenches), 1e-3)
    wide = np.zeros((len(wrenches), 12))
    wide[:, ::2] = wrenches
    layouts = [
        wrenches,
        wide[:, ::2],
        wrenches[::-1][::-1],
        list(wrenches.T),
        tuple(np.ascontiguousarray(column) for column in wrenches.T),
        wrenches.astype(">f8"),
    ]
    for layout in layouts:
        assert_same(Fingertip(scene).sense_all(layout, 1e-3), wanted, 1e-13)
    single = Fingertip(scene, np.float32).sense_all(wrenches.astype(np.float32), 1e-3)
    assert single.dtype == np.float32
    good = wanted.contact & single.contact
    assert np.abs(single.point - wanted.point)[good].max() < 1e-6


def test_columns_in_one_piece_are_not_copied_and_out_is_written_where_it_lies(scene):
    rows = 1_000_000
    columns = np.zeros((6, rows))
    columns[2] = -1.0
    tip, out = Fingertip(scene), Touches.empty(rows)
    places = [column.__array_interface__["data"][0] for column in out.columns().values()]
    assert tip.sense_all(columns.T, 1e-3, out=out) is out
    assert [column.__array_interface__["data"][0] for column in out.columns().values()] == places
    assert out.contact.all() and (out.point == [0.0, 0.0, RADIUS]).all()
    # What is allocated meanwhile is nothing like the 48 MB of the columns.
    import tracemalloc

    tracemalloc.start()
    tip.sense_all(columns.T, 1e-3, out=out)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 100_000


def test_out_must_fit_and_must_not_be_what_is_read(scene):
    tip, rows = Fingertip(scene), np.zeros((5, 6))
    with pytest.raises(fingertip.FingertipError, match="room for 4 rows, and there are 5"):
        tip.sense_all(rows, 1e-3, out=Touches.empty(4))
    with pytest.raises(fingertip.FingertipError, match="same precision"):
        tip.sense_all(rows, 1e-3, out=Touches.empty(5, np.float32))
    out = Touches.empty(5)
    with pytest.raises(fingertip.FingertipError, match="borrow"):
        tip.sense_all([*out._point, *out._tangential_force], 1e-3, out=out)


@pytest.mark.parametrize(
    ("columns", "sentence"),
    [
        (np.zeros((3, 5)), "there must be 6 columns, not 5"),
        (np.zeros(6), "must have two dimensions, not shape"),
        ([np.zeros(3)] * 5 + [np.zeros(4)], "of one length"),
        ([np.zeros(3)] * 7, "there must be 6 columns, not 7"),
        (["push"] * 6, "must be numbers"),
    ],
)
def test_what_are_no_columns_is_refused_in_a_sentence(scene, columns, sentence):
    with pytest.raises(fingertip.FingertipError, match=sentence):
        Fingertip(scene).sense_all(columns, 1e-3)


def test_no_rows_are_no_touches(scene):
    assert len(Fingertip(scene).sense_all(np.zeros((0, 6)), 1e-3)) == 0


def test_a_zero_and_a_convention_are_applied_in_columns(wrenches):
    scene = Scene.from_dict({**SECTIONS, "input": {"convention": "reaction"}})
    rest = np.random.default_rng(5).normal(0, 0.001, (300, 6)) + 0.1
    tip = Fingertip(scene)
    tip.tare(rest)
    found = tip.sense_all(rest.mean(axis=0) - wrenches, 1e-3)
    plain = Fingertip(Scene.from_dict(SECTIONS)).sense_all(wrenches, 1e-3)
    assert np.allclose(found.normal_force, plain.normal_force, atol=1e-12)


def test_rows_that_begin_anew_forget(scene):
    sections = {**SECTIONS, "slip": {"detector": "drop", "noise_N": 0.01}}
    scene = Scene.from_dict(sections)
    x = np.concatenate([np.linspace(0, 1.0, 300), np.linspace(0.9, 0.5, 30)])
    rows = np.stack([x, 0 * x, 0 * x - 2, 0 * x, x * RADIUS, 0 * x], axis=1)
    anew = np.zeros(len(x), bool)
    anew[300] = True
    slips = Fingertip(scene).sense_all(rows, 1e-3).slip == SlipVerdict.SLIPPING
    forgotten = Fingertip(scene).sense_all(rows, 1e-3, anew=anew).slip == SlipVerdict.SLIPPING
    assert slips[300:303].any() and not forgotten[300:303].any()
    apart = Fingertip(scene).sense_all(rows[300:], 1e-3)
    assert np.array_equal(Fingertip(scene).sense_all(rows, 1e-3, anew=anew).slip[300:], apart.slip)


@given(st.lists(st.lists(st.floats(width=64), min_size=6, max_size=6), min_size=1, max_size=9), st.floats())
@settings(max_examples=200, deadline=None)
def test_no_columns_panic(rows, step):
    touches = Fingertip(Scene.from_dict(SECTIONS)).sense_all(np.array(rows), step)
    finite = np.isfinite(np.array(rows)).all(axis=1)
    assert not touches.contact[~finite].any()


def test_other_threads_run_meanwhile(scene):
    tip = Fingertip(Scene.from_dict({**SECTIONS, "slip": {"detector": "drop", "noise_N": 0.01}}))
    columns = np.zeros((6, 2_000_000))
    columns[2] = -1.0
    # A thread that counts gets on while a long call lasts.
    counted, end = [0], threading.Event()

    def count():
        while not end.is_set():
            counted[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=count)
    thread.start()
    while counted[0] < 3:
        time.sleep(1e-3)
    before = counted[0]
    tip.sense_all(columns.T, 1e-3)
    after = counted[0]
    end.set()
    thread.join()
    assert after - before > 20


def test_gauges_give_what_their_wrenches_give():
    seen = fingertip.simulate()
    tip = Fingertip(seen.scene())
    tip.tare(seen.gauges[seen.phase == 0])
    found = tip.sense_all(seen.gauges, 1e-3)
    strong = np.linalg.norm(np.nan_to_num(seen.force), axis=1) > 5
    error = np.linalg.norm(found.point - seen.point, axis=1)[strong & found.contact]
    assert (strong & found.contact).sum() > 5000 and np.median(error) < 1e-4
    tip.reset()
    again = [tip.sense(reading, 1e-3) for reading in seen.gauges[:50]]
    assert [bool(touch) for touch in again] == found.contact[:50].tolist()
    with pytest.raises(fingertip.ReadingError, match="incomplete"):
        tip.sense(np.zeros(5), 1e-3)
    bad = seen.gauges[2000:2003].copy()
    bad[1, 3] = np.nan
    assert tip.sense_all(bad, 1e-3).contact[1] == np.False_
