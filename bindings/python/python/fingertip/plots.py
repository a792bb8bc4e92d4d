"""Pictures, by matplotlib: ``pip install fingertip[plots]``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fingertip._recordings import Analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fingertip import Scene

__all__ = ["plot_contacts", "plot_forces", "plot_surface"]

_SLIPPING = 3


def _axes(axes: Any, **how: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained", **how)[1]


def plot_contacts(found: Analysis, scene: Scene, *, axes: Axes | None = None) -> Axes:
    """Draw contacts on the flat map of the fingertip, coloured by normal force; slips are rings.

    Parameters
    ----------
    found : Analysis
    scene : Scene
        Whose map it is: in mm on a plane and an unrolled cylinder; on other shapes in radii, a map that keeps areas.
    axes : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes
    """
    axes = _axes(axes)
    touched = found.contact
    # The firmest on top.
    order = np.flatnonzero(touched)[np.argsort(found.normal_force[touched])]
    right, up = scene.project(found.point[order])
    forces = found.normal_force[order]
    drawn = axes.scatter(right, up, c=forces, s=6, cmap="viridis", linewidths=0)
    slips = found.slip[order] == _SLIPPING
    if slips.any():
        axes.scatter(right[slips], up[slips], s=40, facecolors="none", edgecolors="tab:red", label="slip")
        axes.legend(loc="upper right")
    axes.figure.colorbar(drawn, ax=axes, label="normal force / N")
    shape = scene.to_toml()
    unit = "mm" if any(f'shape = "{name}"' in shape for name in ("plane", "disk", "rectangle", "cylinder")) else "radii"
    axes.set(aspect="equal", xlabel=f"right / {unit}", ylabel=f"up / {unit}", title=f"{len(forces)} contacts")
    axes.grid(alpha=0.3)
    return axes


def plot_forces(found: Analysis, *, axes: Any = None) -> Any:
    """Draw normal and tangential force and the friction ratio over time; slips are shaded.

    Parameters
    ----------
    found : Analysis
    axes : sequence of two matplotlib.axes.Axes, optional
        For the forces, and for the ratio.

    Returns
    -------
    sequence of two matplotlib.axes.Axes
    """
    forces, ratios = axes = _axes(axes, nrows=2, sharex=True, height_ratios=[2, 1])
    tangential = np.linalg.norm(found.tangential_force, axis=1)
    forces.plot(found.time, found.normal_force, label="normal", color="tab:blue", linewidth=1)
    forces.plot(found.time, tangential, label="tangential", color="tab:orange", linewidth=1)
    forces.set(ylabel="force / N", ylim=(0, None))
    forces.legend(loc="upper right")
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = tangential / found.normal_force
    ratios.plot(found.time, ratio, color="tab:green", linewidth=1)
    ratios.set(xlabel="time / s", ylabel="friction ratio", ylim=(0, None))
    slips = found.slip == _SLIPPING
    for one in (forces, ratios):
        for begin, end in _runs(slips):
            one.axvspan(
                found.time[begin], found.time[min(end, len(slips) - 1)], color="tab:red", alpha=0.25, linewidth=1
            )
        one.grid(alpha=0.3)
    return axes


def plot_surface(found: Analysis, *, axes: Any = None) -> Any:
    """Draw contacts and their normals in space, in mm: a view that a notebook can turn."""
    if axes is None:
        axes = _axes(None, subplot_kw={"projection": "3d"})
    touched = found.contact
    points, normals = found.point[touched] * 1e3, found.normal[touched]
    drawn = axes.scatter(*points.T, c=found.normal_force[touched], s=4, cmap="viridis")
    some = slice(None, None, max(1, len(points) // 100))
    size = 0.15 * max(float(np.ptp(points, axis=0).max()), 1e-9) if len(points) else 1.0
    axes.quiver(*points[some].T, *(size * normals[some]).T, linewidth=0.5, color="0.4")
    axes.figure.colorbar(drawn, ax=axes, label="normal force / N")
    axes.set(xlabel="x / mm", ylabel="y / mm", zlabel="z / mm", aspect="equal")
    return axes


def _runs(flags: np.typing.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Where true flags begin and end."""
    edges = np.flatnonzero(np.diff(flags.astype(np.int8), prepend=0, append=0))
    return [(int(begin), int(end)) for begin, end in zip(edges[::2], edges[1::2], strict=True)]
