//! Numerical tools that several shapes share.

pub(crate) mod closest;
pub(crate) mod ellipse;
pub mod fine_pose;
pub(crate) mod interval;
pub mod mixed_precision;
pub mod moved;
pub(crate) mod powers;
pub mod quadratic;
pub(crate) mod range;
pub mod roots;
pub(crate) mod support;
pub mod twofold;
pub mod vectors;
