//! Slip before the slide: the loss of tangential stiffness where the motion is known.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

use crate::{BadDetector, NormalForceGate, SlipVerdict};

/// How many places divide the window.
const PLACES: usize = 4;

/// Sees the contact patch let go from its edge: the tangential force grows less and less with the
/// displacement of the fingertip (Mindlin 1949) before it stops growing.
///
/// From force alone nothing can be told before the first gross slip; with the displacement of the
/// fingertip over the object (from the hand's joints, or a stage) it can. The stiffness over the
/// last stretch of motion is compared with the mean stiffness since the motion last turned: below
/// the warning share it warns, below a fifth it calls slip. Only motion is judged, so that rest
/// gives no alarm whatever the force does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncipientSlip<T: Real> {
    gate: NormalForceGate<T>,
    window: T,
    warning_share: T,
    state: Option<State<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T: Real> {
    /// Where the motion last turned, and the force there.
    turn: Place<T>,
    /// The place farthest from it.
    farthest: Place<T>,
    farthest_distance: T,
    /// The last places, a quarter window apart, oldest first.
    places: [Place<T>; PLACES + 1],
    known: usize,
    verdict: SlipVerdict,
    /// Stiffness since the turn, once known \[N/m\].
    stiffness: Option<T>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Place<T: Real> {
    displacement: Vector3<T>,
    force: Vector3<T>,
}

impl<T: Real> Place<T> {
    /// Distance and stiffness from another place, along the way between them.
    fn from(&self, other: &Self) -> (T, T) {
        let way = self.displacement - other.displacement;
        let scale = way.amax().normalising_factor();
        let square = (way * scale).norm_squared();
        // The force on the fingertip opposes its displacement.
        let stiffness = -(self.force - other.force).dot(&(way * scale)) * scale / square;
        (square.root() / scale, stiffness)
    }
}

impl<T: Real> IncipientSlip<T> {
    /// From the gate on the normal force, the stretch of motion \[m\] over which to measure the
    /// stiffness, and the share of the mean stiffness at which to warn.
    ///
    /// The stretch is some forty times the resolution of the displacement, and long enough for
    /// the force to grow by ten times its noise; 4 µm and 0.65 suit a rubber pad and a good
    /// encoder.
    ///
    /// # Errors
    /// [`BadDetector`] unless the stretch is positive and finite and the share between 0.2 and 1.
    pub fn new(gate: NormalForceGate<T>, window: T, warning_share: T) -> Result<Self, BadDetector> {
        if !(window > T::zero() && window.is_number()) {
            return Err(BadDetector { parameter: "window", requirement: "positive and finite" });
        }
        if !(warning_share > T::literal(0.2) && warning_share < T::one()) {
            return Err(BadDetector { parameter: "warning share", requirement: "between 0.2 and 1" });
        }
        Ok(Self { gate, window, warning_share, state: None })
    }

    /// Takes the contact force and the displacement of the fingertip over the object \[m\] at the
    /// same instant. [`SlipVerdict::Warning`] and [`SlipVerdict::Slipping`] last until the motion
    /// turns or the contact opens. A sample that is not finite changes nothing.
    pub fn update(&mut self, force: &ContactForce<T>, displacement: &Vector3<T>) -> SlipVerdict {
        if !(force.is_finite() && displacement.iter().all(|x| x.is_number())) {
            return SlipVerdict::NotPressing;
        }
        if !(force.normal > self.gate.least()) {
            self.state = None;
            return SlipVerdict::NotPressing;
        }
        let here = Place { displacement: *displacement, force: force.tangential };
        let quarter = self.window / T::literal(PLACES as f64);
        let Some(state) = &mut self.state else {
            self.state = Some(State::at(here));
            return SlipVerdict::Holding;
        };
        let (distance, _) = here.from(&state.turn);
        let (back, _) = here.from(&state.farthest);
        if distance > state.farthest_distance {
            state.farthest = here;
            state.farthest_distance = distance;
        } else if back > quarter {
            // It turned: the farthest place is the new start.
            let start = state.farthest;
            *state = State::at(start);
            state.farthest = here;
            state.farthest_distance = back;
        }
        if distance < quarter && state.known == 1 {
            // At rest before the motion: the force may relax.
            state.turn.force = here.force;
            state.places[0] = state.turn;
            return state.verdict;
        }
        let newest = state.places[state.known - 1];
        let (step, _) = here.from(&newest);
        if step < quarter {
            return state.verdict;
        }
        if state.known <= PLACES {
            state.places[state.known] = here;
            state.known += 1;
        } else {
            state.places.copy_within(1.., 0);
            state.places[PLACES] = here;
        }
        if state.known <= PLACES {
            return state.verdict;
        }
        let oldest = state.places[0];
        let (way, mean) = oldest.from(&state.turn);
        let (_, local) = here.from(&oldest);
        // The first stretches settle: fewer than four windows tell no mean stiffness.
        if way >= self.window * T::literal(4.0) && mean > T::zero() && mean.is_number() {
            state.stiffness = Some(mean);
            if state.verdict == SlipVerdict::Holding && local < mean * self.warning_share {
                state.verdict = SlipVerdict::Warning;
            }
            if state.verdict == SlipVerdict::Warning && local < mean * T::literal(0.2) {
                state.verdict = SlipVerdict::Slipping;
            }
        }
        state.verdict
    }

    /// The mean tangential stiffness \[N/m\] since the motion last turned; `None` before enough
    /// motion.
    #[must_use]
    pub fn stiffness(&self) -> Option<T> {
        self.state.as_ref().and_then(|state| state.stiffness)
    }

    /// Forgets the motion.
    pub fn reset(&mut self) {
        self.state = None;
    }
}

impl<T: Real> State<T> {
    fn at(place: Place<T>) -> Self {
        Self {
            turn: place,
            farthest: place,
            farthest_distance: T::zero(),
            places: [place; PLACES + 1],
            known: 1,
            verdict: SlipVerdict::Holding,
            stiffness: None,
        }
    }
}
