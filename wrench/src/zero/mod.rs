//! What is taken off a reading before it is load: rest, temperature, payload.

mod compensation;
mod dummy_gauge;
mod motion;
mod payload;
mod rest;
mod tare;
mod temperature;

pub use compensation::{Compensation, Uncompensated};
pub use dummy_gauge::{DummyGauge, DummyGaugeAccumulator, GaugesAndDummy};
pub use motion::Motion;
pub use payload::{BadPayload, Payload};
pub use rest::{NotAtRest, RestTest, Rested};
pub use tare::{Tare, TareAccumulator, TareError};
pub use temperature::{BadTemperatureModel, GaugesAndTemperature, TemperatureCompensation};
