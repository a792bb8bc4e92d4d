"""What the tests of the bridges share: a recording whose contacts are known, and `fingertip live` that plays it.

`FINGERTIP` names the command, built with `--features web,foxglove,ros2`. With `FINGERTIP_QUIET` the machine does nothing else and
the command is optimised: then times are held to the limits that are given, and printed only without.
"""

import math
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

FINGERTIP = os.environ.get("FINGERTIP", "target/debug/fingertip")
QUIET = bool(os.environ.get("FINGERTIP_QUIET"))
RADIUS = 0.013
COEFFICIENT = 0.5
SCENE = f"""version = 2
[input]
convention = "on_fingertip"
[surface]
shape = "sphere"
radius_m = {RADIUS}
[contact]
least_force_N = 0.1
[friction]
static_coefficient = {COEFFICIENT}
[slip]
detector = "drop"
noise_N = 0.01
"""


class Row:
    """A sample, as it was made: a contact on the sphere, pressed with known forces."""

    def __init__(self, number):
        self.time = number / 1000
        polar, azimuth = 0.3 + 0.2 * math.sin(number * 1e-3), 1e-3 * number
        normal = [math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth), math.cos(polar)]
        across = [-math.sin(azimuth), math.cos(azimuth), 0.0]
        self.normal, self.point = normal, [RADIUS * n for n in normal]
        self.normal_force, self.tangential_force = 2 + math.sin(number * 0.01), 0.3 + 1e-4 * (number % 1000)
        force = [-self.normal_force * n + self.tangential_force * a for n, a in zip(normal, across)]
        (x, y, z), (fx, fy, fz) = self.point, force
        self.wrench = force + [y * fz - z * fy, z * fx - x * fz, x * fy - y * fx]
        self.utilisation = self.tangential_force / (COEFFICIENT * self.normal_force)


@pytest.fixture(scope="session")
def rows():
    return [Row(number) for number in range(40_000)]


@pytest.fixture(scope="session")
def folder(tmp_path_factory, rows):
    """A folder with `touch.csv` and `scene.toml`."""
    folder = tmp_path_factory.mktemp("live")
    lines = [",".join([repr(row.time), *map(repr, row.wrench)]) for row in rows]
    (folder / "touch.csv").write_text("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n" + "\n".join(lines) + "\n")
    (folder / "scene.toml").write_text(SCENE)
    return folder


class Live:
    """A running `fingertip live`."""

    def __init__(self, arguments, environment=None):
        self.process = subprocess.Popen(
            [FINGERTIP, "live", *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, **(environment or {})},
        )
        self.said = []

    def line(self, pattern):
        """The first group of the line that matches; waits for it."""
        while True:
            line = self.process.stdout.readline()
            assert line, f"ended before it said {pattern}: {self.said} {self.process.stderr.read()}"
            self.said.append(line)
            if found := re.search(pattern, line):
                return found.group(1)

    def memory(self):
        """Resident memory in kB."""
        text = open(f"/proc/{self.process.pid}/status").read()
        return int(re.search(r"VmRSS:\s+(\d+)", text).group(1))

    def kill(self):
        self.process.kill()
        self.process.communicate()

    def end(self):
        """Ends it as Ctrl-C does; what it said on the standard error."""
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=20)
        assert self.process.returncode == 0, errors
        return errors


@pytest.fixture
def live():
    running = []

    def start(*arguments, **options):
        running.append(Live(arguments, **options))
        return running[-1]

    yield start
    for one in running:
        if one.process.poll() is None:
            one.kill()


def check_consecutive(numbers, count):
    assert len(numbers) >= count
    gaps = [(one, other) for one, other in zip(numbers, numbers[1:]) if other != one + 1]
    assert not gaps, gaps[:5]


def close(one, other, tolerance):
    return all(abs(a - b) <= tolerance for a, b in zip(one, other, strict=True))


TIMER = """
import signal, sys, time
steps, begun, last, ends = [], time.time(), time.time(), []
signal.signal(signal.SIGTERM, lambda *_: ends.append(1))
while not ends:
    time.sleep(max(0, begun + 1e-3 * (len(steps) + 1) - time.time()))
    steps.append(abs(time.time() - last - 1e-3))
    last = time.time()
print(sorted(steps)[int(0.99 * len(steps))])
"""


@contextmanager
def timer():
    """A process that does nothing but wake at 1 kHz: what 99 of 100 of its steps keep [s], which is the machine's own share."""
    process = subprocess.Popen([sys.executable, "-c", TIMER], stdout=subprocess.PIPE, text=True)
    share = []
    try:
        yield share
    finally:
        process.terminate()
        share.append(float(process.communicate(timeout=20)[0]))


def said(name, seconds, median=None, most=None):
    """Prints quantiles of times; a quiet machine is held to a median and to what 99 of 100 keep [ms]."""
    ordered = sorted(seconds)
    part = lambda share: 1e3 * ordered[min(len(ordered) - 1, int(share * len(ordered)))]
    print(f"\n{name}: median {part(0.5):.3f} ms, 99 % {part(0.99):.3f} ms, most {part(1):.3f} ms")
    if QUIET:
        assert median is None or part(0.5) < median, (name, part(0.5))
        assert most is None or part(0.99) < most, (name, part(0.99))


def now():
    return time.time()
