//! Designing a sensor: from the loads it must bear to where its gauges go.

mod assessment;
mod bridge;
mod contact_weight;
mod criterion;
mod decoupling;
mod error;
mod landscape;
mod layout_file;
mod loads;
mod maltese_cross;
mod material;
mod nelder_mead;
mod objective;
mod quasi_newton;
mod search;
mod space;
mod stewart;
mod strain_field;
#[cfg(test)]
mod test_spaces;
mod tolerance;
mod trial;
mod tube_layout;
mod tube_space;
mod tube_strength;

pub use assessment::Assessment;
pub use bridge::{Bridge, Excitation};
pub use contact_weight::{ContactWeight, Touch};
pub use criterion::{Criterion, gram};
pub use decoupling::Decoupling;
pub use error::DesignError;
pub use landscape::Landscape;
pub use layout_file::{LAYOUT_VERSION, LayoutFile};
pub use loads::NominalLoads;
pub use maltese_cross::{MalteseCross, MalteseCrossSpace};
pub use material::Material;
pub use search::{Findings, Minimum, Progress, Search, Sensitivity, search};
pub use space::{DesignSpace, Parameter, ParameterUnit};
pub use stewart::{Stewart, StewartSpace, StewartStrength};
pub use strain_field::{GaugeAngle, LinearStructure, StrainSite, choose_sites};
pub use tolerance::{Placement, Spread, ToleranceReport, Touches, tolerance};
pub use trial::{Accuracy, MatrixUsed, Trial};
pub use tube_layout::{TubeLayout, TubeTheory};
pub use tube_space::{Coordinate, GaugeRule, TubeSpace, Wall};
pub use tube_strength::{LoadedTube, THICKEST_WALL, TubeStrength};
