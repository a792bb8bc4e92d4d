//! Laws of every slip detector.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

use super::Draws;
use super::models::between;
use crate::{SlipDetector, SlipVerdict};

/// What a detector is tried with: a contact that holds, then is loaded until it lets go, and slides.
///
/// ```
/// use fingertip_friction::testing::{SlipTrial, detector_laws};
/// use fingertip_friction::{DropDetector, ForceNoise};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let pull = |sideways| ContactForce::new(4.0, Vector3::new(sideways, 0.0, 0.0), 0.0);
/// let trial = SlipTrial {
///     hold: pull(1.0),
///     peak: pull(3.0),
///     sliding: pull(2.0),
///     noise: 0.01,
///     time_step: 1e-3,
///     learning: 100,
/// };
/// let new = DropDetector::new(ForceNoise::isotropic(0.01)?)?;
/// detector_laws(|| new, &trial);
/// // Where the force stays as it is nothing slips, and the laws miss the slip.
/// let idle = SlipTrial { peak: trial.hold, sliding: trial.hold, ..trial };
/// assert!(std::panic::catch_unwind(|| detector_laws(|| new, &idle)).is_err());
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SlipTrial<T: Real> {
    /// A force under which the contact holds, far from slip.
    pub hold: ContactForce<T>,
    /// The force at which it lets go.
    pub peak: ContactForce<T>,
    /// The force while it slides.
    pub sliding: ContactForce<T>,
    /// Standard deviation of the noise of normal and tangential force \[N\]; zero for none.
    pub noise: T,
    /// Time between samples \[s\].
    pub time_step: T,
    /// Samples of hold that the detector needs before it hears a slip.
    pub learning: usize,
}

/// Samples from hold to peak, and those of the slide.
const RAMP: usize = 50;
const SLIDE: usize = 30;
/// Uses before a reset that are tried.
const USES: usize = 12;

/// Runs every law of slip detectors: a hold without noise is no slip, and neither is warned of; a slip is seen; the same
/// samples give the same verdicts; an open contact and a pull do not press; a sample that is not finite does not press
/// and leaves no trace; a reset makes a detector as new, whatever it was given.
///
/// `make` makes a new detector, the same each time.
///
/// # Panics
/// Where a law is broken.
pub fn detector_laws<T: Real, D: SlipDetector<T>>(mut make: impl FnMut() -> D, trial: &SlipTrial<T>) {
    let step = trial.time_step;
    let mut constant = make();
    for index in 0..trial.learning + 1000 {
        let verdict = constant.update(&trial.hold, step);
        assert!(
            matches!(verdict, SlipVerdict::Holding | SlipVerdict::NotPressing),
            "a hold is no slip: {verdict:?} at sample {index} of {:?}",
            trial.hold
        );
    }

    let (mut detector, mut twin) = (make(), make());
    let mut seen = false;
    for (index, force) in trial.samples(1) {
        let verdict = detector.update(&force, step);
        let again = twin.update(&force, step);
        assert!(
            verdict == again,
            "the same samples, the same verdicts: {verdict:?} and {again:?} at sample {index}"
        );
        seen |= index >= trial.learning && verdict == SlipVerdict::Slipping;
    }
    assert!(seen, "a slip is seen: from {:?} to {:?}", trial.peak, trial.sliding);

    check_open(&mut make, trial);
    check_open_before_slip(&mut make, trial);
    check_not_finite(&mut make, trial);
    check_reset(&mut make, trial);
}

fn check_open<T: Real, D: SlipDetector<T>>(make: &mut impl FnMut() -> D, trial: &SlipTrial<T>) {
    let step = trial.time_step;
    let mut draws = Draws::new(2);
    let (mut told, mut given) = (make(), make());
    let pull = ContactForce { normal: -trial.hold.normal.abs(), ..trial.hold };
    for (index, force) in trial.samples(3).chain(trial.samples(4)) {
        let chance = draws.share();
        let verdicts = if chance < 0.02 {
            (told.update_open(step), given.update(&ContactForce::zero(), step))
        } else if chance < 0.04 {
            (told.update(&pull, step), given.update(&pull, step))
        } else {
            told.update(&force, step);
            given.update(&force, step);
            continue;
        };
        let wanted = (SlipVerdict::NotPressing, SlipVerdict::NotPressing);
        assert!(verdicts == wanted, "an open contact does not press: {verdicts:?} at sample {index}");
    }
}

