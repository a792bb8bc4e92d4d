//! A fingertip on the paper's sensor, played by a script.
//!
//! A [`Script`] says what touches the fingertip: presses, rolls, drags until it slips. The
//! [`SimulatedFingertip`] turns it into what the electronics would read, sample by sample: the
//! load strains six gauges on a thin aluminium tube (Bicchi & Dario 1987, its model (16), (17)
//! with the misprints mended), each in a quarter bridge, amplified and converted with 12 bits,
//! with noise and thermal drift, and a seventh gauge that sees the temperature alone. With every
//! sample comes the truth. The same seed gives the same samples.
//!
//! Figures of the parts stand with their reasons at [`Design`], [`Electronics`],
//! [`ThermalDrift`] and [`Imperfections`].
//!
//! ```
//! use fingertip_drivers::simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
//!
//! let script = Script::default()
//!     .rest(0.5)
//!     .press(SurfacePoint::degrees(30.0, 0.0), 2.0, 0.2)
//!     .hold(0.1)
//!     .drag(0.0, (0.5, 0.35), 0.5, 0.2)
//!     .release(0.1);
//! let fingertip = SimulatedFingertip::new(&script, Options::default())?;
//! assert_eq!(fingertip.slip_onsets(), [0.5 + 0.2 + 0.1 + 0.5]);
//! let slipping = fingertip.filter(|sample| sample.truth.slipping).count();
//! assert_eq!(slipping, 200);
//! # Ok::<(), fingertip_drivers::simulation::SimulationError>(())
//! ```

mod design;
mod electronics;
mod error;
mod fingertip;
mod imperfections;
mod score;
mod script;
mod session;
mod surface_point;
mod thermal_drift;
mod timeline;

pub use design::Design;
pub use electronics::Electronics;
pub use error::{ScriptProblem, SimulationError};
pub use fingertip::{Options, SimulatedFingertip, SimulatedSample, Truth};
pub use imperfections::Imperfections;
pub use score::{LevelScore, PressScore, SessionReport, SessionScore, SlipScore};
pub use script::{Script, Segment};
pub use session::standard_session;
pub use surface_point::SurfacePoint;
pub use thermal_drift::ThermalDrift;
pub use timeline::{Phase, TrueContact};
