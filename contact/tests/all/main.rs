//! Point contact: one by one and in batches, at flat angles and at extremes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod any_bits;
mod batch;
mod extremes;
mod grazing;
mod point_contact;
mod stored;
