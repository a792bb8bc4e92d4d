//! What is wrong with an ATI calibration file.

use thiserror::Error;

use super::FileError;

/// Why a `.cal` file cannot be used.
///
/// ```
/// use fingertip_calibration::file::{AtiCalibration, AtiError};
///
/// assert!(matches!(AtiCalibration::from_xml("0.1, 0.2, 0.3"), Err(AtiError::NotXml(_))));
/// // What is missing is named.
/// let error = AtiCalibration::from_xml(r#"<FTSensor Serial="FT1"/>"#).unwrap_err();
/// assert!(matches!(error, AtiError::MissingElement { .. }), "{error}");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AtiError {
    /// Not XML.
    #[error("not XML: {0}")]
    NotXml(#[from] roxmltree::Error),
    /// More elements than any such file has.
    #[error("it has more than {most} elements; is it a calibration of ATI's?")]
    TooMany {
        /// So many are read.
        most: usize,
    },
    /// An element is missing.
    #[error("element `{element}` is missing")]
    MissingElement {
        /// Which one.
        element: String,
    },
    /// An attribute is missing.
    #[error("attribute `{attribute}` of element `{element}` is missing")]
    MissingAttribute {
        /// Of which element.
        element: String,
        /// Which one.
        attribute: String,
    },
    /// An attribute is not what it must be.
    #[error("attribute `{attribute}` of element `{element}` is {found:?}: {requirement}")]
    BadAttribute {
        /// Of which element.
        element: String,
        /// Which one.
        attribute: String,
        /// What it says.
        found: String,
        /// What it must be.
        requirement: &'static str,
    },
    /// The frame is turned, and the file has no `UserAxis` elements that would tell how.
    #[error("the frame is turned by (Rx, Ry, Rz) and the file has no UserAxis elements")]
    Turned,
    /// The numbers are no calibration.
    #[error(transparent)]
    Calibration(#[from] FileError),
}
