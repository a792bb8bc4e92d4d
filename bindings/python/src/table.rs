//! `fingertip.Table`: columns that libraries of Arrow and NumPy share.

use alloc::sync::Arc;
use core::panic::RefUnwindSafe;
use core::ptr::NonNull;

use arrow_array::cast::AsArray;
use arrow_array::types::{ArrowPrimitiveType, Float32Type, Float64Type, UInt8Type};
use arrow_array::{Array, ArrayRef, PrimitiveArray, RecordBatch, StringArray};
use arrow_buffer::{Buffer, ScalarBuffer};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use fingertip_recordings::{AssumedUnits, ColumnMeaning, ColumnName, HeaderProblem, Layout};
use numpy::ndarray::ArrayView1;
use numpy::{Element, PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};

use crate::{capsule, errors};

/// Columns of one length by name: made of NumPy's arrays or of any table of Arrow, and given to any library of Arrow, all
/// without a copy where columns lie in one piece.
///
/// Parameters
/// ----------
/// columns : dict
///     Arrays of float64, float32 or uint8, or lists of str, by name. Arrays must not be written while the table lives.
#[pyclass(name = "Table", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyTable {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

/// An object of Python that owns the memory of a column.
struct Owner {
    _array: Py<PyAny>,
}

/// Nobody looks into it: it is only kept.
impl RefUnwindSafe for Owner {}

/// An array of NumPy as a column of Arrow.
fn shared<P: ArrowPrimitiveType>(array: &Bound<'_, PyArray1<P::Native>>) -> Option<ArrayRef>
where
    P::Native: Element,
{
    if !array.is_contiguous() {
        return None;
    }
    let length = array.len();
    if length == 0 {
        return Some(Arc::new(PrimitiveArray::<P>::from_iter_values([])));
    }
    let start = NonNull::new(array.data().cast::<u8>())?;
    let owner = Arc::new(Owner { _array: array.clone().into_any().unbind() });
    // SAFETY: the array lies in one piece of so many numbers, and `owner` keeps it alive. That nobody writes it meanwhile
    // is asked of the user, as every library that shares arrays asks.
    let bytes = unsafe { Buffer::from_custom_allocation(start, length * size_of::<P::Native>(), owner) };
    if start.as_ptr().align_offset(align_of::<P::Native>()) != 0 {
        return None;
    }
    Some(Arc::new(PrimitiveArray::<P>::new(ScalarBuffer::new(bytes, 0, length), None)))
}

/// A column of whatever a table is made of.
fn column(name: &str, given: &Bound<'_, PyAny>) -> PyResult<ArrayRef> {
    let one_piece =
        || errors::bad(format!("column `{name}` must lie in one piece: give np.ascontiguousarray of it"));
    if let Ok(array) = given.cast::<PyArray1<f64>>() {
        return shared::<Float64Type>(array).ok_or_else(one_piece);
    }
    if let Ok(array) = given.cast::<PyArray1<f32>>() {
        return shared::<Float32Type>(array).ok_or_else(one_piece);
    }
    if let Ok(array) = given.cast::<PyArray1<u8>>() {
        return shared::<UInt8Type>(array).ok_or_else(one_piece);
    }
    let texts: Result<Vec<String>, _> = given.try_iter()?.map(|text| text?.extract()).collect();
    let kind = crate::numbers::kind(given);
    let texts = texts.map_err(|_| {
        errors::bad(format!("column `{name}` must be of float64, float32, uint8 or of texts, not {kind}"))
    })?;
    Ok(Arc::new(StringArray::from(texts)))
}

/// A column of Arrow as an array of NumPy, where it lies if nothing in it is missing; a missing number is NaN.
fn numbers<'py, P: ArrowPrimitiveType>(
    table: &Bound<'py, PyTable>,
    column: &PrimitiveArray<P>,
    missing: P::Native,
) -> PyResult<Bound<'py, PyAny>>
where
    P::Native: Element,
{
    if column.null_count() > 0 {
        let copied = column.iter().map(|number| number.unwrap_or(missing));
        return Ok(PyArray1::from_iter(table.py(), copied).into_any());
    }
    let view = ArrayView1::from(&column.values()[..]);
    // SAFETY: the memory belongs to a batch of the table, which is frozen and which the array keeps alive as its base.
    let array = unsafe { PyArray1::borrow_from_array(&view, table.clone().into_any()) };
    let flags = PyDict::new(table.py());
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(array.into_any())
}

