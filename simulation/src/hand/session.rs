//! A script that shows everything once.

use fingertip_surfaces::CappedCylinder;
use nalgebra::Vector3;

use super::finger::FingerPlace;
use super::gripping::{Felt, GrippingHand, GrippingSettings};
use super::object::HeldObject;
use super::script::HandScript;
use super::world::{HandOptions, HandSample, SimulatedHand};
use crate::error::SimulationError;
use crate::fingertip::Options;

/// The session of `fingertip demo --hand`, 8.5 s: three fingertips close on a jar of 200 g and 6 cm, lift it by 4 cm, tilt
/// it and back, 100 g are poured in, it is pushed, put on the table and lifted again; then another hand takes it, and
/// the fingers open.
///
/// ```
/// let hand = fingertip_simulation::hand::standard_hand(1)?;
/// assert!((hand.duration() - 8.5).abs() < 1e-9);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
///
/// # Errors
/// Never, for these numbers.
pub fn standard_hand(seed: u64) -> Result<SimulatedHand<CappedCylinder<f64>, 3>, SimulationError> {
    let tilt = Vector3::y() * 0.4;
    let script = HandScript::default()
        .open(0.5)
        .hold(0.4)
        .lift(0.04, 0.5)
        .hold(0.3)
        .turn(tilt, 0.6)
        .turn(-tilt, 0.6)
        .hold(0.2)
        .pour(0.1, Vector3::new(0.0, 0.0, -0.03), 0.6)
        .hold(0.5)
        .push(Vector3::new(1.2, 0.6, -1.0), Vector3::new(0.0, 0.01, 0.03), 0.06, 0.28)
        .hold(0.4)
        .put_down(0.04, 0.6)
        .hold(0.3)
        .lift(0.04, 0.6)
        .hold(0.5)
        .hand_over(0.5)
        .hold(0.5)
        .open(0.5);
    let options = HandOptions { sensors: Options { seed, ..Options::default() }, ..HandOptions::default() };
    SimulatedHand::new(HeldObject::cylinder(0.03, 0.05, 0.2)?, FingerPlace::ring(0.05), &script, options)
}

/// Plays the [session](standard_hand) as [`GrippingHand::play`] does. No generic function, so that it is compiled here, as
/// fast as this crate is.
///
/// # Errors
/// [`SimulationError`] for settings out of range.
pub fn play_standard_hand(
    seed: u64,
    settings: &GrippingSettings<3>,
    each: &mut dyn FnMut(&HandSample<3>, &Felt<3>, &GrippingHand<3>),
) -> Result<(), SimulationError> {
    GrippingHand::play(&mut standard_hand(seed)?, settings, each).map(|_| ())
}
