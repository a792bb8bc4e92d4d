"""Recordings, by the same pass as the command."""

import csv
import pickle
import re
import subprocess
import sys
from pathlib import Path

import fingertip
import numpy as np
import pytest
from conftest import SECTIONS
from fingertip import Scene

COMMAND = [sys.executable, "-m", "fingertip._command"]
NAMES = ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"]


def write(path, time, wrenches, names=NAMES):
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["t_s", *names])
        out.writerows([repr(float(cell)) for cell in row] for row in np.column_stack([time, wrenches]))


@pytest.fixture
def recorded(tmp_path):
    seen = fingertip.simulate()
    random = np.random.default_rng(7)
    path = tmp_path / "touch.csv"
    noisy = seen.wrench + random.normal(0, 1, seen.wrench.shape) * np.array([0.01] * 3 + [1e-4] * 3)
    write(path, seen.time, noisy)
    sections = {
        "input": {"convention": "on_fingertip", "rest_s": 0.8},
        "surface": {
            "shape": "sphere",
            "centre_m": seen.centre.tolist(),
            "radius_m": seen.radius,
            "pole": [1.0, 0.0, 0.0],
        },
        "contact": {"least_force_N": 0.1, "model": "soft_finger"},
        "friction": {"static_coefficient": 0.4},
        "slip": {"detector": "drop", "noise_N": 0.01},
        "uncertainty": {"force_noise_N": 0.01, "torque_noise_Nm": 1e-4},
    }
    return path, Scene.from_dict(sections), seen, noisy


def test_rows_come_back_bit_for_bit(recorded):
    path, _, seen, noisy = recorded
    recording = fingertip.read_recording(path)
    assert np.array_equal(recording.time, seen.time) and np.array_equal(recording.wrench(), noisy)
    assert recording.usable.all() and not recording.gap.any() and len(recording) == len(seen)
    assert np.array_equal(pickle.loads(pickle.dumps(recording)).wrench(), noisy)


def test_units_gaps_and_faults_are_told(tmp_path):
    path = tmp_path / "two.csv"
    rows = ["t_ms,S1_Fx (mN),S1_Fy (mN),S1_Fz (mN),S1_Tx (Nmm),S1_Ty (Nmm),S1_Tz (Nmm)"]
    rows += [f"{t},1000,0,{t},500,0,0" for t in [0, 1, 2, 3, 100, 100, 50]] + ["101,,0,0,0,0,0"]
    path.write_text("\n".join(rows) + "\n")
    recording = fingertip.read_recording(path)
    assert list(recording.wrenches) == ["s1"]
    assert recording.wrench("s1")[0].tolist() == [1.0, 0.0, 0.0, 0.5, 0.0, 0.0]
    assert recording.gap.tolist()[4] and np.isnan(recording.wrench()[-1, 0])
    assert not recording.usable[5:7].any()
    assert recording.faults["gaps in time"][0] == recording.gap.sum() and recording.faults["empty cells"] == (1, [9])
    assert recording.time_step[1] == pytest.approx(1e-3) and recording.time_step[6] == 0
    with pytest.raises(fingertip.RecordingError, match="name one of the sensors"):
        recording.wrench("s2")
    bare = tmp_path / "bare.csv"
    bare.write_text("t_s,fx,fy,fz,tx,ty,tz\n0,1000,0,0,0,0,0\n")
    with pytest.raises(fingertip.RecordingError, match="unit"):
        fingertip.read_recording(bare)
    assert fingertip.read_recording(bare, force_unit="mN", torque_unit="Nmm").wrench()[0, 0] == 1.0


def test_an_analysis_is_that_of_the_command(recorded, tmp_path):
    path, scene, seen, _ = recorded
    found = fingertip.analyze(path, scene)
    file = tmp_path / "scene.toml"
    file.write_text(scene.to_toml())
    out, page = tmp_path / "contacts.csv", tmp_path / "report.html"
    run = subprocess.run(
        [*COMMAND, "analyze", str(path), "--scene", str(file), "--output", str(out), "--report", str(page)],
        capture_output=True,
        text=True,
        check=True,
    )
    with out.open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert [row["status"] for row in rows] == found.status.tolist()
    for name in ["fx_N", "tz_Nm", "x_m", "y_m", "z_m", "nx", "normal_N", "spin_Nm", "margin_N", "ellipse_a_m"]:
        said = np.array([float(row[name]) if row[name] else np.nan for row in rows])
        # The command writes eight significant digits, and single precision below 1e-7.
        np.testing.assert_allclose(said, found.columns[name], rtol=5.01e-8, atol=1e-14, err_msg=name)
    words = np.array(["not_pressing", "holding", "warning", "slipping"])
    assert [row["slip"] or "not_pressing" for row in rows] == words[found.slip].tolist()
    assert found.summary.splitlines()[1:4] == run.stdout.splitlines()[1:4]
    assert found.html.count("<svg") == page.read_text().count("<svg") > 3
    strong = np.linalg.norm(np.nan_to_num(seen.force), axis=1) > 5
    error = np.linalg.norm(found.point - seen.point, axis=1)[strong & found.contact]
    assert len(error) > 5000 and np.median(error) < 1e-4


