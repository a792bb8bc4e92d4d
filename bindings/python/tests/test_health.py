"""What a recording tells of the sensor itself."""

from __future__ import annotations

import json

import fingertip
import numpy as np
import pytest

HEADER = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm"


@pytest.fixture
def rest(tmp_path):
    random = np.random.default_rng(4)
    time = np.arange(8000) / 1000
    wrench = random.normal(0, [0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4], (8000, 6))
    wrench[:, 2] += 0.02 * np.sin(2 * np.pi * 50 * time)
    wrench[:, 4] = 1.25e-3
    path = tmp_path / "rest.csv"
    np.savetxt(path, np.column_stack([time, wrench]), delimiter=",", header=HEADER, comments="")
    return path


def test_it_is_what_the_command_finds(rest, tmp_path):
    found = fingertip.health(rest)
    written = tmp_path / "health.json"
    # The command says by its exit code that readings are wrong.
    from fingertip._native import run_command

    assert run_command(["fingertip", "health", str(rest), "--json", str(written)]) == 1
    figures = json.loads(written.read_text())
    assert json.loads(json.dumps(found.figures)) == figures
    assert found.verdict is fingertip.HealthLevel.BAD and found.findings[0].level is found.verdict
    kinds = {finding.what: finding for finding in found.findings}
    assert kinds["dead"].channels == ("ty_Nm",) and kinds["hum"].channels == ("fz_N",)
    assert found.channels["fx_N"]["noise"]["deviation"] == pytest.approx(0.01, rel=0.05)
    strongest = max(found.spectra["fz_N"].tolist(), key=lambda line: line[1])
    assert strongest[0] == pytest.approx(50, abs=0.5)
    assert found.courses["fz_N"].shape[1] == 4 and found.courses["fz_N"][-1, 0] == pytest.approx(8, abs=0.1)
    assert "dead" in str(found) or "never changes" in str(found)
    assert repr(found).startswith("<fingertip.Health: bad; bad: ")


def test_its_page_is_written_whole(rest, tmp_path):
    found = fingertip.health(rest)
    page = tmp_path / "health.html"
    assert found.report_html(page) == page.read_text(encoding="utf-8")
    assert "<svg" in page.read_text(encoding="utf-8") and "<iframe" in found._repr_html_()


def test_what_cannot_be_is_said_as_the_command_says_it(rest, tmp_path):
    with pytest.raises(fingertip.RecordingError, match=r"nothing\.csv"):
        fingertip.health(tmp_path / "nothing.csv")
    with pytest.raises(fingertip.RecordingError, match="--rate"):
        fingertip.health(rest, rate=-1.0)
    with pytest.raises(fingertip.RecordingError, match="no sensor|sensor"):
        fingertip.health(rest, sensor="left")
