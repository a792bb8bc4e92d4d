//! `fingertip.fit_object`: what shape an object has that was touched.

use fingertip_calibration::object::{
    Concave, FittedObject, ObjectPoint, PoseNoise, fit_cylinder, fit_plane, fit_sphere, to_ply,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::{errors, numbers};

/// A touch a row: point, outward normal, covariance and shape operator.
const WIDTH: usize = 24;

fn touches(given: &Bound<'_, PyAny>) -> PyResult<Vec<ObjectPoint>> {
    let table: DMatrix<f64> = numbers::table(given, "touches")?;
    if table.ncols() != WIDTH {
        return Err(errors::bad(format!("touches have {WIDTH} numbers each, not {}", table.ncols())));
    }
    let touch = |numbers: Vec<f64>| {
        let vector = |at: usize| Vector3::from_iterator(numbers.iter().skip(at).copied());
        let matrix = |at: usize| Matrix3::from_row_iterator(numbers.iter().skip(at).copied());
        ObjectPoint { point: vector(0), normal: vector(3), covariance: matrix(6), bend: matrix(15) }
    };
    Ok(table.row_iter().map(|row| touch(row.iter().copied().collect())).collect())
}

/// What is told of any shape.
fn told<'py, S>(py: Python<'py>, fit: &FittedObject<S>, probability: f64) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("concave", fit.concave == Concave::Yes)?;
    found.set_item("deviations", numpy::PyArray1::from_slice(py, &fit.deviations))?;
    found.set_item("half_widths", numpy::PyArray1::from_vec(py, fit.half_widths(probability)))?;
    found.set_item("distance", fit.distance)?;
    found.set_item("angle", fit.angle)?;
    found.set_item("noise_scale", fit.noise_scale)?;
    Ok(found)
}

/// A plane, sphere or cylinder through touches: the parts of a `FittedObject`.
#[pyfunction]
pub(crate) fn fit_touches<'py>(
    py: Python<'py>,
    shape: &str,
    rows: &Bound<'py, PyAny>,
    position: f64,
    turn: f64,
    probability: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let touches = touches(rows)?;
    let noise = PoseNoise::new(position, turn).map_err(errors::bad)?;
    if !(probability > 0.0 && probability < 1.0) {
        return Err(errors::bad(format!("`probability` must lie between 0 and 1, not {probability}")));
    }
    match shape {
        "plane" => {
            let fit = py.detach(|| fit_plane(&touches, noise)).map_err(errors::bad)?;
            let found = told(py, &fit, probability)?;
            found.set_item("point", numbers::array(py, &fit.shape.point()))?;
            found.set_item("direction", numbers::array(py, &fit.shape.outward()))?;
            Ok(found)
        }
        "sphere" => {
            let fit = py.detach(|| fit_sphere(&touches, noise)).map_err(errors::bad)?;
            let found = told(py, &fit, probability)?;
            found.set_item("point", numbers::array(py, &fit.shape.centre()))?;
            found.set_item("radius", fit.shape.radius())?;
            Ok(found)
        }
        "cylinder" => {
            let fit = py.detach(|| fit_cylinder(&touches, noise)).map_err(errors::bad)?;
            let found = told(py, &fit, probability)?;
            found.set_item("point", numbers::array(py, &fit.shape.centre()))?;
            found.set_item("direction", numbers::array(py, &fit.shape.axis()))?;
            found.set_item("radius", fit.shape.radius())?;
            Ok(found)
        }
        _ => Err(errors::bad(format!(
            "`shape` {shape:?} is not known; there are \"plane\", \"sphere\" and \"cylinder\""
        ))),
    }
}

/// Touches as the text of a PLY file.
#[pyfunction]
pub(crate) fn touches_to_ply(rows: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(to_ply(&touches(rows)?))
}
