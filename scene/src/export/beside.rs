//! What a scene has beside the pipeline: functions of their own, and how they are called.

use fingertip::wrench::Real;
use nalgebra::Matrix6;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::stages::{NOISE, chosen};
use super::template::Writer;
use crate::uncertainty::Uncertainty;

/// A part beside the pipeline: its items, and a comment on how they are called after a sample.
pub(super) struct Beside {
    pub(super) items: String,
    pub(super) call: String,
}

const UNCERTAIN: &str = "
/// What is known of the friction: `slip_probability` of a contact's force.
///
/// # Errors
/// Never for the numbers below.
pub fn friction_model() -> Result<friction::UncertainCoulomb<{T}>, BadTip> {{
    Ok(friction::UncertainCoulomb::new({static_coefficient}, {deviation}, NOISY)?)
}}
";

const ESTIMATE: &str = "
/// For so long after a slip begins the fingertip is taken to slide [s].
pub const SLIDE_S: {T} = {slide_s};

/// Learns the static friction from the peak before each slip.
///
/// # Errors
/// Never for the numbers below.
pub fn static_friction() -> Result<friction::StaticFriction<{T}>, BadTip> {{
    Ok(friction::StaticFriction::new(NOISE, {scatter}, {wander})?)
}}

/// Learns the kinetic friction while the fingertip slides.
///
/// # Errors
/// Never for the numbers below.
pub fn kinetic_friction() -> Result<friction::KineticFriction<{T}>, BadTip> {{
    Ok(friction::KineticFriction::new(NOISE, {memory_s})?)
}}
";

const GRIP: &str = "
/// What commands the grip.
///
/// # Errors
/// Never for the numbers below.
pub fn grip() -> Result<friction::GripController<{T}>, BadTip> {{
    Ok(friction::GripController::new(friction::GripSettings {{
        safety: {safety},
        least: {least_N},
        greatest: {greatest_N},
        rise: {rise_N_per_s},
        fall: {fall_N_per_s},
        slip_boost: {slip_boost},
    }})?)
}}
";

const NOISY: &str = "
/// How sure a wrench is: standard deviations at rest, and relative ones under load.
///
/// # Errors
/// Never for the numbers below.
pub fn wrench_noise() -> Result<contact::WrenchNoise<{T}>, BadTip> {{
    let noise = contact::WrenchNoise::new(nalgebra::Vector6::from({floor:a}), {relative})?;
    Ok(noise)
}}
";

const GEOMETRY: &str = "
/// How sure the size and the place of the surface are.
///
/// # Errors
/// Never for the numbers below.
pub fn geometry() -> Result<contact::GeometryUncertainty<{T}>, BadTip> {{
    let geometry = contact::GeometryUncertainty {{
        offset: {offset},
        position: nalgebra::Matrix3::from_diagonal_element({position}),
        attitude: nalgebra::Matrix3::from_diagonal_element({attitude}),
        pivot: {pivot:v},
    }}
    .checked()?;
    Ok(geometry)
}}
";

const CALIBRATION: &str = "
/// What the fit of the calibration leaves uncertain of a wrench.
///
/// # Errors
/// Never for the numbers below.
pub fn calibration_uncertainty() -> Result<contact::CalibrationUncertainty<{T}>, BadTip> {{
    Ok(contact::CalibrationUncertainty::new(
        nalgebra::Matrix6::from({readings:a}),
        nalgebra::Matrix6::from({loads:a}),
    )?)
}}
";

impl<T: Real + DeserializeOwned> Writer<T> {
    /// A template of items, in which braces of Rust are doubled.
    pub(super) fn items(&mut self, template: &str, keys: &Table) -> Result<String, ExportError> {
        let (open, close) = ('\u{1}'.to_string(), '\u{2}'.to_string());
        let text = self.fill(&template.replace("{{", &open).replace("}}", &close), keys)?;
        Ok(text.replace(&open, "{").replace(&close, "}"))
    }

