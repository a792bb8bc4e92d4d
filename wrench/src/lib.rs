#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("fingertip-wrench needs one of the features `std` and `libm` for its square root");

mod compensation;
mod contact_force;
#[cfg(feature = "num-dual")]
mod dual;
mod frame;
pub mod gauge_layout;
mod gaussian;
mod hardware_sqrt;
mod line_of_action;
mod real;
mod sensor_matrix;
mod solver;
mod tare;
mod transform;
mod wrench;

pub use compensation::{Compensation, Uncompensated};
pub use contact_force::ContactForce;
pub use frame::{Frame, Sensor};
pub use gaussian::{GaussianElimination, SingularMatrix};
pub use line_of_action::{Line, LineOfAction, NoLineOfAction};
pub use real::Real;
pub use sensor_matrix::{SensorMatrix, SensorMatrixError};
pub use solver::WrenchSolver;
pub use tare::{Tare, TareAccumulator, TareError};
pub use transform::{RigidTransform, TransformError};
pub use wrench::Wrench;
