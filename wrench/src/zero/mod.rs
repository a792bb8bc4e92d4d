//! What is taken off a reading before it is load: rest, temperature, payload.

mod compensation;
mod dummy_gauge;
mod motion;
mod not_at_rest;
mod payload;
mod rest;
mod rest_limits;
mod tare;
mod temperature;

pub use compensation::{Compensation, Uncompensated};
pub use dummy_gauge::{DummyGauge, DummyGaugeAccumulator, GaugesAndDummy};
pub use motion::Motion;
pub use not_at_rest::NotAtRest;
pub use payload::{BadPayload, Payload};
pub use rest::{RestTest, Rested};
pub use tare::{Tare, TareAccumulator, TareError};
pub use temperature::{BadTemperatureModel, GaugesAndTemperature, TemperatureCompensation};
