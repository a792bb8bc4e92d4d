"""Lifts in MuJoCo, in closed loop at 1 kHz through `fingertip`: physics that nobody here wrote.

Two or three fingertips (balls, eggs, capsules) close on a box, a cylinder or an ellipsoid of 20 to 400 g, feel how much
friction there is (0.3 to 1, which nobody tells them), lift, have something poured in, turn, and put down::

    pip install fingertip[mujoco,plots]
    python lifts.py --lifts 100 --seed 1 --plot lifts.png

With ``--wet 0.7`` friction falls by 30 % at once while the object hangs in the air. Each line is a lift. The least that
holds is worked out of MuJoCo's contact list with the true friction and weight, which the controller never sees.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field, replace

import mujoco
import numpy as np
from fingertip import SlipVerdict
from grip import PERIOD, Grip
from oracle import Contacts, Oracle
from script import IN_AIR, Script
from world import Lift, Vector, draw, model

EVERY = 5
"""Milliseconds between two looks at the least grip."""
DROPPED = 0.02
"""An object that moves so far in the hand is dropped [m]."""
ALONE = 20
"""Milliseconds that no finger touches a dropped object. MuJoCo misses the contact of two ellipsoids now and then."""
LONGEST = 12.0
"""A lift that is not over by then never will be [s]."""


@dataclass
class Row:
    """A moment of a lift."""

    time: float
    phase: str
    pressed: float
    """True sum of normal forces, the least that holds, and what is commanded [N]."""
    least: float
    commanded: float
    used: float
    """Of the friction of that contact which uses most of it."""
    borne: float
    """What the sensors say that the object weighs [N]."""
    height: float
    tilt: float


@dataclass
class Story:
    """What became of a lift."""

    lift: Lift
    holdable: bool = False
    """Whether a controller that knows all could do it, within the limits of the fingers."""
    dropped: bool = False
    grip: float = np.nan
    """Over the least that holds, mean over the time in the air, and the worst of it."""
    worst: float = np.nan
    way: float = np.nan
    """How far the hand moved from where the first finger slid to where that was said [m]."""
    answered: float = np.nan
    """From where friction fell in the air to where slip was said [s]."""
    slid: float = 0.0
    """How far the object moved between the fingertips in the air [m]."""
    friction: float = np.nan
    """What was learnt of it, before the lift."""
    mass: float = np.nan
    stands: bool = False
    rows: list[Row] = field(default_factory=list)
    slips: list[float] = field(default_factory=list)
    """When slip was said [s]."""


class Watch:
    """Writes the story of a lift."""

    def __init__(self, story: Story, grip: Grip, script: Script, oracle: Oracle) -> None:
        self.story, self.grip, self.script, self.oracle = story, grip, script, oracle
        self.phase = "close"
        self.ratios: list[float] = []
        self.sliding: float | None = None
        self.wetted: float | None = None
        self.place: Vector | None = None
        self.alone = 0

    def see(self, data: mujoco.MjData, tick: int) -> None:
        """The state after a millisecond."""
        phase, story = self.script.phase, self.story
        contacts = self.oracle.contacts(data)
        begins, self.phase = phase != self.phase, phase
        slips = SlipVerdict.SLIPPING in self.grip.verdicts
        if slips and (not story.slips or data.time - story.slips[-1] > 0.02):
            story.slips.append(data.time)
        if begins and phase == "feel":
            story.holdable = self.oracle.holdable(data, contacts)
        if begins and phase == "lift":
            story.friction = np.nan if self.grip.friction is None else self.grip.friction
        if begins and phase == "hold":
            estimate = self.grip.weight.estimate()
            story.mass = np.nan if estimate is None else estimate[0]
            self.wetted = data.time
        if self.wetted is not None and slips and np.isnan(story.answered):
            story.answered = data.time - self.wetted
        if phase == "feel" and np.isnan(story.way):
            self._feel(contacts, slips)
        if phase in IN_AIR:
            self._air(data, contacts)
        if tick % EVERY == 0:
            self._look(data, contacts)

    def _feel(self, contacts: Contacts, slips: bool) -> None:
        if self.sliding is None:
            if any(contact and contact["used"] > 0.995 for contact in contacts):
                self.sliding = self.script.height
        elif slips:
            self.story.way = self.script.height - self.sliding

    def _air(self, data: mujoco.MjData, contacts: Contacts) -> None:
        turn = data.xmat[self.oracle.hand].reshape(3, 3)
        tips = np.mean([data.geom_xpos[tip] for tip in self.oracle.tips], axis=0)
        place = turn.T @ (data.xpos[self.oracle.object] - tips)
        self.place = place if self.place is None else self.place
        self.story.slid = max(self.story.slid, float(np.linalg.norm(place - self.place)))
        touching = any(contact is not None for contact in contacts)
        self.alone = 0 if touching else self.alone + 1
        self.story.dropped |= self.story.slid > DROPPED or self.alone > ALONE

    def _look(self, data: mujoco.MjData, contacts: Contacts) -> None:
        least = self.oracle.least(contacts, self.oracle.load(data, self.script.poured), None)
        pressed = sum(contact["normal"] for contact in contacts if contact)
        if self.phase in IN_AIR and least is not None:
            self.ratios.append(pressed / least)
        used = max((contact["used"] for contact in contacts if contact), default=0.0)
        row = Row(data.time, self.phase, pressed, np.nan if least is None else least, sum(self.grip.normal), used,
                  self.grip.borne, self.script.height, self.script.tilt)  # fmt: skip
        self.story.rows.append(row)

    def end(self, data: mujoco.MjData) -> None:
        story, lift = self.story, self.story.lift
        if self.ratios:
            story.grip, story.worst = float(np.mean(self.ratios)), max(self.ratios)
        story.stands = not story.dropped and abs(data.xpos[self.oracle.object][2] - lift.size[2]) < 2e-3


def play(lift: Lift, random: np.random.Generator) -> Story:
    """One lift, from open hand to open hand."""
    world = model(lift)
    data = mujoco.MjData(world)
    mujoco.mj_forward(world, data)
    grip = Grip(world, lift.tips, random)
    script, story = Script(world, lift, grip), Story(lift)
    watch = Watch(story, grip, script, Oracle(world, lift))
    tick = 0
    while script.phase != "over" and data.time < LONGEST and not story.dropped:
        script.step(data)
        mujoco.mj_step(world, data, nstep=round(PERIOD / world.opt.timestep))
        watch.see(data, tick)
        tick += 1
    watch.end(data)
    return story


def told(number: int, story: Story) -> str:
    """A line."""
    lift = story.lift
    end = "not to be held" if not story.holdable else "DROPPED" if story.dropped else "fell over" * (not story.stands)
    return (
        f"{number:4} {lift.shape:9} by {len(lift.tips)}, {lift.mass * 1e3:3.0f} g ({story.mass * 1e3:5.1f} felt), "
        f"friction {lift.friction:.2f} ({story.friction:.2f} learnt), "
        f"grip {story.grip:.2f} (at most {story.worst:.2f}) of the least, "
        f"slip after {story.way * 1e3:.2f} mm, slid {story.slid * 1e3:.2f} mm {end}"
    )


def summary(stories: list[Story]) -> str:
    """What all of them say."""
    held = [story for story in stories if story.holdable]
    grips = np.array([story.grip for story in held])
    masses = np.array([abs(story.mass / story.lift.mass - 1) for story in held])
    ways = 1e3 * np.array([story.way for story in stories])
    lines = [
        f"{len(stories)} lifts, {len(held)} of which can be held; of these dropped: {sum(s.dropped for s in held)}, "
        f"not standing at the end: {sum(not s.stands for s in held)}",
        f"grip over the least that holds: median {np.nanmedian(grips):.2f}, mean {np.nanmean(grips):.2f}, "
        f"worst lift {np.nanmax(grips):.2f}, worst moment {np.nanmax([s.worst for s in held]):.2f}; "
        f"lifts above 1.5: {int(np.sum(grips > 1.5))}",
        f"slip said while feeling after a way of {np.nanmedian(ways):.2f} mm (median), {np.nanmax(ways):.2f} mm at "
        f"most; without slip: {int(np.sum(np.isnan(ways)))}",
        f"object slid in the air by {1e3 * np.median([s.slid for s in held]):.2f} mm (median), "
        f"{1e3 * max(s.slid for s in held):.2f} mm at most",
        f"mass off by {100 * np.nanmedian(masses):.1f} % (median), {100 * np.nanmax(masses):.1f} % at most",
    ]
    answered = 1e3 * np.array([s.answered for s in held if s.lift.wetted < 1 and not np.isnan(s.answered)])
    if len(answered):
        lines.append(
            f"slip in the air: said in {len(answered)} lifts, after {np.median(answered):.0f} ms (median), "
            f"{np.max(answered):.0f} ms at most"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lifts", type=int, default=10, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="other lifts by another number")
    parser.add_argument("--only", type=int, nargs="*", help="of these the numbers to play")
    parser.add_argument("--wet", type=float, default=1.0, help="by what friction is multiplied in the air")
    parser.add_argument("--plot", metavar="FILE", help="a picture of the first lift and of all grips")
    given = parser.parse_args()
    stories = []
    for number in given.only or range(given.lifts):
        random = np.random.default_rng([given.seed, number])
        stories.append(play(replace(draw(random), wetted=given.wet), random))
        print(told(number, stories[-1]), flush=True)
    print(summary(stories))
    if given.plot:
        from picture import picture

        picture(stories, given.plot)


if __name__ == "__main__":
    main()
