//! What a hand scene may ask for beside: what else touches the object, disturbances, and how good the grasp is.

use fingertip::hand::{FingerLimits, Grasp, GraspBall, Hand, Metric, Reach};
use fingertip::wrench::{LineOfAction, Wrench};
use fingertip_recordings::{NumberColumn, Row};
use nalgebra::Vector3;
use serde::Deserialize;

use super::file::MOST;
use super::limits::ROWS;
use crate::opened::Rows;

/// `[object]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectSection {
    #[serde(rename = "mass_kg")]
    mass: f64,
    #[serde(rename = "centre_m", default)]
    centre: [f64; 3],
    #[serde(rename = "gravity_m_per_s2")]
    gravity: Option<[f64; 3]>,
    gravity_columns: Option<String>,
}

/// `[[disturbance]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DisturbanceSection {
    name: String,
    #[serde(rename = "force_N", default)]
    force: [f64; 3],
    #[serde(rename = "at_m", default)]
    at: [f64; 3],
    #[serde(rename = "torque_Nm", default)]
    torque: [f64; 3],
}

/// `[quality]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QualitySection {
    #[serde(rename = "length_m")]
    length: f64,
    #[serde(default)]
    effort: Effort,
    #[serde(rename = "every_s", default = "tenth")]
    every: f64,
}

fn tenth() -> f64 {
    0.1
}

/// What counts as an effort of 1 N.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Effort {
    /// All normal forces together.
    #[default]
    Total,
    /// Each.
    Each,
}

/// What is asked for, checked.
pub(super) struct Beside {
    object: Option<Object>,
    pub(super) disturbances: Vec<(String, Wrench<f64, Hand>)>,
    quality: Option<(Metric<f64>, f64)>,
}

/// What is held.
struct Object {
    mass: f64,
    centre: Vector3<f64>,
    gravity: Vector3<f64>,
    /// The prefix of the columns of gravity, where it is in columns.
    columns: Option<String>,
}

impl ObjectSection {
    fn check(self) -> Result<Object, String> {
        let Self { mass, centre, gravity, gravity_columns } = self;
        if !(mass > 0.0 && mass.is_finite()) {
            return Err(format!("mass_kg = {mass} of [object] must be positive and finite"));
        }
        if gravity.is_some() && gravity_columns.is_some() {
            return Err("gravity of [object] is either fixed or in columns; leave `gravity_m_per_s2` or `gravity_columns` out"
                .to_owned());
        }
        let gravity = gravity.unwrap_or([0.0, 0.0, -9.80665]);
        if !centre.iter().chain(&gravity).all(|x| x.is_finite()) {
            return Err("`centre_m` and `gravity_m_per_s2` of [object] must be finite".to_owned());
        }
        Ok(Object { mass, centre: centre.into(), gravity: gravity.into(), columns: gravity_columns })
    }
}

impl Beside {
    /// Checks the sections.
    pub(super) fn check(
        object: Option<ObjectSection>,
        sections: Vec<DisturbanceSection>,
        quality: Option<QualitySection>,
    ) -> Result<Self, String> {
        let object = object.map(ObjectSection::check).transpose()?;
        let mut disturbances: Vec<(String, Wrench<f64, Hand>)> = Vec::new();
        for DisturbanceSection { name, force, at, torque } in sections {
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if name.is_empty() || !name.chars().all(plain) {
                return Err(format!(
                    "disturbance {name:?}: its name must be of letters, digits and _, since a column is named by it"
                ));
            }
            if disturbances.iter().any(|(other, _)| *other == name) {
                return Err(format!("disturbance {name:?}: another one has this name; give each its own"));
            }
            let wrench = Wrench::from_force_at(&at.into(), force.into())
                + Wrench::on_fingertip(Vector3::zeros(), torque.into());
            if !wrench.is_finite() || wrench.components().amax() == 0.0 {
                return Err(format!(
                    "disturbance {name:?}: `force_N` or `torque_Nm` must be other than zero, and all finite"
                ));
            }
            disturbances.push((name, wrench));
        }
        let quality = match quality {
            Some(QualitySection { length, effort, every }) => {
                if !(length > 0.0 && length.is_finite()) {
                    return Err(format!("length_m = {length} of [quality] must be positive and finite"));
                }
                if !(every >= 0.0 && every.is_finite()) {
                    return Err(format!("every_s = {every} of [quality] must be finite and not negative"));
                }
                let metric = match effort {
                    Effort::Total => Metric::Total { length },
                    Effort::Each => Metric::Each { length },
                };
                Some((metric, every))
            }
            None => None,
        };
        Ok(Self { object, disturbances, quality })
    }

