//! Wrench and tactile array together, beside the pipeline.

use fingertip::wrench::Real;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::beside::Beside;
use super::template::Writer;
use crate::fusion::Joined;

const FUSED: &str = "
/// What the wrench of a sample and a tactile array tell together; of each place of the array that is pressed the centroid
/// [m] and the normal force [N], one to four.
///
/// # Errors
/// For a reading that is not finite or not near the surface, and for a wrench that is not finite.
pub fn fused<Reading, Verdict, const K: usize>(
    tip: &Tip,
    touch: &fingertip::Touch<{T}, Reading, Verdict>,
    noise: &contact::WrenchNoise<{T}>,
CALIBRATED    readings: &[(nalgebra::Vector3<{T}>, {T}); K],
) -> Result<contact::Fused<{T}, K>, surfaces::BadShape> {{
    let fusion = contact::Fusion::new(COVARIANCE, {friction})?;
    let array = readings.map(|(centroid, normal_force)| {{
        let relative = {relative} * normal_force;
        contact::ArrayContact {{
            centroid,
            centroid_covariance: nalgebra::Matrix3::from_diagonal_element({position_variance}),
            normal_force,
            normal_deviation: wrench::Real::root({normal_deviation} * {normal_deviation} + relative * relative),
        }}
    }});
    fusion.estimate(tip.surface(), &touch.wrench, &array)
}}
";

impl<T: Real + DeserializeOwned> Writer<T> {
    /// What joins the wrench with an array; `calibrated` if the fit of the calibration leaves something uncertain.
    pub(super) fn fusion(&mut self, joined: &Joined<T>, calibrated: bool) -> Result<Beside, ExportError> {
        let mut keys = Table::new();
        for (key, number) in [
            ("friction", joined.friction),
            ("relative", joined.relative),
            ("position_variance", joined.position_variance),
            ("normal_deviation", joined.normal_deviation),
        ] {
            keys.insert(key.to_owned(), Value::Float(number.to_f64()));
        }
        let (parameter, covariance, given, noise) = if calibrated {
            (
                format!("    calibration: &contact::CalibrationUncertainty<{}>,\n", Self::scalar()),
                "noise.covariance(&touch.wrench) + calibration.covariance(&touch.wrench)",
                "&noise, &calibration",
                "(noise, calibration) = (wrench_noise()?, calibration_uncertainty()?)",
            )
        } else {
            (String::new(), "noise.covariance(&touch.wrench)", "&noise", "noise = wrench_noise()?")
        };
        let items =
            self.items(FUSED, &keys)?.replace("CALIBRATED", &parameter).replace("COVARIANCE", covariance);
        Ok(Beside {
            items,
            call: format!(
                "With `let {noise}`, wrench and array together are\n    \
                 fused(&tip, &touch, {given}, &[(centroid, normal_force)])\n"
            ),
        })
    }
}
