//! The extension module of the Python package `fingertip`. The package itself, with what is written in Python, is in
//! `python/fingertip`; its classes and functions are explained there, by `help(fingertip)`.
// `numpy` reads headers of arrays, and verdicts are written as bytes: each place says why it may.
#![allow(unsafe_code)]
#![allow(clippy::type_complexity, reason = "tuples of Python are what they are")]
#![allow(clippy::needless_pass_by_value, reason = "what Python passes is passed by value")]

extern crate alloc;

mod batch;
mod calibration;
mod capsule;
mod columns;
mod contact;
mod controller;
mod dynamics;
mod enums;
mod errors;
mod fingertip;
mod friction;
mod gauges;
mod hand;
mod limits;
mod model;
mod numbers;
mod object;
mod pipe;
mod recording;
mod rest;
mod rolling;
mod scene;
mod sections;
mod simulation;
mod surface;
mod table;
mod timing;
mod touch;
mod track;
mod value;
mod weight;

/// The extension module.
#[pyo3::pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use crate::calibration::{PyCalibration, calibrate_table};
    #[pymodule_export]
    use crate::contact::{PyContact, PyNoContact};
    #[pymodule_export]
    use crate::controller::PyController;
    #[pymodule_export]
    use crate::dynamics::PyBristle;
    #[pymodule_export]
    use crate::errors::{
        CalibrationError, DesignError, FingertipError, FrictionError, HandError, ReadingError,
        RecordingError, SceneError, ShapeError, SimulationError,
    };
    #[pymodule_export]
    use crate::fingertip::PyFingertip;
    #[pymodule_export]
    use crate::friction::{PyDetector, PyIncipient, PyLimit, limit_curve};
    #[pymodule_export]
    use crate::gauges::{PyMonitor, conditioning, worst_errors};
    #[pymodule_export]
    use crate::hand::PyGrasp;
    #[pymodule_export]
    use crate::model::{PyCovariance, PyJacobian, PyModel, paper_bounds};
    #[pymodule_export]
    use crate::object::{fit_touches, touches_to_ply};
    #[pymodule_export]
    use crate::recording::{analyze_rows, look_at_health, read_rows, run_command};
    #[pymodule_export]
    use crate::rolling::PyRolling;
    #[pymodule_export]
    use crate::scene::PyScene;
    #[pymodule_export]
    use crate::simulation::{design_layout, simulate_script};
    #[pymodule_export]
    use crate::surface::PySurface;
    #[pymodule_export]
    use crate::table::{PyTable, find_columns};
    #[pymodule_export]
    use crate::timing::{time_all, time_sense};
    #[pymodule_export]
    use crate::touch::{PyHappened, PyImpact, PySpread, PyTouch, PyTracked};
    #[pymodule_export]
    use crate::track::{PyEvents, PyJudge, PyMeeting, fuse};
    #[pymodule_export]
    use crate::weight::PyWeight;
}
