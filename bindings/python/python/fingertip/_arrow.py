"""Tables of Arrow through a scene."""

from __future__ import annotations

from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt

from fingertip import _native
from fingertip._native import Fingertip, FingertipError, Scene, Table

T = TypeVar("T")

__all__ = ["Columns", "Table", "columns"]


def _as(kind: type, table: Table) -> Any:
    """A table as the library of `kind` has it."""
    library = kind.__module__.partition(".")[0]
    if library == "polars":
        import polars

        return polars.DataFrame(table)
    if library == "pandas":
        import pyarrow

        return pyarrow.table(table).to_pandas()
    if library == "pyarrow":
        import pyarrow

        return pyarrow.record_batch(table) if kind is pyarrow.RecordBatch else pyarrow.table(table)
    return table


class Columns:
    """A function from a table of wrenches to the same table with contacts. `columns` makes it, and has the words.

    It pickles, so that engines can send it to other machines, and every call begins anew.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        sensor: str | None = None,
        time_step: float | None = None,
        group: str | None = None,
        dtype: npt.DTypeLike = np.float64,
    ) -> None:
        self.scene = scene
        self.sensor = sensor if sensor is not None else scene.sensor_name
        self.time_step = time_step
        self.group = group
        self.dtype = np.dtype(dtype)

    def __call__(self, table: T) -> T:
        """The table with more columns behind its own."""
        given = table if isinstance(table, Table) else Table.from_arrow(table)
        tip = Fingertip(self.scene, self.dtype)
        gauges = tip.channels if self.scene.has_sensor else None
        time, found = _native.find_columns(given.names, self.sensor, gauges)
        if self.time_step is None and time is None and self.scene.sample_rate is None:
            raise FingertipError("the table has no column of time; add one (t_s), or give `time_step`")
        pieces: list[Table] = []
        before: Table | None = None
        last_time = np.nan
        for batch in given.batches():
            readings = [self._column(batch, name, size) for name, size in found]
            anew = np.zeros(len(batch), np.bool_)
            if self.group is not None:
                anew = batch.changes(self.group)
                if before is not None and len(anew):
                    anew[0] = not batch.continues(before, self.group)
            step: Any = self.time_step
            if step is None and time is None:
                step = 1.0 / (self.scene.sample_rate or 1.0)
            elif step is None and time is not None:
                clock = np.asarray(self._column(batch, *time), np.float64)
                step = np.diff(clock, prepend=last_time)
                step[~(step > 0) | anew] = 0.0
                last_time = clock[-1] if len(clock) else last_time
            touches = tip.sense_all(readings, step, anew=anew if anew.any() else None)
            pieces.append(batch.with_columns(Table(touches.columns())))
            before = batch if len(batch) else before
        if not pieces:
            empty = Table(tip.sense_all([np.zeros(0)] * tip.channels, 0.0).columns())
            nothing = Table.joined([], given)
            return cast(T, _as(type(table), nothing.with_no_rows(empty)))
        return cast(T, _as(type(table), Table.joined(pieces, given)))

    def _column(self, batch: Table, name: str, size: float) -> npt.NDArray[Any]:
        column = batch.column(name)
        return column if size == 1.0 else np.asarray(column * size, column.dtype)


def columns(
    scene: Scene,
    *,
    sensor: str | None = None,
    time_step: float | None = None,
    group: str | None = None,
    dtype: npt.DTypeLike = np.float64,
) -> Columns:
    """Make a function from a table of wrenches to the same table with contacts.

    Tables are those of any library that has the Arrow PyCapsule interface: pyarrow, polars, pandas, DuckDB's results,
    `fingertip.Table`. The function gives back the kind that it takes. Columns of float64 and float32 in SI units are read
    where they lie, and those of the table are in the result without a copy.

    Parameters
    ----------
    scene : Scene
    sensor : str, optional
        Which sensor, by the prefix of its columns; the scene's by default, or the only one.
    time_step : float, optional
        Between rows [s]. By default that of a column of time (`t_s`), or the scene's sample rate.
    group : str, optional
        A column that tells recordings apart: where it changes, a fingertip begins anew.
    dtype : dtype, optional
        `float64` or `float32`: the precision of the arithmetic, and of the columns that come out.

    Returns
    -------
    Columns
        The function. Columns in: `fx_N` to `tz_Nm`, or in other units, or gauges for a scene with `[sensor]`. Columns
        out: those, and `x_m`, `y_m`, `z_m`, `normal_N`, `tangential_x_N` …, `margin_N`, `utilisation` and `slip`.

    Notes
    -----
    Every call begins anew: what a slip detector or a filter remembers does not pass from one batch of an engine to the
    next. So a batch must hold whole recordings, in the order of time: let the engine group by recording
    (Ray ``groupby(..).map_groups``, Dask partitions of one file each), or let `group` name the column where several
    are in one batch. A scene without slip detector, filter, tracking and estimate remembers only where the last contact
    was, and of a convex shape that does not matter: its batches may be cut anywhere.

    Examples
    --------
    >>> import numpy as np
    >>> import fingertip
    >>> scene = fingertip.Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.013}})
    >>> names = ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"]
    >>> table = fingertip.Table({name: np.full(3, -1.0 if name == "fz_N" else 0.0) for name in names})
    >>> touched = fingertip.columns(scene, time_step=1e-3)(table)
    >>> touched.column("z_m").tolist()
    [0.013, 0.013, 0.013]
    """
    return Columns(scene, sensor=sensor, time_step=time_step, group=group, dtype=dtype)
