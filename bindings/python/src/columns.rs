//! Columns of readings, where they lie.

use fingertip::wrench::Real;
use numpy::ndarray::ArrayView1;
use numpy::{
    AllowTypeChange, Element, PyArray1, PyArrayLike1, PyArrayMethods, PyReadonlyArray1, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PySlice;

use crate::errors;
use crate::numbers::kind;

/// A scalar that NumPy has, too.
pub(crate) trait Scalar: Real + Element {
    /// The numbers of a column where they lie, if they are of this type and next to each other.
    fn direct<'a>(column: &View<'a>) -> Option<&'a [Self]>;
}

/// A column that is kept while it is read.
pub(crate) enum Column<'py> {
    Double(PyReadonlyArray1<'py, f64>),
    Single(PyReadonlyArray1<'py, f32>),
    /// Of another type, and so copied.
    Converted(PyArrayLike1<'py, f64, AllowTypeChange>),
}

/// The numbers of a column, of any stride.
#[derive(Clone, Copy)]
pub(crate) enum View<'a> {
    Double(ArrayView1<'a, f64>),
    Single(ArrayView1<'a, f32>),
}

impl<'py> Column<'py> {
    /// A column of numbers, without a copy if it is an array of float64 or float32.
    pub(crate) fn of(given: &Bound<'py, PyAny>, what: &str) -> PyResult<Self> {
        if let Ok(array) = given.cast::<PyArray1<f64>>() {
            return Ok(Self::Double(array.try_readonly().map_err(errors::bad)?));
        }
        if let Ok(array) = given.cast::<PyArray1<f32>>() {
            return Ok(Self::Single(array.try_readonly().map_err(errors::bad)?));
        }
        let converted = given.extract();
        converted.map(Self::Converted).map_err(|_| {
            errors::bad(format!("`{what}` must be numbers in one dimension, not {}", kind(given)))
        })
    }

    /// The columns of an array of two dimensions, or those of a sequence.
    pub(crate) fn all(given: &Bound<'py, PyAny>, count: usize) -> PyResult<Vec<Self>> {
        let named = |index: usize| format!("columns[{index}]");
        let wrong = |found: usize| errors::bad(format!("there must be {count} columns, not {found}"));
        if let Ok(array) = given.cast::<PyUntypedArray>() {
            let &[_, found] = array.shape() else {
                let shape = array.shape();
                return Err(errors::bad(format!("`columns` must have two dimensions, not shape {shape:?}")));
            };
            if found != count {
                return Err(wrong(found));
            }
            let rows = PySlice::full(given.py());
            return (0..count)
                .map(|index| Self::of(&given.get_item((&rows, index))?, &named(index)))
                .collect();
        }
        let parts = given.try_iter()?.collect::<PyResult<Vec<_>>>()?;
        if parts.len() != count {
            return Err(wrong(parts.len()));
        }
        let columns = parts.iter().enumerate().map(|(index, part)| Self::of(part, &named(index)));
        let columns = columns.collect::<PyResult<Vec<_>>>()?;
        let lengths: Vec<usize> = columns.iter().map(|column| column.view().len()).collect();
        if lengths.iter().any(|length| Some(length) != lengths.first()) {
            return Err(errors::bad(format!("columns must be of one length, not {lengths:?}")));
        }
        Ok(columns)
    }

    pub(crate) fn view(&self) -> View<'_> {
        match self {
            Self::Double(array) => View::Double(array.as_array()),
            Self::Single(array) => View::Single(array.as_array()),
            Self::Converted(array) => View::Double(array.as_array()),
        }
    }
}

impl View<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Double(view) => view.len(),
            Self::Single(view) => view.len(),
        }
    }

    /// The number in a row; NaN beyond the last.
    #[inline]
    pub(crate) fn at<T: Real>(&self, row: usize) -> T {
        match self {
            Self::Double(view) => view.get(row).map_or(T::literal(f64::NAN), |number| T::literal(*number)),
            Self::Single(view) => {
                view.get(row).map_or(T::literal(f64::NAN), |number| T::literal(f64::from(*number)))
            }
        }
    }

    /// Copies rows from `start` on into a buffer.
    pub(crate) fn copy_to<T: Real>(&self, start: usize, buffer: &mut [T]) {
        let end = (start + buffer.len()).min(self.len());
        let rows = numpy::ndarray::s![start..end];
        match self {
            Self::Double(view) => {
                buffer.iter_mut().zip(view.slice(rows)).for_each(|(to, from)| *to = T::literal(*from));
            }
            Self::Single(view) => buffer
                .iter_mut()
                .zip(view.slice(rows))
                .for_each(|(to, from)| *to = T::literal(f64::from(*from))),
        }
    }
}

impl Scalar for f64 {
    fn direct<'a>(column: &View<'a>) -> Option<&'a [Self]> {
        match column {
            View::Double(view) => view.to_slice(),
            View::Single(_) => None,
        }
    }
}

impl Scalar for f32 {
    fn direct<'a>(column: &View<'a>) -> Option<&'a [Self]> {
        match column {
            View::Single(view) => view.to_slice(),
            View::Double(_) => None,
        }
    }
}
