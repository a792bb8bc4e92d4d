#![doc = include_str!("../README.md")]

extern crate alloc;

mod batch;
mod carried;
mod columns;
mod doubts;
mod estimate;
mod export;
mod fault;
mod filter;
mod formula;
mod friction;
mod front;
mod grip;
mod input;
mod meaning;
mod model;
mod noise;
mod pipeline;
mod projection;
pub mod registry;
mod rest;
mod scene;
mod sensor;
mod skin;
mod slip;
mod stages;
mod surface;
mod uncertainty;

pub use carried::{BadCarried, Carried};
pub use estimate::{Estimate, Learnt};
pub use export::{ExportError, Scalar};
pub use fault::{SceneError, SceneFault, SceneProblem, VERSION};
pub use filter::Filter;
pub use formula::BadFormula;
pub use friction::{Friction, Limit};
pub use input::Convention;
pub use model::Model;
pub use pipeline::{Felt, Pipeline, Tells};
pub use projection::{MapKind, Projection};
pub use rest::{Doubt, RestWatch};
pub use scene::Scene;
pub use sensor::{BadSensor, GAUGES, GaugeReading, NoWrench, Sensor};
pub use skin::Skin;
pub use slip::{Detector, SlipWatch};
pub use uncertainty::{Spread, Uncertainty};
