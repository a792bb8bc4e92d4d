"""Sensors: calibrated, simulated, designed."""

import pickle
import subprocess
import sys

import fingertip
import numpy as np
import pytest
from fingertip import Quality

NOMINAL = np.array([10, 10, 10, 0.1, 0.1, 0.1])


def known(samples=80, gauges=6, noise=1e-4, seed=1):
    random = np.random.default_rng(seed)
    loads = random.uniform(-1, 1, (samples, 6)) * NOMINAL
    matrix = np.vstack([np.eye(6)] * 2)[:gauges] + 0.1 * random.standard_normal((gauges, 6))
    zero = random.uniform(-1, 1, gauges)
    signals = loads / NOMINAL @ matrix.T + zero + noise * random.standard_normal((samples, gauges))
    return loads, signals, matrix, zero


@pytest.mark.parametrize("gauges", [6, 8])
@pytest.mark.parametrize("method", ["least_squares", "huber", "ransac"])
def test_a_known_sensor_is_found(gauges, method):
    loads, signals, matrix, zero = known(gauges=gauges)
    found = fingertip.calibrate(loads, signals, nominal=NOMINAL, method=method)
    assert found.verdict is Quality.GOOD and not found.reasons
    assert np.abs(found.matrix - matrix).max() < 2e-4 and np.abs(found.zero - zero).max() < 2e-4
    # The oracle: NumPy's own least squares.
    if method == "least_squares":
        design = np.column_stack([loads / NOMINAL, np.ones(len(loads))])
        theirs = np.linalg.lstsq(design, signals, rcond=None)[0]
        assert np.allclose(found.matrix, theirs[:6].T, atol=1e-12) and np.allclose(found.zero, theirs[6], atol=1e-12)
        assert found.condition_number == pytest.approx(np.linalg.cond(theirs[:6].T), rel=1e-9)
    assert np.abs(found.loads(signals) - loads).max() < 0.02


def test_a_report_is_a_dictionary_a_text_and_a_page(tmp_path):
    loads, signals, _, _ = known()
    found = fingertip.calibrate(loads, signals, names=[f"weight {i}" for i in range(len(loads))])
    report = found.report()
    assert report["verdict"] == "good" and len(report["axes"]) == 6 and report["details"][3]["name"] == "weight 3"
    assert found._repr_html_().startswith("<!") and "svg" in found.report_html("tip")
    assert "GOOD" in str(found) and "good" in repr(found)
    assert pickle.loads(pickle.dumps(found)) == found
    found.save(tmp_path / "tip.toml")
    assert (tmp_path / "tip.toml").read_text() == found.to_toml()


def test_a_calibration_is_saved_whole_or_not_at_all(tmp_path):
    loads, signals, _, _ = known()
    found = fingertip.calibrate(loads, signals)
    path = tmp_path / "tip.toml"
    path.write_text("of yesterday")
    path.chmod(0o640)
    # A process whose files may have 100 bytes at most stands for a full disk.
    program = (
        "import pickle, resource, sys\n"
        "found = pickle.loads(sys.stdin.buffer.read())\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
        "found.save(sys.argv[1])\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", program, path], input=pickle.dumps(found), capture_output=True, check=False
    )
    assert run.returncode == 1 and b"CalibrationError" in run.stderr and b"tip.toml" in run.stderr, run.stderr
    assert path.read_text() == "of yesterday" and [file.name for file in tmp_path.iterdir()] == ["tip.toml"]
    found.save(path)
    assert path.read_text() == found.to_toml() and path.stat().st_mode & 0o777 == 0o640


def test_a_bad_calibration_is_stamped_and_none_is_refused():
    loads, signals, _, _ = known(noise=0.1)
    found = fingertip.calibrate(loads, signals)
    assert found.verdict is Quality.BAD and found.reasons
    flat = loads.copy()
    flat[:, 3:] = 0
    with pytest.raises(fingertip.CalibrationError):
        fingertip.calibrate(flat, signals)
    for wrong, sentence in [
        ({"loads": loads[:, :4]}, "must have 6 columns"),
        ({"signals": signals[:-1]}, "entries|rows"),
        ({"unit": "bananas"}, "is not known; write V"),
        ({"method": "magic"}, "is not known; there are"),
        ({"loads": loads * np.nan}, "not a finite number"),
    ]:
        given = {"loads": loads, "signals": signals, **wrong}
        with pytest.raises(fingertip.CalibrationError, match=sentence):
            fingertip.calibrate(**given)


def test_a_sensor_that_bends_is_fitted_so_and_believed_where_it_was(tmp_path):
    loads, signals, matrix, zero = known(samples=300, noise=1e-4)
    # What the loads are in the bent signals: squares of a tenth of full scale.
    bent = signals - zero
    loads[:, 2] += 0.1 * NOMINAL[2] * bent[:, 0] ** 2
    loads[:, 4] -= 0.1 * NOMINAL[4] * bent[:, 3] * bent[:, 5]
    straight = fingertip.calibrate(loads, signals, nominal=NOMINAL)
    curved = fingertip.calibrate(loads, signals, nominal=NOMINAL, curvature="chosen")
    misses = [np.abs(found.loads(signals) - loads).max(axis=0) / NOMINAL for found in (straight, curved)]
    assert misses[1].max() < 0.01 and misses[0].max() > 0.03, misses
    report = curved.report()["curve"]
    assert report["taken"] and report["left_out_percent"] < 0.2 * report["straight_percent"], report
    # Through a scene: as the calibration itself, and no wrench far from where it was fitted.
    curved.save(tmp_path / "bends.toml")
    sections = {
        "version": 2,
        "input": {"convention": "on_fingertip"},
        "sensor": {"calibration": "bends.toml"},
        "surface": {"shape": "sphere", "radius_m": 0.01},
    }
    tip = fingertip.Fingertip(fingertip.Scene.from_dict(sections, folder=tmp_path))
    felt = tip.sense(signals[3], 1e-3)
    assert np.allclose(felt.wrench, curved.loads(signals[3:4])[0], rtol=1e-9, atol=1e-9)
    with pytest.raises(fingertip.ReadingError, match="beyond what the curved sensor"):
        tip.sense(signals[3] + 10, 1e-3)
    with pytest.raises(fingertip.CalibrationError, match="is not known"):
        fingertip.calibrate(loads, signals, curvature="magic")


