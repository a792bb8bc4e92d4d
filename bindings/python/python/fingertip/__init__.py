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
from fingertip._formula import formula
from fingertip._health import Finding, Health, health
from fingertip._native import (
    BristleFriction,
    Calibration,
    CalibrationError,
    ChannelMonitor,
    Contact,
    ContactCovariance,
    ContactEvents,
    ContactJacobian,
    ContactModel,
    DesignError,
    Fingertip,
    FingertipError,
    FrictionError,
    FrictionLimit,
    Grasp,
    HandError,
    HandController,
    Happened,
    Impact,
    IncipientSlip,
    LineMeeting,
    MotionJudge,
    NoContact,
    ObjectWeight,
    ReadingError,
    RecordingError,
    RollingCurvature,
    Scene,
    SceneError,
    ShapeError,
    SimulationError,
    SlipDetector,
    Spread,
    Surface,
    Touch,
    Tracked,
    conditioning,
    fuse,
    limit_curve,
    paper_bounds,
    worst_errors,
)
from fingertip._recordings import Analysis, Recording, analyze, read_recording
from fingertip._sensors import Design, Simulation, calibrate, design, simulate
from fingertip._touches import Touches

__all__ = [
    "Analysis",
    "BristleFriction",
    "Calibration",
    "CalibrationError",
    "ChannelMonitor",
    "Columns",
    "Contact",
    "ContactCovariance",
    "ContactEvents",
    "ContactJacobian",
    "ContactModel",
    "Continuity",
    "Convention",
    "Design",
    "DesignError",
    "Finding",
    "Fingertip",
    "FingertipError",
    "FrictionError",
    "FrictionLimit",
    "Grasp",
    "HandController",
    "HandError",
    "Happened",
    "Health",
    "Impact",
    "IncipientSlip",
    "LineMeeting",
    "MotionJudge",
    "NoContact",
    "NoContactReason",
    "ObjectWeight",
    "Quality",
    "ReadingError",
    "Recording",
    "RecordingError",
    "RollingCurvature",
    "Scene",
    "SceneError",
    "ShapeError",
    "Simulation",
    "SimulationError",
    "SlipDetector",
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
    "conditioning",
    "design",
    "formula",
    "fuse",
    "health",
    "limit_curve",
    "paper_bounds",
    "read_recording",
    "simulate",
    "worst_errors",
]
