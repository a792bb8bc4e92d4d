//! Point contact, one by one and in batches, at flat angles and at extremes; which model; how sure.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod any_bits;
mod auto;
mod bad_uncertainty;
mod batch;
mod choice;
mod convex_bound;
mod covariance;
mod entries;
mod extremes;
#[cfg(feature = "mixed-precision")]
mod flat_angles;
mod fusion;
mod grazing;
mod point_contact;
mod skins;
mod spherical_cap;
mod stored;
mod superquadrics;
mod thresholds;
mod track;
mod worst_case;
mod wrappers;
