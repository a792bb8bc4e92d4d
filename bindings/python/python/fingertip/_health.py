"""What a recording tells of the sensor itself."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from fingertip import _native
from fingertip._enums import HealthLevel
from fingertip._pages import Page

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Finding:
    """Something that was found of a sensor.

    Attributes
    ----------
    what : str
        Its kind, such as "stuck", "hum" or "zero_step".
    level : HealthLevel
        How bad it is.
    channels : tuple of str
        The names of the channels; empty if it is of all.
    at : float or None
        When [s].
    size : float or None
        How much, in the unit of the channel or as a ratio.
    said : str
        In a sentence, without its full stop.
    """

    what: str
    level: HealthLevel
    channels: tuple[str, ...]
    at: float | None
    size: float | None
    said: str

    def __str__(self) -> str:
        return f"{self.level.value}: {self.said}"


@dataclass(frozen=True, eq=False, repr=False)
class Health(Page):
    """The health of a sensor. `health` makes it.

    Attributes
    ----------
    verdict : HealthLevel
        The worst of what was found.
    figures : dict
        All figures, as the command writes them by `--json`: samples, rate, rest, channels, zeros that jumped, channels that
        share noise.
    spectra : dict of ndarray, shape (n, 2)
        Of each channel: frequency [Hz] and amplitude density [unit/√Hz].
    courses : dict of ndarray, shape (n, 4)
        How each channel went, in parts of the recording: time [s], and the least, mean and greatest reading.
    notes : list of str
        What should be minded.
    summary : str
        The result in sentences and tables, as the command prints it.
    html : str
        The page that the command writes.
    """

    verdict: HealthLevel
    figures: Mapping[str, Any]
    spectra: Mapping[str, Numbers]
    courses: Mapping[str, Numbers]
    summary: str
    html: str
    notes: list[str] = field(default_factory=list)

    @property
    def findings(self) -> list[Finding]:
        """What is wrong and what is good to know, worst first."""
        return [
            Finding(**{**one, "channels": tuple(one["channels"]), "level": HealthLevel(one["level"])})
            for one in self.figures["findings"]
        ]

    @property
    def channels(self) -> Mapping[str, Mapping[str, Any]]:
        """The figures of each channel by its name: range, step, noise, drift, lines, stretches at fault."""
        return {channel["name"]: channel for channel in self.figures["channels"]}

    def __str__(self) -> str:
        return self.summary

    def __repr__(self) -> str:
        said = "".join(f"; {finding}" for finding in self.findings[:3])
        return f"<fingertip.Health: {self.verdict.value}{said}>"


def health(
    recording: str | os.PathLike[str],
    *,
    sensor: str | None = None,
    topics: Iterable[str] = (),
    calibration: str | os.PathLike[str] | None = None,
    celsius: float | None = None,
    rate: float | None = None,
) -> Health:
    """What a recording tells of the sensor itself, as the command `fingertip health` finds it.

    Noise and its spectrum, hum, drift, jumps of the zero; channels that are dead, stuck, clipped, or share noise; samples
    that are missing. Best is a recording of some seconds in which the sensor rests. Other threads run meanwhile.

    Parameters
    ----------
    recording : str or os.PathLike
        CSV with units in the names of its columns, or MCAP.
    sensor : str, optional
        This one alone, by the prefix of its columns.
    topics : iterable of str, optional
        Of an MCAP file, these topics alone.
    calibration : str or os.PathLike, optional
        For a recording of signals: figures are then given of the wrench, too.
    celsius : float, optional
        Temperature of the whole recording, for a calibration that drifts with it.
    rate : float, optional
        Samples a second of a recording that has no column of time.

    Raises
    ------
    RecordingError
        With the sentence that the command says.

    Examples
    --------
    >>> import tempfile, numpy as np
    >>> from fingertip import health
    >>> noise = np.random.default_rng(1).normal(0, 0.01, (4000, 3))
    >>> noise[:, 1] = 0.25
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = folder + "/rest.csv"
    ...     rows = np.column_stack([np.arange(4000) / 1000, noise, 1e-3 * noise])
    ...     header = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm"
    ...     np.savetxt(path, rows, delimiter=",", header=header, comments="")
    ...     found = health(path)
    >>> [finding.channels for finding in found.findings if finding.what == "dead"]
    [('fy_N',), ('ty_Nm',)]
    """
    calibration = None if calibration is None else os.fspath(calibration)
    found = _native.look_at_health(os.fspath(recording), sensor, list(topics), calibration, celsius, rate)
    return Health(**{**found, "verdict": HealthLevel(found["verdict"])})
