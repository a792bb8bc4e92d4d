#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("fingertip-wrench needs one of the features `std` and `libm` for its square root");

#[cfg(feature = "serde")]
mod array_in_file;
mod channels;
mod combination;
mod compensated;
mod compensation;
mod conditioning;
mod consistency;
mod contact_force;
mod contact_frame;
mod covariance;
mod decoupled;
#[cfg(feature = "num-dual")]
mod dual;
mod dummy_gauge;
mod equilibration;
mod error_bound;
mod false_alarm;
mod frame;
pub mod gauge_layout;
mod gaussian;
mod hardware_sqrt;
mod inverse;
mod largest;
mod least_squares;
mod line_of_action;
mod nonnegative;
mod orthogonal;
mod payload;
mod real;
mod refined;
mod rest;
mod rounding;
mod sensor_matrix;
mod singular;
mod singular_values;
mod solver;
mod stored;
mod tangential_force;
mod tare;
mod temperature;
mod transform;
pub mod units;
mod wrench;

pub use channels::{BadLimits, ChannelFault, ChannelLimits, ChannelMonitor};
pub use combination::{BicchiDario, Combination, FourRosettes, ThreeRosettes, diagonal_pattern};
pub use compensation::{Compensation, Uncompensated};
pub use conditioning::{BeyondBound, Conditioning};
pub use consistency::{BadCheck, ConsistencyCheck, DriftMonitor, Fault, Verdict};
pub use contact_force::ContactForce;
pub use contact_frame::{BadNormal, ContactFrame, ContactLoad};
pub use covariance::{BadCovariance, WrenchCovariance};
pub use decoupled::{Decoupled, NotDecoupled};
pub use dummy_gauge::{DummyGauge, DummyGaugeAccumulator, GaugesAndDummy};
pub use error_bound::{ErrorBound, NoErrorBound, Uncertainty};
pub use frame::{Frame, Sensor};
pub use gaussian::GaussianElimination;
pub use inverse::{BadInverse, Inverse};
pub use least_squares::{LeastSquares, LeastSquaresError};
pub use line_of_action::{Line, LineOfAction, NoLineOfAction};
pub use payload::{BadPayload, Payload};
pub use real::Real;
pub use refined::Refined;
pub use rest::{NotAtRest, RestTest, Rested};
pub use sensor_matrix::{SensorMatrix, SensorMatrixError};
pub use singular::SingularMatrix;
pub use singular_values::singular_values;
pub use solver::{LinearSolver, OwnError, WrenchSolver};
pub use tangential_force::{TangentialForce, scaled_length};
pub use tare::{Tare, TareAccumulator, TareError};
pub use temperature::{BadTemperatureModel, GaugesAndTemperature, TemperatureCompensation};
pub use transform::{RigidTransform, TransformError};
pub use wrench::Wrench;
