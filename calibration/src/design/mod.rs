//! Designing a sensor: from the loads it must bear to where its gauges go (Bicchi & Dario 1987,
//! section 4; Bicchi 1992).
//!
//! * A [`DesignSpace`] is a family of sensors: [`TubeSpace`] (the paper's tube, with any number of gauges
//!   free, symmetric or fixed), [`StewartSpace`], [`MalteseCrossSpace`], and [`LinearStructure`] for
//!   anything whose compliance is known from finite elements. Channels may be gauges or [`Bridge`]s.
//! * A [`Criterion`] says what is to be small; [`search()`] finds its local minima, and [`Landscape`] shows
//!   the ground between them.
//! * [`Assessment`], [`tolerance()`] and [`Trial`] judge a design: as drawn, as it will be made, and as it
//!   will be used. [`LoadedTube`] says whether it holds.
//! * [`LayoutFile`] keeps it, and gives it to the solvers; [`Decoupling`] finds the sums and differences of
//!   signals that untangle it, if there are any.
//!
//! ```
//! use fingertip_calibration::design::{
//!     Criterion, LoadedTube, Material, NominalLoads, Search, TubeSpace, Wall, search,
//! };
//!
//! // The paper's six gauges for 10 N and 0.1 N·m: radius, gauge angle and distance of the rings are free.
//! let loads = NominalLoads::equal(10.0, 0.1)?;
//! let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
//! let angles = (1_f64.to_radians(), 59_f64.to_radians());
//! let space =
//!     TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
//! let found = search(&space, &Criterion::ConditionNumber, &loads, &Search::default(), &|_| ())?;
//! let best = found.best().ok_or("nothing found")?;
//! assert!((best.criterion - 4.183).abs() < 1e-3); // at R = 6.55 mm, Q = 14.45°, d = 13.46 mm
//! assert_eq!(best.share, 1.0); // from every start
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

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
mod touch;
mod trial;
mod tube_layout;
mod tube_space;
mod tube_strength;

pub use assessment::Assessment;
pub use bridge::{Bridge, Excitation};
pub use contact_weight::ContactWeight;
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
pub use touch::{DesignTouch, TouchSet};
pub use trial::{Accuracy, MatrixUsed, Trial};
pub use tube_layout::{TubeLayout, TubeTheory};
pub use tube_space::{Coordinate, GaugeRule, TubeSpace, Wall};
pub use tube_strength::{LoadedTube, THICKEST_WALL, TubeFailure, TubeStrength};
