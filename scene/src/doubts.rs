//! What a scene can say and hardly means.

use fingertip::surfaces::{DynSurface, SmoothSurface};
use toml::{Table, Value};

use crate::surface::ShapeSource;

/// Longer than any fingertip \[m\].
const LONG: f64 = 0.5;
/// Smaller than any fingertip, from its middle \[m\].
const SHORT: f64 = 1e-4;
/// Coefficients beyond these are of no skin or rubber.
const COEFFICIENTS: [f64; 2] = [0.05, 2.5];
/// Slower, a fall of the friction ratio passes between two samples \[Hz\].
const SLOW: f64 = 200.0;

/// Sentences about what is implausible in a scene that can be read, with the key. `shape` is what its section `[surface]`
/// is read as, and `surface` what that became.
pub(crate) fn of(scene: &Table, shape: &ShapeSource, surface: &DynSurface<f64>) -> Vec<String> {
    let mut doubts = Vec::new();
    match shape {
        ShapeSource::Here(value) => {
            lengths("surface", "", value, &mut doubts);
            doubts.extend(tiny(surface));
        }
        ShapeSource::MeshFile { metres_per_unit, .. } => doubts.extend(size(*metres_per_unit, surface)),
        // Its keys are those of the scene.
        ShapeSource::Formula(_) => {
            scene.get("surface").into_iter().for_each(|value| lengths("surface", "", value, &mut doubts));
            doubts.extend(tiny(surface));
        }
    }
    for section in ["pose", "map"] {
        if let Some(value) = scene.get(section) {
            lengths(section, "", value, &mut doubts);
        }
    }
    let number = |section: &str, key: &str| scene.get(section)?.get(key).and_then(as_number);
    for key in ["static_coefficient", "coefficient_along", "coefficient_across"] {
        if let Some(found) = number("friction", key)
            && !(COEFFICIENTS[0]..=COEFFICIENTS[1]).contains(&found)
        {
            doubts.push(format!(
                "`{key}` of [friction] is {found}: few materials hold so, most between 0.2 and 1"
            ));
        }
    }
    let noises = [("uncertainty", "force_noise_N"), ("slip", "noise_N"), ("estimate", "noise_N")]
        .map(|(section, key)| Some((section, key, number(section, key)?)));
    let deviations = number("contact", "least_force_deviations");
    if let Some(found) = deviations.filter(|deviations| *deviations < 3.0) {
        doubts.push(format!(
            "`least_force_deviations` of [contact] is {found}, less than three: noise will pass for contacts"
        ));
    }
    let least = number("contact", "least_force_N").unwrap_or(0.0);
    let greatest = noises.iter().flatten().max_by(|a, b| a.2.total_cmp(&b.2));
    if let Some((section, key, noise)) = greatest
        && deviations.is_none()
        && least < 3.0 * noise
    {
        doubts.push(format!(
            "`least_force_N` of [contact] is {least}, less than three times the `{key}` of [{section}], {noise}: noise \
             will pass for contacts"
        ));
    }
    let smallest = noises.iter().flatten().min_by(|a, b| a.2.total_cmp(&b.2));
    if let (Some(least), Some(most)) = (smallest, greatest)
        && most.2 > 3.0 * least.2
    {
        doubts.push(format!(
            "`{}` of [{}] is {} and `{}` of [{}] is {}, though both are of one sensor",
            least.1, least.0, least.2, most.1, most.0, most.2
        ));
    }
    let detector = scene.get("slip").and_then(|slip| slip.get("detector")).and_then(Value::as_str);
    if let (Some("drop" | "adaptive_drop" | "likelihood_ratio" | "stick_slip"), Some(rate)) =
        (detector, number("input", "sample_rate_Hz"))
        && rate < SLOW
    {
        doubts.push(format!(
            "`sample_rate_Hz` of [input] is {rate}: slips pass between two samples; the detector wants some hundred hertz"
        ));
    }
    doubts
}

fn as_number(value: &Value) -> Option<f64> {
    #[allow(clippy::cast_precision_loss, reason = "of lengths and forces")]
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// What is odd about the size of a mesh, whose file says no unit.
fn size(metres_per_unit: f64, mesh: &DynSurface<f64>) -> Option<String> {
    let reach = mesh.extent().radius;
    let odd = if reach > LONG {
        "longer"
    } else if reach < SHORT {
        "smaller"
    } else {
        return None;
    };
    Some(format!(
        "`metres_per_unit` of [surface] is {}, by which the mesh reaches {} m from its middle, {odd} than any fingertip; it \
         is 0.001 for a file in millimetres",
        short(metres_per_unit),
        rounded(reach)
    ))
}

/// What is odd about a shape that is smaller than any fingertip.
fn tiny(surface: &DynSurface<f64>) -> Option<String> {
    let reach = surface.extent().radius;
    (reach < SHORT).then(|| {
        format!(
            "[surface] reaches {} m from its middle, smaller than any fingertip; its lengths are in metres, of which a \
             millimetre is 0.001",
            short(reach)
        )
    })
}

/// A length to the millimetre, or in one digit.
fn rounded(length: f64) -> String {
    if (1e-3..1e6).contains(&length) { format!("{length:.3}") } else { format!("{length:.0e}") }
}

/// A number in few digits, however large or small.
fn short(number: f64) -> String {
    if number == 0.0 || (1e-3..1e6).contains(&number.abs()) {
        format!("{number}")
    } else {
        format!("{number:e}")
    }
}

/// Lengths that are those of a robot, not of its fingertip: by the unit in their key.
fn lengths(section: &str, key: &str, value: &Value, doubts: &mut Vec<String>) {
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| lengths(section, key, value, doubts)),
        Value::Array(list) if !key.ends_with("_m") => {
            list.iter().for_each(|value| lengths(section, key, value, doubts));
        }
        Value::Array(list) => {
            if let Some(value) = list.iter().find(|value| is_long(value)) {
                lengths(section, key, value, doubts);
            }
        }
        other if key.ends_with("_m") && is_long(other) => {
            let found = as_number(other).unwrap_or(0.0);
            doubts.push(format!(
                "`{key}` of [{section}] is {} m, longer than any fingertip; of millimetres it is {}",
                short(found),
                short(found / 1000.0)
            ));
        }
        _ => {}
    }
}

fn is_long(value: &Value) -> bool {
    match value {
        Value::Array(list) => list.iter().any(is_long),
        other => as_number(other).is_some_and(|number| number.abs() > LONG),
    }
}
