//! The hand scene: which sensors of a recording are the fingertips of one hand, and where they are.

use std::path::{Path, PathBuf};

use fingertip::hand::{ContactFriction, Hand, HandSettings};
use fingertip::wrench::{RigidTransform, Sensor};
use fingertip_calibration::file::read_text;
use fingertip_scene::{Limit, Scene};
use nalgebra::Vector3;
use serde::Deserialize;

use super::beside::{Beside, DisturbanceSection, ObjectSection, QualitySection};
use super::limits::{LimitKeys, Limits};
use crate::error::CliError;
use crate::scene;

/// Most fingers of a hand.
pub(super) const MOST: usize = 8;

/// A hand scene, as it stands in a file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct HandFile {
    version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    hand: HandSection,
    finger: Vec<FingerSection>,
    object: Option<ObjectSection>,
    #[serde(default)]
    disturbance: Vec<DisturbanceSection>,
    quality: Option<QualitySection>,
}

/// `[hand]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct HandSection {
    sensors_in: SensorsIn,
    safety: f64,
    greatest_ratio: f64,
}

impl Default for HandSection {
    fn default() -> Self {
        let greatest_ratio = HandSettings::default().greatest_ratio;
        Self { sensors_in: SensorsIn::Fingers, safety: 1.0, greatest_ratio }
    }
}

/// On which side of the contacts the sensors are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum SensorsIn {
    /// In the fingertips: their normals point into the object.
    Fingers,
    /// In the object, whose pads are pressed by bare fingers: their normals point at the fingers.
    Object,
}

/// `[[finger]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FingerSection {
    name: String,
    scene: PathBuf,
    sensor: Option<String>,
    #[serde(rename = "translation_m", default)]
    translation: [f64; 3],
    #[serde(rename = "rotation_deg", default)]
    rotation: [f64; 3],
    pose_columns: Option<String>,
    friction: Option<f64>,
    #[serde(rename = "torque_arm_m")]
    arm: Option<f64>,
    #[serde(rename = "least_normal_N")]
    least_normal: Option<f64>,
    #[serde(rename = "greatest_normal_N")]
    greatest_normal: Option<f64>,
    cost: Option<f64>,
    #[serde(rename = "greatest_torques_Nm", default)]
    torques: Vec<f64>,
    jacobian: Option<Vec<[f64; 6]>>,
    jacobian_columns: Option<String>,
}

/// A hand scene that was checked.
pub(super) struct HandScene {
    pub(super) name: String,
    pub(super) sensors_in: SensorsIn,
    pub(super) safety: f64,
    pub(super) greatest_ratio: f64,
    pub(super) fingers: Vec<FingerScene>,
    pub(super) beside: Beside,
}

/// One finger of it.
pub(super) struct FingerScene {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) scene: Scene,
    /// The prefix of its columns, if the hand scene gives it.
    pub(super) sensor: Option<String>,
    pub(super) pose: RigidTransform<f64, Hand, Sensor>,
    /// The prefix of the columns of its pose, before `_x_m` and the others.
    pub(super) pose_columns: Option<String>,
    pub(super) friction: ContactFriction<f64>,
    pub(super) limits: Limits,
}

/// The text of a file that is a hand scene: it has a key `finger`. A file that cannot be read is none, and is told of where
/// it is read as a scene.
pub(in crate::analyze) fn text_of(path: &Path) -> Option<String> {
    let text = read_text(path).ok()?;
    let is_hand = text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("finger"));
    is_hand.then_some(text)
}

