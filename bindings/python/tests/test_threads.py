"""Threads at once: with the interpreter's lock, and on free-threaded interpreters without it."""

import threading

import numpy as np
from conftest import SECTIONS

import fingertip
from fingertip import Fingertip, Scene

LOAD = np.array([0.5, 0.2, -2.0, 1e-3, 0.0, 0.0])


def in_threads(count, work):
    """What the threads give back; what one of them raises is raised here."""
    found = []
    start = threading.Barrier(count)

    def run():
        start.wait()
        try:
            found.append(work())
        except Exception as error:  # Told to the thread of the test.
            found.append(error)

    threads = [threading.Thread(target=run) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in found:
        if isinstance(result, Exception):
            raise result
    assert len(found) == count
    return found


def rows():
    random = np.random.default_rng(1)
    found = random.normal(0, 0.3, (20_000, 6))
    found[:, 2] -= 2
    found[:, 3:] *= 1e-2
    return found


def test_a_fingertip_for_each_thread():
    scene = Scene.from_dict(SECTIONS)

    def work():
        tip = Fingertip(scene)
        return [tip.sense(LOAD, 1e-3).normal_force for _ in range(2000)]

    alone = work()
    assert alone[0] > 0
    assert all(found == alone for found in in_threads(4, work))


def test_one_fingertip_is_for_one_thread_at_a_time():
    tip = Fingertip(Scene.from_dict(SECTIONS))
    force = tip.sense(LOAD, 1e-3).normal_force

    def work():
        answered = 0
        for _ in range(2000):
            try:
                assert tip.sense(LOAD, 1e-3).normal_force == force
            except RuntimeError as error:
                assert "borrowed" in str(error)
            else:
                answered += 1
        return answered

    assert sum(in_threads(4, work)) > 0
    # Whatever was in between, it goes on.
    assert tip.sense(LOAD, 1e-3).normal_force == force


def test_columns_in_threads():
    scene, given = Scene.from_dict(SECTIONS), rows()

    def work():
        return Fingertip(scene).sense_all(given, 1e-3).columns()

    alone = work()
    for found in in_threads(4, work):
        assert all(np.array_equal(found[name], alone[name], equal_nan=True) for name in alone)


def test_one_result_is_for_one_thread_at_a_time():
    scene, given = Scene.from_dict(SECTIONS), rows()
    out = fingertip.Touches(len(given))

    def work():
        told = []
        for _ in range(5):
            try:
                Fingertip(scene).sense_all(given, 1e-3, out=out)
            except fingertip.FingertipError as error:
                told.append(str(error))
        return told

    for told in in_threads(4, work):
        assert all("borrowed" in sentence for sentence in told)
    alone = Fingertip(scene).sense_all(given, 1e-3).columns()
    assert all(np.array_equal(out.columns()[name], alone[name], equal_nan=True) for name in alone)
