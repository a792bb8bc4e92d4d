//! Arrow's C data interface in capsules of Python, as its specification "The Arrow PyCapsule Interface" has them.

use alloc::sync::Arc;
use core::ffi::CStr;
use core::ptr::NonNull;

use arrow_array::ffi::{FFI_ArrowArray, FFI_ArrowSchema, from_ffi, to_ffi};
use arrow_array::ffi_stream::{FFI_ArrowArrayStream, RecordBatchStreamReader};
use arrow_array::{Array, RecordBatch, RecordBatchIterator, StructArray};
use arrow_schema::{Schema, SchemaRef};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyTuple};

use crate::errors;

const STREAM: &CStr = c"arrow_array_stream";
const SCHEMA: &CStr = c"arrow_schema";
const ARRAY: &CStr = c"arrow_array";

/// What a capsule of a name holds.
fn held<A>(capsule: &Bound<'_, PyAny>, name: &'static CStr) -> PyResult<NonNull<A>> {
    Ok(capsule.cast::<PyCapsule>()?.pointer_checked(Some(name))?.cast())
}

/// The batches of whatever gives itself as a stream or an array of Arrow; numbers stay where they lie.
pub(crate) fn batches_of(table: &Bound<'_, PyAny>) -> PyResult<(SchemaRef, Vec<RecordBatch>)> {
    if table.hasattr("__arrow_c_stream__")? {
        let capsule = table.call_method0("__arrow_c_stream__")?;
        let mut stream = held::<FFI_ArrowArrayStream>(&capsule, STREAM)?;
        // SAFETY: a capsule of this name holds such a stream, by the specification, and lives as long as `capsule`. It
        // is taken out and leaves an empty one, which the capsule does not release.
        let reader = unsafe { RecordBatchStreamReader::from_raw(stream.as_mut()) }.map_err(errors::bad)?;
        let schema = arrow_array::RecordBatchReader::schema(&reader);
        return Ok((schema, reader.collect::<Result<_, _>>().map_err(errors::bad)?));
    }
    if table.hasattr("__arrow_c_array__")? {
        let pair = table.call_method0("__arrow_c_array__")?;
        let (schema, array): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.cast::<PyTuple>()?.extract()?;
        let (mut schema, mut array) = (held(&schema, SCHEMA)?, held(&array, ARRAY)?);
        // SAFETY: capsules of these names hold a schema and an array, by the specification, and live as long as `pair`.
        // Both are taken out and leave released ones; the array is of this schema.
        let data = unsafe {
            let schema = FFI_ArrowSchema::from_raw(schema.as_mut());
            from_ffi(FFI_ArrowArray::from_raw(array.as_mut()), &schema)
        };
        let batch = RecordBatch::from(StructArray::from(data.map_err(errors::bad)?));
        return Ok((batch.schema(), vec![batch]));
    }
    let kind = crate::numbers::kind(table);
    Err(errors::bad(format!(
        "{kind} is no table of Arrow: it has neither __arrow_c_stream__ nor __arrow_c_array__"
    )))
}

/// A stream of batches.
pub(crate) fn stream<'py>(
    py: Python<'py>,
    schema: &SchemaRef,
    batches: &[RecordBatch],
) -> PyResult<Bound<'py, PyCapsule>> {
    let batches: Vec<_> = batches.iter().cloned().map(Ok).collect();
    let reader = RecordBatchIterator::new(batches, Arc::clone(schema));
    PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), STREAM)
}

/// A schema.
pub(crate) fn schema<'py>(py: Python<'py>, schema: &Schema) -> PyResult<Bound<'py, PyCapsule>> {
    PyCapsule::new_with_value(py, FFI_ArrowSchema::try_from(schema).map_err(errors::bad)?, SCHEMA)
}

/// The schema and the array of one batch.
pub(crate) fn array<'py>(
    py: Python<'py>,
    batch: &RecordBatch,
) -> PyResult<(Bound<'py, PyCapsule>, Bound<'py, PyCapsule>)> {
    let (array, schema) = to_ffi(&StructArray::from(batch.clone()).into_data()).map_err(errors::bad)?;
    Ok((PyCapsule::new_with_value(py, schema, SCHEMA)?, PyCapsule::new_with_value(py, array, ARRAY)?))
}
