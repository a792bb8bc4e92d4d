//! Many readings at once.

use core::array;

use fingertip::contact::{NoContact, Resolution};
use fingertip::friction::SlipVerdict;
use fingertip::wrench::Wrench;
use fingertip::{AnyTouch, Touch, Touches};
use fingertip_scene::{GaugeReading, NoWrench, Pipeline};
use nalgebra::Vector6;
use numpy::{
    Element, PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray1, PyReadwriteArray2, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use crate::columns::{Column, Scalar, View};
use crate::errors;
use crate::fingertip::PyFingertip;
use crate::pipe::Pipe;

/// Rows that are brought together before they are sensed, where columns cannot be read where they lie: six columns of
/// these stay in the first cache.
const CHUNK: usize = 512;

/// Time steps: the same for all rows, or one for each.
#[derive(Clone, Copy)]
pub(crate) enum Steps<'a> {
    Same(f64),
    Each(View<'a>),
}

/// What is sensed.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    pub(crate) columns: &'a [View<'a>],
    pub(crate) steps: Steps<'a>,
    /// Not zero in rows that begin anew.
    pub(crate) anew: Option<View<'a>>,
    /// Whether the columns are gauges, and of wrenches zero and sign.
    pub(crate) gauges: bool,
    pub(crate) zero: Vector6<f64>,
    pub(crate) sign: f64,
}

/// The columns of a `Touches`, kept while they are written.
pub(crate) struct Written<'py, T: Element> {
    point: PyReadwriteArray2<'py, T>,
    tangential_force: PyReadwriteArray2<'py, T>,
    numbers: [PyReadwriteArray1<'py, T>; 3],
    slip: PyReadwriteArray1<'py, u8>,
}

impl<'py, T: Scalar> Written<'py, T> {
    /// Those of an object of `fingertip.Touches`.
    pub(crate) fn of(touches: &Bound<'py, PyAny>) -> PyResult<Self> {
        let wrong =
            "`out` must be a Touches of the same precision as the fingertip, whose columns may be written";
        let wide = |name| -> PyResult<PyReadwriteArray2<'py, T>> {
            let array = touches.getattr(name)?;
            array.cast::<PyArray2<T>>().map_err(|_| errors::bad(wrong))?.try_readwrite().map_err(errors::bad)
        };
        let narrow = |name| -> PyResult<PyReadwriteArray1<'py, T>> {
            let array = touches.getattr(name)?;
            array.cast::<PyArray1<T>>().map_err(|_| errors::bad(wrong))?.try_readwrite().map_err(errors::bad)
        };
        let slip = touches.getattr("slip")?;
        let slip = slip.cast::<PyArray1<u8>>().map_err(|_| errors::bad(wrong))?;
        Ok(Self {
            point: wide("_point")?,
            tangential_force: wide("_tangential_force")?,
            numbers: [narrow("normal_force")?, narrow("margin")?, narrow("utilisation")?],
            slip: slip.try_readwrite().map_err(errors::bad)?,
        })
    }

    pub(crate) fn touches(&mut self) -> PyResult<Touches<'_, T>> {
        let apart = || errors::bad("the columns of `out` must lie in one piece each");
        let [normal_force, margin, utilisation] = &mut self.numbers;
        let slip = self.slip.as_slice_mut().map_err(|_| apart())?;
        slip.fill(SlipVerdict::NotPressing as u8);
        let (length, start) = (slip.len(), slip.as_mut_ptr());
        // SAFETY: a verdict is stored as a byte (`repr(u8)`), and every byte of the column has just been made one of
        // its values; the column is borrowed by `self` for as long as the verdicts are.
        let slip = unsafe { core::slice::from_raw_parts_mut(start.cast::<SlipVerdict>(), length) };
        Ok(Touches {
            point: three(&mut self.point).ok_or_else(apart)?,
            normal_force: normal_force.as_slice_mut().map_err(|_| apart())?,
            tangential_force: three(&mut self.tangential_force).ok_or_else(apart)?,
            margin: margin.as_slice_mut().map_err(|_| apart())?,
            utilisation: utilisation.as_slice_mut().map_err(|_| apart())?,
            slip,
        })
    }
}

