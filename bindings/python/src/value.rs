//! What classes that hold a value of the library have in common: they are equal, copied and pickled by that value.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::errors;

/// A value as bytes. MessagePack, since it has numbers that are not finite and keeps every bit.
pub(crate) fn to_bytes<'py, V: Serialize>(py: Python<'py>, value: &V) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = rmp_serde::to_vec_named(value).map_err(errors::bad)?;
    Ok(PyBytes::new(py, &bytes))
}

/// A value from its bytes.
pub(crate) fn from_bytes<V: DeserializeOwned>(bytes: &[u8]) -> PyResult<V> {
    rmp_serde::from_slice(bytes)
        .map_err(|error| errors::bad(format!("these bytes are no such value: {error}")))
}

/// What `__reduce__` gives: a function that makes the object anew, the class, and its bytes.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyAny>, Bound<'py, PyBytes>));

/// Reduces an object of a class to bytes.
pub(crate) fn reduced<'py, V: Serialize>(object: &Bound<'py, PyAny>, value: &V) -> PyResult<Reduced<'py>> {
    let py = object.py();
    let restore = py.import("fingertip._pickled")?.getattr("restore")?;
    Ok((restore, (object.get_type().into_any(), to_bytes(py, value)?)))
}

/// Pickles of a class whose field 0 can be stored: they keep it.
macro_rules! stored_class {
    ($class:ident) => {
        #[pymethods]
        impl $class {
            #[staticmethod]
            fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
                $crate::value::from_bytes(bytes).map(Self)
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<$crate::value::Reduced<'py>> {
                $crate::value::reduced(slf.as_any(), &slf.borrow().0)
            }
        }
    };
}
pub(crate) use stored_class;

/// Copies of a class that has a memory: they keep it.
macro_rules! cloned_class {
    ($class:ident) => {
        #[pymethods]
        impl $class {
            fn __copy__(&self) -> Self {
                self.clone()
            }

            fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
                self.clone()
            }
        }
    };
}
pub(crate) use cloned_class;

/// Equality, copies and pickles of a class that holds its value in field 0, which can be stored.
macro_rules! value_class {
    ($($class:ident),+ $(,)?) => {
        $($crate::value::stored_class!($class);

        #[pymethods]
        impl $class {
            fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
                other.cast::<Self>().is_ok_and(|other| other.get().0 == self.0)
            }

            fn __copy__(slf: Py<Self>) -> Py<Self> {
                slf
            }

            fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
                slf
            }
        })+
    };
}
pub(crate) use value_class;

/// Copies and pickles of a class that is made by `of` from what its field `made` holds: a copy keeps what it saw, a pickle
/// begins anew.
macro_rules! watcher_class {
    ($($class:ident),+ $(,)?) => {
        $($crate::value::cloned_class!($class);

        #[pymethods]
        impl $class {
            #[staticmethod]
            fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
                Self::of($crate::value::from_bytes(bytes)?)
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<$crate::value::Reduced<'py>> {
                $crate::value::reduced(slf.as_any(), &slf.borrow().made)
            }
        })+
    };
}
pub(crate) use watcher_class;

/// Copies and pickles of a class whose field 0 is what it has learnt, which can be stored: both keep it.
macro_rules! learner_class {
    ($class:ident) => {
        $crate::value::cloned_class!($class);
        $crate::value::stored_class!($class);
    };
}
pub(crate) use learner_class;
