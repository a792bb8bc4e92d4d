//! One error for programs that build a fingertip.

use fingertip_surfaces::BadShape;
use fingertip_wrench::gauge_layout::LayoutError;
use fingertip_wrench::{LeastSquaresError, SensorMatrixError, SingularMatrix, TareError, TransformError};
use thiserror::Error;

/// What can be wrong with the parts of a [`Fingertip`](crate::Fingertip): every constructor's error becomes it by `?`.
///
/// ```
/// use fingertip::contact::PointContact;
/// use fingertip::surfaces::Sphere;
/// use fingertip::wrench::Wrench;
/// use fingertip::{Error, Fingertip};
/// use nalgebra::Vector3;
///
/// fn height(radius: f64) -> Result<Option<f64>, Error> {
///     let ball = Sphere::centred(radius)?;
///     let mut tip = Fingertip::builder().contact(ball, PointContact::new(0.1)?).build();
///     let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
///     Ok(tip.sense_wrench(push, 1e-3).point().map(|point| point.z))
/// }
///
/// assert_eq!(height(0.013), Ok(Some(0.013)));
/// assert!(matches!(height(-1.0), Err(Error::Shape(_))));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A shape, a contact model or an uncertainty.
    #[error(transparent)]
    Shape(#[from] BadShape),
    /// A friction limit, a detector or a controller.
    #[cfg(feature = "friction")]
    #[error(transparent)]
    Friction(#[from] fingertip_friction::BadParameter),
    /// A sensor matrix.
    #[error(transparent)]
    Sensor(#[from] SensorMatrixError),
    /// A layout of gauges.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// A matrix that no solver can solve.
    #[error(transparent)]
    Singular(#[from] SingularMatrix),
    /// More gauges than components, and no solution.
    #[error(transparent)]
    LeastSquares(#[from] LeastSquaresError),
    /// A zero that could not be taken.
    #[error(transparent)]
    Tare(#[from] TareError),
    /// A transform between frames.
    #[error(transparent)]
    Transform(#[from] TransformError),
}
