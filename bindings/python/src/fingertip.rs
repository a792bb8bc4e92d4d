//! `fingertip.Fingertip`.

use fingertip::wrench::{InertialReading, Motion, Wrench};
use fingertip_scene::{ArrayReading, NoWrench};
use nalgebra::{DMatrix, Vector3, Vector6};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::pipe::{Beside, Pipe, each};
use crate::rest::Rested;
use crate::scene::PyScene;
use crate::touch::PyTouch;
use crate::track;
use crate::{errors, numbers};

/// A fingertip that a scene describes: takes reading after reading, and says what touches.
///
/// It remembers what follows from sample to sample: the last contact, what the slip detector saw, what was learnt. One
/// recording, one fingertip. A copy keeps all that; a pickle keeps the scene and the zero, and its next sample is the
/// first. Not for two threads at once: the second is told so by a `RuntimeError`.
///
/// Parameters
/// ----------
/// scene : Scene
/// dtype : dtype, optional
///     `float64` or `float32`: the precision of the arithmetic.
///
/// Examples
/// --------
/// >>> import fingertip
/// >>> scene = fingertip.Scene.from_dict({
/// ...     "surface": {"shape": "sphere", "radius_m": 0.013},
/// ...     "friction": {"static_coefficient": 0.6},
/// ... })
/// >>> tip = fingertip.Fingertip(scene)
/// >>> touch = tip.sense([0.5, 0.0, -2.0, 0.0, 6.5e-3, 0.0], 1e-3)
/// >>> float(touch.point[2]), round(touch.normal_force, 6), touch.margin > 0.5
/// (0.013, 2.0, True)
#[pyclass(name = "Fingertip", module = "fingertip", subclass)]
pub(crate) struct PyFingertip {
    scene: Py<PyScene>,
    pub(crate) pipe: Pipe,
    pub(crate) gauges: Option<usize>,
    carries: bool,
    /// What a sensor of wrenches reads at rest.
    pub(crate) zero: Vector6<f64>,
    pub(crate) sign: f64,
    /// The readings of the last rest, and what was known beside them.
    rested: Option<Rested>,
}

/// What `__reduce__` gives: class, arguments, state.
type Reduced<'py> = (Bound<'py, PyAny>, (Py<PyScene>, &'static str), Option<Bound<'py, PyDict>>);

