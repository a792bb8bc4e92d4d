//! A scene as what runs without files: Rust with the typed pipeline, or JSON.

mod before;
mod beside;
mod calibrated;
mod followed;
mod formula;
mod fused;
mod json;
mod layout;
mod library;
mod module;
mod resolved;
mod shapes;
mod stages;
mod template;

use fingertip_calibration::file::{CalibrationFile, FileError};
use thiserror::Error;

pub use fingertip_calibration::file::Scalar;
pub use library::CLibrary;

use crate::fault::SceneProblem;
use crate::scene::Scene;

/// Why a scene cannot be exported.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{ExportError, Scalar, Scene};
///
/// let scene = Scene::from_text(BALL)?;
/// let refused = scene.to_c(Scalar::F32, None, "Tip").unwrap_err();
/// assert!(matches!(&refused, ExportError::Name { name } if name == "Tip"));
/// assert!(refused.to_string().contains("is no name for C"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A number of the scene is out of the range of the precision, or a mesh cannot be read any more.
    #[error(transparent)]
    Scene(#[from] SceneProblem),
    /// Something for which there is no type.
    #[error("{what} has no type to export to; take it out of the scene, or run the scene as a file")]
    NoType {
        /// What.
        what: String,
    },
    /// A key that the export of a choice asks for.
    #[error("the scene has no `{key}` that could be exported")]
    Missing {
        /// Which.
        key: String,
    },
    /// The calibration cannot be exported.
    #[error("the calibration cannot be exported: {0}")]
    Calibration(#[from] FileError),
    /// A name that is none in C.
    #[error("{name:?} is no name for C; take small letters, digits and _, and begin with a letter")]
    Name {
        /// As it was written.
        name: String,
    },
    /// Too few gauges for a wrench.
    #[error("the calibration has {found} gauges, and a wrench takes six at least")]
    Gauges {
        /// How many.
        found: usize,
    },
}

impl Scene {
    /// The scene as a Rust module: the typed pipeline (`Tip`), a function that makes it of constants (`tip`), and
    /// functions for what the pipeline has no stage for. It needs `fingertip` alone, no files and no standard
    /// library; a heap for meshes and heightfields alone. Its answers are those of [`Scene::pipeline_in`], bit for bit.
    ///
    /// With the calibration of the sensor, the pipeline begins with its readings, otherwise with wrenches.
    ///
    /// ```
    /// use fingertip_scene::{Scalar, Scene};
    ///
    /// let scene = Scene::from_text(
    ///     r#"
    ///     version = 2
    ///     [input]
    ///     convention = "on_fingertip"
    ///     [surface]
    ///     shape = "sphere"
    ///     radius_m = 0.013
    ///     "#,
    /// )?;
    /// let text = scene.to_rust(Scalar::F32, None)?;
    /// assert!(text.contains("surfaces::Sphere::new(Vector3::zeros(), 0.013)?"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn to_rust(
        &self,
        scalar: Scalar,
        calibration: Option<&CalibrationFile>,
    ) -> Result<String, ExportError> {
        match scalar {
            Scalar::F32 => module::of::<f32>(self, scalar, calibration),
            Scalar::F64 => module::of::<f64>(self, scalar, calibration),
        }
        .map(|module| module.text)
    }

    /// The scene for C: a package that makes a static library of [`to_rust`](Self::to_rust)'s module with three functions
    /// for C, and the header for it. `name` is what all their names begin with.
    ///
    /// # Errors
    /// [`ExportError`], also for a section that tells what has no place in the structure of a touch.
    pub fn to_c(
        &self,
        scalar: Scalar,
        calibration: Option<&CalibrationFile>,
        name: &str,
    ) -> Result<CLibrary, ExportError> {
        match scalar {
            Scalar::F32 => CLibrary::of::<f32>(self, scalar, calibration, name),
            Scalar::F64 => CLibrary::of::<f64>(self, scalar, calibration, name),
        }
    }

    /// The scene as JSON, complete: in the newest version of the format, with all that it leaves to defaults, and a mesh
    /// in the place of its file. Numbers are those of the scene, to the bit; an infinite one is the text `"inf"`.
    ///
    /// # Errors
    /// [`ExportError::Scene`] if the file of a mesh cannot be read any more.
    pub fn to_json(&self) -> Result<String, ExportError> {
        Ok(json::text(toml::Value::Table(resolved::resolve::<f64>(self)?)))
    }
}
