#![doc = include_str!("../README.md")]

extern crate alloc;

mod columns;
mod doubts;
mod estimate;
mod export;
mod fault;
mod formula;
mod friction;
mod grip;
mod input;
mod meaning;
mod model;
mod pipeline;
mod projection;
pub mod registry;
mod scene;
mod skin;
mod slip;
mod stages;
mod surface;
mod uncertainty;

pub use estimate::{Estimate, Learnt};
pub use export::{ExportError, Scalar};
pub use fault::{SceneError, SceneFault, SceneProblem, VERSION};
pub use formula::BadFormula;
pub use friction::{Friction, Limit};
pub use input::Convention;
pub use model::Model;
pub use pipeline::{Felt, Pipeline, Tells};
pub use projection::{MapKind, Projection};
pub use scene::Scene;
pub use skin::Skin;
pub use slip::{Detector, SlipWatch};
pub use uncertainty::{Spread, Uncertainty};
