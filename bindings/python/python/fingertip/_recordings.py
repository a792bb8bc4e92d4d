"""Recordings, and what they show."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fingertip import _native
from fingertip._native import Scene
from fingertip._pages import Page

if TYPE_CHECKING:
    from fingertip._arrow import Table

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Recording:
    """The rows of a recording, as columns. `read_recording` makes it.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s]; NaN where the file has none.
    wrenches : dict of ndarray, shape (n, 6)
        By the name of the sensor, which is empty if the file gives none: (fx, fy, fz [N], tx, ty, tz [N·m]) as
        recorded, converted to SI units.
    signals : dict of ndarray, shape (n, gauges)
        By the name of the sensor: its gauges, and behind these the dummy gauge, if there is one.
    signal_units : dict of str
        By the name of the sensor: "V", "count" and so on.
    gap : ndarray of bool, shape (n,)
        Rows that came after a pause.
    usable : ndarray of bool, shape (n,)
        Rows that neither repeat another one nor go back in time.
    faults : dict
        By its name how often each fault was found, and in which lines first.
    quality : str
        The same as a sentence.
    notes : list of str
        What should be minded.
    """

    time: Numbers
    wrenches: Mapping[str, Numbers]
    signals: Mapping[str, Numbers]
    signal_units: Mapping[str, str | None]
    gap: npt.NDArray[np.bool_]
    usable: npt.NDArray[np.bool_]
    faults: Mapping[str, tuple[int, list[int]]]
    quality: str
    notes: list[str] = field(default_factory=list)

    @property
    def time_step(self) -> Numbers:
        """Time since the row before [s]; 0 of the first, and where time is missing or goes back."""
        steps = np.diff(self.time, prepend=self.time[:1])
        return np.where(steps > 0, steps, 0.0)

    def wrench(self, sensor: str | None = None) -> Numbers:
        """The wrenches of a sensor, or of the only one."""
        return _of(self.wrenches, sensor, "wrenches")

    def gauges(self, sensor: str | None = None) -> Numbers:
        """The signals of a sensor, or of the only one."""
        return _of(self.signals, sensor, "signals")

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        return f"<fingertip.Recording: {self.quality}>"


def _of(all_of: Mapping[str, Numbers], sensor: str | None, what: str) -> Numbers:
    if sensor is None and len(all_of) == 1:
        return next(iter(all_of.values()))
    if sensor is None or sensor not in all_of:
        known = ", ".join(repr(name) for name in all_of) or "none"
        raise _native.RecordingError(f"name one of the sensors that have {what}: {known}")
    return all_of[sensor]


def read_recording(
    path: str | os.PathLike[str],
    *,
    scene: Scene | None = None,
    topics: Iterable[str] = (),
    force_unit: str | None = None,
    torque_unit: str | None = None,
) -> Recording:
    """Read a recording: CSV with units in the names of its columns, or MCAP with ROS 2 messages.

    Parameters
    ----------
    path : str or os.PathLike
    scene : Scene, optional
        Whose names of columns hold, if it has `[input.columns]`.
    topics : iterable of str, optional
        Of an MCAP file, these topics alone.
    force_unit, torque_unit : str, optional
        For columns without a unit, such as "N" and "Nmm".

    Raises
    ------
    RecordingError
        It names the file, and the line where it is known.
    """
    parts = _native.read_rows(os.fspath(path), scene, list(topics), force_unit, torque_unit)
    return Recording(**parts)


@dataclass(frozen=True, eq=False)
class Analysis(Page):
    """What a recording shows. `analyze` makes it.

    Attributes
    ----------
    columns : dict of ndarray, shape (n,)
        A column for each number, with its unit in the name: `t_s`, `fx_N` to `tz_Nm`, `x_m`, `y_m`, `z_m`, `nx`, `ny`,
        `nz`, `normal_N`, `tangential_x_N` …, `spin_Nm`, `margin_N`, `utilisation`, `slip` (a `SlipVerdict`), and what a
        scene asks for beside. NaN where a row has no such number.
    status_codes : ndarray of uint8, shape (n,)
        Which of `status_words` each row is.
    status_words : list of str
        "contact", or why there is none: "below_threshold", "rest", "unusable_row" …
    sensor : str
        Which was analysed; empty if the recording gives no name.
    notes : list of str
        What should be minded.
    faults, quality
        As of a `Recording`.
    summary : str
        Sentences and tables, as the command prints them.
    html : str
        The page that the command writes.
    """

    columns: Mapping[str, npt.NDArray[Any]]
    status_codes: npt.NDArray[np.uint8]
    status_words: list[str]
    sensor: str
    notes: list[str]
    faults: Mapping[str, tuple[int, list[int]]]
    quality: str
    summary: str
    html: str

    @property
    def time(self) -> Numbers:
        """[s], shape (n,)."""
        return self.columns["t_s"]

    @property
    def wrench(self) -> Numbers:
        """Load on the fingertip [N, N·m], shape (n, 6)."""
        return self._stacked("fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm")

    @property
    def point(self) -> Numbers:
        """Where the environment touches [m], shape (n, 3)."""
        return self._stacked("x_m", "y_m", "z_m")

    @property
    def normal(self) -> Numbers:
        """Outward normals, shape (n, 3)."""
        return self._stacked("nx", "ny", "nz")

    @property
    def normal_force(self) -> Numbers:
        """[N], shape (n,)."""
        return self.columns["normal_N"]

    @property
    def tangential_force(self) -> Numbers:
        """On the fingertip [N], shape (n, 3)."""
        return self._stacked("tangential_x_N", "tangential_y_N", "tangential_z_N")

    @property
    def slip(self) -> npt.NDArray[np.uint8]:
        """What the detector says, a `SlipVerdict`, shape (n,)."""
        return self.columns["slip"]

    @property
    def contact(self) -> npt.NDArray[np.bool_]:
        """Whether there is a contact, shape (n,)."""
        found: npt.NDArray[np.bool_] = self.status == "contact"
        return found

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """The word of each row, shape (n,)."""
        return np.array(self.status_words, dtype=np.str_)[self.status_codes]

    def to_arrow(self) -> Table:
        """The columns as a table that every library of Arrow takes, without a copy."""
        from fingertip._arrow import Table

        return Table({**self.columns, "status": self.status})

    def _stacked(self, *names: str) -> Numbers:
        return np.stack([self.columns[name] for name in names], axis=1)

    def __len__(self) -> int:
        return len(self.status_codes)

    def __str__(self) -> str:
        return self.summary

    def __repr__(self) -> str:
        return f"<fingertip.Analysis: {len(self)} rows, {int(self.contact.sum())} in contact>"


def analyze(
    recording: str | os.PathLike[str],
    scene: Scene,
    *,
    sensor: str | None = None,
    topics: Iterable[str] = (),
    celsius: float | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Analysis:
    """Contacts from a recording, as the command `fingertip analyze` finds them.

    Units, signs, the rest at the start, the calibration, the payload and gaps in time are seen to as the scene says.
    Other threads run meanwhile.

    Parameters
    ----------
    recording : str or os.PathLike
        CSV with units in the names of its columns, or MCAP.
    scene : Scene
    sensor : str, optional
        Which of the recording, by the prefix of its columns; the scene's by default, or the only one.
    topics : iterable of str, optional
        Of an MCAP file, these topics alone.
    celsius : float, optional
        Temperature of the whole recording, for a calibration that drifts with it.
    start, end : float, optional
        What comes earlier or later than so many seconds behind the first row is left out; a rest at the start is taken
        as ever.

    Raises
    ------
    RecordingError
        With the sentence that the command says.
    """
    rows = _native.analyze_rows(os.fspath(recording), scene, sensor, list(topics), celsius, start, end)
    return Analysis(**rows)
