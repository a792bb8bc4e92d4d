//! `fingertip demo --hand`: simulated fingertips on one object, the loop closed through the hand's controller.

mod figures;
mod findings;

use fingertip::friction::{FrictionModel, SlipMargin, SlipVerdict, SoftFingerLimit};
use fingertip::hand::{Grasp, HandState, ObjectWeight};
use fingertip_simulation::hand::{
    Felt, GrippingHand, GrippingSettings, HandSample, HandSegment, Weighing, play_standard_hand,
    standard_hand,
};

use super::args::DemoArguments;
use super::fault;
use crate::error::CliError;
use crate::output::Outputs;
use crate::report;

/// How many fingers.
const FINGERS: usize = 3;
/// Samples between two estimates of the mass.
const BETWEEN: usize = 20;

/// One sample of the session.
struct Moment {
    time: f64,
    /// Commanded normal forces \[N\]; `None` while the fingers close or are open.
    commanded: Option<[f64; FINGERS]>,
    /// Felt normal forces \[N\].
    felt: [f64; FINGERS],
    /// The least share of friction that is left at a contact: as the sensors say, with the friction that is believed;
    /// and as it is.
    left: Option<(f64, f64)>,
    /// Whether a slip was called, and whether a contact slipped.
    slip: (bool, bool),
    /// How far the object is from where it was gripped, in the hand \[m\].
    moved: Option<f64>,
    phase: usize,
    holding: bool,
}

/// A mass that was found, with its standard deviation \[kg\], beside the true one.
#[derive(Clone, Copy)]
struct Mass {
    time: f64,
    found: f64,
    deviation: f64,
    truth: f64,
}

struct Outcome {
    phases: Vec<(HandSegment, f64)>,
    moments: Vec<Moment>,
    masses: Vec<Mass>,
    seed: u64,
}

impl Outcome {
    /// The masses of each weighing: between two the hand weighs nothing for a while.
    fn weighings(&self) -> impl Iterator<Item = &[Mass]> {
        self.masses.chunk_by(|one, next| next.time - one.time <= 0.05)
    }
}

pub(super) fn run(arguments: &DemoArguments) -> Result<(), CliError> {
    let outputs = Outputs::guard(arguments.overwrite, "output", [], [&arguments.out])?;
    let outcome = play(arguments.seed)?;
    let findings = findings::of(&outcome);
    let page = report::of_design(&findings, figures::of(&outcome));
    outputs.write("report", &arguments.out, &page)?;
    outputs.say(&findings.to_string(), &[])
}

fn play(seed: u64) -> Result<Outcome, CliError> {
    let hand = standard_hand(seed).map_err(fault)?;
    let phases: Vec<_> = hand.phases().collect();
    let (mut moments, mut masses) = (Vec::new(), Vec::new());
    let mut scales = Scales::default();
    let mut held_at = None;
    let settings = GrippingSettings::default();
    let frictions = hand.options().skins.map(|skin| skin.static_friction);
    play_standard_hand(seed, &settings, &mut |sample, felt, gripping| {
        if let Some(mass) = scales.weigh(sample, felt, gripping, &phases) {
            masses.push(mass);
        }
        let in_air = sample.truth.table == 0.0 && felt.command.is_some();
        let moved = in_air.then(|| {
            let origin = sample.truth.origin;
            (origin - *held_at.get_or_insert(origin)).norm()
        });
        moments.push(Moment {
            time: sample.time,
            commanded: felt.command.map(|command| command.normal),
            felt: felt.fingers.map(|finger| finger.sample().map_or(0.0, |sample| sample.force.normal)),
            left: felt.command.and_then(|_| left(sample, felt, &settings, &frictions)),
            slip: (
                felt.fingers
                    .iter()
                    .filter_map(|finger| Some(finger.sample()?.slip))
                    .any(|slip| slip == SlipVerdict::Slipping),
                sample.truth.slipping.contains(&true),
            ),
            moved,
            phase: sample.phase,
            holding: felt.command.is_some_and(|command| {
                matches!(command.state, HandState::Holding | HandState::WithoutSafety)
            }),
        });
    })
    .map_err(fault)?;
    Ok(Outcome { phases, moments, masses, seed })
}

/// The least share of friction that is left, as felt and as it is; `None` unless all fingers touch.
fn left(
    sample: &HandSample<FINGERS>,
    felt: &Felt<FINGERS>,
    settings: &GrippingSettings<FINGERS>,
    frictions: &[f64; FINGERS],
) -> Option<(f64, f64)> {
    let unused = |margin: SlipMargin<f64>| 1.0 - margin.utilisation;
    let (grasp, forces) = Grasp::of_fingers(&felt.fingers);
    let felt = grasp.least_slip_margin(&forces).map(unused)?;
    let mut truth = f64::INFINITY;
    for (contact, friction) in sample.truth.contacts.iter().zip(frictions) {
        let limit = SoftFingerLimit::new(*friction, settings.arm).ok()?;
        truth = truth.min(unused(limit.slip_margin(&contact.as_ref()?.force)));
    }
    truth.is_finite().then_some((felt, truth))
}

/// What the hand weighs as it goes: begun anew whenever what it holds may have changed.
#[derive(Default)]
struct Scales {
    weighing: Option<Weighing<FINGERS>>,
    samples: usize,
}

impl Scales {
    /// Takes a sample in; the mass every so often. The script says when nothing but the hand touches the object: from a
    /// tenth of a second of a lift on, until something is poured, pushes, bears or takes it.
    fn weigh(
        &mut self,
        sample: &HandSample<FINGERS>,
        felt: &Felt<FINGERS>,
        gripping: &GrippingHand<FINGERS>,
        phases: &[(HandSegment, f64)],
    ) -> Option<Mass> {
        let (segment, start) = phases.get(sample.phase)?;
        let begins = match segment {
            HandSegment::Move { by, .. } if by.z > 0.0 => sample.time > start + 0.1,
            // After something was poured in, or a push.
            HandSegment::Hold { .. } => {
                let before = sample.phase.checked_sub(1).and_then(|index| phases.get(index));
                matches!(before, Some((HandSegment::Pour { .. } | HandSegment::Push { .. }, _)))
            }
            _ => false,
        };
        let undisturbed = match segment {
            HandSegment::Move { by, .. } => by.z > 0.0,
            HandSegment::Hold { .. } | HandSegment::Turn { .. } => true,
            _ => false,
        };
        if !undisturbed {
            self.weighing = None;
            return None;
        }
        if begins && self.weighing.is_none() {
            self.weighing = Some(gripping.weighing());
            self.samples = 0;
        }
        let weighing = self.weighing.as_mut()?;
        weighing.add(&felt.wrenches, &sample.gravity);
        self.samples += 1;
        if !self.samples.is_multiple_of(BETWEEN) {
            return None;
        }
        let mut weight = ObjectWeight::new();
        weighing.observe(&mut weight, &sample.tips);
        let (found, deviation) = weight.mass()?;
        Some(Mass { time: sample.time, found, deviation, truth: sample.truth.mass })
    }
}

#[cfg(test)]
mod tests;
