//! How sure a contact is: Jacobians, covariance, worst case, rigorous bounds.
//!
//! Three answers to three questions, from the cheapest to the safest:
//!
//! | question | answer | holds |
//! |---|---|---|
//! | how does noise spread the contact? | [`ContactJacobian`], [`ContactCovariance`] | to first order |
//! | how far can errors of known size push it? | [`ContactJacobian::worst_case`], [`ball_bound`] | to first order |
//! | where can the true contact not be? | [`sphere_bound`], [`ConvexBound`] | always |
//!
//! First order fails near grazing: it needs `ε sin φ ≪ R cos² φ`, where `ε` is the error of the
//! line of action and `φ` the angle between force and inward normal (theory 2.4).

mod ball_bound;
mod convex_bound;
mod covariance;
mod geometry;
mod jacobian;
mod paper;
mod sensor;
mod sphere_bound;
mod worst_case;

pub use ball_bound::ball_bound;
pub use convex_bound::ConvexBound;
pub use covariance::{ConfidenceEllipse, ContactCovariance};
pub use geometry::{GeometrySensitivity, GeometryUncertainty, ShapeParameters};
pub use jacobian::ContactJacobian;
pub use paper::PaperBounds;
pub use sensor::{SensorUncertainty, WrenchNoise};
pub use sphere_bound::{ErrorBudget, sphere_bound};
pub use worst_case::WorstCase;