    /// What is known of a friction with a deviation.
    pub(super) fn friction_model(&mut self, friction: &Table) -> Result<Option<Beside>, ExportError> {
        if chosen(friction, "limit") != "uncertain" {
            return Ok(None);
        }
        let noise = self.fill(&format!("{{?Some({NOISE})?}}"), friction)?;
        let noise = if noise.is_empty() { "None".to_owned() } else { noise };
        Ok(Some(Beside {
            items: self.items(UNCERTAIN, friction)?.replace("NOISY", &noise),
            call: "With `let model = friction_model()?`, the probability that the contact slips is\n    \
                   model.slip_probability(&force)\n"
                .to_owned(),
        }))
    }

    /// What learns the friction.
    pub(super) fn estimate(&mut self, estimate: &Table) -> Result<Beside, ExportError> {
        let noise = self.fill(NOISE, estimate)?;
        Ok(Beside {
            items: self.items(ESTIMATE, estimate)?.replace("NOISE", &noise),
            call: "With `let (mut at_rest, mut sliding) = (static_friction()?, kinetic_friction()?)`\nand `let mut left = \
                   0.0`, the friction is learnt by\n    \
                   let slips = touch.slip == friction::SlipVerdict::Slipping;\n    \
                   left = if slips { SLIDE_S } else { left - time_step };\n    \
                   match &touch.force {\n        \
                       Some(force) if left > 0.0 => {\n            \
                           if slips {\n                \
                               let _ = at_rest.onset();\n            \
                           }\n            \
                           sliding.observe(force, time_step);\n        \
                       }\n        \
                       Some(force) => at_rest.observe(force),\n        \
                       None => left = 0.0,\n    \
                   }\n\
                   and told by `at_rest.estimate()` and `sliding.estimate()`.\n"
                .to_owned(),
        })
    }

    /// What commands the grip; `slips` if there is a detector.
    pub(super) fn grip(&mut self, grip: &Table, slips: bool) -> Result<Beside, ExportError> {
        let verdict = if slips { "touch.slip" } else { "friction::SlipVerdict::Holding" };
        Ok(Beside {
            items: self.items(GRIP, grip)?,
            call: format!(
                "With `let mut grip = grip()?`, the normal force to command next [N] is\n    \
                 match &touch.force {{\n        \
                     Some(force) => grip.command(&tip.friction().0, force, {verdict}, time_step),\n        \
                     None => grip.present(),\n    \
                 }}\n"
            ),
        })
    }

    /// How sure a contact is.
    pub(super) fn uncertainty(
        &mut self,
        uncertainty: &Uncertainty<T>,
        contact: &Table,
    ) -> Result<Beside, ExportError> {
        let mut keys = Table::new();
        let float = |number: T| Value::Float(number.to_f64());
        let noise = &uncertainty.noise;
        keys.insert("floor".to_owned(), Value::Array(noise.floor.iter().map(|x| float(*x)).collect()));
        keys.insert("relative".to_owned(), float(noise.relative));
        keys.insert("probability".to_owned(), float(uncertainty.probability));
        let mut items = self.items(NOISY, &keys)?;
        let geometry = &uncertainty.geometry;
        if !uncertainty.exact {
            keys.insert("offset".to_owned(), float(geometry.offset));
            keys.insert("position".to_owned(), float(geometry.position.m11));
            keys.insert("attitude".to_owned(), float(geometry.attitude.m11));
            keys.insert("pivot".to_owned(), Value::Array(geometry.pivot.iter().map(|x| float(*x)).collect()));
            items.push_str(&self.items(GEOMETRY, &keys)?);
        }
        if let Some(calibration) = &uncertainty.calibration {
            let columns = |matrix: &Matrix6<T>| {
                let column = |column: [T; 6]| Value::Array(column.iter().map(|x| float(*x)).collect());
                Value::Array(matrix.data.0.into_iter().map(column).collect())
            };
            keys.insert("readings".to_owned(), columns(calibration.readings()));
            keys.insert("loads".to_owned(), columns(calibration.loads()));
            items.push_str(&self.items(CALIBRATION, &keys)?);
        }
        let skin = contact.contains_key("skin");
        let parts = Parts { skin, exact: uncertainty.exact, calibrated: uncertainty.calibration.is_some() };
        items.push_str(&covariance(Self::scalar(), jacobian(chosen(contact, "model"), skin), parts));
        let of = [
            (true, "noise", "wrench_noise()?"),
            (parts.calibrated, "calibration", "calibration_uncertainty()?"),
            (!parts.exact, "geometry", "geometry()?"),
        ];
        let of: Vec<_> = of.into_iter().filter(|(is_there, ..)| *is_there).collect();
        let list = |names: Vec<&str>| match names.as_slice() {
            [one] => (*one).to_owned(),
            _ => format!("({})", names.join(", ")),
        };
        let geometry = format!(
            "let {} = {}",
            list(of.iter().map(|(_, name, _)| *name).collect()),
            list(of.iter().map(|(.., made)| *made).collect())
        );
        let last = if skin { "&tip, &touch, before" } else { "&tip, &touch" };
        let given: String = of.iter().map(|(_, name, _)| format!(", &{name}")).collect();
        let call = format!("covariance({last}{given})");
        let before = if skin { "; `before` is the last contact before this sample" } else { "" };
        let probability = self.fill("{probability}", &keys)?;
        Ok(Beside {
            items,
            call: format!(
                "With `{geometry}`, the covariance of the contact is\n    {call}\n\
                 whose `ellipse({probability})` is that of the scene{before}.\n"
            ),
        })
    }
}

