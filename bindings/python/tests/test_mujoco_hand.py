"""The example of hands in MuJoCo: what it claims, in a few of its lifts."""

import dataclasses
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import skipped

try:
    import mujoco
except ImportError:  # pragma: no cover
    mujoco = None

EXAMPLE = Path(__file__).parents[1] / "examples" / "mujoco_hand"


@pytest.fixture
def lifts(monkeypatch):
    if mujoco is None:
        skipped("MuJoCo is not installed: the example of hands is not tested")
    monkeypatch.syspath_prepend(str(EXAMPLE))
    import lifts

    yield lifts
    for name in ("lifts", "grip", "oracle", "script", "world"):
        sys.modules.pop(name, None)


def lifted(lifts, seed, fingers, **changes):
    random = np.random.default_rng(seed)
    return lifts.play(dataclasses.replace(lifts.draw(random, fingers), **changes), random)


def test_three_fingers_learn_the_friction_lift_pour_turn_and_put_down(lifts):
    story = lifted(lifts, 1, 3)
    assert story.holdable and story.stands and not story.dropped
    assert 1.0 < story.grip < 1.5
    assert story.friction == pytest.approx(story.lift.friction, rel=0.12)
    assert story.mass == pytest.approx(story.lift.mass, rel=0.03)
    assert story.slid < 1e-3


def test_two_fingers_catch_what_becomes_slippery_in_the_air(lifts):
    story = lifted(lifts, 2, 2, wetted=0.7)
    assert story.holdable and story.stands and not story.dropped
    # Of 1.2 times the least as it was, 0.84 are left.
    assert 1.0 < story.grip < 1.5
    assert story.answered < 0.005 and story.slid < 2e-3


def test_without_slip_it_would_be_dropped(lifts, monkeypatch):
    import grip

    monkeypatch.setattr(grip.Grip, "_slip", lambda *_: None)
    story = lifted(lifts, 2, 2)
    assert story.holdable and story.dropped