impl PyTable {
    fn of(batches: Vec<RecordBatch>, schema: SchemaRef) -> Self {
        Self { schema, batches }
    }

    fn place(&self, name: &str) -> PyResult<usize> {
        self.schema.index_of(name).map_err(|_| {
            errors::bad(format!("there is no column `{name}`; there are {}", self.names().join(", ")))
        })
    }

    /// A column as `Table` takes it: of numbers, or a list of texts.
    fn stored<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let array = slf.get().only()?.column(slf.get().place(name)?);
        match array.as_string_opt::<i32>().filter(|texts| texts.null_count() == 0) {
            Some(texts) => Ok(PyList::new(slf.py(), texts.iter().flatten())?.into_any()),
            None if array.null_count() == 0 => Self::column(slf, name),
            None => {
                let way = "; give pyarrow.table of it to be pickled";
                Err(errors::bad(format!("column `{name}` has places without a value{way}")))
            }
        }
    }

    fn only(&self) -> PyResult<&RecordBatch> {
        match self.batches.as_slice() {
            [only] => Ok(only),
            several => {
                Err(errors::bad(format!("the table has {} batches; take them by `batches`", several.len())))
            }
        }
    }
}

#[pymethods]
impl PyTable {
    #[new]
    fn new(columns: &Bound<'_, PyDict>) -> PyResult<Self> {
        let (mut fields, mut arrays) = (Vec::new(), Vec::new());
        for (name, given) in columns {
            let name: String = name.extract()?;
            let array = column(&name, &given)?;
            fields.push(Field::new(name, array.data_type().clone(), false));
            arrays.push(array);
        }
        let schema = Arc::new(Schema::new(fields));
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(errors::bad)?;
        Ok(Self::of(vec![batch], schema))
    }

    /// Any table, record batch or data frame that has `__arrow_c_stream__` or `__arrow_c_array__`.
    #[staticmethod]
    fn from_arrow(table: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (schema, batches) = capsule::batches_of(table)?;
        Ok(Self::of(batches, schema))
    }

    /// The names of the columns.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    /// The pieces that the table came in, each a table.
    fn batches(&self) -> Vec<Self> {
        let piece = |batch: &RecordBatch| Self::of(vec![batch.clone()], Arc::clone(&self.schema));
        self.batches.iter().map(piece).collect()
    }

    /// Pieces of the same columns as one table; `like` tells the columns of none.
    #[staticmethod]
    fn joined(pieces: Vec<Py<Self>>, like: &Self) -> Self {
        let schema =
            pieces.first().map_or_else(|| Arc::clone(&like.schema), |piece| Arc::clone(&piece.get().schema));
        Self::of(pieces.iter().flat_map(|piece| piece.get().batches.clone()).collect(), schema)
    }

