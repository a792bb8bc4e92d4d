//! The stages beside the surface as types: contact model, skin, friction limit, slip detector.

use fingertip::friction::run_length::{likelihood_ratio_threshold, run_length_for};
use fingertip::friction::{BadParameter, Cusum};
use fingertip::wrench::Real;
use nalgebra::Vector3;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::template::{Row, Typed, Writer, number, row};
use crate::fault::SceneProblem;
use crate::friction::Limit;
use crate::slip::{ALLOWANCE, WINDOW};
use crate::uncertainty::Uncertainty;

const MODELS: &[Row] = &[
    row(
        "point",
        "contact::PointContact<{T}>",
        "contact::PointContact::new({least_force_N})?{?.with_greatest_gap({gap_m})??}\
         {?.with_greatest_friction({greatest_friction_ratio})??}",
    ),
    row(
        "soft_finger",
        "contact::SoftFinger<{T}>",
        "contact::SoftFinger::new({least_force_N})?{?.with_greatest_friction({greatest_friction_ratio})??}\
         {?.with_torque_noise({spin_noise_Nm})??}{?.with_torque_arm({torque_arm_m})??}",
    ),
    row(
        "auto",
        "contact::Auto<{T}>",
        "contact::Auto::new(point, soft, nalgebra::Matrix6::from_diagonal(&nalgebra::Vector6::from({variances:a})))?\
         {?.with_greatest_pitch({greatest_pitch_m}, {pitch_deviations})??}",
    ),
];

const SKINS: &[Row] = &[
    row(
        "linear",
        "contact::LinearStiffness<{T}>",
        "contact::LinearStiffness::new({stiffness_N_per_m}, {radius_m})?",
    ),
    row(
        "power",
        "contact::PowerLaw<{T}>",
        "contact::PowerLaw::new([{patch_at_1_N_m}, {patch_exponent}], [{depth_at_1_N_m}, {depth_exponent}])?",
    ),
    row(
        "hertz",
        "contact::Hertz<{T}>",
        "contact::Hertz::new({radii_m:a}, contact::contact_modulus({young_moduli_Pa:a}, {poisson_ratios:a})?)?",
    ),
    row(
        "local_hertz",
        "contact::LocalHertz<{T}>",
        "contact::LocalHertz::new(contact::contact_modulus({young_moduli_Pa:a}, {poisson_ratios:a})?, \
         {object_curvature_per_m}, {largest_radius_m})?",
    ),
    row(
        "table",
        "contact::Tabulated<{T}, [[{T}; 3]; {force_depth_patch_N_m_m:n}]>",
        "contact::Tabulated::new({force_depth_patch_N_m_m:a})?",
    ),
];

const LIMITS: &[Row] = &[
    row("coulomb", "friction::Coulomb<{T}>", "friction::Coulomb::new({static_coefficient})?"),
    row(
        "anisotropic",
        "friction::AnisotropicCoulomb<{T}>",
        "friction::AnisotropicCoulomb::new([{first:v}, {second:v}], {coefficients:a})?",
    ),
    row(
        "soft_finger",
        "friction::SoftFingerLimit<{T}>",
        "friction::SoftFingerLimit::{?conservative{conservative:y}?}{?new{conservative:x}?}\
         ({static_coefficient}, {torque_arm_m})?",
    ),
    row(
        "power",
        "friction::PowerLimit<{T}>",
        "friction::PowerLimit::for_patch({static_coefficient}, {patch_radius_m}, \
         friction::PressureDistribution::{pressure:w})?",
    ),
    row(
        "load_dependent",
        "friction::LoadDependentLimit<{T}>",
        "friction::LoadDependentLimit::new({static_coefficient}, {torque_arm_m}, {reference_force_N}, {growth_exponent})?",
    ),
    // What margins and grip count with; what is known of the friction is a function of its own.
    row("uncertain", "friction::Coulomb<{T}>", "friction::Coulomb::new({cautious})?"),
];

/// The noise of a section.
pub(super) const NOISE: &str = "friction::ForceNoise::isotropic({noise_N})?";

const DETECTORS: &[Row] = &[
    row(
        "drop",
        "friction::DropDetector<{T}>",
        "friction::DropDetector::{?with_sum(NOISE, friction::Cusum::new({allowance}, {threshold})?)??}\
         {?new(NOISE){usual:y}??}",
    ),
    row(
        "threshold",
        "friction::RatioThreshold<{T}>",
        "friction::RatioThreshold::new(friction::NormalForceGate::from_noise(&NOISE), {coefficient})?\
         .with_warning_share({warning_share})?",
    ),
    row(
        "likelihood_ratio",
        "friction::LikelihoodRatioDetector<{T}, {window:i}>",
        "friction::LikelihoodRatioDetector::with_ratio(NOISE, friction::LikelihoodRatio::new({threshold})?)?",
    ),
    row(
        "stick_slip",
        "friction::StickSlipDetector<{T}>",
        "friction::StickSlipDetector::new(friction::DropDetector::new(NOISE)?)",
    ),
    row(
        "adaptive_drop",
        "friction::AdaptiveDropDetector<{T}>",
        "friction::AdaptiveDropDetector::new(NOISE, {false_alarms_per_minute}, {sample_rate})?",
    ),
];

