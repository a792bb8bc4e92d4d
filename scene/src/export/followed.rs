//! What follows the contact over time, beside the pipeline.

use fingertip::wrench::Real;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::beside::{Beside, jacobian};
use super::stages::chosen;
use super::template::Writer;
use crate::uncertainty::Uncertainty;

const TRACKER: &str = "
/// Follows the contact over time.
///
/// # Errors
/// Never for the numbers below.
pub fn tracker() -> Result<contact::Tracker<{T}>, BadTip> {{
    Ok(contact::Tracker::new({speed_m_per_s}, {turns_within_s})?.with_gate({doubted_share})?)
}}
";

const EVENTS: &str = "
/// Tells when something touches, lets go or strikes.
///
/// # Errors
/// Never for the numbers below.
pub fn contact_events() -> Result<contact::ContactEvents<{T}>, BadTip> {{
    let events = contact::ContactEvents::new({noise}, {least_touch_N}, {samples_per_false_event})?;
    Ok(events.with_longest_impact({longest_impact_s})?)
}}
";

impl<T: Real + DeserializeOwned> Writer<T> {
    /// What follows the contact, and what tells its events.
    pub(super) fn tracking(
        &mut self,
        tracking: &Table,
        uncertainty: Option<&Uncertainty<T>>,
        contact: &Table,
    ) -> Result<Beside, ExportError> {
        let mut keys = tracking.clone();
        let noise = uncertainty.map_or_else(T::zero, Uncertainty::force_noise);
        keys.insert("noise".to_owned(), Value::Float(noise.to_f64()));
        let skin = contact.contains_key("skin");
        let mut items = self.items(TRACKER, &keys)?;
        items.push_str(&sighting(Self::scalar(), jacobian(chosen(contact, "model"), skin), skin));
        let (last, before) = if skin {
            ("&tip, &touch, before, &noise", "; `before` is the last contact before this sample")
        } else {
            ("&tip, &touch, &noise", "")
        };
        let mut call = format!(
            "With `let (mut tracker, noise) = (tracker()?, wrench_noise()?)`, the contact over time is\n    \
             let sighting = sighting({last});\n    \
             tracker.follow(tip.surface(), sighting.as_ref(), time_step)\n\
             and `tracker.reset()` is to be called after a pause{before}.\n"
        );
        if tracking.contains_key("least_touch_N") {
            items.push_str(&self.items(EVENTS, &keys)?);
            call.push_str(
                "With `let mut events = contact_events()?`, touch, release and blow are told by\n    \
                 events.observe(&touch.wrench.force(), time_step)\n",
            );
        }
        Ok(Beside { items, call })
    }
}

/// The function that tells where the contact of a sample is and how sure.
fn sighting(t: &str, jacobian: &str, skin: bool) -> String {
    let (last, indented) = if skin {
        (
            format!("    last: Option<&nalgebra::Vector3<{t}>>,\n"),
            "let indented = tip.model().resolve_indented(&touch.wrench, surface, last).ok()?;\n    ",
        )
    } else {
        (String::new(), "")
    };
    format!(
        "\n/// Where the contact of a sample is, and how sure; `None` without one, and where that cannot be said.\n\
         pub fn sighting<Reading, Verdict>(\n    tip: &Tip,\n    \
             touch: &fingertip::Touch<{t}, Reading, Verdict>,\n{last}    \
             noise: &contact::WrenchNoise<{t}>,\n) -> Option<contact::Sighting<{t}>> {{\n    \
             let surface = tip.surface();\n    \
             let found = touch.resolution.contact()?;\n    \
             {indented}let jacobian = {jacobian};\n    \
             contact::Sighting::of(found, &jacobian, &noise.covariance(&touch.wrench))\n}}\n"
    )
}
