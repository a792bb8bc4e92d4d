"""A picture of the first lift over time, and of the grips of all."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from lifts import Story
from matplotlib.axes import Axes


def picture(stories: list[Story], file: str) -> None:
    """Writes it."""
    figure, axes = plt.subplot_mosaic(
        [["forces", "grips"], ["used", "grips"], ["way", "friction"]], figsize=(13, 8), layout="constrained",
        height_ratios=[2, 1, 1], width_ratios=[1.6, 1],
    )  # fmt: skip
    _story(stories[0], axes)
    _all(stories, axes)
    figure.savefig(file, dpi=110)
    plt.close(figure)


def _story(story: Story, axes: dict[str, Axes]) -> None:
    rows, lift = story.rows, story.lift
    time = np.array([row.time for row in rows])
    forces = axes["forces"]
    forces.plot(time, [row.pressed for row in rows], label="pressed", color="tab:blue")
    # Before all fingers touch there is no telling.
    least = [np.nan if row.phase in ("close", "settle", "open", "over") else row.least for row in rows]
    forces.plot(time, least, label="least that holds the weight", color="black", lw=1, ls="--")
    forces.plot(time, [row.borne for row in rows], label="weight felt", color="tab:green", lw=1)
    forces.set_ylabel("sum over the fingers [N]")
    forces.set_title(
        f"{lift.shape} by {len(lift.tips)} fingers, {lift.mass * 1e3:.0f} g, friction {lift.friction:.2f}"
        + (f" ({story.friction:.2f} learnt)" if story.friction > 0 else ""),
        fontsize=10,
    )
    axes["used"].plot(time, [100 * row.used for row in rows], color="tab:red", lw=1)
    axes["used"].set_ylabel("friction used [%]")
    axes["used"].set_ylim(0, 105)
    axes["way"].plot(time, [1e3 * row.height for row in rows], color="tab:purple", label="height [mm]")
    axes["way"].plot(time, [np.degrees(row.tilt) for row in rows], color="tab:orange", label="tilt [°]")
    axes["way"].set_xlabel("time [s]")
    for name in ("forces", "used", "way"):
        for number, slip in enumerate(story.slips):
            axes[name].axvline(slip, color="tab:red", lw=1, ls=":", label="slip is said" if number == 0 else None)
        axes[name].set_xlim(0, time[-1])
    begins = [row for row, before in zip(rows[1:], rows, strict=False) if row.phase != before.phase]
    for row in begins:
        if row.phase != "over":
            place = forces.get_xaxis_transform()
            forces.text(row.time, 0.98, row.phase, transform=place, rotation=90, fontsize=7, va="top", color="gray")
        for name in ("forces", "used", "way"):
            axes[name].axvline(row.time, color="lightgray", lw=0.6, zorder=0)
    forces.set_ylim(top=1.5 * forces.get_ylim()[1])
    forces.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0.88), ncols=4)
    axes["way"].legend(fontsize=8, loc="upper left")


def _all(stories: list[Story], axes: dict[str, Axes]) -> None:
    for count, marker in ((2, "o"), (3, "^")):
        some = [story for story in stories if len(story.lift.tips) == count and story.holdable]
        masses = [1e3 * story.lift.mass for story in some]
        points = axes["grips"].scatter(masses, [s.grip for s in some], c=[s.lift.friction for s in some], marker=marker,
                                       vmin=0.3, vmax=1.0, label=f"{count} fingers")  # fmt: skip
        axes["friction"].scatter([s.lift.friction for s in some], [s.friction for s in some], marker=marker, s=12)
    plt.colorbar(points, ax=axes["grips"], label="friction")
    axes["grips"].axhline(1.5, color="tab:red", lw=1, ls="--")
    axes["grips"].axhline(1.0, color="black", lw=1)
    axes["grips"].set_xscale("log")
    axes["grips"].set_xticks([20, 50, 100, 200, 400], ["20", "50", "100", "200", "400"])
    axes["grips"].minorticks_off()
    axes["grips"].set_xlim(18, 440)
    axes["grips"].set_xlabel("mass [g]")
    axes["grips"].set_ylabel("grip over the least that holds")
    axes["grips"].set_title(f"{len(stories)} lifts", fontsize=10)
    axes["grips"].legend(fontsize=8)
    axes["friction"].plot([0.3, 1], [0.3, 1], color="black", lw=1)
    axes["friction"].set_xlabel("friction")
    axes["friction"].set_ylabel("learnt")
