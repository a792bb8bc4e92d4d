"""Columns of what many samples say."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

_NUMBERS = ("normal_force", "margin", "utilisation")


class Touches:
    """What many samples say, a row each.

    `Fingertip.sense_all` makes these, and writes into one that is given to it. Numbers are 0 where there is no contact.

    Attributes
    ----------
    point : ndarray, shape (n, 3)
        Where the environment touches [m].
    normal_force : ndarray, shape (n,)
        Normal force [N], positive when pressing.
    tangential_force : ndarray, shape (n, 3)
        Tangential force on the fingertip [N].
    margin : ndarray, shape (n,)
        Signed distance to the friction limit [N]; 0 without friction model.
    utilisation : ndarray, shape (n,)
        How much of the friction limit is used; 0 without friction model.
    slip : ndarray of uint8, shape (n,)
        What the detector says, a `SlipVerdict`; `NOT_PRESSING` without one.

    Notes
    -----
    Each column lies in one piece: ``point[:, 0]`` is contiguous.
    """

    __slots__ = ("_point", "_tangential_force", "margin", "normal_force", "slip", "utilisation")

    _point: npt.NDArray[Any]
    _tangential_force: npt.NDArray[Any]
    normal_force: npt.NDArray[Any]
    margin: npt.NDArray[Any]
    utilisation: npt.NDArray[Any]
    slip: npt.NDArray[np.uint8]

    def __init__(self, rows: int, dtype: npt.DTypeLike = np.float64) -> None:
        self._point = np.zeros((3, rows), dtype)
        self._tangential_force = np.zeros((3, rows), dtype)
        for name in _NUMBERS:
            setattr(self, name, np.zeros(rows, dtype))
        self.slip = np.zeros(rows, np.uint8)

    @classmethod
    def empty(cls, rows: int, dtype: npt.DTypeLike = np.float64) -> Touches:
        """Room for so many rows, whatever stands in it."""
        new = cls.__new__(cls)
        new._point = np.empty((3, rows), dtype)
        new._tangential_force = np.empty((3, rows), dtype)
        for name in _NUMBERS:
            setattr(new, name, np.empty(rows, dtype))
        new.slip = np.empty(rows, np.uint8)
        return new

    @property
    def point(self) -> npt.NDArray[Any]:
        """Where the environment touches [m], shape (n, 3)."""
        return self._point.T

    @property
    def tangential_force(self) -> npt.NDArray[Any]:
        """Tangential force on the fingertip [N], shape (n, 3)."""
        return self._tangential_force.T

    @property
    def contact(self) -> npt.NDArray[np.bool_]:
        """Whether there is a contact, shape (n,): a normal force, or a point where a miss was accepted."""
        found: npt.NDArray[np.bool_] = (self.normal_force > 0) | self._point.any(axis=0)
        return found

    @property
    def dtype(self) -> np.dtype[Any]:
        """The precision of the numbers."""
        return self._point.dtype

    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """The columns by the names that recordings give them, units included, without a copy."""
        x, y, z = self._point
        sx, sy, sz = self._tangential_force
        return {
            "x_m": x,
            "y_m": y,
            "z_m": z,
            "normal_N": self.normal_force,
            "tangential_x_N": sx,
            "tangential_y_N": sy,
            "tangential_z_N": sz,
            "margin_N": self.margin,
            "utilisation": self.utilisation,
            "slip": self.slip,
        }

    def __len__(self) -> int:
        return len(self.normal_force)

    def _parts(self) -> Iterator[npt.NDArray[Any]]:
        return (getattr(self, name) for name in self.__slots__)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Touches):
            return NotImplemented
        return all(
            a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
            for a, b in zip(self._parts(), other._parts(), strict=True)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<fingertip.Touches: {len(self)} rows, {int(self.contact.sum())} in contact>"
