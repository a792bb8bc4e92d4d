"""The enumerations. Values are those that files and columns hold."""

from __future__ import annotations

from enum import Enum, IntEnum


class SlipVerdict(IntEnum):
    """What a slip detector says of a sample."""

    NOT_PRESSING = 0
    """The normal force is too small, or the sample not finite: nothing can be said."""
    HOLDING = 1
    """The contact holds, as far as the detector sees."""
    WARNING = 2
    """Slip is near: the contact still holds."""
    SLIPPING = 3
    """The contact slips."""


class Convention(str, Enum):
    """Which of the two opposite loads of a contact is meant."""

    ON_FINGERTIP = "on_fingertip"
    """The load that the environment applies to the fingertip."""
    REACTION = "reaction"
    """The load that the fingertip applies to the environment."""


class NoContactReason(str, Enum):
    """Why a wrench gives no contact."""

    NOT_FINITE = "not_finite"
    BELOW_THRESHOLD = "below_threshold"
    MISSES = "misses"
    ONLY_PULLING = "only_pulling"
    BEYOND_FRICTION = "beyond_friction"
    OUTSIDE_ACTIVE_REGION = "outside_active_region"
    PURE_COUPLE = "pure_couple"
    AMBIGUOUS = "ambiguous"
    UNRESOLVED = "unresolved"
    NOT_ONE_CONTACT = "not_one_contact"


class Continuity(str, Enum):
    """How a sample fits to those before it."""

    NEW = "new"
    """Another contact than before, or the first."""
    FOLLOWED = "followed"
    """The same contact, a little farther."""
    DOUBTED = "doubted"
    """Too far away for the same contact; the next sample decides."""
    BRIDGED = "bridged"
    """No contact was seen, but the track still knows where it would be."""


class Quality(str, Enum):
    """Whether a calibration can be trusted."""

    GOOD = "good"
    """Checked, and within what was asked for."""
    SUSPECT = "suspect"
    """Within what was asked for but for readings that do not fit the others."""
    BAD = "bad"
    """Checked, and not: the reasons stand beside it."""
    UNCHECKED = "unchecked"
    """Nobody has checked it."""


class ChannelFault(str, Enum):
    """What is wrong with a reading of a channel."""

    NOT_FINITE = "not_finite"
    """It is no number."""
    SATURATED_LOW = "saturated_low"
    """It is at or below the lower end of the linear range."""
    SATURATED_HIGH = "saturated_high"
    """It is at or above the upper end."""
    PLATEAU_LOW = "plateau_low"
    """It stays at its lowest value."""
    PLATEAU_HIGH = "plateau_high"
    """It stays at its highest value."""
    STUCK = "stuck"
    """It stays where noise would not let it."""


class HealthLevel(str, Enum):
    """How bad something is that was found of a sensor."""

    SOUND = "sound"
    """Nothing is."""
    NOTE = "note"
    """Good to know."""
    SUSPECT = "suspect"
    """Somebody should look at it."""
    BAD = "bad"
    """Readings are wrong."""
