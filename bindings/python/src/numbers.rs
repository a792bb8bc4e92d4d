//! Numbers from Python and to it.

use nalgebra::{DMatrix, Dim, Matrix, RawStorage, SMatrix, SVector, Vector3};
use numpy::ndarray::Array2;
use numpy::{
    AllowTypeChange, PyArray1, PyArray2, PyArrayDescrMethods, PyArrayLike1, PyArrayLike2, PyUntypedArray,
    PyUntypedArrayMethods, dtype,
};
use pyo3::prelude::*;

use crate::errors;

/// `N` numbers: of an array of double precision without any call to Python, of whatever NumPy makes an array of
/// otherwise.
#[inline]
pub(crate) fn numbers<const N: usize>(given: &Bound<'_, PyAny>, what: &str) -> PyResult<[f64; N]> {
    match of_double_array(given) {
        Some(numbers) => Ok(numbers),
        None => of_anything(given, what),
    }
}

/// The numbers of an array of `N` numbers in double precision, of any stride.
#[inline]
fn of_double_array<const N: usize>(given: &Bound<'_, PyAny>) -> Option<[f64; N]> {
    let array = given.cast::<PyUntypedArray>().ok()?;
    if array.ndim() != 1 || array.len() != N || !array.dtype().is(dtype::<f64>(given.py())) {
        return None;
    }
    let stride = *array.strides().first()?;
    // SAFETY: an array that lives has a header, which this reads.
    let data = unsafe { (*array.as_array_ptr()).data };
    let mut numbers = [0.0; N];
    for (place, number) in (0..).zip(&mut numbers) {
        // SAFETY: the type is that of `f64` in native order, and index `place` is below the length, so NumPy promises
        // eight readable bytes there; they need not be aligned. The interpreter does not run meanwhile.
        *number = unsafe { data.offset(stride * place).cast::<f64>().read_unaligned() };
    }
    Some(numbers)
}

#[cold]
fn of_anything<const N: usize>(given: &Bound<'_, PyAny>, what: &str) -> PyResult<[f64; N]> {
    let numbers = list(given, what)?;
    let count = numbers.len();
    numbers.try_into().map_err(|_| errors::bad(format!("`{what}` must be {N} numbers, not {count}")))
}

/// Numbers, however many.
pub(crate) fn list(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<f64>> {
    let array: PyArrayLike1<'_, f64, AllowTypeChange> = given.extract().map_err(|_| {
        errors::bad(format!("`{what}` must be numbers in one dimension, not {}", kind(given)))
    })?;
    Ok(array.as_array().to_vec())
}

/// A vector of three numbers.
pub(crate) fn three(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vector3<f64>> {
    Ok(Vector3::from(numbers::<3>(given, what)?))
}

/// A matrix of whatever size.
pub(crate) fn table(given: &Bound<'_, PyAny>, what: &str) -> PyResult<DMatrix<f64>> {
    let array: PyArrayLike2<'_, f64, AllowTypeChange> = given.extract().map_err(|_| {
        errors::bad(format!("`{what}` must be numbers in rows and columns, not {}", kind(given)))
    })?;
    let view = array.as_array();
    let (rows, columns) = view.dim();
    Ok(DMatrix::from_row_iterator(rows, columns, view.iter().copied()))
}

/// A matrix of fixed size.
pub(crate) fn matrix<const R: usize, const C: usize>(
    given: &Bound<'_, PyAny>,
    what: &str,
) -> PyResult<SMatrix<f64, R, C>> {
    let table = table(given, what)?;
    if table.shape() == (R, C) {
        return Ok(table.fixed_view::<R, C>(0, 0).into_owned());
    }
    let (rows, columns) = table.shape();
    Err(errors::bad(format!("`{what}` must be {R} × {C} numbers, not {rows} × {columns}")))
}

/// What an argument is, for messages.
pub(crate) fn kind(given: &Bound<'_, PyAny>) -> String {
    let name = given.get_type().name().map_or_else(|_| "that".to_owned(), |name| name.to_string());
    match given.cast::<PyUntypedArray>() {
        Ok(array) => format!("an array of {} of shape {:?}", array.dtype().typeobj(), array.shape()),
        Err(_) => format!("a {name}"),
    }
}

/// A vector as an array.
pub(crate) fn array<'py, const N: usize>(
    py: Python<'py>,
    vector: &SVector<f64, N>,
) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, vector.as_slice())
}

/// A matrix as an array of two dimensions.
pub(crate) fn array2<'py, R: Dim, C: Dim, S: RawStorage<f64, R, C>>(
    py: Python<'py>,
    matrix: &Matrix<f64, R, C, S>,
) -> Bound<'py, PyArray2<f64>> {
    PyArray2::from_owned_array(py, Array2::from_shape_fn(matrix.shape(), |at| matrix[at]))
}