def test_outliers_are_named_or_left_out():
    loads, signals, matrix, _ = known()
    signals[7] += 0.3
    kept = fingertip.calibrate(loads, signals, nominal=NOMINAL)
    assert [outlier["sample"] for outlier in kept.report()["outliers"]] == ["sample 8"]
    out = fingertip.calibrate(loads, signals, nominal=NOMINAL, reject_outliers=True)
    assert [one["sample"] for one in out.report()["excluded"]] == ["sample 8"]
    assert np.abs(out.matrix - matrix).max() < 2e-4


def test_a_simulation_is_what_its_script_says():
    script = [
        {"do": "rest", "duration": 0.2},
        {"do": "press", "at": {"from_top": 0.5, "azimuth": 1.0}, "force": 3.0, "duration": 0.2},
        {
            "do": "drag",
            "heading": 0.0,
            "static_coefficient": 0.5,
            "kinetic_coefficient": 0.4,
            "ramp": 0.3,
            "slide": 0.1,
        },
    ]
    seen = fingertip.simulate(script, sample_rate=500, seed=3)
    assert len(seen) == 400 and seen.time[1] == pytest.approx(0.002)
    pressed = seen.phase == 1
    assert np.linalg.norm(seen.force[pressed][-1]) == pytest.approx(3.0, rel=1e-3)
    direction = (seen.point[pressed][-1] - seen.centre) / seen.radius
    assert np.allclose(direction, [np.cos(0.5), np.sin(0.5) * np.cos(1), np.sin(0.5) * np.sin(1)])
    touched = pressed & np.isfinite(seen.point[:, 0])
    assert touched.sum() > 90
    assert np.allclose(np.cross(seen.point, seen.force)[touched], seen.wrench[touched, 3:], atol=1e-12)
    assert seen.slipping.any() and len(seen.slip_onsets) == 1
    again = fingertip.simulate(script, sample_rate=500, seed=3)
    assert np.array_equal(seen.raw, again.raw)
    assert not np.array_equal(seen.raw, fingertip.simulate(script, sample_rate=500, seed=4).raw)
    with pytest.raises(fingertip.SimulationError, match="the script is none"):
        fingertip.simulate([{"do": "dance"}])
    with pytest.raises(fingertip.SimulationError):
        fingertip.simulate(script, sample_rate=-1)


def test_a_design_is_a_sensor_and_its_files_are_read(tmp_path):
    found = fingertip.design(starts=6, force=20, torque=0.2)
    assert found.condition_number == pytest.approx(np.linalg.cond(found.matrix), rel=1e-6)
    assert 4e-3 <= found.radius <= 10e-3 and found.thickness > 0
    (tmp_path / "tip.toml").write_text(found.calibration_toml)
    scene = fingertip.Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.013}})
    tip = fingertip.Fingertip(scene.calibrated_by(tmp_path / "tip.toml"))
    load = np.array([2.0, -1.0, -5.0, 0.01, 0.02, -0.01])
    signals = found.matrix @ (load / [20, 20, 20, 0.2, 0.2, 0.2])
    assert np.allclose(tip.sense(signals, 1e-3).wrench, load, atol=1e-9)
    for wrong in ({"material": "cheese"}, {"criterion": "beauty"}, {"gauges": 7}, {"force": -1.0}):
        with pytest.raises(fingertip.DesignError):
            fingertip.design(starts=2, **wrong)


def test_creep_is_taken_off() -> None:
    """Load cycles of a sensor whose gauges go on by some hundredths within 20 s."""
    shares = np.array([0.03, 0.02, 0.025, 0.02, 0.01, 0.03])
    full = np.array([10, 10, 20, 0.2, 0.2, 0.1])
    state, rows = np.zeros(6), []
    for sample in range(600):
        cycle, phase = divmod(sample, 50)
        height = 1.0 if 10 <= phase < 35 else 0.0
        load = height * np.sin(7 * np.arange(6) + 3 * cycle * np.arange(1, 7))
        rows.append((load * full, load + shares * state))
        state += (load - state) * -np.expm1(-1 / 20)
    loads, signals = (np.array(column) for column in zip(*rows, strict=True))
    found = fingertip.calibrate(loads, signals, times=np.arange(600.0), creep=True)
    creep = found.report()["creep"]
    assert creep["with_percent"] < 0.1 * creep["without_percent"]
    # A step between two samples counts as a ramp, which takes up to some 1.5 s off the 20 s.
    assert 18 < creep["creep"]["times_s"][0] < 20
    with pytest.raises(fingertip.CalibrationError, match="t_s"):
        fingertip.calibrate(loads, signals, creep=True)
