//! A scene as a library for C: a package of Rust around the module of the scene, and the header.

mod border;
mod header;

use fingertip::wrench::Real;
use fingertip_calibration::file::{CalibrationFile, Scalar};
use serde::de::DeserializeOwned;
use toml::Value;

use super::ExportError;
use super::module::{MIXED_PRECISION, Module, of as module_of};
use crate::scene::Scene;

/// A scene as a library for C, before it is compiled: [`Scene::to_c`].
///
/// ```
/// use fingertip_scene::{Scalar, Scene};
///
/// let scene = Scene::from_text(
///     "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n",
/// )?;
/// let library = scene.to_c(Scalar::F32, None, "thumb")?;
/// assert!(library.border().contains("extern \"C\" fn thumb_sense("));
/// assert!(library.header(96).contains("uint32_t thumb_sense("));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CLibrary {
    name: String,
    title: String,
    scalar: Scalar,
    text: String,
    gauges: Option<usize>,
    is_warm: bool,
    range: Option<[f64; 2]>,
    has_limit: bool,
    has_detector: bool,
    has_grip: bool,
    features: Vec<&'static str>,
    /// Sections of which the library tells nothing.
    untold: Vec<&'static str>,
}

impl CLibrary {
    pub(super) fn of<T: Real + DeserializeOwned>(
        scene: &Scene,
        scalar: Scalar,
        calibration: Option<&CalibrationFile>,
        name: &str,
    ) -> Result<Self, ExportError> {
        let good = |(at, letter): (usize, char)| {
            letter.is_ascii_lowercase() || (at > 0 && (letter.is_ascii_digit() || letter == '_'))
        };
        if name.is_empty() || !name.char_indices().all(good) {
            return Err(ExportError::Name { name: name.to_owned() });
        }
        let has = |section: &str| matches!(scene.document.get(section), Some(Value::Table(_)));
        if let Some(section) = ["tracking", "estimate", "fusion"].into_iter().find(|section| has(section)) {
            let what = format!("the section [{section}], of which a touch for C tells nothing,");
            return Err(ExportError::NoType { what });
        }
        if let Some(section) = ["payload", "filter"].into_iter().find(|section| has(section)) {
            let what = format!("the section [{section}], for which the functions for C have no place,");
            return Err(ExportError::NoType { what });
        }
        let Module { text, gauges, is_warm, range, has_limit, has_detector, features } =
            module_of::<T>(scene, scalar, calibration)?;
        let has_grip = has("grip") && has_limit;
        let untold = has("uncertainty").then_some("uncertainty").into_iter().collect();
        let (name, title) = (name.to_owned(), scene.name().replace(['\n', '\r'], " "));
        Ok(Self {
            name,
            title,
            scalar,
            text,
            gauges,
            is_warm,
            range,
            has_limit,
            has_detector,
            has_grip,
            features,
            untold,
        })
    }

    /// The smallest library: single precision that is never refined in double. Contacts at flat angles and under large spin
    /// torques are less exact, others are the same. In double precision it changes nothing.
    ///
    /// ```
    /// # use fingertip_scene::{Scalar, Scene};
    /// # let text = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
    /// let library = Scene::from_text(text)?.to_c(Scalar::F32, None, "thumb")?.without_mixed_precision();
    /// assert!(!library.manifest("path = \"..\"").contains("mixed-precision"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn without_mixed_precision(mut self) -> Self {
        self.features.retain(|feature| *feature != MIXED_PRECISION);
        self
    }

    /// Whether its answers are those of the scene to the last bit: not without the refinement in double precision.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.scalar == Scalar::F64 || self.features.contains(&MIXED_PRECISION)
    }

    /// The module of the scene, `scene.rs` of the package.
    #[must_use]
    pub fn module(&self) -> &str {
        &self.text
    }

    /// The functions for C, `lib.rs` of the package.
    #[must_use]
    pub fn border(&self) -> String {
        border::text(self)
    }

    /// `Cargo.toml` of the package, where `fingertip` is a dependency with this source, such as `path = "…"`.
    #[must_use]
    pub fn manifest(&self, fingertip: &str) -> String {
        let features: Vec<String> = self.features.iter().map(|feature| format!("{feature:?}")).collect();
        format!(
            "[package]\nname = \"{}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n\
             [lib]\npath = \"lib.rs\"\ncrate-type = [\"staticlib\"]\n\n\
             [dependencies]\nfingertip = {{ {fingertip}, default-features = false, features = [{}] }}\n\n\
             [profile.release]\nopt-level = 3\ncodegen-units = 1\nlto = \"fat\"\npanic = \"abort\"\n\n[workspace]\n",
            self.name,
            features.join(", ")
        )
    }

    /// The header, for a state of so many bytes: the number behind [`MARK`](Self::MARK) in the compiled library.
    #[must_use]
    pub fn header(&self, state_bytes: usize) -> String {
        header::text(self, state_bytes)
    }

    /// What stands before the size of the state in the compiled library, in decimal digits.
    pub const MARK: &'static str = "fingertip: bytes of state: ";

    /// The size of the state that a compiled library tells; `None` of another file.
    #[must_use]
    pub fn state_bytes(compiled: &[u8]) -> Option<usize> {
        let mark = Self::MARK.as_bytes();
        let at = compiled.windows(mark.len()).position(|window| window == mark)?;
        let digits = compiled.get(at + mark.len()..)?.iter().take_while(|byte| byte.is_ascii_digit());
        digits.fold(None, |number: Option<usize>, digit| {
            number.unwrap_or(0).checked_mul(10)?.checked_add(usize::from(digit - b'0'))
        })
    }

    /// How many numbers a sample is: gauges, or the six of a wrench.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.gauges.unwrap_or(6)
    }

    /// Whether a sample is of gauges, not a wrench.
    #[must_use]
    pub const fn takes_gauges(&self) -> bool {
        self.gauges.is_some()
    }

    /// Whether a sample has a temperature.
    #[must_use]
    pub const fn is_warm(&self) -> bool {
        self.is_warm
    }

    /// Whether it has the normal force to command.
    #[must_use]
    pub const fn has_grip(&self) -> bool {
        self.has_grip
    }

    /// Sections of the scene of which the library tells nothing.
    #[must_use]
    pub fn untold(&self) -> &[&'static str] {
        &self.untold
    }

    /// Whether it takes its memory of `malloc`, once: meshes and heightfields.
    #[must_use]
    pub fn needs_heap(&self) -> bool {
        self.features.contains(&"alloc")
    }

    const fn scalar_in_c(&self) -> &'static str {
        match self.scalar {
            Scalar::F32 => "float",
            Scalar::F64 => "double",
        }
    }

    const fn scalar_in_rust(&self) -> &'static str {
        match self.scalar {
            Scalar::F32 => "f32",
            Scalar::F64 => "f64",
        }
    }
}
