"""Sensors: calibrated, simulated, designed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from fingertip import _native
from fingertip._native import Calibration, Scene

Numbers = npt.NDArray[np.float64]


def calibrate(
    loads: npt.ArrayLike,
    signals: npt.ArrayLike,
    *,
    unit: Literal["V", "mV/V", "count", "strain"] = "V",
    method: Literal["least_squares", "huber", "ransac"] = "least_squares",
    bias: bool = True,
    curvature: Literal["straight", "quadratic", "chosen"] = "straight",
    loads_from_signals: bool | None = None,
    nominal: npt.ArrayLike | None = None,
    range: tuple[float, float] | None = None,
    names: Sequence[str] | None = None,
    cases: Sequence[int] | None = None,
    groups: Sequence[int] | None = None,
    tare_groups: bool = False,
    weights: npt.ArrayLike | None = None,
    times: npt.ArrayLike | None = None,
    celsius: npt.ArrayLike | None = None,
    reference_celsius: float | None = None,
    creep: bool = False,
    reject_outliers: bool = False,
    greatest_left_out_percent: float = 2.0,
    greatest_condition_number: float = 100.0,
) -> Calibration:
    """Fit a sensor to known loads, and say what it is worth.

    Parameters
    ----------
    loads : array_like, shape (samples, 6) or (samples, 3)
        What the environment applied: (fx, fy, fz [N], tx, ty, tz [N·m]) about the origin of the sensor, or forces.
    signals : array_like, shape (samples, gauges)
        What the gauges read.
    unit : str, optional
        Of the signals.
    method : str, optional
        Least squares, or one of two that stand samples gone wrong.
    bias : bool, optional
        Whether a zero is fitted; without, the readings must be tared.
    curvature : str, optional
        What is fitted beside what is proportional to the signals: nothing, all products of two signals, or as many products
        of two and three signals and smooth bumps as predict load cases best that were left out.
    loads_from_signals : bool, optional
        Inverse regression, as makers of sensors often publish it; what a curved sensor is fitted by.
    nominal : array_like, optional
        Full scale of each axis [N, N·m]; the greatest loads by default.
    range : (float, float), optional
        Least and greatest reading of a gauge: samples at or beyond are left out, by name.
    names, cases, groups : sequence, optional
        What to call each sample; its load case, which is left out as one; its mounting, which has a zero of its own.
    tare_groups : bool, optional
        Whether each group's reading without load is taken off.
    weights, times, celsius : array_like, shape (samples,), optional
    reference_celsius : float, optional
        Fit the drift with temperature, and give matrix and zero at this one.
    creep : bool, optional
        Find how readings go on changing under a load that stays, from load cycles with `times`, and take it off. What was
        found is `report()["creep"]`; a scene with the calibration takes it off, too.
    reject_outliers : bool, optional
        Whether samples that do not fit the others are left out, by name.
    greatest_left_out_percent, greatest_condition_number : float, optional
        Beyond these a calibration is stamped as bad.

    Raises
    ------
    CalibrationError
        The loads do not determine the sensor, or the fit is not worth having.

    Examples
    --------
    >>> import numpy as np
    >>> import fingertip
    >>> random = np.random.default_rng(1)
    >>> loads = random.uniform(-1, 1, (60, 6)) * [10, 10, 10, 0.1, 0.1, 0.1]
    >>> gauges = np.eye(6) + 0.1 * random.standard_normal((6, 6))
    >>> signals = loads / [10, 10, 10, 0.1, 0.1, 0.1] @ gauges.T + 0.5 + 1e-4 * random.standard_normal((60, 6))
    >>> found = fingertip.calibrate(loads, signals)
    >>> found.verdict.value
    'good'
    >>> bool(np.abs(found.loads(signals) - loads).max() < 0.01)
    True
    """
    options: dict[str, Any] = {
        "unit": unit,
        "method": method,
        "bias": bias,
        "curvature": curvature,
        "loads_from_signals": loads_from_signals,
        "nominal": nominal,
        "range": range,
        "names": names,
        "cases": cases,
        "groups": groups,
        "tare_groups": tare_groups,
        "weights": weights,
        "times": times,
        "celsius": celsius,
        "reference_celsius": reference_celsius,
        "creep": creep,
        "reject_outliers": reject_outliers,
        "greatest_left_out_percent": greatest_left_out_percent,
        "greatest_condition_number": greatest_condition_number,
    }
    return _native.calibrate_table(loads, signals, options)


@dataclass(frozen=True, eq=False)
class Simulation:
    """What a simulated fingertip reads, and what was really so. `simulate` makes it.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s]
    raw : ndarray, shape (n, 7)
        Six gauges and the dummy gauge, which no load strains [V].
    wrench : ndarray, shape (n, 6)
        The load on the fingertip, truly [N, N·m].
    point, normal, force : ndarray, shape (n, 3)
        The contact, truly [m, 1, N]; NaN without one.
    slipping : ndarray of bool, shape (n,)
    phase : ndarray of int, shape (n,)
        Which part of the script.
    slip_onsets : ndarray
        When each slip began [s].
    matrix : ndarray, shape (6, 6)
        The calibrated sensor matrix: volts under nominal loads.
    nominal : ndarray, shape (6,)
        Nominal loads [N, N·m].
    centre, radius, half_angle
        Of the spherical tip [m, m, rad], around the first axis.
    """

    time: Numbers
    raw: Numbers
    wrench: Numbers
    point: Numbers
    normal: Numbers
    force: Numbers
    slipping: npt.NDArray[np.bool_]
    phase: npt.NDArray[np.uint64]
    slip_onsets: Numbers
    matrix: Numbers
    nominal: Numbers
    centre: Numbers
    radius: float
    half_angle: float

    @property
    def gauges(self) -> Numbers:
        """The six gauges without what the dummy gauge shows to drift with all of them [V], shape (n, 6)."""
        return self.raw[:, :6] - self.raw[:, 6:]

    def scene(self, **sections: Mapping[str, Any]) -> Scene:
        """A scene of this fingertip, whose readings are `gauges`.

        Parameters
        ----------
        **sections : dict
            More sections, or others: ``friction={"static_coefficient": 0.4}``.
        """
        rest = {
            "input": {"convention": "on_fingertip"},
            "sensor": {
                "signal_unit": "V",
                "load_per_signal_N_Nm": (self.nominal[:, None] * np.linalg.inv(self.matrix)).tolist(),
            },
            "surface": {
                "shape": "sphere",
                "centre_m": self.centre.tolist(),
                "radius_m": self.radius,
                "pole": [1.0, 0.0, 0.0],
                "active_half_angle_deg": float(np.degrees(self.half_angle)),
            },
            "contact": {"least_force_N": 0.05},
        }
        return Scene.from_dict({**rest, **sections})

    def __len__(self) -> int:
        return len(self.time)


def simulate(
    script: Iterable[Mapping[str, Any]] | None = None, *, sample_rate: float = 1000.0, seed: int = 1
) -> Simulation:
    """Play a script on a simulated fingertip: the sensor of Bicchi & Dario 1987 with a spherical tip.

    Parameters
    ----------
    script : iterable of dict, optional
        What happens, one after the other: ``{"do": "press", "at": {"from_top": 0.2, "azimuth": 0.0}, "force": 2.0,
        "duration": 0.3}``, or "rest", "hold", "squeeze", "roll", "drag" and "release". The session of
        `fingertip demo` by default.
    sample_rate : float, optional
        [Hz]
    seed : int, optional
        Of all that is random.

    Examples
    --------
    >>> import fingertip
    >>> seen = fingertip.simulate([
    ...     {"do": "rest", "duration": 0.1},
    ...     {"do": "press", "at": {"from_top": 0.2, "azimuth": 0.0}, "force": 2.0, "duration": 0.1},
    ... ])
    >>> len(seen), round(float(seen.wrench[-1, 0]), 1)
    (200, -2.0)
    """
    played = None if script is None else [dict(segment) for segment in script]
    return Simulation(**_native.simulate_script(played, sample_rate, seed))


@dataclass(frozen=True, eq=False)
class Design:
    """A layout of gauges on a tube. `design` makes it.

    Attributes
    ----------
    gauges : ndarray, shape (gauges, 3)
        How far behind the origin [m], the angle around the tube [rad], and the angle of the gauge [rad].
    radius, thickness : float
        Of the tube [m].
    condition_number : float
        Of the normalised sensor matrix.
    criterion : float
        What was made small.
    matrix : ndarray, shape (gauges, 6)
        Volts under nominal loads.
    layout_toml, calibration_toml : str
        Files: what to make, and the calibration that a perfect specimen would have.
    """

    gauges: Numbers
    radius: float
    thickness: float
    condition_number: float
    criterion: float
    matrix: Numbers
    layout_toml: str
    calibration_toml: str


def design(
    *,
    force: float = 30.0,
    torque: float = 0.3,
    radius: tuple[float, float] = (4e-3, 10e-3),
    length: float = 20e-3,
    layout: Literal["rosettes", "paper", "free"] = "rosettes",
    gauges: int = 6,
    criterion: Literal[
        "condition_number", "contact_error", "worst_axis", "trace", "log_determinant"
    ] = "condition_number",
    material: str = "aluminium-7075-t6",
    safety: float = 3.0,
    tip_radius: float = 13e-3,
    friction: float = 0.5,
    supply: float = 5.0,
    gauge_factor: float = 2.0,
    gain: float = 500.0,
    starts: int = 40,
    seed: int = 1,
) -> Design:
    """Search for a layout of gauges on a thin-walled tube. Other threads run meanwhile.

    Parameters
    ----------
    force, torque : float, optional
        Range on every axis [N, N·m].
    radius : (float, float), optional
        Least and greatest of the tube [m].
    length : float, optional
        Where the tube is clamped, behind the centre of the tip [m].
    layout : str, optional
        Pairs of gauges in one ring, the six of Bicchi & Dario 1987, or every gauge free.
    gauges : int, optional
    criterion : str, optional
        What to make small.
    material : str, optional
    safety : float, optional
        Failing load over full load; the wall is as thin as that allows.
    tip_radius, friction : float, optional
        Of the touches that are expected [m, 1].
    supply, gauge_factor, gain : float, optional
        What turns strain into volts.
    starts, seed : int, optional
        Of the search.

    Raises
    ------
    DesignError

    Examples
    --------
    >>> import fingertip
    >>> found = fingertip.design(starts=4)
    >>> found.gauges.shape, found.condition_number < 2
    ((6, 3), True)
    """
    wanted: dict[str, Any] = {
        "force": force,
        "torque": torque,
        "radius": [float(bound) for bound in radius],
        "length": length,
        "layout": layout,
        "gauges": gauges,
        "criterion": criterion,
        "material": material,
        "safety": safety,
        "tip_radius": tip_radius,
        "friction": friction,
        "supply": supply,
        "gauge_factor": gauge_factor,
        "gain": gain,
        "starts": starts,
        "seed": seed,
    }
    return Design(**_native.design_layout(wanted))