    /// The columns of gravity that a recording must have.
    pub(super) fn gravity_names(&self) -> Vec<String> {
        let prefix = self.object.as_ref().and_then(|object| object.columns.as_ref());
        let names =
            |prefix: &String| ["x", "y", "z"].map(|axis| format!("{prefix}_{axis}_m_per_s2")).to_vec();
        prefix.map(names).unwrap_or_default()
    }

    pub(super) fn knows_object(&self) -> bool {
        self.object.is_some()
    }

    pub(super) fn asks_quality(&self) -> bool {
        self.quality.is_some()
    }

    /// What is summed up of it, in words: as [`Answers::told`].
    pub(super) fn names(&self) -> Vec<String> {
        let other = self.object.iter().map(|_| "what else touches: its force".to_owned());
        let reaches = self.disturbances.iter().map(|(name, _)| format!("reach: times {name}"));
        let quality = self.quality.iter().map(|_| "ball that 1 N of effort surely bears".to_owned());
        other.chain(reaches).chain(quality).collect()
    }
}

/// What is asked for beside of one recording after row.
pub(super) struct Asked<'a> {
    beside: &'a Beside,
    gravity: Vec<NumberColumn>,
    /// When the quality is looked at next \[s\].
    next: f64,
}

/// What else touches the object, and the line of its force if it has one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Other {
    pub(super) wrench: Wrench<f64, Hand>,
    pub(super) line: Option<LineOfAction<f64>>,
}

/// How good a grasp is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quality {
    pub(super) closure: Option<bool>,
    pub(super) ball: GraspBall<f64, Hand>,
}

/// The answers of a row.
pub(super) struct Answers {
    pub(super) other: Option<Other>,
    /// Of each disturbance.
    pub(super) reaches: Vec<Reach<f64>>,
    pub(super) quality: Option<Quality>,
}

impl Answers {
    /// The numbers that are summed up; none of a reach without limit.
    pub(super) fn told(&self, beside: &Beside) -> Vec<Option<f64>> {
        let force = self.other.map(|other| other.wrench.force().norm());
        let other = beside.object.iter().map(|_| force);
        let reaches = self.reaches.iter().map(|reach| match reach {
            Reach::Times(times) => Some(*times),
            Reach::Unlimited | Reach::NotHeld | Reach::Unknown => None,
        });
        let quality = beside.quality.iter().map(|_| self.quality.map(|quality| quality.ball.certified));
        other.chain(reaches).chain(quality).collect()
    }
}

impl<'a> Asked<'a> {
    /// `None` if a column of gravity is not there.
    pub(super) fn new(beside: &'a Beside, reader: &mut Rows) -> Option<Self> {
        let gravity = beside.gravity_names().iter().map(|name| reader.watch(name)).collect::<Option<_>>()?;
        Some(Self { beside, gravity, next: f64::NEG_INFINITY })
    }

    /// What else touches the object beside the fingers, from what these feel together.
    pub(super) fn other(&self, row: &Row<'_>, load: &Wrench<f64, Hand>) -> Option<Other> {
        let object = self.beside.object.as_ref()?;
        let mut gravity = object.gravity;
        for (axis, column) in gravity.iter_mut().zip(&self.gravity) {
            *axis = row.number(column).filter(|x| x.is_finite())?;
        }
        let wrench = *load - Wrench::from_force_at(&object.centre, gravity * object.mass);
        Some(Other { wrench, line: wrench.line_of_action().ok() })
    }

    /// How far each disturbance can grow beside a load; `None` for a load that is not known.
    pub(super) fn reaches(
        &self,
        grasp: &Grasp<f64, MOST>,
        limits: &[FingerLimits<f64, ROWS>; MOST],
        load: Option<&Wrench<f64, Hand>>,
    ) -> Vec<Reach<f64>> {
        let reach = |(_, disturbance): &(String, Wrench<f64, Hand>)| {
            load.map_or(Reach::Unknown, |load| grasp.reach(limits, load, disturbance))
        };
        self.beside.disturbances.iter().map(reach).collect()
    }

    /// How good the grasp is, where it is time to look at it.
    pub(super) fn quality(&mut self, time: f64, grasp: &Grasp<f64, MOST>) -> Option<Quality> {
        let (metric, every) = self.beside.quality?;
        if time < self.next || grasp.touching() == 0 {
            return None;
        }
        self.next = time + every;
        Some(Quality { closure: grasp.force_closure(), ball: grasp.ball(metric)? })
    }
}
