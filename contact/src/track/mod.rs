//! A contact over time: followed on the surface, the events that it begins and ends with, and how it moves.

mod bad_track;
mod events;
mod fold;
mod followed;
mod meeting;
mod motion;
mod plane;
mod retract;
mod sighting;
mod symmetric;
mod tracked;
mod tracker;

pub use bad_track::BadTrack;
pub use events::{ContactEvents, Happened, Impact};
pub use meeting::{LineMeeting, Met, NoMeeting};
pub use motion::{FingerVelocity, MotionJudge, Motions, NoCurvature, ObjectCurvature, RollingCurvature};
pub use sighting::Sighting;
pub use tracked::{Continuity, Tracked};
pub use tracker::Tracker;
