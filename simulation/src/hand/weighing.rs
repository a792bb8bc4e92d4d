//! The mean load of a lift, with all that is not certain of it.

use fingertip_hand::{Hand, ObjectWeight, UncertainWrench};
use fingertip_wrench::{RigidTransform, Sensor, SensorMatrix, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::imperfections::Imperfections;

/// Takes the loads of a lift in, and gives their mean to an [`ObjectWeight`] as one observation.
///
/// One, since most of what is wrong does not average out: beside the noise of this sample and of the tare, the scale
/// and the entries of each sensor's calibration ([`Imperfections`]) stay what they are. With `w` the mean on a
/// fingertip, `C` its normalised matrix and `w̄ = w/nominal`, its covariance is
/// `Σ/n + Σ/n₀ + s² w wᵀ + e²|w̄|² C⁻¹ diag(maxⱼ C²ᵢⱼ) C⁻ᵀ`; the sensors are independent.
///
/// ```
/// # use fingertip_simulation::hand::{FingerPlace, GrippingHand, GrippingSettings, HandOptions};
/// # use fingertip_simulation::hand::{HandScript, HeldObject, SimulatedHand};
/// # let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// # let script = HandScript::default().open(0.3).hold(0.4).lift(0.03, 0.5).hold(0.2);
/// # let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// use fingertip_hand::ObjectWeight;
///
/// let (mut weighing, mut tips) = (None, None);
/// GrippingHand::play(&mut hand, &GrippingSettings::default(), |sample, felt, gripping| {
///     // While the jar of 0.2 kg hangs still in the air.
///     if sample.phase == 3 {
///         weighing.get_or_insert_with(|| gripping.weighing()).add(&felt.wrenches, &sample.gravity);
///         tips = Some(sample.tips);
///     }
/// })?;
/// let mut weight = ObjectWeight::new();
/// assert!(weighing.expect("it hung").observe(&mut weight, &tips.expect("it hung")));
/// let (kilograms, deviation) = weight.mass().expect("observed");
/// assert!((kilograms - 0.2).abs() < 4.0 * deviation && deviation < 0.02);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Weighing<const K: usize> {
    sensors: [Doubt; K],
    sums: [Vector6<f64>; K],
    gravity: Vector3<f64>,
    samples: u32,
}

/// What is not certain of one sensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubt {
    /// Of a sample, and how many there were at rest.
    noise: Matrix6<f64>,
    at_rest: f64,
    scale: f64,
    /// Of the wrench, for a normalised wrench of length one.
    entries: Matrix6<f64>,
    nominal: Vector6<f64>,
}

impl Doubt {
    pub(super) fn new(
        matrix: &SensorMatrix<f64, 6>,
        flaws: &Imperfections,
        noise: Matrix6<f64>,
        at_rest: f64,
    ) -> Option<Self> {
        let inverse = matrix.normalised().try_inverse()?;
        let nominal = *matrix.nominal();
        let mut root = inverse;
        for (mut column, row) in root.column_iter_mut().zip(matrix.normalised().row_iter()) {
            column *= row.amax() * flaws.calibration_entry;
        }
        for (mut row, nominal) in root.row_iter_mut().zip(nominal.iter()) {
            row *= *nominal;
        }
        let entries = root * root.transpose();
        Some(Self { noise, at_rest, scale: flaws.calibration_scale, entries, nominal })
    }

    fn covariance(&self, mean: &Vector6<f64>, samples: f64) -> Matrix6<f64> {
        let normalised = mean.component_div(&self.nominal).norm_squared();
        self.noise * (samples.recip() + self.at_rest.recip())
            + mean * mean.transpose() * (self.scale * self.scale)
            + self.entries * normalised
    }
}

impl<const K: usize> Weighing<K> {
    pub(super) fn new(sensors: [Doubt; K]) -> Self {
        Self { sensors, sums: [Vector6::zeros(); K], gravity: Vector3::zeros(), samples: 0 }
    }

    /// Takes the wrenches of a sample in, and gravity less the acceleration of the hand, in its frame \[m/s²\]. A sample
    /// that is not finite is left out.
    pub fn add(&mut self, wrenches: &[Wrench<f64>; K], gravity: &Vector3<f64>) {
        if !(wrenches.iter().all(Wrench::is_finite) && gravity.iter().all(|x| x.is_finite())) {
            return;
        }
        for (sum, wrench) in self.sums.iter_mut().zip(wrenches) {
            *sum += wrench.components();
        }
        self.gravity += gravity;
        self.samples = self.samples.saturating_add(1);
    }

    /// The mean load on all fingertips, with the tips where they are now, and the mean gravity; `None` before the first
    /// sample.
    #[must_use]
    pub fn load(
        &self,
        tips: &[RigidTransform<f64, Hand, Sensor>; K],
    ) -> Option<(UncertainWrench<f64>, Vector3<f64>)> {
        if self.samples == 0 {
            return None;
        }
        let samples = f64::from(self.samples);
        let mut load = UncertainWrench::zero();
        for ((sum, doubt), tip) in self.sums.iter().zip(&self.sensors).zip(tips) {
            let mean = sum / samples;
            let covariance = doubt.covariance(&mean, samples);
            let felt = UncertainWrench { wrench: Wrench::from_components(&mean), covariance };
            load = load + felt.expressed_in(tip);
        }
        Some((load, self.gravity / samples))
    }

    /// Lets a weight learn from the mean; `false`, and nothing learnt, before the first sample.
    pub fn observe(
        &self,
        weight: &mut ObjectWeight<f64>,
        tips: &[RigidTransform<f64, Hand, Sensor>; K],
    ) -> bool {
        self.load(tips).is_some_and(|(load, gravity)| weight.observe(&load, &gravity))
    }
}