/// The derivatives of a contact, as each model knows them; `contact` and `wrench` are the sample's.
pub(super) fn jacobian(model: &str, skin: bool) -> &'static str {
    const OF_POINT: &str = "contact::ContactJacobian::of_point_contact(
        found,
        &touch.wrench,
        &surfaces::SmoothSurface::shape_operator(surface, &found.point),
    )?";
    match (model, skin) {
        ("soft_finger", false) => "contact::ContactJacobian::of_soft_finger_on(found, surface)?",
        ("auto", _) => {
            "match tip.model().test(&touch.wrench)?.choice {
        contact::Choice::SoftFinger => contact::ContactJacobian::of_soft_finger_on(found, surface)?,
        _ => contact::ContactJacobian::of_point_contact(
            found,
            &touch.wrench,
            &surfaces::SmoothSurface::shape_operator(surface, &found.point),
        )?,
    }"
        }
        (_, false) => OF_POINT,
        ("soft_finger", true) => "tip.model().jacobian(&indented, surface)?",
        (_, true) => "tip.model().jacobian(&indented, &touch.wrench, surface)?",
    }
}

/// What takes part in the covariance of a contact.
#[derive(Clone, Copy)]
struct Parts {
    skin: bool,
    /// Whether the geometry is taken to be known exactly.
    exact: bool,
    calibrated: bool,
}

/// The function that tells how sure a contact is.
fn covariance(t: &str, jacobian: &str, Parts { skin, exact, calibrated }: Parts) -> String {
    let (last, found) = if skin {
        (
            format!("    last: Option<&nalgebra::Vector3<{t}>>,\n"),
            "let indented = tip.model().resolve_indented(&touch.wrench, surface, last).ok()?;",
        )
    } else {
        (String::new(), "let found = touch.resolution.contact()?;")
    };
    let (mut parameters, mut of_wrench, mut with) =
        (String::new(), "noise.covariance(&touch.wrench)".to_owned(), "");
    if calibrated {
        parameters += &format!("    calibration: &contact::CalibrationUncertainty<{t}>,\n");
        of_wrench = format!("({of_wrench} + calibration.covariance(&touch.wrench))");
    }
    if !exact {
        parameters += &format!("    geometry: &contact::GeometryUncertainty<{t}>,\n");
        with = ".with_geometry(&jacobian, geometry)";
    }
    format!(
        "\n/// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.\n\
         pub fn covariance<Reading, Verdict>(\n    tip: &Tip,\n    \
             touch: &fingertip::Touch<{t}, Reading, Verdict>,\n{last}    \
             noise: &contact::WrenchNoise<{t}>,\n{parameters}) -> Option<contact::ContactCovariance<{t}>> {{\n    \
             let surface = tip.surface();\n    \
             {found}\n    \
             let jacobian = {jacobian};\n    \
             let covariance = contact::ContactCovariance::new(&jacobian, &{of_wrench});\n    \
             Some(covariance{with})\n}}\n"
    )
}
