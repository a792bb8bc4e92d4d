//! From signals to wrench, with the error of the answer.

mod closely;
mod combination;
pub(crate) mod compensated;
mod conditioning;
mod covariance;
mod curved;
mod decoupled;
pub(crate) mod equilibration;
mod error_bound;
mod gaussian;
mod inverse;
mod least_squares;
pub(crate) mod nonnegative;
pub(crate) mod orthogonal;
mod refined;
pub(crate) mod singular;
mod solver;

pub use combination::{BicchiDario, Combination, FourRosettes, ThreeRosettes, diagonal_pattern};
pub use conditioning::{BeyondBound, Conditioning};
pub use covariance::{BadCovariance, WrenchCovariance};
pub use curved::{BadCurve, CurvedInverse, ProductTerm, RadialTerm};
pub use decoupled::{Decoupled, NotDecoupled};
pub use error_bound::{ErrorBound, NoErrorBound, Uncertainty};
pub use gaussian::GaussianElimination;
pub use inverse::{BadInverse, Inverse};
pub use least_squares::{LeastSquares, LeastSquaresError};
pub use refined::Refined;
pub use singular::SingularMatrix;
pub use solver::{LinearMap, OwnError, WrenchSolver};
