//! Members of the enumerations, which are Python's own.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use serde::Serialize;

use fingertip::friction::SlipVerdict;

use crate::errors;

static VERDICTS: PyOnceLock<Vec<Py<PyAny>>> = PyOnceLock::new();

/// The member of `fingertip.SlipVerdict`.
pub(crate) fn slip(py: Python<'_>, verdict: SlipVerdict) -> PyResult<Py<PyAny>> {
    let members = VERDICTS.get_or_try_init(py, || {
        let class = py.import("fingertip._enums")?.getattr("SlipVerdict")?;
        (0..4_u8).map(|code| Ok(class.call1((code,))?.unbind())).collect::<PyResult<Vec<_>>>()
    })?;
    match members.get(verdict as usize) {
        Some(member) => Ok(member.clone_ref(py)),
        None => Err(errors::bad("a verdict that this package does not know")),
    }
}

/// The member of an enumeration of `fingertip._enums` whose value is the name that the library stores.
pub(crate) fn member<'py>(
    py: Python<'py>,
    class: &str,
    value: &impl Serialize,
) -> PyResult<Bound<'py, PyAny>> {
    let stored = serde_json::to_value(value).map_err(errors::bad)?;
    let name = match &stored {
        serde_json::Value::String(name) => name.as_str(),
        // A variant with numbers: its name is the key.
        serde_json::Value::Object(fields) => fields.keys().next().map_or("", String::as_str),
        _ => "",
    };
    named(py, class, name)
}

/// The member of an enumeration of `fingertip._enums` with a value.
pub(crate) fn named<'py>(py: Python<'py>, class: &str, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("fingertip._enums")?.getattr(class)?.call1((name,))
}