impl PyFingertip {
    fn beside(
        gravity: Option<&Bound<'_, PyAny>>,
        turning: [Option<&Bound<'_, PyAny>>; 2],
        celsius: Option<f64>,
        dummy: Option<f64>,
    ) -> PyResult<Beside> {
        let motion = match gravity {
            None => None,
            Some(gravity) => {
                let mut motion = Motion::resting(numbers::three(gravity, "gravity")?);
                if let [Some(velocity), _] = turning {
                    motion.angular_velocity = numbers::three(velocity, "angular_velocity")?;
                }
                if let [_, Some(acceleration)] = turning {
                    motion.angular_acceleration = numbers::three(acceleration, "angular_acceleration")?;
                }
                Some(motion)
            }
        };
        Ok(Beside { motion, celsius, dummy })
    }

    /// The load on the fingertip of what the sensor reports, less its zero.
    #[inline]
    pub(crate) fn on_fingertip(&self, reported: &[f64; 6]) -> Wrench<f64> {
        Wrench::from_components(&((Vector6::from(*reported) - self.zero) * self.sign))
    }

    pub(crate) const fn carries(&self) -> bool {
        self.carries
    }

    #[cold]
    fn sense_with_unit(
        &mut self,
        reading: &Bound<'_, PyAny>,
        unit: &InertialReading<f64>,
        beside: &Beside,
        time_step: f64,
    ) -> PyResult<PyTouch> {
        if self.gauges.is_some() {
            let gauges = numbers::list(reading, "reading")?;
            return self.pipe.sense_reading_inertial(&gauges, unit, beside, time_step).map(PyTouch::from);
        }
        let wrench = self.on_fingertip(&numbers::numbers(reading, "reading")?);
        self.pipe.sense_inertial(wrench, unit, time_step).map(PyTouch::from)
    }

    #[cold]
    fn sense_beside(
        &mut self,
        reading: &Bound<'_, PyAny>,
        time_step: f64,
        beside: &Beside,
    ) -> PyResult<PyTouch> {
        if self.gauges.is_some() {
            let gauges = numbers::list(reading, "reading")?;
            return self.pipe.sense_reading(&gauges, beside, time_step).map(PyTouch::from);
        }
        let wrench = self.on_fingertip(&numbers::numbers(reading, "reading")?);
        match &beside.motion {
            Some(motion) => self.pipe.sense_moving(wrench, motion, time_step).map(PyTouch::from),
            None => Err(errors::reading(NoWrench::NoMotion)),
        }
    }
}

#[pymethods]
impl PyFingertip {
    #[new]
    #[pyo3(signature = (scene, dtype=None))]
    fn new(py: Python<'_>, scene: Py<PyScene>, dtype: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let single = match dtype {
            None => false,
            Some(dtype) => {
                let dtype = numpy::PyArrayDescr::new(py, dtype)?;
                let is = |other: &Bound<'_, numpy::PyArrayDescr>| {
                    numpy::PyArrayDescrMethods::is_equiv_to(&dtype, other)
                };
                if !is(&numpy::dtype::<f64>(py)) && !is(&numpy::dtype::<f32>(py)) {
                    return Err(PyTypeError::new_err("`dtype` must be float64 or float32"));
                }
                is(&numpy::dtype::<f32>(py))
            }
        };
        let pipe = Pipe::of(scene.get().scene(), single)?;
        let sign = match scene.get().scene().convention() {
            fingertip_scene::Convention::OnFingertip => 1.0,
            fingertip_scene::Convention::Reaction => -1.0,
        };
        let (gauges, carries) = (pipe.gauges(), pipe.carries());
        Ok(Self { scene, pipe, gauges, carries, zero: Vector6::zeros(), sign, rested: None })
    }

    /// The scene.
    #[getter]
    fn scene(&self, py: Python<'_>) -> Py<PyScene> {
        self.scene.clone_ref(py)
    }

    /// The precision of the arithmetic.
    #[getter]
    pub(crate) fn dtype<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArrayDescr> {
        match self.pipe {
            Pipe::Double(_) => numpy::dtype::<f64>(py),
            Pipe::Single(_) => numpy::dtype::<f32>(py),
        }
    }

    /// 1.0 where readings are loads on the fingertip, -1.0 where they are the reaction.
    #[getter]
    fn sign(&self) -> f64 {
        self.sign
    }

    /// How many numbers a reading has: the gauges of the scene's `[sensor]`, or 6.
    #[getter]
    fn channels(&self) -> usize {
        self.gauges.unwrap_or(6)
    }

    /// Whether the scene asks for the noise of a rest, and it is not known: until `tare`, no force is a contact.
    #[getter]
    fn awaits_noise(&self) -> bool {
        each!(&self.pipe, pipeline => pipeline.awaits_noise())
    }

    /// Takes one reading of the sensor, as it reports it.
    ///
    /// Parameters
    /// ----------
    /// reading : array_like, shape (6,) or (gauges,)
    ///     (fx, fy, fz [N], tx, ty, tz [N·m]) of the sign that the scene's convention says; of a scene with
    ///     `[sensor]`, its gauges. An array of float64 is read where it is.
    /// time_step : float
    ///     Time since the reading before [s].
    /// gravity : array_like, shape (3,), optional
    ///     Gravity less acceleration, in the sensor frame [m/s²]; a scene with `[payload]` needs it.
    /// angular_velocity, angular_acceleration : array_like, shape (3,), optional
    ///     Of the sensor [rad/s, rad/s²], for a `[payload]`.
    /// acceleration : array_like, shape (3,), optional
    ///     What the accelerometer of an `[inertial_unit]` reads [m/s²], in the place of gravity and angular
    ///     acceleration; the angular velocity then is what its gyroscope reads, along its own axes.
    /// celsius, dummy : float, optional
    ///     Temperature of the sensor and reading of its dummy gauge, for a `[sensor]` that needs them.
    ///
    /// Returns
    /// -------
    /// Touch
    ///
    /// Raises
    /// ------
    /// ReadingError
    ///     The reading gives no wrench; the next time step should count from the reading before.
    #[pyo3(signature = (reading, time_step, *, gravity=None, angular_velocity=None, angular_acceleration=None, celsius=None, dummy=None, acceleration=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    #[inline]
    fn sense(
        &mut self,
        reading: &Bound<'_, PyAny>,
        time_step: f64,
        gravity: Option<&Bound<'_, PyAny>>,
        angular_velocity: Option<&Bound<'_, PyAny>>,
        angular_acceleration: Option<&Bound<'_, PyAny>>,
        celsius: Option<f64>,
        dummy: Option<f64>,
        acceleration: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyTouch> {
        if let Some(acceleration) = acceleration {
            let Some(turning) = angular_velocity else {
                return Err(errors::bad(
                    "acceleration needs angular_velocity: what accelerometer and gyroscope read",
                ));
            };
            if gravity.is_some() || angular_acceleration.is_some() {
                return Err(errors::bad(
                    "acceleration stands in the place of gravity and angular_acceleration",
                ));
            }
            let unit = InertialReading {
                acceleration: numbers::three(acceleration, "acceleration")?,
                angular_velocity: numbers::three(turning, "angular_velocity")?,
            };
            let beside = Self::beside(None, [None, None], celsius, dummy)?;
            return self.sense_with_unit(reading, &unit, &beside, time_step);
        }
        if self.gauges.is_some() || self.carries {
            let beside = Self::beside(gravity, [angular_velocity, angular_acceleration], celsius, dummy)?;
            return self.sense_beside(reading, time_step, &beside);
        }
        let wrench = self.on_fingertip(&numbers::numbers(reading, "reading")?);
        self.pipe.sense(wrench, time_step)
    }

    /// Takes a wrench on the fingertip: neither convention nor zero nor payload are applied.
    ///
    /// Parameters
    /// ----------
    /// wrench : array_like, shape (6,)
    ///     (fx, fy, fz [N], tx, ty, tz [N·m]) that the environment applies to the fingertip.
    /// time_step : float
    ///     Time since the one before [s].
    #[inline]
    fn sense_wrench(&mut self, wrench: &Bound<'_, PyAny>, time_step: f64) -> PyResult<PyTouch> {
        let wrench = Wrench::from_components(&numbers::numbers(wrench, "wrench")?.into());
        self.pipe.sense(wrench, time_step)
    }

    /// The contacts that the wrench of the last sample and a tactile array tell together, of a scene with `[fusion]`.
    ///
    /// Parameters
    /// ----------
    /// readings : array_like, shape (n, 4)
    ///     For each place of the array that is pressed, one to four: centroid x, y, z in the sensor frame [m] and normal
    ///     force [N].
    ///
    /// Returns
    /// -------
    /// tuple
    ///     A dict for each reading, as the function `fuse` gives them (`point`, `normal`, `force`, `point_covariance`,
    ///     `force_covariance`, `share_from_wrench`, `grip`), and the disagreement: χ² with six degrees of freedom if all is
    ///     right.
    ///
    /// Examples
    /// --------
    /// >>> import fingertip
    /// >>> tip = fingertip.Fingertip(fingertip.Scene.from_dict({
    /// ...     "surface": {"shape": "sphere", "radius_m": 0.013},
    /// ...     "uncertainty": {"force_noise_N": 0.01, "torque_noise_Nm": 1e-4},
    /// ...     "fusion": {"position_deviation_m": 1e-3, "normal_deviation_N": 0.1, "static_coefficient": 0.5},
    /// ... }))
    /// >>> touch = tip.sense([-0.1, 0.4, 0.0, 0.0, 0.0, 0.0], 1e-3)
    /// >>> contacts, disagreement = tip.fuse([[-0.013, 0.0, 0.0, 1.05], [0.013, 0.0, 0.0, 1.05]])
    /// >>> [round(float(contact["force"][1]), 1) for contact in contacts]
    /// [0.2, 0.2]
    fn fuse<'py>(
        &self,
        py: Python<'py>,
        readings: &Bound<'py, PyAny>,
    ) -> PyResult<(Vec<Bound<'py, PyDict>>, f64)> {
        let table = numbers::table(readings, "readings")?;
        if table.ncols() != 4 {
            return Err(errors::bad(format!(
                "`readings` must have 4 columns, x, y, z and the normal force, not {}",
                table.ncols()
            )));
        }
        let reading = |row: usize| ArrayReading {
            centroid: Vector3::new(table[(row, 0)], table[(row, 1)], table[(row, 2)]),
            normal_force: table[(row, 3)],
        };
        let readings: Vec<ArrayReading<f64>> = (0..table.nrows()).map(reading).collect();
        let fused = self.pipe.fuse(&readings)?;
        let contacts = fused.contacts.iter().flatten().map(|contact| track::parts(py, contact));
        Ok((contacts.collect::<PyResult<_>>()?, fused.disagreement))
    }

    /// Takes the zero from readings without load, and with it the noise that a scene may ask for.
    ///
    /// Parameters
    /// ----------
    /// readings : array_like, shape (n, channels)
    ///     As `sense` takes them.
    /// gravity : array_like, shape (3,), optional
    ///     How the sensor lay, for a scene with `[payload]` [m/s²].
    /// celsius : float, optional
    /// dummy : array_like, shape (n,), optional
    ///     For a `[sensor]` that needs them.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (6,), or None
    ///     Standard deviation of the components of the wrench [N, N·m].
    ///
    /// Warns
    /// -----
    /// UserWarning
    ///     The sensor may not have been at rest.
    #[pyo3(signature = (readings, *, gravity=None, celsius=None, dummy=None))]
    fn tare<'py>(
        &mut self,
        py: Python<'py>,
        readings: &Bound<'py, PyAny>,
        gravity: Option<&Bound<'py, PyAny>>,
        celsius: Option<f64>,
        dummy: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, numpy::PyArray1<f64>>>> {
        let readings = numbers::table(readings, "readings")?;
        if readings.ncols() != self.channels() {
            let (found, expected) = (readings.ncols(), self.channels());
            return Err(errors::bad(format!("`readings` must have {expected} columns, not {found}")));
        }
        let gravity = gravity.map(|gravity| numbers::three(gravity, "gravity")).transpose()?;
        let dummy = dummy.map(|dummy| numbers::list(dummy, "dummy")).transpose()?;
        let rested = Rested { readings, gravity, celsius, dummy };
        let (doubt, noise) = rested.take_zero(&mut self.pipe, self.gauges.is_some(), &mut self.zero)?;
        self.rested = Some(rested);
        if let Some(doubt) = doubt {
            let sentence = format!("the sensor may not have been at rest: {doubt}");
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &alloc::ffi::CString::new(sentence)?, 1)?;
        }
        Ok(noise.map(|noise| numbers::array(py, &noise)))
    }

    /// Forgets all samples: the next is the first. The zero stays.
    fn reset(&mut self) {
        each!(&mut self.pipe, pipeline => pipeline.reset());
    }

    /// Forgets the last contact and what the slip detector saw, as after a gap; what was learnt of the friction stays.
    fn start_anew(&mut self) {
        each!(&mut self.pipe, pipeline => pipeline.start_anew());
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        Self {
            scene: self.scene.clone_ref(py),
            pipe: self.pipe.clone(),
            rested: self.rested.clone(),
            ..*self
        }
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.__copy__(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let (py, this) = (slf.py(), slf.borrow());
        let dtype = if matches!(this.pipe, Pipe::Double(_)) { "float64" } else { "float32" };
        let state = this.rested.as_ref().map(|rested| {
            let state = PyDict::new(py);
            state.set_item("readings", numbers::array2(py, &rested.readings))?;
            state.set_item("gravity", rested.gravity.map(|gravity| numbers::array(py, &gravity)))?;
            state.set_item("celsius", rested.celsius)?;
            state.set_item("dummy", rested.dummy.clone())?;
            PyResult::Ok(state)
        });
        Ok((slf.get_type().into_any(), (this.scene.clone_ref(py), dtype), state.transpose()?))
    }

    fn __setstate__(&mut self, state: &Bound<'_, PyDict>) -> PyResult<()> {
        let part = |key| state.get_item(key).map(|part| part.filter(|part| !part.is_none()));
        let readings = part("readings")?.ok_or_else(|| errors::bad("the state has no readings"))?;
        let readings = readings.cast::<PyArray2<f64>>()?.readonly();
        let (rows, columns) = readings.as_array().dim();
        let rested = Rested {
            readings: DMatrix::from_row_iterator(rows, columns, readings.as_array().iter().copied()),
            gravity: part("gravity")?.map(|gravity| numbers::three(&gravity, "gravity")).transpose()?,
            celsius: part("celsius")?.map(|celsius| celsius.extract()).transpose()?,
            dummy: part("dummy")?.map(|dummy| dummy.extract()).transpose()?,
        };
        rested.take_zero(&mut self.pipe, self.gauges.is_some(), &mut self.zero)?;
        self.rested = Some(rested);
        Ok(())
    }

    fn __repr__(&self) -> String {
        format!("<fingertip.Fingertip of scene {:?}>", self.scene.get().scene().name())
    }
}
