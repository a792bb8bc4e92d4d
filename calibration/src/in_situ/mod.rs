//! Calibration in use: what ordinary point contacts tell, because their wrenches have no pitch.

mod drift;
mod form;
mod refine;

pub use drift::{DriftMonitor, DriftVerdict};
pub use form::{Form, PointContactForm, angle_between, form_of};
pub use refine::{Refined, refine};
