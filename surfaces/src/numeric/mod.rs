//! Numerical tools that several shapes share.

pub mod closest;
pub mod ellipse;
pub mod interval;
pub mod quadratic;
pub mod roots;
pub mod support;
pub mod twofold;
pub mod vectors;
