#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "batch")]
pub mod batch;
#[cfg(feature = "fusion")]
mod fusion;
mod model;
mod shapes;
#[cfg(feature = "skin")]
mod skin;
mod soft_finger;
#[cfg(feature = "track")]
mod track;
mod uncertainty;

#[cfg(feature = "fusion")]
pub use fusion::{ArrayContact, Fused, FusedContact, Fusion, Grip};
pub use model::{
    Auto, Choice, Contact, ContactBound, ContactModel, NoContact, PitchTest, PointContact, Resolution,
    WorstErrors,
};
#[cfg(feature = "skin")]
pub use skin::{
    Compliant, CompliantContact, CompliantPointContact, CompliantSoftFinger, Hertz, Indentation,
    IndentationSlope, LinearStiffness, LocalHertz, PowerLaw, SkinLaw, Tabulated, contact_modulus,
};
pub use soft_finger::{Patch, Search, SoftContact, SoftFinger, SoftFingerSurface, newton_soft_contacts};
#[cfg(feature = "track")]
pub use track::{
    BadTrack, ContactEvents, Continuity, FingerVelocity, Happened, Impact, LineMeeting, Met, MotionJudge,
    Motions, NoCurvature, NoMeeting, ObjectCurvature, RollingCurvature, Sighting, Tracked, Tracker,
};
pub use uncertainty::{
    CalibrationUncertainty, ConfidenceEllipse, ContactCovariance, ContactJacobian, ConvexBound,
    GeometrySensitivity, GeometryUncertainty, PaperBounds, SensorUncertainty, WorstCase, WrenchNoise,
    WrenchSpread,
};
