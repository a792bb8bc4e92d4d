//! How sure a contact is: Jacobians, covariance, worst case, rigorous bounds.
//!
//! Three answers to three questions, from the cheapest to the safest:
//!
//! | question | answer | holds |
//! |---|---|---|
//! | how does noise spread the contact? | [`ContactJacobian`], [`ContactCovariance`] | to first order |
//! | how far can errors of known size push it? | [`ContactJacobian::worst_case`], [`Contact::first_order_bound`](crate::Contact::first_order_bound) | to first order |
//! | where can the true contact not be? | [`ContactBound::on_sphere`](crate::ContactBound::on_sphere), [`ConvexBound`] | always |
//!
//! First order fails near grazing: it needs `ε sin φ ≪ R cos² φ`, where `ε` is the error of the
//! line of action and `φ` the angle between force and inward normal (`docs/theory/contact.md#grazing`).

mod answers;
mod calibration;
mod convex_bound;
mod covariance;
pub(crate) mod geometry;
mod is_covariance;
mod jacobian;
mod line_spread;
mod paper;
mod sensor;
mod sinking;
#[cfg(feature = "skin")]
mod skin;
mod spread;
mod worst_case;

pub use calibration::CalibrationUncertainty;
pub use convex_bound::ConvexBound;
pub use covariance::{ConfidenceEllipse, ContactCovariance};
pub use geometry::{GeometrySensitivity, GeometryUncertainty};
pub(crate) use is_covariance::is_covariance;
pub use jacobian::ContactJacobian;
pub(crate) use line_spread::LineSpread;
pub use paper::PaperBounds;
pub use sensor::{SensorUncertainty, WrenchNoise};
pub use spread::WrenchSpread;
pub use worst_case::WorstCase;