/// The choice that a section names.
pub(super) fn chosen<'a>(keys: &'a Table, key: &str) -> &'a str {
    keys.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn numbers<'a, T: Real>(numbers: impl IntoIterator<Item = &'a T>) -> Value {
    Value::Array(numbers.into_iter().map(|number| Value::Float(number.to_f64())).collect())
}

fn bad(bad: BadParameter) -> ExportError {
    SceneProblem::Friction(bad).into()
}

impl<T: Real + DeserializeOwned> Writer<T> {
    /// The contact model of `[contact]`, under its skin if it has one.
    pub(super) fn model(
        &mut self,
        contact: &Table,
        uncertainty: Option<&Uncertainty<T>>,
    ) -> Result<Typed, ExportError> {
        let mut keys = contact.clone();
        if let Some(gap) = contact.get("greatest_gap_m").and_then(number).filter(|gap| *gap > 0.0) {
            keys.insert("gap_m".to_owned(), Value::Float(gap));
        }
        let name = chosen(contact, "model");
        if name == "auto" {
            let point = self.choice(MODELS, "contact", "point", &keys)?.make;
            let soft = self.choice(MODELS, "contact", "soft_finger", &keys)?.make;
            let noise =
                uncertainty.ok_or_else(|| ExportError::Missing { key: "uncertainty".to_owned() })?.at_rest();
            keys.insert("variances".to_owned(), numbers(noise.diagonal().iter()));
            let Typed { of, make } = self.choice(MODELS, "contact", name, &keys)?;
            return Ok(Typed { of, make: make.replace("(point, soft, ", &format!("({point}, {soft}, ")) });
        }
        let rigid = self.choice(MODELS, "contact", name, &keys)?;
        let Some(Value::Table(skin)) = contact.get("skin") else { return Ok(rigid) };
        let law = self.choice(SKINS, "contact.skin", chosen(skin, "law"), skin)?;
        let share = self.fill("{?.with_share({skin_share})??}", contact)?;
        Ok(Typed {
            of: format!("contact::Compliant<{}, {}, {}>", Self::scalar(), rigid.of, law.of),
            make: format!("contact::Compliant::new({}, {}){share}", rigid.make, law.make),
        })
    }

    /// The limit of `[friction]`; `limit` is the same, made.
    pub(super) fn limit(&mut self, friction: &Table, limit: &Limit<T>) -> Result<Typed, ExportError> {
        let mut keys = friction.clone();
        let mut derive = |key: &str, value: Value| keys.insert(key.to_owned(), value);
        match limit {
            Limit::Anisotropic(limit) => {
                let [first, second]: [Vector3<T>; 2] = limit.directions();
                derive("first", numbers(first.iter()));
                derive("second", numbers(second.iter()));
                derive("coefficients", numbers(&limit.coefficients()));
            }
            Limit::Uncertain { cautious, .. } => {
                derive("cautious", Value::Float(cautious.coefficient().to_f64()));
            }
            _ => {}
        }
        self.choice(LIMITS, "friction", chosen(friction, "limit"), &keys)
    }

    /// The detector of `[slip]`. What is worked out of false alarms is a number, so that it costs no time where it runs.
    pub(super) fn detector(
        &mut self,
        slip: &Table,
        limit: Option<&Limit<T>>,
        sample_rate: Option<f64>,
    ) -> Result<Typed, ExportError> {
        let mut keys = slip.clone();
        let mut derive = |key: &str, value: Value| keys.insert(key.to_owned(), value);
        if let Some(limit) = limit {
            derive("coefficient", Value::Float(limit.coefficient().to_f64()));
        }
        let alarms = slip.get("false_alarms_per_minute").and_then(number).zip(sample_rate);
        match (chosen(slip, "detector"), alarms) {
            ("drop", Some((alarms, rate))) => {
                let sum = Cusum::for_false_alarms(T::literal(ALLOWANCE), alarms, rate).map_err(bad)?;
                derive("allowance", Value::Float(sum.allowance().to_f64()));
                derive("threshold", Value::Float(sum.threshold().to_f64()));
            }
            ("drop", None) => {
                derive("usual", Value::Boolean(true));
            }
            ("likelihood_ratio", Some((alarms, rate))) => {
                let threshold =
                    likelihood_ratio_threshold(WINDOW, run_length_for(alarms, rate)).map_err(bad)?;
                derive("threshold", Value::Float(threshold));
                derive("window", Value::Integer(i64::try_from(WINDOW).unwrap_or(i64::MAX)));
            }
            ("adaptive_drop", Some((_, rate))) => {
                derive("sample_rate", Value::Float(rate));
            }
            _ => {}
        }
        let noise = self.fill(NOISE, slip)?;
        let Typed { of, make } = self.choice(DETECTORS, "slip", chosen(slip, "detector"), &keys)?;
        Ok(Typed { of, make: make.replace("NOISE", &noise) })
    }
}
