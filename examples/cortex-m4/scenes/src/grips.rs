//! The least grip of five soft fingers under a load that moves: what benchmarks, the count of instructions and the firmware
//! solve.

use fingertip::hand::{FingerLimits, Grasp, GraspContact, GripOutcome, Hand, LeastGrip};
use fingertip::wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::felt::Words;

/// Fingers of the hand.
pub const FINGERS: usize = 5;

/// Where a thumb and four fingers touch a jar of 4 cm radius: cosine and sine of their angles, and heights \[m\].
const PLACES: [[f64; 3]; FINGERS] = [
    [1.0, 0.0, 0.0],
    [-0.588_501_117_255, 0.808_496_403_820, 0.02],
    [-0.942_222_340_669, 0.334_988_150_156, 0.01],
    [-0.936_456_687_291, -0.350_783_227_690, -0.01],
    [-0.574_823_946_533, -0.818_277_111_064, -0.02],
];

/// Cosine and sine of a thousandth of a turn.
const TURN: [f64; 2] = [0.999_980_260_856_137, 0.006_283_143_965_559];

/// What a call solves.
pub type Outcome<T> = GripOutcome<T, FINGERS>;

/// What the object loads the fingers with.
pub type GripLoad<T> = Wrench<T, Hand>;

impl Words for Outcome<f32> {
    fn words(&self, mut visit: impl FnMut(u32)) {
        let Self::Held(grip) = self else { return visit(u32::MAX) };
        visit(grip.steps);
        visit(grip.cost.to_bits());
        for force in &grip.forces {
            visit(force.normal.to_bits());
            visit(force.spin.to_bits());
            force.tangential.vector().iter().for_each(|x| visit(x.to_bits()));
        }
    }
}

/// A grasp, and a load that turns once in a thousand samples, as much as at 1 kHz it turns in a second.
#[derive(Clone, Copy, Debug)]
pub struct Grips<T: Real> {
    grasp: Grasp<T, FINGERS>,
    limits: [FingerLimits<T, 1>; FINGERS],
    least: LeastGrip<T, FINGERS, 1>,
    turn: [T; 2],
}

impl<T: Real> Grips<T> {
    /// Friction 0.6, torque arms of 2 mm, fingers of 15 N. `None` never happens: the parameters are constants.
    #[must_use]
    pub fn new() -> Option<Self> {
        let mut contacts = [None; FINGERS];
        for (contact, [x, y, height]) in contacts.iter_mut().zip(PLACES) {
            let place = Vector3::new(0.04 * x, 0.04 * y, height).map(T::literal);
            let normal = Vector3::new(-x, -y, 0.0).map(T::literal);
            *contact = Some(GraspContact::soft(place, normal, T::literal(0.6), T::literal(2e-3)).ok()?);
        }
        let limits = [FingerLimits::none().with_greatest_normal(T::literal(15.0)).ok()?; FINGERS];
        let turn = [T::one(), T::zero()];
        Some(Self { grasp: Grasp::new(contacts), limits, least: LeastGrip::new(), turn })
    }

    /// The load of the next sample.
    pub fn next_load(&mut self) -> GripLoad<T> {
        let ([x, y], [cos, sin]) = (self.turn, TURN.map(T::literal));
        self.turn = [x * cos - y * sin, x * sin + y * cos];
        let force = Vector3::new(T::literal(0.8) * y, T::literal(0.5) * x, T::literal(-2.9));
        Wrench::from_force_at(&Vector3::new(5e-3, 0.0, -0.02).map(T::literal), force)
    }

    /// From the solution of the sample before.
    #[inline(always)]
    pub fn warm(&mut self, load: &GripLoad<T>) -> Outcome<T> {
        self.least.solve(&self.grasp, &self.limits, load)
    }

    /// From nothing.
    #[inline(always)]
    pub fn cold(&mut self, load: &GripLoad<T>) -> Outcome<T> {
        self.least.forget();
        self.least.solve(&self.grasp, &self.limits, load)
    }
}
