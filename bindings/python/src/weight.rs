//! `fingertip.ObjectWeight`: what an object weighs, and what else touches it.

use fingertip::hand::{Hand, ObjectWeight, OtherContact, UncertainWrench, WeightEstimate};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::hand::wrench;
use crate::{numbers, value};

/// Learns what an object weighs and where its middle is, from what holds it while it is turned.
/// Copies and pickles keep what it has learnt.
#[pyclass(name = "ObjectWeight", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyWeight(ObjectWeight<f64>);

value::learner_class!(PyWeight);

#[pymethods]
impl PyWeight {
    #[new]
    fn new() -> Self {
        Self(ObjectWeight::new())
    }

    /// Takes the load that the fingers bear, its covariance, and gravity in the same frame [m/s²]; `False` for one that
    /// tells nothing.
    fn observe(
        &mut self,
        load: &Bound<'_, PyAny>,
        covariance: &Bound<'_, PyAny>,
        gravity: &Bound<'_, PyAny>,
    ) -> PyResult<bool> {
        let load = uncertain(load, covariance)?;
        Ok(self.0.observe(&load, &numbers::three(gravity, "gravity")?))
    }

    /// Mass [kg] and its deviation, centre of mass [m] and its covariance; `None` before enough is known.
    fn estimate<'py>(
        &self,
        py: Python<'py>,
    ) -> Option<(f64, f64, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
        let WeightEstimate { mass, mass_deviation, centre, centre_covariance } = self.0.estimate()?;
        Some((mass, mass_deviation, numbers::array(py, &centre), numbers::array2(py, &centre_covariance)))
    }

    /// Whether something else than the fingers touches the object, with a probability of a false alarm; `None` before the
    /// weight is known.
    #[pyo3(signature = (load, covariance, gravity, false_alarm=1e-3))]
    fn touches_elsewhere(
        &self,
        load: &Bound<'_, PyAny>,
        covariance: &Bound<'_, PyAny>,
        gravity: &Bound<'_, PyAny>,
        false_alarm: f64,
    ) -> PyResult<Option<bool>> {
        let load = uncertain(load, covariance)?;
        let other = OtherContact::new(&load, &self.0, &numbers::three(gravity, "gravity")?);
        Ok(other.map(|other| other.touches(false_alarm)))
    }

    /// What else touches the object, such as a table or another hand, if anything does.
    ///
    /// Parameters
    /// ----------
    /// load, covariance, gravity : array_like
    ///     As in `observe`.
    ///
    /// Returns
    /// -------
    /// dict or None
    ///     `wrench` of the others on the object about the origin of the frame [N, N·m], its `covariance`, and `statistic`:
    ///     χ² with six degrees of freedom if nothing touches. `line`, if the wrench has a force: the `point` next to the
    ///     origin [m], the unit `direction`, and the `pitch` [m], torque along the line over force; of a single contact without
    ///     friction torque the pitch is zero, and the contact lies on the line. `None` before the weight is known.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from fingertip import ObjectWeight
    /// >>> weight, noise = ObjectWeight(), np.diag([1e-4] * 3 + [1e-8] * 3)
    /// >>> for gravity in ([0, 0, -9.81], [-9.81, 0, 0]):
    /// ...     _ = weight.observe(np.array([*gravity, 0, 0, 0]) * 0.2, noise, gravity)
    /// >>> table = np.array([0, 0, 0.981, *np.cross([0.02, 0, -0.05], [0, 0, 0.981])])
    /// >>> other = weight.elsewhere(np.array([0, 0, -1.962, 0, 0, 0]) + table, noise, [0, 0, -9.81])
    /// >>> round(float(other["line"]["point"][0]), 3), abs(other["line"]["pitch"]) < 1e-9
    /// (0.02, True)
    fn elsewhere<'py>(
        &self,
        py: Python<'py>,
        load: &Bound<'py, PyAny>,
        covariance: &Bound<'py, PyAny>,
        gravity: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let load = uncertain(load, covariance)?;
        let Some(other) = OtherContact::new(&load, &self.0, &numbers::three(gravity, "gravity")?) else {
            return Ok(None);
        };
        let told = PyDict::new(py);
        told.set_item("wrench", numbers::array(py, &other.load.wrench.components()))?;
        told.set_item("covariance", numbers::array2(py, &other.load.covariance))?;
        told.set_item("statistic", other.statistic)?;
        let line = match other.line {
            Ok(found) => {
                let line = PyDict::new(py);
                line.set_item("point", numbers::array(py, &found.line.point))?;
                line.set_item("direction", numbers::array(py, &found.line.direction))?;
                line.set_item("pitch", found.pitch)?;
                Some(line)
            }
            Err(_) => None,
        };
        told.set_item("line", line)?;
        Ok(Some(told))
    }
}

fn uncertain(load: &Bound<'_, PyAny>, covariance: &Bound<'_, PyAny>) -> PyResult<UncertainWrench<f64, Hand>> {
    let covariance = numbers::matrix::<6, 6>(covariance, "covariance")?;
    Ok(UncertainWrench { wrench: wrench(load, "load")?, covariance })
}
