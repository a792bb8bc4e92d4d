"""Touch from a small force/torque sensor behind a robot's fingertip.

From the wrench and the known shape of the fingertip come the point of contact, normal and tangential force, how far
the grip is from slipping, and how sure that is. All numbers are in SI units; a wrench is the load that the environment
applies to the fingertip, and normals point out of it.

>>> import fingertip
>>> scene = fingertip.Scene.from_dict({"surface": {"shape": "sphere", "radius_m": 0.013}})
>>> tip = fingertip.Fingertip(scene)
>>> tip.sense([0.0, 0.0, -2.0, 0.0, 0.0, 0.0], 1e-3).point.tolist()
[0.0, 0.0, 0.013]
"""

from fingertip._arrow import Columns, Table, columns
from fingertip._enums import Continuity, Convention, NoContactReason, Quality, SlipVerdict
from fingertip._native import (
    Calibration,
    CalibrationError,
    Contact,
    DesignError,
    Fingertip,
    FingertipError,
    FrictionError,
    HandError,
    Happened,
    Impact,
    NoContact,
    ReadingError,
    RecordingError,
    Scene,
    SceneError,
    ShapeError,
    SimulationError,
    Spread,
    Surface,
    Touch,
    Tracked,
)
from fingertip._recordings import Analysis, Recording, analyze, read_recording
from fingertip._sensors import Design, Simulation, calibrate, design, simulate
from fingertip._touches import Touches

__all__ = [
    "Analysis",
    "Calibration",
    "CalibrationError",
    "Columns",
    "Contact",
    "Continuity",
    "Convention",
    "Design",
    "DesignError",
    "Fingertip",
    "FingertipError",
    "FrictionError",
    "HandError",
    "Happened",
    "Impact",
    "NoContact",
    "NoContactReason",
    "Quality",
    "ReadingError",
    "Recording",
    "RecordingError",
    "Scene",
    "SceneError",
    "ShapeError",
    "Simulation",
    "SimulationError",
    "SlipVerdict",
    "Spread",
    "Surface",
    "Table",
    "Touch",
    "Touches",
    "Tracked",
    "analyze",
    "calibrate",
    "columns",
    "design",
    "read_recording",
    "simulate",
]
