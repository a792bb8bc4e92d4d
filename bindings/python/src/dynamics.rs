//! `fingertip.BristleFriction`: friction in motion.

use fingertip::friction::{
    Bristle, BristleLaw, Coupled, Dahl, Drive, ElastoPlastic, Exponential, LuGre, ReturnMap, StepForce,
    Stribeck, StribeckFriction,
};
use nalgebra::Vector2;
use numpy::PyArray1;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{errors, numbers, value};

/// Friction in motion, in the plane, by a law and a way to integrate it.
#[derive(Clone)]
enum AnyBristle {
    Dahl(Bristle<f64, Dahl<f64>, 2, Exponential>),
    LuGre(Bristle<f64, LuGre<f64>, 2, Exponential>),
    ElastoPlastic(Bristle<f64, ElastoPlastic<f64>, 2, Exponential>),
    Stribeck(Bristle<f64, StribeckFriction<f64>, 2, ReturnMap>),
}

macro_rules! each_bristle {
    ($of:expr, $bristle:ident => $call:expr) => {
        match $of {
            AnyBristle::Dahl($bristle) => $call,
            AnyBristle::LuGre($bristle) => $call,
            AnyBristle::ElastoPlastic($bristle) => $call,
            AnyBristle::Stribeck($bristle) => $call,
        }
    };
}

/// Friction in motion: bristles that bend before they slide. Coefficients are over the normal force.
///
/// Parameters
/// ----------
/// law : str
///     "dahl", "lugre", "elasto_plastic", or "stribeck", which bends nothing before it slides but elastically.
/// stiffness : float
///     Of the bristles over the normal force [1/m].
/// kinetic, breakaway : float
///     Coefficients while it slides fast, and when it breaks away; Dahl's law has the kinetic one alone.
/// speed : float, optional
///     At which the coefficient falls from one to the other [m/s].
/// damping, viscous : float, optional
///     Of the bristles, and of the sliding [s/m].
/// elastic_share : float, optional
///     Of the greatest deflection, below which the elasto-plastic law creeps not.
///
/// Notes
/// -----
/// A copy keeps how far the bristles are bent; a pickle begins with straight ones.
#[pyclass(name = "BristleFriction", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyBristle {
    bristle: AnyBristle,
    made: Made,
}

/// What it is made of.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Made {
    law: String,
    stiffness: f64,
    kinetic: f64,
    breakaway: f64,
    speed: f64,
    damping: f64,
    viscous: f64,
    elastic_share: f64,
}

impl PyBristle {
    fn of(made: Made) -> PyResult<Self> {
        let bad = errors::friction;
        let Made { stiffness, kinetic, breakaway, speed, damping, viscous, elastic_share, .. } = made;
        let curve = || Stribeck::new(kinetic, breakaway, speed).map_err(bad);
        let lugre = || LuGre::new(stiffness, damping, viscous, curve()?).map_err(bad);
        let bristle = match made.law.as_str() {
            "dahl" => AnyBristle::Dahl(Bristle::new(Dahl::new(stiffness, kinetic).map_err(bad)?)),
            "lugre" => AnyBristle::LuGre(Bristle::new(lugre()?)),
            "elasto_plastic" => AnyBristle::ElastoPlastic(Bristle::new(
                ElastoPlastic::new(lugre()?, elastic_share).map_err(bad)?,
            )),
            "stribeck" => AnyBristle::Stribeck(Bristle::with_method(
                StribeckFriction::new(stiffness, viscous, curve()?).map_err(bad)?,
            )),
            other => {
                let known = "dahl, lugre, elasto_plastic or stribeck";
                return Err(errors::friction(format!("`law` {other:?} is not {known}")));
            }
        };
        Ok(Self { bristle, made })
    }
}

value::watcher_class!(PyBristle);

#[pymethods]
impl PyBristle {
    #[new]
    #[pyo3(signature = (law, *, stiffness, kinetic, breakaway=None, speed=1e-3, damping=0.0, viscous=0.0, elastic_share=0.7))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        law: String,
        stiffness: f64,
        kinetic: f64,
        breakaway: Option<f64>,
        speed: f64,
        damping: f64,
        viscous: f64,
        elastic_share: f64,
    ) -> PyResult<Self> {
        let breakaway = breakaway.unwrap_or(kinetic);
        Self::of(Made { law, stiffness, kinetic, breakaway, speed, damping, viscous, elastic_share })
    }

    /// Tells the normal force from now on [N].
    fn set_load(&mut self, normal_force: f64) {
        each_bristle!(&mut self.bristle, bristle => bristle.set_load(normal_force));
    }

    /// Slides with a velocity [m/s], shape (2,), for a time [s]: gives the friction force's mean over the step, and at
    /// its end [N], along the motion that it opposes.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        velocity: &Bound<'py, PyAny>,
        time_step: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
        let velocity = Vector2::from(numbers::numbers::<2>(velocity, "velocity")?);
        let StepForce { mean, end } =
            each_bristle!(&mut self.bristle, bristle => bristle.step(&velocity, time_step));
        Ok((numbers::array(py, &mean), numbers::array(py, &end)))
    }

    /// A body that friction brakes: moves it for a time [s], body and bristles solved together, so that it may be light
    /// and the bristles stiff.
    ///
    /// Parameters
    /// ----------
    /// velocity : array_like, shape (2,)
    ///     Of the body [m/s].
    /// mass : float
    ///     [kg]
    /// force : array_like, shape (2,)
    ///     What drives it beside friction [N].
    /// time_step : float
    /// stiffness : float, optional
    ///     Of a spring that the force comes through [N/m].
    ///
    /// Returns
    /// -------
    /// velocity, friction : ndarray, shape (2,)
    ///     At the end of the step [m/s], and the friction force, along the motion that it opposes [N].
    #[pyo3(signature = (velocity, mass, force, time_step, stiffness=0.0))]
    fn step_body<'py>(
        &mut self,
        py: Python<'py>,
        velocity: &Bound<'py, PyAny>,
        mass: f64,
        force: &Bound<'py, PyAny>,
        time_step: f64,
        stiffness: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
        let velocity = Vector2::from(numbers::numbers::<2>(velocity, "velocity")?);
        let force = Vector2::from(numbers::numbers::<2>(force, "force")?);
        let drive = Drive { mass: Vector2::repeat(mass), force, stiffness };
        let Coupled { velocity, friction } =
            each_bristle!(&mut self.bristle, bristle => bristle.step_body(&velocity, &drive, time_step));
        Ok((numbers::array(py, &velocity), numbers::array(py, &friction)))
    }

    /// How far the bristles are bent [m], shape (2,).
    #[getter]
    fn deflection<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, each_bristle!(&self.bristle, bristle => bristle.deflection()))
    }

    /// The greatest coefficient that the law knows.
    #[getter]
    fn greatest(&self) -> f64 {
        each_bristle!(&self.bristle, bristle => bristle.law().greatest())
    }

    /// Bends all bristles back.
    fn reset(&mut self) {
        each_bristle!(&mut self.bristle, bristle => bristle.reset());
    }
}
