"""What a call from Python costs over the Rust call, and beside the commercial package, in one run.

    python bindings/python/benchmarks/calls.py [--check]

``--check`` fails where a call costs more than 300 ns over the Rust call, where columns give less than 90 % of the Rust
batch, or where the commercial package answers sooner on the same plane.
"""

from __future__ import annotations

import sys
import timeit

import numpy as np

import fingertip
from fingertip import _native

PLANE = {
    "surface": {"shape": "plane", "point_m": [0.0, 0.0, 0.01], "normal": [0.0, 0.0, 1.0]},
    "contact": {"least_force_N": 0.05},
}
BALL = {
    "surface": {"shape": "sphere", "radius_m": 0.013},
    "contact": {"least_force_N": 0.05},
    "friction": {"static_coefficient": 0.6},
    "slip": {"detector": "threshold", "noise_N": 0.01},
}
# Short turns and many of them: the least is then of a moment in which the machine did nothing else.
CALLS, ROWS, REPEATS = 5_000, 50_000, 100
# A push at a point of the plane, without a torque of its own: what the commercial package takes for granted.
FORCE, POINT = np.array([0.5, 0.2, -2.0]), np.array([1e-3, -2e-3, 0.01])
LOAD = np.hstack([FORCE, np.cross(POINT, FORCE)])


def one(call, **names) -> float:
    """Least time of a call [ns]."""
    return min(timeit.repeat(call, number=CALLS, repeat=REPEATS, globals=names)) / CALLS * 1e9


def calls() -> list[tuple[str, float, float]]:
    told = []
    for name, sections in {"plane": PLANE, "sphere, friction, slip": BALL}.items():
        scene = fingertip.Scene.from_dict(sections)
        tip = fingertip.Fingertip(scene)
        rust = min(_native.time_sense(scene, LOAD, CALLS) for _ in range(REPEATS)) / CALLS * 1e9
        told.append((name, rust, one("tip.sense(load, 1e-3)", tip=tip, load=LOAD)))
    return told


def columns() -> tuple[float, float, float]:
    scene = fingertip.Scene.from_dict(BALL)
    random = np.random.default_rng(1)
    rows = np.empty((6, ROWS))
    rows[:2], rows[2] = random.normal(0, 0.3, (2, ROWS)), random.normal(-2, 0.4, ROWS)
    rows[3:] = random.normal(0, 2e-3, (3, ROWS))
    tip, out = fingertip.Fingertip(scene), fingertip.Touches(ROWS)
    tip.sense_all(rows.T, 1e-3, out=out)
    # In turns, so that what else the machine does strikes both alike.
    rust, ours, fresh = [], [], []
    for _ in range(REPEATS):
        rust.append(_native.time_all(scene, rows, 3) / 3)
        ours.append(timeit.timeit(lambda: tip.sense_all(rows.T, 1e-3, out=out), number=3) / 3)
        fresh.append(timeit.timeit(lambda: tip.sense_all(rows.T, 1e-3), number=1))
    return tuple(min(times) / ROWS * 1e9 for times in (rust, ours, fresh))


def commercial() -> tuple[float, float, float] | None:
    """The package's answer to the same load on the same plane, ours, and ours with the point as an array [ns]."""
    try:
        import bota_tactile_sensing_utils as bota
    except ImportError:
        return None
    geometry = bota.ContactGeometry(bota.ContactGeometryType.PLANE, 0.01)
    config = bota.BotaContactPointConfig()
    config.geometry, config.force_threshold = geometry, 0.05
    theirs, point = bota.BotaContactPoint(config), np.zeros(3)
    theirs.update(LOAD, point)
    tip = fingertip.Fingertip(fingertip.Scene.from_dict(PLANE))
    assert np.allclose(tip.sense(LOAD, 1e-3).point, point, atol=1e-12), (tip.sense(LOAD, 1e-3).point, point)
    return (
        one("theirs.update(load, point)", theirs=theirs, load=LOAD, point=point),
        one("tip.sense(load, 1e-3)", tip=tip, load=LOAD),
        one("tip.sense(load, 1e-3).point", tip=tip, load=LOAD),
    )


def main() -> int:
    failed = []
    for name, rust, python in calls():
        print(f"{name}: {rust:.0f} ns in Rust, {python:.0f} ns from Python, {python - rust:.0f} ns between")
        if python - rust > 300:
            failed.append(f"{name}: a call costs {python - rust:.0f} ns over the Rust call")
    rust, ours, fresh = columns()
    share = rust / ours
    print(
        f"columns: {rust:.2f} ns a row in Rust, {ours:.2f} ns into `out` ({share:.0%}), {fresh:.2f} ns into new memory"
    )
    if share < 0.9:
        failed.append(f"columns: {share:.0%} of the Rust batch")
    if (times := commercial()) is None:
        print("skipped: bota-tactile-sensing-utils is not installed", file=sys.stderr)
    else:
        theirs, ours, pointed = times
        print(
            f"plane: {theirs:.0f} ns by bota-tactile-sensing-utils, {ours:.0f} ns here, {pointed:.0f} ns with the point"
        )
        if ours > theirs:
            failed.append("plane: the commercial package answers sooner")
    for line in failed:
        print(f"missed: {line}", file=sys.stderr)
    return len(failed) if "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
