#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("fingertip-wrench needs one of the features `std` and `libm` for its square root");

mod combination;
mod compensated;
mod compensation;
mod conditioning;
mod contact_force;
mod covariance;
mod decoupled;
mod equilibration;
mod error_bound;
mod frame;
pub mod gauge_layout;
mod gaussian;
mod hardware_sqrt;
mod inverse;
mod least_squares;
mod line_of_action;
mod nonnegative;
mod orthogonal;
mod real;
mod refined;
mod rounding;
mod sensor_matrix;
mod singular;
mod singular_values;
mod solver;
mod tare;
mod transform;
mod wrench;

pub use combination::{BicchiDario, Combination, FourRosettes, ThreeRosettes, diagonal_pattern};
pub use compensation::{Compensation, Uncompensated};
pub use conditioning::{BeyondBound, Conditioning};
pub use contact_force::ContactForce;
pub use covariance::{BadCovariance, WrenchCovariance};
pub use decoupled::{Decoupled, NotDecoupled};
pub use error_bound::{ErrorBound, NoErrorBound, Uncertainty};
pub use frame::{Frame, Sensor};
pub use gaussian::GaussianElimination;
pub use inverse::Inverse;
pub use least_squares::{LeastSquares, LeastSquaresError};
pub use line_of_action::{Line, LineOfAction, NoLineOfAction};
pub use real::Real;
pub use refined::Refined;
pub use sensor_matrix::{SensorMatrix, SensorMatrixError};
pub use singular::SingularMatrix;
pub use singular_values::singular_values;
pub use solver::{LinearSolver, OwnError, WrenchSolver};
pub use tare::{Tare, TareAccumulator, TareError};
pub use transform::{RigidTransform, TransformError};
pub use wrench::Wrench;
