//! `[grip]`: the normal force that a hand is told to hold.

use fingertip::friction::{BadParameter, GripController, GripSettings, SlipVerdict};
use fingertip::wrench::{ContactForce, Real};
use serde::{Deserialize, Serialize};

use crate::friction::Limit;

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
    pub(crate) fn build<T: Real>(&self) -> Result<Grip<T>, BadParameter> {
        let number = T::literal;
        let controller = GripController::new(GripSettings {
            safety: number(self.safety),
            least: number(self.least),
            greatest: number(self.greatest),
            rise: number(self.rise),
            fall: number(self.fall),
            slip_boost: number(self.slip_boost),
        })?;
        Ok(Grip { start: controller, controller })
    }
}

/// The controller of the grip.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip<T: Real> {
    start: GripController<T>,
    controller: GripController<T>,
}

impl<T: Real> Grip<T> {
    /// The normal force to command next \[N\]: that of before without a contact.
    pub(crate) fn command(
        &mut self,
        limit: &Limit<T>,
        force: Option<&ContactForce<T>>,
        slip: Option<SlipVerdict>,
        time_step: T,
    ) -> T {
        match force {
            Some(force) => {
                let slip = slip.unwrap_or(SlipVerdict::Holding);
                self.controller.command(limit, force, slip, time_step)
            }
            None => self.controller.present(),
        }
    }

    /// Starts anew.
    pub(crate) fn reset(&mut self) {
        self.controller = self.start;
    }
}