/// The three rows of an array.
fn three<'a, T: Element>(array: &'a mut PyReadwriteArray2<'_, T>) -> Option<[&'a mut [T]; 3]> {
    let &[3, length] = array.shape() else { return None };
    if !array.is_c_contiguous() {
        return None;
    }
    let all = array.as_slice_mut().ok()?;
    let (x, rest) = all.split_at_mut_checked(length)?;
    let (y, z) = rest.split_at_mut_checked(length)?;
    Some([x, y, z])
}

/// What a row without a wrench says.
fn nothing<T: Scalar>() -> AnyTouch<T> {
    let resolution = Resolution::NoContact(NoContact::NotFinite);
    Touch { wrench: Wrench::zero(), resolution, force: None, grip: None, slip: None, tracked: () }
}

/// Rows `start` and on of the touches.
fn rest_of<'a, T>(touches: Touches<'a, T>, start: usize, count: usize) -> Touches<'a, T> {
    fn part<A>(column: &mut [A], start: usize, count: usize) -> &mut [A] {
        column.get_mut(start..start + count).unwrap_or_default()
    }
    let Touches { point, normal_force, tangential_force, margin, utilisation, slip } = touches;
    Touches {
        point: point.map(|column| part(column, start, count)),
        normal_force: part(normal_force, start, count),
        tangential_force: tangential_force.map(|column| part(column, start, count)),
        margin: part(margin, start, count),
        utilisation: part(utilisation, start, count),
        slip: part(slip, start, count),
    }
}

impl Batch<'_> {
    pub(crate) fn rows(&self) -> usize {
        self.columns.first().map_or(0, View::len)
    }

    /// Senses all rows.
    pub(crate) fn sense<T: Scalar>(&self, pipeline: &mut Pipeline<T>, touches: Touches<'_, T>) {
        match self.steps {
            Steps::Same(step) if !self.gauges && self.anew.is_none() => {
                self.sense_wrenches(pipeline, T::literal(step), touches);
            }
            _ => self.sense_rows(pipeline, touches),
        }
    }

    /// Wrenches at a steady rate: where they lie, or chunk by chunk.
    fn sense_wrenches<T: Scalar>(&self, pipeline: &mut Pipeline<T>, step: T, mut touches: Touches<'_, T>) {
        let as_they_are = self.sign == 1.0 && self.zero == Vector6::zeros();
        let direct: Vec<&[T]> = self.columns.iter().filter_map(T::direct).collect();
        if let (true, Ok(columns)) = (as_they_are, <[&[T]; 6]>::try_from(direct.as_slice())) {
            return pipeline.sense_all(columns, step, touches);
        }
        let mut buffers = [[T::zero(); CHUNK]; 6];
        let rows = self.rows();
        for start in (0..rows).step_by(CHUNK) {
            let count = CHUNK.min(rows - start);
            for ((buffer, column), zero) in buffers.iter_mut().zip(self.columns).zip(&self.zero) {
                let buffer = buffer.get_mut(..count).unwrap_or_default();
                column.copy_to(start, buffer);
                if !as_they_are {
                    let (zero, sign) = (T::literal(*zero), T::literal(self.sign));
                    buffer.iter_mut().for_each(|number| *number = (*number - zero) * sign);
                }
            }
            let parts = buffers.each_ref().map(|buffer| buffer.get(..count).unwrap_or_default());
            pipeline.sense_all(parts, step, rest_of(touches.by_ref(), start, count));
        }
    }

    /// Row by row.
    fn sense_rows<T: Scalar>(&self, pipeline: &mut Pipeline<T>, mut touches: Touches<'_, T>) {
        let mut gauges = vec![T::zero(); self.columns.len()];
        let (zero, sign) = (self.zero.map(T::literal), T::literal(self.sign));
        // Since the last row that gave a wrench.
        let mut waited = T::zero();
        for row in 0..self.rows() {
            if self.anew.is_some_and(|anew| anew.at::<f64>(row) != 0.0) {
                pipeline.start_anew();
                waited = T::zero();
            }
            let step = match self.steps {
                Steps::Same(step) => T::literal(step),
                Steps::Each(steps) => steps.at(row),
            };
            waited = if step > T::zero() { waited + step } else { waited };
            for (gauge, column) in gauges.iter_mut().zip(self.columns) {
                *gauge = column.at(row);
            }
            if self.gauges {
                match pipeline.sense_reading(&GaugeReading::of(&gauges), None, waited) {
                    Ok(felt) => touches.put(row, &felt.touch),
                    Err(_) => {
                        touches.put(row, &nothing());
                        continue;
                    }
                }
            } else {
                let reported: [T; 6] =
                    array::from_fn(|axis| gauges.get(axis).copied().unwrap_or_else(T::zero));
                let wrench = Wrench::from_components(&((Vector6::from(reported) - zero) * sign));
                touches.put(row, &pipeline.sense(wrench, waited).touch);
            }
            waited = T::zero();
        }
    }
}