/// Lets go for one sample, shortly before the slip, by no contact and by no force: what comes after is the same.
fn check_open_before_slip<T: Real, D: SlipDetector<T>>(make: &mut impl FnMut() -> D, trial: &SlipTrial<T>) {
    let step = trial.time_step;
    for before in 0..16 {
        let opens = (trial.learning + RAMP).saturating_sub(before);
        let (mut told, mut given) = (make(), make());
        for (index, force) in trial.samples(5) {
            if index == opens {
                told.update_open(step);
                given.update(&ContactForce::zero(), step);
            }
            let verdicts = (told.update(&force, step), given.update(&force, step));
            assert!(
                verdicts.0 == verdicts.1,
                "open is no force: {verdicts:?} at sample {index}, opened at {opens}"
            );
        }
    }
}

fn check_not_finite<T: Real, D: SlipDetector<T>>(make: &mut impl FnMut() -> D, trial: &SlipTrial<T>) {
    let mut draws = Draws::new(5);
    let (mut disturbed, mut plain) = (make(), make());
    for (index, force) in trial.samples(6) {
        if draws.share() < 0.1 {
            let bad = not_finite(&force, &mut draws);
            // At the time of the sample before, so that no time passes by it.
            let verdict = disturbed.update(&bad, T::zero());
            assert!(
                verdict == SlipVerdict::NotPressing,
                "not finite does not press: {verdict:?} of {bad:?} at sample {index}"
            );
        }
        let step = trial.time_step;
        let verdicts = (disturbed.update(&force, step), plain.update(&force, step));
        assert!(verdicts.0 == verdicts.1, "not finite leaves no trace: {verdicts:?} at sample {index}");
    }
}

fn check_reset<T: Real, D: SlipDetector<T>>(make: &mut impl FnMut() -> D, trial: &SlipTrial<T>) {
    let mut draws = Draws::new(7);
    let nan = T::zero() / T::zero();
    let steps = [T::zero(), -trial.time_step, nan, T::one() / T::zero(), T::GREATEST];
    let whole = trial.learning + RAMP + SLIDE;
    let mut used = make();
    for use_of_it in 0..USES {
        // Of the first uses all, so that it has learnt and called a slip.
        let end = if use_of_it < 3 { whole } else { (draws.share() * whole as f64) as usize };
        for (_, force) in trial.samples(8 + use_of_it as u64).take(end) {
            used.update(&force, trial.time_step);
            if use_of_it % 2 == 1 && draws.share() < 0.02 {
                let step = steps[(draws.share() * 5.0) as usize % 5];
                let bad = not_finite(&force, &mut draws);
                let huge = ContactForce { normal: T::GREATEST, ..force };
                let given = [bad, huge, force, ContactForce::zero()][(draws.share() * 4.0) as usize % 4];
                used.update(&given, step);
            }
        }
        used.reset();
        let mut new = make();
        for (index, force) in trial.samples(9) {
            let verdicts = (used.update(&force, trial.time_step), new.update(&force, trial.time_step));
            assert!(
                verdicts.0 == verdicts.1,
                "a reset is as new: {verdicts:?} at sample {index} after use {use_of_it}"
            );
        }
        used.reset();
    }
}

fn not_finite<T: Real>(force: &ContactForce<T>, draws: &mut Draws) -> ContactForce<T> {
    let infinite = T::one() / T::zero();
    let value = [T::zero() / T::zero(), infinite, -infinite][(draws.share() * 3.0) as usize % 3];
    match (draws.share() * 3.0) as usize {
        0 => ContactForce { normal: value, ..*force },
        1 => ContactForce { tangential: Vector3::new(value, T::zero(), T::zero()).into(), ..*force },
        _ => ContactForce { spin: value, ..*force },
    }
}

impl<T: Real> SlipTrial<T> {
    /// Hold, ramp and slide, with noise of a seed, and their numbers.
    fn samples(&self, seed: u64) -> impl Iterator<Item = (usize, ContactForce<T>)> + use<T> {
        let trial = *self;
        let mut draws = Draws::new(seed);
        (0..trial.learning + RAMP + SLIDE)
            .map(move |index| {
                let ramp = index.saturating_sub(trial.learning);
                let share = T::literal((ramp as f64 / RAMP as f64).min(1.0));
                let force =
                    if ramp > RAMP { trial.sliding } else { between(&trial.hold, &trial.peak, share) };
                let mut noise = || trial.noise * T::literal(draws.normal());
                ContactForce {
                    normal: force.normal + noise(),
                    tangential: (*force.tangential + Vector3::new(noise(), noise(), T::zero())).into(),
                    spin: force.spin,
                }
            })
            .enumerate()
    }
}
