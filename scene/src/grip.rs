//! `[grip]`: the normal force that a hand is told to hold.

use fingertip::friction::{BadParameter, GripController, GripSettings};
use fingertip::wrench::Real;
use serde::{Deserialize, Serialize};

/// `[grip]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GripSection {
    #[serde(default = "usual_safety")]
    safety: f64,
    #[serde(rename = "least_N")]
    least: f64,
    #[serde(rename = "greatest_N")]
    greatest: f64,
    #[serde(rename = "rise_N_per_s")]
    rise: f64,
    #[serde(rename = "fall_N_per_s")]
    fall: f64,
    #[serde(default = "usual_boost")]
    slip_boost: f64,
}

const fn usual_safety() -> f64 {
    1.5
}
const fn usual_boost() -> f64 {
    1.25
}

impl GripSection {
    pub(crate) fn build<T: Real>(&self) -> Result<GripController<T>, BadParameter> {
        let number = T::literal;
        GripController::new(GripSettings {
            safety: number(self.safety),
            least: number(self.least),
            greatest: number(self.greatest),
            rise: number(self.rise),
            fall: number(self.fall),
            slip_boost: number(self.slip_boost),
        })
    }
}