/// Readings of a fingertip to the columns of a `Touches`.
pub(crate) fn sense_all<'py>(
    tip: &mut PyFingertip,
    columns: &Bound<'py, PyAny>,
    time_step: &Bound<'py, PyAny>,
    anew: Option<&Bound<'py, PyAny>>,
    out: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = columns.py();
    if tip.carries() {
        return Err(errors::reading(NoWrench::NoMotion));
    }
    let columns = Column::all(columns, tip.gauges.unwrap_or(6))?;
    let views: Vec<View<'_>> = columns.iter().map(Column::view).collect();
    let rows = views.first().map_or(0, View::len);
    let fits = |column: &Column<'_>, what: &str| {
        let length = column.view().len();
        let sentence =
            || errors::bad(format!("`{what}` must have one entry for each of {rows} rows, not {length}"));
        if length == rows { Ok(()) } else { Err(sentence()) }
    };
    let same: Option<f64> = time_step.extract().ok();
    let each = if same.is_none() { Some(Column::of(time_step, "time_step")?) } else { None };
    each.as_ref().map_or(Ok(()), |column| fits(column, "time_step"))?;
    let anew = anew.map(|anew| Column::of(anew, "anew")).transpose()?;
    anew.as_ref().map_or(Ok(()), |column| fits(column, "anew"))?;
    let steps = each.as_ref().map_or(Steps::Same(same.unwrap_or(0.0)), |column| Steps::Each(column.view()));
    let anew = anew.as_ref().map(Column::view);
    let (zero, sign, gauges) = (tip.zero, tip.sign, tip.gauges.is_some());
    let batch = Batch { columns: &views, steps, anew, gauges, zero, sign };
    let class = py.import("fingertip._touches")?.getattr("Touches")?;
    let out = match out {
        Some(out) => out,
        None => class.call_method1("empty", (rows, tip.dtype(py)))?,
    };
    if out.len()? != rows {
        let room = out.len()?;
        return Err(errors::bad(format!("`out` has room for {room} rows, and there are {rows}")));
    }
    match &mut tip.pipe {
        Pipe::Double(pipeline) => {
            let mut written = Written::of(&out)?;
            let touches = written.touches()?;
            py.detach(|| batch.sense(pipeline, touches));
        }
        Pipe::Single(pipeline) => {
            let mut written = Written::of(&out)?;
            let touches = written.touches()?;
            py.detach(|| batch.sense(pipeline, touches));
        }
    }
    Ok(out)
}

#[pymethods]
impl PyFingertip {
    /// Takes many readings, one after the other in time; other threads run meanwhile.
    ///
    /// Parameters
    /// ----------
    /// columns : array_like, shape (n, channels), or sequence of `channels` arrays of shape (n,)
    ///     Readings as `sense` takes them. Columns in one piece, of the fingertip's precision, are read where they lie if
    ///     the scene's convention is "on_fingertip" and no zero was taken: of an array, in Fortran's order.
    /// time_step : float or array_like, shape (n,)
    ///     Time since the reading before [s].
    /// anew : array_like of bool, shape (n,), optional
    ///     Rows that come after a gap or begin another recording: what was before is forgotten.
    /// out : Touches, optional
    ///     To write into, for instance what an earlier call gave.
    ///
    /// Returns
    /// -------
    /// Touches
    ///     Columns. A reading that gives no wrench is a row without contact.
    ///
    /// Notes
    /// -----
    /// A point contact on a plane, a sphere, an ellipsoid, a capsule or a cylinder without ends, with Coulomb friction and
    /// the threshold detector and at a steady rate, is one vectorised loop, a few nanoseconds a row.
    #[pyo3(signature = (columns, time_step, *, anew=None, out=None))]
    fn sense_all<'py>(
        &mut self,
        columns: &Bound<'py, PyAny>,
        time_step: &Bound<'py, PyAny>,
        anew: Option<&Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        sense_all(self, columns, time_step, anew, out)
    }
}