def test_reports_are_written_whole(recorded, tmp_path):
    path, scene, _, _ = recorded
    found = fingertip.analyze(path, scene)
    page = tmp_path / "page.html"
    assert found.report_html(page) == page.read_text()
    assert [file.name for file in tmp_path.iterdir() if "part" in file.name] == []
    assert "iframe" in found._repr_html_()
    with pytest.raises(OSError):
        found.report_html(tmp_path / "none" / "page.html")


def test_mcap_is_read_as_csv_is(recorded, tmp_path):
    path, scene, _, noisy = recorded
    mcap = tmp_path / "touch.mcap"
    subprocess.run([*COMMAND, "convert", str(path), str(mcap)], check=True, capture_output=True)
    recording = fingertip.read_recording(mcap)
    assert np.array_equal(recording.wrench(), noisy)
    one, other = fingertip.analyze(mcap, scene), fingertip.analyze(path, scene)
    for name, column in one.columns.items():
        assert np.array_equal(column, other.columns[name], equal_nan=True), name


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "cannot read recording .*; check the path and its permissions"),
        ("", "empty|no header|no column"),
        ("a,b\n1,2\n", "no column is a force, a torque or a signal"),
        ("t_s,fx_N\n0,1\n", "the wrench lacks fy"),
        ("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n", "has a header but no rows"),
        ("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,1,x,0,0,0,0\n", "line 2"),
    ],
)
def test_what_is_no_recording_is_refused_in_the_sentence_of_the_command(tmp_path, scene, text, sentence):
    path = tmp_path / "bad.csv"
    if text is not None:
        path.write_text(text)
    with pytest.raises(fingertip.RecordingError, match=sentence) as raised:
        fingertip.analyze(path, scene)
    file = tmp_path / "scene.toml"
    file.write_text(scene.to_toml())
    command = [*COMMAND, "analyze", str(path), "--scene", str(file), "--output", "-", "--no-report"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.stderr.strip().splitlines()[-1] == f"error: {raised.value}"


def test_the_lines_of_the_readme_run(tmp_path):
    readme = (Path(__file__).parent.parent / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", readme, re.S)
    assert blocks and len(blocks[0].strip().splitlines()) <= 10
    seen = fingertip.simulate()
    write(tmp_path / "recording.csv", seen.time, seen.wrench)
    for block in blocks:
        run = subprocess.run([sys.executable, "-c", block], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr


def test_the_command_comes_with_the_package():
    command = Path(sys.executable).parent / "fingertip"
    told = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
    assert told.stdout.startswith("fingertip")
    wrong = subprocess.run([command, "dance"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2 and "dance" in wrong.stderr


def test_sections_of_the_scene_are_used(recorded):
    path, _, _, _ = recorded
    with pytest.raises(fingertip.RecordingError, match="rest"):
        long = {**SECTIONS, "input": {"convention": "on_fingertip", "rest_s": 1e4}}
        fingertip.analyze(path, Scene.from_dict(long))


def test_a_part_of_a_recording_is_that_part(recorded):
    path, scene, _, _ = recorded
    whole = fingertip.analyze(path, scene)
    time = whole.columns["t_s"]
    part = fingertip.analyze(path, scene, start=1.0, end=2.0)
    within = (time - time[0] >= 1.0) & (time - time[0] <= 2.0)
    assert np.array_equal(part.columns["t_s"], time[within])
    assert np.array_equal(part.columns["x_m"], whole.columns["x_m"][within], equal_nan=True)
    with pytest.raises(fingertip.RecordingError, match="--start 1000 must be before the end of the recording"):
        fingertip.analyze(path, scene, start=1000.0)
