//! What is taken off a reading before it is load: rest, temperature, payload.

mod compensation;
mod creep;
mod delay_line;
mod dummy_gauge;
mod inertial_unit;
mod motion;
mod moving_payload;
mod not_at_rest;
mod payload;
mod rest;
mod rest_limits;
mod state_filter;
mod tare;
mod temperature;

pub use compensation::{Compensation, Uncompensated};
pub use creep::{BadCreep, CreepCompensation};
pub use delay_line::DelayLine;
pub use dummy_gauge::{DummyGauge, DummyGaugeAccumulator, GaugesAndDummy};
pub use inertial_unit::{BadInertialUnit, InertialReading, InertialUnit};
pub use motion::Motion;
pub use moving_payload::MovingPayload;
pub use not_at_rest::NotAtRest;
pub use payload::{BadPayload, Payload};
pub use rest::{RestTest, Rested};
pub use state_filter::StateFilter;
pub use tare::{Tare, TareAccumulator, TareError};
pub use temperature::{BadTemperatureModel, GaugesAndTemperature, TemperatureCompensation};
