//! What a row says of all fingers together.

use fingertip::hand::{FingerLimits, FingerState, Grasp, GraspContact, Grip, GripOutcome, Hand, LeastGrip};
use fingertip::wrench::{ContactForce, RigidTransform, Sensor, Wrench};
use fingertip_recordings::Row;
use fingertip_scene::Felt;

use super::beside::{Answers, Asked};
use super::file::{FingerScene, HandScene, MOST, SensorsIn};
use super::limits::ROWS;

/// What the fingers feel in a row, in the frame of the hand.
pub(super) struct Fingers {
    fingers: [FingerState<f64>; MOST],
    load: Wrench<f64, Hand>,
}

/// What all that means.
pub(super) struct Grasped {
    pub(super) contacts: [Option<GraspContact<f64>>; MOST],
    pub(super) forces: [ContactForce<f64>; MOST],
    /// What the object loads the fingers with, of whatever they feel.
    pub(super) load: Wrench<f64, Hand>,
    /// How far each contact is from slipping \[N\].
    pub(super) margins: [Option<f64>; MOST],
    /// The sum of the normal forces \[N\].
    pub(super) grip: f64,
    /// The part of it with which the object is squeezed \[N\].
    pub(super) squeeze: f64,
    /// The least sum of normal forces that holds the load, and each finger's \[N\]: with safety, or else without it.
    pub(super) least: Option<(f64, [f64; MOST])>,
    pub(super) held: &'static str,
    /// What the scene asks for beside.
    pub(super) answers: Answers,
}

impl Fingers {
    pub(super) fn none() -> Self {
        Self { fingers: [FingerState::Free; MOST], load: Wrench::zero() }
    }

    /// Takes in what a finger feels, with its pose in the hand. A sensor in the object feels what the finger does to
    /// the object: the finger feels the opposite, and its normal is the other one.
    pub(super) fn add(
        &mut self,
        index: usize,
        finger: &FingerScene,
        sensors_in: SensorsIn,
        pose: &RigidTransform<f64, Hand, Sensor>,
        felt: &Felt<f64>,
    ) {
        let wrench = felt.touch.wrench.expressed_in(pose);
        let told = felt.touch.finger(&finger.friction).expressed_in(pose);
        let (wrench, told) = match sensors_in {
            SensorsIn::Fingers => (wrench, told),
            SensorsIn::Object => (-wrench, told.reversed()),
        };
        self.load = self.load + wrench;
        if let Some(to) = self.fingers.get_mut(index) {
            *to = told;
        }
    }
}

impl Grasped {
    /// The program starts from the last row's solution. Where a finger says what cannot be, what the others are to bear is
    /// not known, and neither the least grip nor how far disturbances can grow is asked for.
    pub(super) fn of(
        fingers: Fingers,
        limits: &[FingerLimits<f64, ROWS>; MOST],
        scene: &HandScene,
        program: &mut LeastGrip<f64, MOST, ROWS>,
        (asked, row, time): (&mut Asked<'_>, &Row<'_>, f64),
    ) -> Self {
        let Fingers { fingers, load } = fingers;
        let (grasp, forces) = Grasp::of_fingers(&fingers);
        let contacts = *grasp.contacts();
        let margins = grasp.slip_margins(&forces).map(|margin| margin.map(|margin| margin.newtons));
        let touching = |forces: &[ContactForce<f64>; MOST]| -> f64 {
            forces.iter().zip(&contacts).filter_map(|(f, contact)| contact.map(|_| f.normal)).sum()
        };
        let (grip, squeeze) = (touching(&forces), touching(&grasp.split(&forces).internal));
        // A safety that leaves no friction leaves no contact: it was checked, and friction is not that small.
        let careful =
            contacts.map(|contact| contact.and_then(|contact| contact.with_safety(scene.safety).ok()));
        let careful = Grasp::new(careful);
        let plausible = fingers.iter().all(|finger| finger.is_plausible(scene.greatest_ratio));
        let (least, held) = if !plausible {
            (None, "doubtful")
        } else if grasp.touching() == 0 {
            (None, "")
        } else {
            match program.solve(&careful, limits, &load) {
                GripOutcome::Held(grip) => (Some(normal(&grip)), "held"),
                GripOutcome::NotFinite => (None, "not_finite"),
                failed => match LeastGrip::new().solve(&grasp, limits, &load) {
                    GripOutcome::Held(grip) => (Some(normal(&grip)), "without_safety"),
                    _ if matches!(failed, GripOutcome::Undecided) => (None, "undecided"),
                    _ => (None, "cannot_hold"),
                },
            }
        };
        let known = (plausible && grasp.touching() > 0).then_some(&load);
        let answers = Answers {
            other: asked.other(row, &load),
            reaches: asked.reaches(&careful, limits, known),
            quality: asked.quality(time, &careful),
        };
        Self { contacts, forces, load, margins, grip, squeeze, least, held, answers }
    }

    /// The least of the margins \[N\].
    pub(super) fn least_margin(&self) -> Option<f64> {
        self.margins.iter().flatten().copied().reduce(f64::min)
    }

    /// How many fingers touch.
    pub(super) fn touching(&self) -> usize {
        self.contacts.iter().flatten().count()
    }
}

/// The sum of the normal forces of a grip, and each finger's.
fn normal(grip: &Grip<f64, MOST>) -> (f64, [f64; MOST]) {
    let each = grip.forces.map(|force| force.normal);
    (each.iter().sum(), each)
}
