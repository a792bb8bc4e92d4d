//! Laws of friction models, friction limits and slip detectors, to be run on one's own.
//!
//! Each check panics with the law's name, the sample and the figures where a law is broken. The draws come from a
//! fixed generator, so that a failure repeats.
//!
//! ```
//! use fingertip_friction::testing::{Claims, model_laws};
//! use fingertip_friction::{FrictionModel, SlipMargin};
//! use fingertip_wrench::ContactForce;
//!
//! /// Holds half of the normal force, and what glue holds besides.
//! struct Glue(f64);
//!
//! impl FrictionModel<f64> for Glue {
//!     fn slip_margin(&self, force: &ContactForce<f64>) -> SlipMargin<f64> {
//!         let newtons = 0.5 * force.normal + self.0 - force.tangential_magnitude();
//!         SlipMargin { newtons, utilisation: force.tangential_magnitude() / (0.5 * force.normal + self.0) }
//!     }
//!     fn least_normal_force(&self, force: &ContactForce<f64>, safety: f64) -> f64 {
//!         ((safety * force.tangential_magnitude() - self.0) / 0.5).max(0.0)
//!     }
//! }
//!
//! let claims = Claims { homogeneous: false, convex: true, arm: 0.0, tolerance: 1e-12 };
//! // Glue holds a contact that does not press, which no model may say.
//! assert!(std::panic::catch_unwind(|| model_laws(&Glue(0.1), &claims, 100)).is_err());
//! ```

mod claims;
mod detectors;
mod draws;
mod limits;
mod models;

pub use claims::Claims;
pub use detectors::{SlipTrial, detector_laws};
pub use draws::Draws;
pub use limits::friction_laws;
pub use models::model_laws;
