#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("fingertip-wrench needs one of the features `std` and `libm` for its square root");

#[cfg(feature = "serde")]
mod array_in_file;
mod gauges;
mod health;
mod load;
#[doc(hidden)]
pub mod numeric;
mod scalar;
mod solve;
mod stored;
pub mod units;
mod zero;

pub use gauges::gauge_layout;
pub use gauges::{
    BadCheck, BadRegion, CalibratedRegion, ConsistencyCheck, DriftMonitor, Fault, SensorMatrix,
    SensorMatrixError, Verdict, WithinRegion,
};
pub use health::{AllanVariance, BadLimits, ChannelFault, ChannelLimits, ChannelMonitor, Resolution};
pub use load::{
    BadNormal, ContactForce, ContactFrame, ContactLoad, Frame, Line, LineOfAction, NoLineOfAction,
    RigidTransform, Sensor, TangentialForce, TransformError, Wrench, scaled_length, tangents,
};
pub use numeric::singular_values;
pub use scalar::Real;
pub use solve::{
    BadCovariance, BadCurve, BadInverse, BeyondBound, BicchiDario, Combination, Conditioning, CurvedInverse,
    Decoupled, ErrorBound, FourRosettes, GaussianElimination, Inverse, LeastSquares, LeastSquaresError,
    LinearMap, NoErrorBound, NotDecoupled, OwnError, ProductTerm, RadialTerm, Refined, SingularMatrix,
    ThreeRosettes, Uncertainty, WrenchCovariance, WrenchSolver, diagonal_pattern,
};
pub use zero::{
    BadCreep, BadInertialUnit, BadPayload, BadTemperatureModel, Compensation, CreepCompensation, DelayLine,
    DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaugesAndTemperature, InertialReading, InertialUnit,
    Motion, MovingPayload, NotAtRest, Payload, RestTest, Rested, StateFilter, Tare, TareAccumulator,
    TareError, TemperatureCompensation, Uncompensated,
};
