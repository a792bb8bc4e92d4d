//! Numerical tools that several shapes share.

pub(crate) mod closest;
pub(crate) mod covariance;
pub(crate) mod ellipse;
pub(crate) mod interval;
pub(crate) mod quadratic;
pub(crate) mod roots;
pub(crate) mod support;
pub(crate) mod twofold;
pub(crate) mod vectors;
