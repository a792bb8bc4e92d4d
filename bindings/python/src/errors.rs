//! Exceptions, with the sentences that the command says.

use core::fmt::Display;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(fingertip, FingertipError, PyValueError, "What can be wrong; all others are of this kind.");
create_exception!(fingertip, SceneError, FingertipError, "A scene is not as it must be.");
create_exception!(
    fingertip,
    ShapeError,
    FingertipError,
    "Numbers of a shape or of a contact model cannot be."
);
create_exception!(fingertip, ReadingError, FingertipError, "A reading of the sensor gives no wrench.");
create_exception!(fingertip, RecordingError, FingertipError, "A recording cannot be read or analysed.");
create_exception!(fingertip, CalibrationError, FingertipError, "Loads and signals give no calibration.");
create_exception!(fingertip, DesignError, FingertipError, "No sensor was found for what was asked.");
create_exception!(fingertip, SimulationError, FingertipError, "What is to be simulated cannot be.");
create_exception!(
    fingertip,
    FrictionError,
    FingertipError,
    "Numbers of a friction model or of a detector cannot be."
);
create_exception!(fingertip, HandError, FingertipError, "Contacts or settings of a hand cannot be.");

macro_rules! kinds {
    ($($name:ident: $exception:ident;)*) => {
        $(
            #[doc = concat!("As a [`", stringify!($exception), "`].")]
            pub(crate) fn $name(error: impl Display) -> PyErr {
                $exception::new_err(error.to_string())
            }
        )*
    };
}

kinds! {
    bad: FingertipError;
    scene: SceneError;
    shape: ShapeError;
    reading: ReadingError;
    recording: RecordingError;
    calibration: CalibrationError;
    design: DesignError;
    simulation: SimulationError;
    friction: FrictionError;
    hand: HandError;
}