/// Reads and checks the text of a hand scene whose file is called so, with the scenes of its fingers, which are named from
/// its folder.
pub(super) fn parse(text: &str, path: &Path) -> Result<HandScene, CliError> {
    let bad = |message: String| CliError::Calibrate { path: path.to_owned(), message };
    let file: HandFile = toml::from_str(text).map_err(|error| bad(error.to_string()))?;
    if file.version != 1 {
        return Err(bad(format!(
            "has version {}; this program knows hand scenes of version 1",
            file.version
        )));
    }
    if !(1..=MOST).contains(&file.finger.len()) {
        return Err(bad(format!("has {} [[finger]]; a hand has 1 to {MOST}", file.finger.len())));
    }
    let HandSection { sensors_in, safety, greatest_ratio } = file.hand;
    if !(safety >= 1.0 && safety.is_finite()) {
        return Err(bad(format!("safety = {safety} of [hand] must be at least 1 and finite")));
    }
    if !(greatest_ratio > 0.0 && greatest_ratio.is_finite()) {
        return Err(bad(format!("greatest_ratio = {greatest_ratio} of [hand] must be positive and finite")));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut fingers: Vec<FingerScene> = Vec::new();
    for section in file.finger {
        let named = |message: String| bad(format!("finger {:?}: {message}", section.name));
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if section.name.is_empty() || !section.name.chars().all(plain) {
            return Err(named(
                "its name must be of letters, digits and _, since columns are named by it".to_owned(),
            ));
        }
        if fingers.iter().any(|other| other.name == section.name) {
            return Err(named("another finger has this name; give each its own".to_owned()));
        }
        let finger = finger(section, folder, &fingers, &bad)?;
        fingers.push(finger);
    }
    let beside = Beside::check(file.object, file.disturbance, file.quality).map_err(&bad)?;
    Ok(HandScene { name: file.name, sensors_in, safety, greatest_ratio, fingers, beside })
}

/// `others` are the fingers before it: a scene that several have is read once.
fn finger(
    section: FingerSection,
    folder: &Path,
    others: &[FingerScene],
    bad: &impl Fn(String) -> CliError,
) -> Result<FingerScene, CliError> {
    let name = section.name;
    let named = |message: String| bad(format!("finger {name:?}: {message}"));
    let path = folder.join(&section.scene);
    let read = others.iter().find(|other| other.path == path).map(|other| other.scene.clone());
    let scene = read.map_or_else(|| scene::load(&path), Ok)?;
    let friction = section.friction.or(scene.limit().map(Limit::coefficient)).ok_or_else(|| {
        named(format!("neither `friction` here nor [friction] of {} says how much it holds", path.display()))
    })?;
    let of_scene = match scene.limit() {
        Some(Limit::SoftFinger(limit)) => Some(limit.arm()),
        _ => None,
    };
    let arm = section.arm.or(of_scene);
    let must = |key: &str| named(format!("`{key}` must be positive and finite"));
    let mut friction = ContactFriction::point(friction).map_err(|_| must("friction"))?;
    if let Some(arm) = arm {
        friction = friction.with_arm(arm).map_err(|_| must("torque_arm_m"))?;
    }
    let FingerSection { least_normal, greatest_normal, cost, torques, jacobian, jacobian_columns, .. } =
        section;
    let keys = LimitKeys { least_normal, greatest_normal, cost, torques, jacobian, jacobian_columns };
    let limits = keys.check().map_err(named)?;
    let fixed = section.translation != [0.0; 3] || section.rotation != [0.0; 3];
    if fixed && section.pose_columns.is_some() {
        return Err(named(
            "its pose is either fixed or in columns; leave `pose_columns` or the others out".to_owned(),
        ));
    }
    let rotation = Vector3::from(section.rotation).map(f64::to_radians);
    let pose = RigidTransform::from_axis_angle(rotation, section.translation.into())
        .map_err(|_| named("`translation_m` and `rotation_deg` must be finite".to_owned()))?;
    let (sensor, pose_columns) = (section.sensor, section.pose_columns);
    Ok(FingerScene { name, path, scene, sensor, pose, pose_columns, friction, limits })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rand::{RngExt, SeedableRng};

    use super::parse;

    /// Whatever is changed in a hand scene: it is read, with numbers that can be, or refused in a sentence with its name.
    #[test]
    fn any_change_is_read_or_refused() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/hands/two_pads.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        let odd =
            ["nan", "-inf", "1e308", "-1", "0", "\"\"", "[]", "9223372036854775807", "\u{2028}", "=", "]]"];
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let (mut read, mut refused) = (0, 0);
        for _ in 0..1500 {
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            for _ in 0..random.random_range(1..4) {
                let at = random.random_range(0..lines.len());
                match random.random_range(0..4) {
                    0 => drop(lines.remove(at)),
                    1 => lines.insert(at, lines[random.random_range(0..lines.len())].clone()),
                    2 => {
                        let mut words: Vec<&str> = lines[at].split(' ').collect();
                        let word = random.random_range(0..words.len());
                        words[word] = odd[random.random_range(0..odd.len())];
                        lines[at] = words.join(" ");
                    }
                    _ => {
                        let mut letters: Vec<char> = lines[at].chars().collect();
                        letters
                            .insert(random.random_range(0..=letters.len()), random.random_range(' '..='~'));
                        lines[at] = letters.into_iter().collect();
                    }
                }
            }
            match parse(&lines.join("\n"), &path) {
                Ok(hand) => {
                    read += 1;
                    assert!((1..=super::MOST).contains(&hand.fingers.len()) && hand.safety >= 1.0);
                    assert!(hand.fingers.iter().all(|finger| finger.friction.coefficient() > 0.0
                        && finger.friction.coefficient().is_finite()));
                }
                Err(error) => {
                    refused += 1;
                    let said = error.to_string();
                    assert!(said.contains("two_pads.toml") || said.contains("scene"), "{said}");
                }
            }
        }
        assert!(read > 100 && refused > 100, "{read} read, {refused} refused");
    }
}
