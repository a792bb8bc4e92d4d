//! The thresholds of the tests of rest.

use nalgebra::ComplexField;

use crate::gauges::false_alarm::{normal_threshold, student_threshold};

/// The thresholds for a number of readings.
pub(super) struct Limits {
    /// Of the slope over its standard error.
    pub(super) slope: f64,
    /// Of the distance from the mean over the standard deviation.
    pub(super) outlier: f64,
    /// Normal deviation for half the share of one test.
    deviations: f64,
}

impl Limits {
    pub(super) fn new(n: f64, tail: f64) -> Self {
        let slope = student_threshold(tail / 2.0, n - 2.0);
        // Grubbs: (n−1)/√n · √(t²/(n−2+t²)), t at tail/2n.
        let t = student_threshold(tail / (2.0 * n), n - 2.0);
        let outlier = (n - 1.0) / ComplexField::sqrt(n) * ComplexField::sqrt(t * t / (n - 2.0 + t * t));
        Self { slope, outlier, deviations: normal_threshold(tail / 2.0) }
    }

    /// Of a variance with these degrees of freedom over a known one: χ² by Wilson & Hilferty's cube.
    pub(super) fn variance(&self, degrees: f64) -> f64 {
        let ninth = 2.0 / (9.0 * degrees);
        let root = 1.0 - ninth + self.deviations * ComplexField::sqrt(ninth);
        root * root * root
    }
}
