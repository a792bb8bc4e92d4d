//! The health of a sensor, from its readings as they come: noise, resolution, drift, and what is wrong.
//!
//! [`HealthWatch`] takes samples of any number of channels, in memory that does not grow with them, and says at any time
//! what it has seen: [`Health`]. All of it is judged against the sensor itself: where it rests, what its noise is there,
//! and what its neighbouring channels do. Nothing is to be set. `docs/theory/wrench.md#the-health-of-a-channel` has the
//! tests and how often they alarm for nothing.
//!
//! ```
//! use fingertip_recordings::health::{Depth, HealthWatch, Kind, Level, WatchedChannel, What};
//!
//! let channels = ["v1", "v2"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
//! let mut watch = HealthWatch::new(channels, Depth::Brief);
//! for i in 0..4000_u32 {
//!     let noise = |k: u32| f64::from((i * k) % 101) * 1e-4;
//!     // The second channel is dead.
//!     watch.add(Some(f64::from(i) * 1e-3), &[noise(7919), 0.25]);
//! }
//! let health = watch.finish();
//! assert_eq!(health.level(), Level::Bad);
//! assert!(health.findings.iter().any(|finding| finding.what == What::Dead && finding.channels == ["v2"]));
//! ```

mod block;
mod channel;
mod channel_judge;
#[cfg(test)]
mod channel_judge_tests;
mod coupling;
mod drift;
mod finding;
mod held;
mod lines;
#[cfg(test)]
mod made;
mod noise;
mod pending;
mod report;
mod rest;
mod sensor_judge;
#[cfg(test)]
mod sensor_judge_tests;
mod spectrum;
#[cfg(test)]
mod spectrum_tests;
mod trace;
#[cfg(test)]
mod trace_tests;
mod watch;
#[cfg(test)]
mod watch_tests;
mod zero_steps;

pub use channel::{Kind, WatchedChannel};
pub use coupling::Coupling;
pub use drift::Drift;
pub use finding::{Finding, Level, What};
pub use held::HeldStretch;
pub use lines::SpectralLine;
pub use noise::{AllanPoint, Noise};
pub use report::{ChannelHealth, Excursion, Health, Rate};
pub use watch::{Depth, HealthWatch};
pub use zero_steps::{StepKind, ZeroStep};