    /// A column as an array that must not be written: where it lies if it is of float64, float32 or uint8 without missing
    /// numbers, converted to float64 otherwise.
    fn column<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let array = this.only()?.column(this.place(name)?);
        match array.data_type() {
            DataType::Float64 => numbers(slf, array.as_primitive::<Float64Type>(), f64::NAN),
            DataType::Float32 => numbers(slf, array.as_primitive::<Float32Type>(), f32::NAN),
            DataType::UInt8 => numbers(slf, array.as_primitive::<UInt8Type>(), 0),
            other => {
                Err(errors::bad(format!("column `{name}` must be of float64, float32 or uint8, not {other}")))
            }
        }
    }

    /// Rows whose entry in a column differs from that of the row before; not the first row.
    fn changes<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let array = self.only()?.column(self.place(name)?);
        let one = |row: usize| array.slice(row, 1).to_data();
        let mut changes = vec![false; array.len()];
        let mut last = None;
        for (row, change) in changes.iter_mut().enumerate() {
            let here = one(row);
            *change = last.as_ref().is_some_and(|last| *last != here);
            last = Some(here);
        }
        Ok(PyArray1::from_vec(py, changes))
    }

    /// The last row of a column, and the first, differ from those of another table: whether a piece begins anew.
    fn continues(&self, before: &Self, name: &str) -> PyResult<bool> {
        let (here, there) = (self.only()?, before.only()?);
        if here.num_rows() == 0 || there.num_rows() == 0 {
            return Ok(true);
        }
        let first = here.column(self.place(name)?).slice(0, 1).to_data();
        Ok(first == there.column(before.place(name)?).slice(there.num_rows() - 1, 1).to_data())
    }

    /// The same rows with more columns behind, without a copy.
    fn with_columns(&self, more: &Self) -> PyResult<Self> {
        let (here, there) = (self.only()?, more.only()?);
        let fields = self.schema.fields().iter().chain(more.schema.fields()).cloned();
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let columns = here.columns().iter().chain(there.columns()).cloned().collect();
        let batch = RecordBatch::try_new(Arc::clone(&schema), columns).map_err(errors::bad)?;
        Ok(Self::of(vec![batch], schema))
    }

    /// A table without rows, of the columns of this one and of another.
    fn with_no_rows(&self, more: &Self) -> Self {
        let fields = self.schema.fields().iter().chain(more.schema.fields()).cloned();
        Self::of(Vec::new(), Arc::new(Schema::new(fields.collect::<Vec<_>>())))
    }

    /// The schema, for libraries of Arrow.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        capsule::schema(py, &self.schema)
    }

    /// The table as a stream of batches, for libraries of Arrow; another schema is not made.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        capsule::stream(py, &self.schema, &self.batches)
    }

    /// A table of one piece as an array, for libraries of Arrow; another schema is not made.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_array__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyCapsule>, Bound<'py, PyCapsule>)> {
        let _ = requested_schema;
        capsule::array(py, self.only()?)
    }

    /// By its columns; of several batches by each.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Vec<Bound<'py, PyDict>>,))> {
        let py = slf.py();
        let restore = py.import("fingertip._pickled")?.getattr("table")?;
        let this = slf.get();
        let mut batches = this.batches();
        if batches.is_empty() {
            let none = RecordBatch::new_empty(Arc::clone(&this.schema));
            batches.push(Self::of(vec![none], Arc::clone(&this.schema)));
        }
        let pieces = batches.into_iter().map(|piece| {
            let piece = Bound::new(py, piece)?;
            let columns = PyDict::new(py);
            for name in piece.get().names() {
                columns.set_item(&name, Self::stored(&piece, &name)?)?;
            }
            Ok(columns)
        });
        Ok((restore, (pieces.collect::<PyResult<_>>()?,)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    fn __repr__(&self) -> String {
        format!("<fingertip.Table: {} rows of {}>", self.__len__(), self.names().join(", "))
    }
}

/// Names of columns with what one unit of each is in SI.
type Scaled = Vec<(String, f64)>;

/// Which columns of a table hold the time, and the wrench or the gauges of a sensor, by the grammar of recordings.
#[pyfunction]
pub(crate) fn find_columns(
    names: Vec<String>,
    sensor: Option<&str>,
    gauges: Option<usize>,
) -> PyResult<(Option<(String, f64)>, Scaled)> {
    let header = |problem: HeaderProblem| errors::recording(problem);
    let layout = Layout::from_header(&names, AssumedUnits::default()).map_err(header)?;
    let sensor = match (gauges, sensor) {
        (None, None) => layout.only_wrench().map_err(header)?.name(),
        (None, Some(sensor)) => layout.wrench(sensor).map_err(header)?.name(),
        (Some(count), sensor) => {
            let signals = sensor.map_or_else(|| layout.only_signals(), |sensor| layout.signals_of(sensor));
            signals.and_then(|signals| signals.expecting(count)).map_err(header)?.name()
        }
    };
    let mut time = None;
    let mut found: Vec<(usize, String, f64)> = Vec::new();
    for name in names {
        let parsed = ColumnName::parse(&name);
        let of_sensor = parsed.sensor.eq_ignore_ascii_case(sensor);
        match (parsed.meaning, gauges) {
            (ColumnMeaning::Time(size), _) if time.is_none() => time = Some((name, size.unwrap_or(1.0))),
            (ColumnMeaning::Force(axis, Some(unit)), None) if of_sensor => {
                found.push((axis, name, unit.in_newtons()));
            }
            (ColumnMeaning::Torque(axis, Some(unit)), None) if of_sensor => {
                found.push((axis + 3, name, unit.in_newton_metres()));
            }
            (ColumnMeaning::Signal(number, _, size), Some(_)) if of_sensor => {
                found.push((number as usize, name, size));
            }
            _ => {}
        }
    }
    found.sort_by_key(|(place, ..)| *place);
    Ok((time, found.into_iter().map(|(_, name, size)| (name, size)).collect()))
}
