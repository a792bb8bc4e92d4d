//! `fingertip.RollingCurvature`: how an object is curved, by rolling over it.

use fingertip::contact::{FingerVelocity, NoCurvature, ObjectCurvature, RollingCurvature, Sighting};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::contact::PyContact;
use crate::model::PyJacobian;
use crate::touch::PyTracked;
use crate::{errors, numbers, value};

/// How an object is curved where it touches, by how the contact moves while the finger rolls over it without sliding, in
/// two directions.
///
/// Parameters
/// ----------
/// radius : float
///     Of the fingertip, about [m].
///
/// Notes
/// -----
/// Copies and pickles keep what it has learnt.
#[pyclass(name = "RollingCurvature", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyRolling(RollingCurvature<f64>);

value::learner_class!(PyRolling);

#[pymethods]
impl PyRolling {
    #[new]
    fn new(radius: f64) -> PyResult<Self> {
        RollingCurvature::new(radius).map(Self).map_err(errors::bad)
    }

    /// Takes a sample while the finger rolls.
    ///
    /// Parameters
    /// ----------
    /// tracked : Tracked
    ///     Where the contact is by all samples so far.
    /// contact : Contact
    ///     Where this sample sees it.
    /// jacobian : ContactJacobian
    /// covariance : array_like, shape (6, 6)
    ///     Of the wrench.
    /// linear, angular : array_like, shape (3,)
    ///     Velocity of the sensor's origin over the object [m/s], and turning [rad/s], in the sensor frame.
    /// curvature : array_like, shape (2, 2)
    ///     Of the finger there, along the tangents of `tracked` [1/m].
    /// time_step : float
    ///     Since the sample before [s].
    #[allow(clippy::too_many_arguments, reason = "what a sample is")]
    fn roll(
        &mut self,
        tracked: &PyTracked,
        contact: &PyContact,
        jacobian: &PyJacobian,
        covariance: &Bound<'_, PyAny>,
        linear: &Bound<'_, PyAny>,
        angular: &Bound<'_, PyAny>,
        curvature: &Bound<'_, PyAny>,
        time_step: f64,
    ) -> PyResult<()> {
        let covariance = numbers::matrix::<6, 6>(covariance, "covariance")?;
        let (linear, angular) = (numbers::three(linear, "linear")?, numbers::three(angular, "angular")?);
        let curvature = numbers::matrix::<2, 2>(curvature, "curvature")?;
        let sighting = Sighting::of(&contact.0, &jacobian.0, &covariance);
        let sighting = sighting.ok_or_else(|| errors::bad("how sure the contact is cannot be said"))?;
        self.0.roll(&tracked.0, &sighting, &FingerVelocity { linear, angular }, &curvature, time_step);
        Ok(())
    }

    /// The curvature of the object along two tangents [1/m], shape (2, 2); the covariance of its entries 11, 12 and 22;
    /// and the tangents.
    ///
    /// Raises
    /// ------
    /// FingertipError
    ///     It did not roll, or in one direction alone.
    fn find<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, [Bound<'py, PyArray1<f64>>; 2])>
    {
        let found: Result<ObjectCurvature<f64>, NoCurvature> = self.0.find();
        let ObjectCurvature { curvature, covariance, tangents } = found.map_err(errors::bad)?;
        let tangents = tangents.map(|tangent| numbers::array(py, &tangent));
        Ok((numbers::array2(py, &curvature), numbers::array2(py, &covariance), tangents))
    }

    /// Forgets all samples.
    fn reset(&mut self) {
        self.0.reset();
    }
}
