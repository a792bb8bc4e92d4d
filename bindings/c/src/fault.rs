//! What can go wrong in a call, and how that is told.

use core::ffi::c_char;
use core::num::FpCategory;

use fingertip::friction::BadParameter;
use fingertip::hand::{BadContact, BadHandSettings, BadLimit};
use fingertip::wrench::{TareError, TransformError};
use fingertip_scene::{NoFusion, NoWrench, SceneError, SceneProblem};
use thiserror::Error;

use crate::message::ft_error;

/// How a call ended. Everything but FT_OK leaves what the call was to write as it was.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ft_status {
    /// It did what it says.
    FT_OK = 0,
    /// A pointer is NULL that must not be.
    FT_NULL = 1,
    /// A text is not UTF-8.
    FT_NOT_TEXT = 2,
    /// A file cannot be read.
    FT_UNREADABLE = 3,
    /// A scene is not as it must be: the message names the line, the key and the mend.
    FT_BAD_SCENE = 4,
    /// A number is none, or out of its range.
    FT_BAD_NUMBER = 5,
    /// More or fewer numbers than are taken.
    FT_WRONG_SIZE = 6,
    /// A gauge reads at or beyond the range that its calibration states. The sample is left out.
    FT_SATURATED = 7,
    /// A number of the reading is not finite, or the temperature or the dummy gauge is missing. The sample is left out.
    FT_INCOMPLETE = 8,
    /// The scene has no [sensor] that turns readings into wrenches: use ft_sense_wrench.
    FT_NO_SENSOR = 9,
    /// The scene has a [payload], and how the sensor moves was not told.
    FT_NO_MOTION = 10,
    /// There was no rest, or too short a one.
    FT_NO_REST = 11,
    /// Columns overlap that must not.
    FT_OVERLAP = 12,
    /// The rest may have been none: the sensor moved or was touched.
    FT_DOUBTFUL = 13,
    /// The reading lies beyond what the curved sensor was calibrated for. The sample is left out.
    FT_UNCALIBRATED = 14,
    /// A fault of this library. The handle can be freed; what it would say is not to be trusted.
    FT_INTERNAL = 15,
}

/// A failure before it is told.
#[derive(Debug, Error)]
pub(crate) enum Fault {
    #[error("`{0}` is NULL, and must not be")]
    Null(&'static str),
    #[error("`{0}` is not UTF-8 text")]
    NotText(&'static str),
    #[error(transparent)]
    File(Box<SceneError>),
    #[error(transparent)]
    Scene(Box<SceneProblem>),
    #[error("`{name}` must be {requirement}")]
    Number { name: &'static str, requirement: &'static str },
    #[error("{found} {what} were given, and {needed} are taken")]
    Size { what: &'static str, found: usize, needed: usize },
    #[error("{found} fingers were given, and a hand has from 1 to {most}")]
    Fingers { found: usize, most: usize },
    #[error("finger {finger}: {source}")]
    Contact { finger: usize, source: BadContact },
    #[error(transparent)]
    NoFinger(BadContact),
    #[error("finger {finger}: {source}")]
    Limit { finger: usize, source: BadLimit },
    #[error(transparent)]
    Settings(#[from] BadHandSettings),
    #[error(transparent)]
    Friction(#[from] BadParameter),
    #[error("`hand_from_sensor`: {0}")]
    Pose(TransformError),
    #[error(transparent)]
    Reading(#[from] NoWrench),
    #[error(transparent)]
    Fusion(#[from] NoFusion),
    #[error(transparent)]
    Tare(#[from] TareError),
    #[error("the columns `{0}` and `{1}` overlap")]
    Overlap(&'static str, &'static str),
    #[error("a fault of this library: a panic was caught at its border")]
    Panicked,
}

impl From<SceneProblem> for Fault {
    fn from(problem: SceneProblem) -> Self {
        Self::Scene(Box::new(problem))
    }
}

impl Fault {
    pub(crate) const fn status(&self) -> ft_status {
        match self {
            Self::Null(_) => ft_status::FT_NULL,
            Self::NotText(_) => ft_status::FT_NOT_TEXT,
            Self::File(error) => match **error {
                SceneError::Unreadable { .. } => ft_status::FT_UNREADABLE,
                _ => ft_status::FT_BAD_SCENE,
            },
            Self::Scene(_) | Self::Fusion(NoFusion::NoSection) => ft_status::FT_BAD_SCENE,
            Self::Fusion(NoFusion::AwaitsNoise) => ft_status::FT_NO_REST,
            Self::Size { .. } | Self::Fingers { .. } | Self::Fusion(NoFusion::Readings(_)) => {
                ft_status::FT_WRONG_SIZE
            }
            Self::Number { .. }
            | Self::Contact { .. }
            | Self::NoFinger(_)
            | Self::Limit { .. }
            | Self::Settings(_)
            | Self::Friction(_)
            | Self::Pose(_)
            | Self::Fusion(_) => ft_status::FT_BAD_NUMBER,
            Self::Reading(NoWrench::Saturated) => ft_status::FT_SATURATED,
            Self::Reading(NoWrench::Uncalibrated) => ft_status::FT_UNCALIBRATED,
            Self::Reading(NoWrench::NoSensor) => ft_status::FT_NO_SENSOR,
            Self::Reading(NoWrench::NoMotion) => ft_status::FT_NO_MOTION,
            Self::Reading(_) => ft_status::FT_INCOMPLETE,
            Self::Tare(_) => ft_status::FT_NO_REST,
            Self::Overlap(..) => ft_status::FT_OVERLAP,
            Self::Panicked => ft_status::FT_INTERNAL,
        }
    }

    /// As it is told.
    #[cold]
    pub(crate) fn told(&self) -> ft_error {
        ft_error::of(self.status(), self)
    }
}

/// A number that is finite.
pub(crate) fn finite(name: &'static str, number: f64) -> Result<f64, Fault> {
    match number.classify() {
        FpCategory::Nan | FpCategory::Infinite => Err(Fault::Number { name, requirement: "finite" }),
        _ => Ok(number),
    }
}

/// What a status means, in a sentence. Any number may be given, such as one that was stored.
#[unsafe(no_mangle)]
pub extern "C" fn ft_status_text(status: u32) -> *const c_char {
    let text = match status {
        0 => c"it did what it says",
        1 => c"a pointer is NULL that must not be",
        2 => c"a text is not UTF-8",
        3 => c"a file cannot be read",
        4 => c"a scene is not as it must be",
        5 => c"a number is none, or out of its range",
        6 => c"more or fewer numbers than are taken",
        7 => c"a gauge is saturated",
        8 => c"the reading is incomplete",
        9 => c"the scene has no [sensor] that turns readings into wrenches",
        10 => c"the scene has a [payload], and how the sensor moves was not told",
        11 => c"there was no rest, or too short a one",
        12 => c"columns overlap that must not",
        13 => c"the rest may have been none",
        14 => c"the reading lies beyond what the curved sensor was calibrated for",
        15 => c"a fault of this library",
        _ => c"no status of this library",
    };
    text.as_ptr()
}
