//! Slip before the slide: the loss of tangential stiffness where the motion is known.

use fingertip_wrench::{ContactForce, Real, stored};
use nalgebra::Vector3;

use crate::{BadParameter, NormalForceGate, SlipVerdict};

/// How many places divide the window.
const PLACES: usize = 4;

/// Sees the contact patch let go from its edge: the tangential force grows less and less with the
/// displacement of the fingertip (Mindlin 1949) before it stops growing.
///
/// From force alone nothing can be told before the first gross slip; with the displacement of the
/// fingertip over the object (from the hand's joints, or a stage) it can. The stiffness over the
/// last stretch of motion is compared with that of the patch while it stuck, which is the greatest
/// mean stiffness since the motion last turned (the mean itself falls as the patch lets go): below
/// the warning share it warns, below a fifth it calls slip. Only motion is judged, so that rest
/// gives no alarm whatever the force does.
///
/// ```
/// use fingertip_friction::{ForceNoise, IncipientSlip, NormalForceGate, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.001)?);
/// let mut slip = IncipientSlip::new(gate, 4e-6)?;
/// // A pad of 50 kN/m under a tip that moves by a micrometre a sample: it sticks.
/// for step in 0..100 {
///     let moved = Vector3::new(1e-6 * f64::from(step), 0.0, 0.0);
///     let force = ContactForce::new(10.0, -moved * 5e4, 0.0);
///     assert_ne!(slip.update(&force, &moved), SlipVerdict::Slipping);
/// }
/// assert!(slip.stiffness().is_some_and(|stiffness| (stiffness - 5e4).abs() < 1e3));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncipientSlip<T: Real> {
    gate: NormalForceGate<T>,
    window: T,
    /// Places per metre.
    scale: T,
    warning_share: T,
    state: Option<State<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T: Real> {
    /// Where the motion last turned, and the force there.
    turn: Place<T>,
    /// The place farthest from it.
    farthest: Place<T>,
    /// Square of its distance from the turn, in steps between places.
    farthest_square: T,
    /// The last places, a quarter window apart, the oldest after the newest.
    places: [Place<T>; PLACES + 1],
    newest: usize,
    /// No place has been left behind yet.
    resting: bool,
    verdict: SlipVerdict,
    /// Greatest mean stiffness since the turn \[N/m\], zero while unknown.
    stiffness: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Place<T: Real> {
    displacement: Vector3<T>,
    force: Vector3<T>,
}

/// A stiffness as the quotient `resisted / way`, for comparisons without a division. Where the places
/// are one, both are zero, and it is neither more nor less than any other.
#[derive(Clone, Copy)]
struct Stiffness<T: Real> {
    resisted: T,
    way: T,
}

impl<T: Real> Stiffness<T> {
    #[inline]
    fn is_below(&self, limit: T) -> bool {
        self.resisted < limit * self.way
    }

    #[inline]
    fn is_above(&self, limit: T) -> bool {
        self.resisted > limit * self.way
    }
}

impl<T: Real> Place<T> {
    /// Square of the distance to a displacement, in units of `1/scale` metres. It underflows only far
    /// below a unit, and overflows only far away.
    #[inline]
    fn square_to(&self, displacement: &Vector3<T>, scale: T) -> T {
        ((displacement - self.displacement) * scale).norm_squared()
    }

    /// Stiffness \[N/m\] from here to another place: the force on the fingertip opposes its
    /// displacement.
    #[inline]
    fn stiffness_to(&self, other: &Self, scale: T) -> Stiffness<T> {
        let way = (other.displacement - self.displacement) * scale;
        Stiffness { resisted: -(other.force - self.force).dot(&way) * scale, way: way.norm_squared() }
    }

    /// Takes a sample's place. It is written component by component: a copy of a whole place that has just been
    /// put together stalls until all its parts have arrived.
    #[inline]
    fn set(&mut self, force: &Vector3<T>, displacement: &Vector3<T>) {
        self.displacement.copy_from(displacement);
        self.force.copy_from(force);
    }
}

impl<T: Real> IncipientSlip<T> {
    /// From the gate on the normal force and the stretch of motion \[m\] over which to measure the
    /// stiffness, warning at 0.65 of the mean stiffness.
    ///
    /// The stretch is some forty times the resolution of the displacement, and long enough for
    /// the force to grow by twenty times its noise (with ten, noise alone warns on three of ten ramps); 4 µm and 0.65 suit a rubber pad and a good
    /// encoder.
    ///
    /// # Errors
    /// [`BadParameter`] unless the stretch is positive, finite and no subnormal number.
    pub fn new(gate: NormalForceGate<T>, window: T) -> Result<Self, BadParameter> {
        if !(window > T::zero() && window.is_number()) {
            return Err(BadParameter { parameter: "window", requirement: "positive and finite" });
        }
        let scale = T::literal(PLACES as f64) / window;
        if !scale.is_number() {
            return Err(BadParameter { parameter: "window", requirement: "no subnormal number" });
        }
        Ok(Self { gate, window, scale, warning_share: T::literal(0.65), state: None })
    }

    /// With another share of the mean stiffness at which to warn: the greater, the sooner, and the more
    /// often without cause.
    ///
    /// # Errors
    /// [`BadParameter`] unless the share is between 0.2 and 1.
    pub fn with_warning_share(self, share: T) -> Result<Self, BadParameter> {
        if !(share > T::literal(0.2) && share < T::one()) {
            return Err(BadParameter { parameter: "warning share", requirement: "between 0.2 and 1" });
        }
        Ok(Self { warning_share: share, ..self })
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
        let (scale, tangential) = (self.scale, force.tangential.vector());
        let Some(state) = &mut self.state else {
            self.state = Some(State::at(Place { displacement: *displacement, force: tangential }));
            return SlipVerdict::Holding;
        };
        let square = state.turn.square_to(displacement, scale);
        if square > state.farthest_square {
            state.farthest.set(&tangential, displacement);
            state.farthest_square = square;
        } else {
            let back = state.farthest.square_to(displacement, scale);
            if back > T::one() {
                state.turn_around(&tangential, displacement, back);
            }
        }
        if square < T::one() && state.resting {
            // At rest before the motion: the force may relax.
            state.turn.force = tangential;
            state.places[0] = state.turn;
            return state.verdict;
        }
        if state.places[state.newest].square_to(displacement, scale) < T::one() {
            return state.verdict;
        }
        state.arrive(&tangential, displacement, scale, self.warning_share)
    }

    /// The tangential stiffness of the patch that sticks \[N/m\]: the greatest mean since the motion
    /// last turned; `None` before enough motion.
    #[must_use]
    pub fn stiffness(&self) -> Option<T> {
        self.state.as_ref().map(|state| state.stiffness).filter(|stiffness| *stiffness > T::zero())
    }

    /// Forgets the motion.
    pub fn reset(&mut self) {
        self.state = None;
    }
}

impl<T: Real> State<T> {
    /// The motion turned: the farthest place is the new start.
    #[inline(never)]
    fn turn_around(&mut self, force: &Vector3<T>, displacement: &Vector3<T>, back: T) {
        *self = Self::at(self.farthest);
        self.farthest.set(force, displacement);
        self.farthest_square = back;
    }

    /// Takes a new place, and judges the stiffness up to it.
    #[inline(never)]
    fn arrive(
        &mut self,
        force: &Vector3<T>,
        displacement: &Vector3<T>,
        scale: T,
        warning_share: T,
    ) -> SlipVerdict {
        let after = |index: usize| if index >= PLACES { 0 } else { index + 1 };
        self.newest = after(self.newest);
        self.places[self.newest].set(force, displacement);
        self.resting = false;
        // The first stretches settle: fewer than four windows tell no mean stiffness. While fewer places are
        // known than there is room for, the oldest is the turn itself.
        let settled = T::literal((4 * PLACES * 4 * PLACES) as f64);
        let (here, oldest) = (&self.places[self.newest], &self.places[after(self.newest)]);
        if self.turn.square_to(&oldest.displacement, scale) < settled {
            return self.verdict;
        }
        let mean = self.turn.stiffness_to(oldest, scale);
        if mean.is_above(self.stiffness) {
            let greatest = mean.resisted / mean.way;
            if greatest.is_number() {
                self.stiffness = greatest;
            }
        }
        if self.stiffness > T::zero() {
            let local = oldest.stiffness_to(here, scale);
            if self.verdict == SlipVerdict::Holding && local.is_below(self.stiffness * warning_share) {
                self.verdict = SlipVerdict::Warning;
            }
            if self.verdict == SlipVerdict::Warning && local.is_below(self.stiffness * T::literal(0.2)) {
                self.verdict = SlipVerdict::Slipping;
            }
        }
        self.verdict
    }

    fn at(place: Place<T>) -> Self {
        Self {
            turn: place,
            farthest: place,
            farthest_square: T::zero(),
            places: [place; PLACES + 1],
            newest: 0,
            resting: true,
            verdict: SlipVerdict::Holding,
            stiffness: T::zero(),
        }
    }
}

stored! {
    IncipientSlip<T>, [T: Real],
    |detector| {
        gate: NormalForceGate<T> = detector.gate,
        #[serde(rename = "window_m")]
        window: T = detector.window,
        warning_share: T = detector.warning_share,
    },
    Self::new(gate, window).and_then(|detector| detector.with_warning_share(warning_share))
}
