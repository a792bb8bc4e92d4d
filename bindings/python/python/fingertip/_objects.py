"""The shape of an object that was touched."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from fingertip import _native

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ObjectTouches:
    """Touches of an object, in its frame.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Where [m].
    normals : array_like, shape (n, 3)
        Outward normals of the object there; any length.
    covariances : array_like, shape (n, 3, 3) or (3, 3)
        Of the place of each touch on the fingertip, in the tangent plane [m²].
    bends : array_like, shape (n, 3, 3) or (3, 3)
        How the outward normal of the fingertip changes as the place on it does: its shape operator [1/m].
    """

    points: npt.ArrayLike
    normals: npt.ArrayLike
    covariances: npt.ArrayLike
    bends: npt.ArrayLike

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"`points` must have 3 columns, not the shape {points.shape}")
        shape = (len(points), 3, 3)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "normals", self._as("normals", self.normals, (len(points), 3)))
        for name in ("covariances", "bends"):
            object.__setattr__(self, name, self._as(name, getattr(self, name), shape))

    @staticmethod
    def _as(name: str, given: npt.ArrayLike, shape: tuple[int, ...]) -> Numbers:
        array = np.array(given, dtype=float)
        try:
            return np.broadcast_to(array, shape).copy()
        except ValueError:
            raise ValueError(f"`{name}` must have the shape {shape}, not {array.shape}") from None

    @classmethod
    def of_contacts(
        cls,
        rotations: npt.ArrayLike,
        origins: npt.ArrayLike,
        places: npt.ArrayLike,
        normals: npt.ArrayLike,
        covariances: npt.ArrayLike,
        bends: npt.ArrayLike,
    ) -> ObjectTouches:
        """Of contacts on a fingertip whose pose is known.

        Parameters
        ----------
        rotations : array_like, shape (n, 3, 3)
            From the axes of the sensor to those of the object.
        origins : array_like, shape (n, 3)
            Where the sensor is in the frame of the object [m].
        places, normals : array_like, shape (n, 3)
            Points of contact [m] and outward normals of the fingertip there, in the sensor frame.
        covariances, bends : array_like, shape (n, 3, 3) or (3, 3)
            As above, in the sensor frame.
        """
        turn, origins = np.asarray(rotations, dtype=float), np.asarray(origins, dtype=float)
        if turn.ndim != 3 or turn.shape[1:] != (3, 3):
            raise ValueError(f"`rotations` must have the shape (n, 3, 3), not {turn.shape}")
        count = len(turn)
        back = turn.transpose(0, 2, 1)
        places, normals = cls._as("places", places, (count, 3)), cls._as("normals", normals, (count, 3))
        covariances, bends = cls._as("covariances", covariances, turn.shape), cls._as("bends", bends, turn.shape)
        return cls(
            np.einsum("nij,nj->ni", turn, places) + cls._as("origins", origins, (count, 3)),
            -np.einsum("nij,nj->ni", turn, normals),
            turn @ covariances @ back,
            turn @ bends @ back,
        )

    def __len__(self) -> int:
        return len(np.asarray(self.points))

    def _rows(self) -> Numbers:
        flat = [np.asarray(part).reshape(len(self), -1) for part in (self.covariances, self.bends)]
        return np.hstack([np.asarray(self.points), np.asarray(self.normals), *flat])

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write points with normals as a PLY file, which viewers of point clouds open."""
        path = Path(path)
        begun = path.with_name(f"{path.name}.unfinished-{os.getpid()}")
        begun.write_text(_native.touches_to_ply(self._rows()), encoding="ascii")
        begun.replace(path)


@dataclass(frozen=True, eq=False)
class FittedObject:
    """A plane, sphere or cylinder, and how sure it is. `fit_object` makes it.

    Attributes
    ----------
    shape : {"plane", "sphere", "cylinder"}
    point : ndarray, shape (3,)
        Of the plane, the centre, or of the axis [m].
    direction : ndarray, shape (3,), or None
        Outward normal of the plane, or axis of the cylinder.
    radius : float or None
        [m]
    concave : bool
        Whether it was touched from within: a bowl, a bore.
    deviations : ndarray
        Standard deviations. Plane: offset along the normal [m], two tilts [rad]. Sphere: radius, centre [m]. Cylinder:
        radius, two of the place of the axis [m], two tilts [rad].
    half_widths : ndarray
        Of the intervals around the same numbers that hold the true ones with the probability asked for.
    distance : float
        RMS distance of the touches from the shape [m].
    angle : float
        RMS angle between their normals and the shape's [rad].
    noise_scale : float
        What is left over what contacts and poses are said to be off by; near 1 where both are as stated.
    """

    shape: str
    point: Numbers
    direction: Numbers | None
    radius: float | None
    concave: bool
    deviations: Numbers
    half_widths: Numbers
    distance: float
    angle: float
    noise_scale: float


def fit_object(
    shape: Literal["plane", "sphere", "cylinder"],
    touches: ObjectTouches,
    *,
    pose_noise: tuple[float, float] = (2e-4, 2e-3),
    probability: float = 0.95,
) -> FittedObject:
    """Fit a shape to touches of an object.

    What each touch says of the normal tells where on the fingertip it really was, so that fingertips that know their contact
    to millimetres tell shapes to tenths.

    Parameters
    ----------
    shape : {"plane", "sphere", "cylinder"}
    touches : ObjectTouches
    pose_noise : tuple of float
        Standard deviations of the position of the fingertip along each axis [m], and of its turn about each [rad].
    probability : float
        Of `half_widths`.

    Raises
    ------
    FingertipError
        The touches are too few, do not determine the shape, or lie on another one.

    Examples
    --------
    A tip of 13 mm touches a ball of 30 mm, in six directions:

    >>> import numpy as np
    >>> from fingertip import ObjectTouches, fit_object
    >>> out = np.vstack([np.eye(3), -np.eye(3)])
    >>> across = np.eye(3) - out[:, :, None] * out[:, None, :]
    >>> touches = ObjectTouches(0.03 * out, out, 1e-8 * across, across / 0.013)
    >>> round(fit_object("sphere", touches).radius, 6)
    0.03
    """
    found = _native.fit_touches(shape, touches._rows(), *pose_noise, probability)
    return FittedObject(shape, direction=found.pop("direction", None), radius=found.pop("radius", None), **found)
