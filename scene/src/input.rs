//! `[input]`: what is recorded.

use fingertip::wrench::{Real, Wrench};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::columns::{ColumnsSection, UnitsSection};

/// Which of the two opposite loads of a contact the recording holds.
///
/// ```
/// use fingertip_scene::Convention;
/// use nalgebra::Vector3;
///
/// // A sensor that reads 2 N up, since the fingertip presses on what is above it.
/// let reads = Vector3::new(0.0, 0.0, 2.0);
/// assert_eq!(Convention::Reaction.wrench(reads, Vector3::zeros()).force().z, -2.0);
/// assert_eq!(Convention::OnFingertip.wrench(reads, Vector3::zeros()).force().z, 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// The load that the environment applies to the fingertip.
    OnFingertip,
    /// The load that the fingertip applies to the environment.
    Reaction,
}

impl Convention {
    /// The load on the fingertip.
    #[inline]
    pub fn wrench<T: Real>(self, force: Vector3<T>, torque: Vector3<T>) -> Wrench<T> {
        match self {
            Self::OnFingertip => Wrench::on_fingertip(force, torque),
            Self::Reaction => Wrench::from_reaction(force, torque),
        }
    }
}

const fn yes() -> bool {
    true
}

/// `[input]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InputSection {
    pub(crate) convention: Convention,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sensor: Option<String>,
    #[serde(rename = "sample_rate_Hz", skip_serializing_if = "Option::is_none")]
    pub(crate) sample_rate: Option<f64>,
    #[serde(rename = "rest_s", skip_serializing_if = "Option::is_none")]
    pub(crate) rest: Option<f64>,
    /// Whether the first line of a recording names its columns.
    #[serde(default = "yes")]
    pub(crate) header: bool,
    #[serde(default)]
    pub(crate) columns: ColumnsSection,
    #[serde(default)]
    pub(crate) units: UnitsSection,
}
