//! Ferrari and Canny's ball: the least disturbance that a grasp cannot resist, whatever its direction.

use fingertip_wrench::{Frame, Real, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::grasp::Spectrum;
use crate::{FingerLimits, Grasp, GripOutcome, LeastGrip, Reach};

/// What counts as an effort of 1 N, and how torques compare with forces.
///
/// ```
/// use fingertip_hand::Metric;
///
/// // One motor drives all fingers, and 1 N·m counts as 1 N at 30 mm.
/// let metric = Metric::Total { length: 0.03 };
/// assert_eq!(metric.length(), 0.03);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Metric<T> {
    /// The normal forces sum to at most 1 N: the convex hull of the friction cones' wrenches (their `L¹`).
    Total {
        /// By which torques about the [centre](Grasp::centre) are divided \[m\].
        length: T,
    },
    /// Each normal force is at most 1 N: the sum of the cones' wrenches (their `L^∞`).
    Each {
        /// By which torques about the [centre](Grasp::centre) are divided \[m\].
        length: T,
    },
}

impl<T: Real> Metric<T> {
    /// By which torques are divided \[m\].
    #[must_use]
    pub const fn length(&self) -> T {
        match self {
            Self::Total { length } | Self::Each { length } => *length,
        }
    }
}

/// The radius of the greatest ball of wrenches that a grasp can bear for an effort of 1 N, between bounds.
///
/// ```
/// use fingertip_hand::{Grasp, GraspContact, Metric};
/// use nalgebra::Vector3;
///
/// // A ball between three fingers; then without the third.
/// let contact = |turn: f64| {
///     let inward = -Vector3::new(turn.cos(), turn.sin(), 0.0);
///     GraspContact::<f64>::soft(inward * -0.03, inward, 0.6, 3e-3)
/// };
/// let [a, b, c] = [contact(0.0)?, contact(2.1)?, contact(4.2)?].map(Some);
/// let quality = |fingers| Grasp::new(fingers).ball(Metric::Each { length: 0.03 }).expect("a length");
/// let three = quality([a, b, c]);
/// assert!(0.0 < three.certified && three.certified <= three.found);
/// // Without one of them it bears far less.
/// assert!(quality([a, b, None]).found < 0.2 * three.found);
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct GraspBall<T: Real, F: Frame> {
    /// The radius is at least this \[N\]: certified, from what the grasp bears along six axes, both ways.
    pub certified: T,
    /// The radius is at most this \[N\]: found by a search from 24 starts, usually the radius itself.
    pub found: T,
    /// The load of that size that is borne least: of unit length in the metric, about the origin of the frame.
    pub weakest: Wrench<T, F>,
}

/// How many cone programs from each start, at most: three or four are usual.
const STEPS: usize = 12;

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// The quality of Ferrari & Canny 1992 with round friction cones (`docs/theory/hand.md#ferrari-and-cannys-ball`):
    /// zero without force closure; `None` if the metric's length is not positive and finite. It takes some hundred cone
    /// programs: for planning, not for every sample.
    ///
    /// ```
    /// use fingertip_hand::{Grasp, GraspContact, Metric};
    /// use nalgebra::Vector3;
    ///
    /// let at = |x: f64| GraspContact::<f64>::soft(Vector3::x() * x, -Vector3::x() * x, 0.5, 3e-3);
    /// let grasp = Grasp::new([Some(at(-0.02)?), Some(at(0.02)?)]);
    /// let ball = grasp.ball(Metric::Each { length: 0.02 }).expect("a length");
    /// // What it bears least is a torque about the line of the fingers: 2·μ·e/length.
    /// assert!((ball.found - 2.0 * 0.5 * 3e-3 / 0.02).abs() < 1e-3);
    /// assert!(ball.certified > 0.0 && ball.certified <= ball.found);
    /// # Ok::<(), fingertip_hand::BadContact>(())
    /// ```
    #[must_use]
    pub fn ball(&self, metric: Metric<T>) -> Option<GraspBall<T, F>> {
        let length = metric.length();
        if !(length > T::zero() && length.is_number()) {
            return None;
        }
        if let Some(weakest) = self.not_borne(length) {
            return Some(GraspBall { certified: T::zero(), found: T::zero(), weakest });
        }
        // Axes, and the wrenches that the map itself bears best and worst.
        let spectrum = Spectrum::new(self.blocks().flatten());
        let axes = Matrix6::identity();
        let starts = axes.column_iter().chain(spectrum.directions.column_iter());
        let mut best = (T::GREATEST, Vector6::x());
        for start in starts.flat_map(|start| [start.into_owned(), -start]) {
            best = self.descend(start, metric, best);
        }
        // Where many planes meet a wrench at once, its neighbours tell which of them lead on.
        let (_, middle) = best;
        for tilt in axes.column_iter().flat_map(|axis| [axis * T::literal(0.05), axis * T::literal(-0.05)]) {
            let start = middle + tilt;
            best = self.descend(start / start.norm_squared().root(), metric, best);
        }
        let (found, direction) = best;
        let found = found.max(T::zero());
        let certified = self.certify(&direction, metric).min(found);
        let weakest = -self.wrench_along(&direction, length);
        Some(GraspBall { certified, found, weakest })
    }

    /// From a direction to those of the planes that end what is borne along it, as long as they are borne less: the least
    /// of all, of the best so far and these.
    fn descend(&self, start: Vector6<T>, metric: Metric<T>, best: (T, Vector6<T>)) -> (T, Vector6<T>) {
        let (mut best, mut direction, mut last) = (best, start, T::GREATEST);
        for _ in 0..STEPS {
            let support = self.support(&direction, metric);
            if support < best.0 {
                best = (support, direction);
            }
            if !(support < last * (T::one() - T::EPSILON.root())) {
                break;
            }
            last = support;
            let Some(next) = self.borne_least_beside(&direction, metric) else { break };
            direction = next;
        }
        best
    }

    /// A load of unit length that no forces bear, if there is one. Then one along an axis is not borne either, and its
    /// certificate is a direction in which the fingers give nothing.
    fn not_borne(&self, length: T) -> Option<Wrench<T, F>> {
        let mut least = LeastGrip::<T, N, 0>::new();
        for axis in 0..12 {
            let mut unit = Vector6::zeros();
            for (i, x) in unit.iter_mut().enumerate() {
                *x = T::literal(f64::from(u8::from(2 * i == axis)) - f64::from(u8::from(2 * i + 1 == axis)));
            }
            let load = self.wrench_along(&unit, length);
            if let GripOutcome::CannotHold(why) = least.solve(self, &[FingerLimits::none(); N], &load) {
                let velocity = why.velocity + why.turning.cross(&self.centre());
                let turning = why.turning * length;
                let size = (velocity.norm_squared() + turning.norm_squared()).root();
                let [vx, vy, vz] = (velocity / size).into();
                let [wx, wy, wz] = (turning / size).into();
                return Some(self.wrench_along(&Vector6::new(vx, vy, vz, wx, wy, wz), length));
            }
            least.forget();
        }
        None
    }

    /// The load that a direction of the metric stands for.
    fn wrench_along(&self, direction: &Vector6<T>, length: T) -> Wrench<T, F> {
        let [fx, fy, fz, tx, ty, tz] = (*direction).into();
        let force = Vector3::new(fx, fy, fz);
        let torque = Vector3::new(tx, ty, tz) * length;
        Wrench::on_fingertip(force, torque + self.centre().cross(&force))
    }

    /// The most that 1 N of effort gives along a unit wrench on the object.
    fn support(&self, direction: &Vector6<T>, metric: Metric<T>) -> T {
        let mut weighed = *direction;
        for torque in weighed.iter_mut().skip(3) {
            *torque *= self.length() / metric.length();
        }
        let gains = self.blocks().flatten().map(|map| {
            let pull = map.tr_mul(&weighed);
            pull.x + (pull.y * pull.y + pull.z * pull.z + pull.w * pull.w).root()
        });
        match metric {
            Metric::Total { .. } => gains.fold(T::zero(), T::max),
            Metric::Each { .. } => gains.fold(T::zero(), |sum, gain| sum + gain.max(T::zero())),
        }
    }

    /// Of the planes that bound what 1 N of effort gives, the one that a unit wrench on the object meets first, as its
    /// normal: nothing beside that wrench is nearer.
    fn borne_least_beside(&self, direction: &Vector6<T>, metric: Metric<T>) -> Option<Vector6<T>> {
        let mut normal = self.radius(&-direction, metric).1?;
        for torque in normal.iter_mut().skip(3) {
            *torque *= metric.length() / self.length();
        }
        let next = normal / normal.norm_squared().root();
        next.iter().all(|x| x.is_number()).then_some(next)
    }

    /// The ball inside the hull of what is borne along six axes, one of them given, both ways.
    fn certify(&self, direction: &Vector6<T>, metric: Metric<T>) -> T {
        // A reflection that takes the first axis to the direction.
        let mut mirror = *direction;
        let sign = if mirror.x > T::zero() { T::one() } else { -T::one() };
        mirror.x += sign;
        let axes =
            Matrix6::identity() - mirror * mirror.transpose() * (T::literal(2.0) / mirror.norm_squared());
        let mut sum = T::zero();
        for axis in axes.column_iter() {
            let (there, back) = (axis.into_owned(), -axis.into_owned());
            let shortest = self.radius(&there, metric).0.min(self.radius(&back, metric).0);
            sum += T::one() / (shortest * shortest);
        }
        let radius = T::one() / sum.root();
        if radius.is_number() { radius } else { T::zero() }
    }

    /// How much of a unit load 1 N of effort bears, and the normal, in the units of the grasp map, of the plane that ends
    /// it: the dual of the program.
    fn radius(&self, direction: &Vector6<T>, metric: Metric<T>) -> (T, Option<Vector6<T>>) {
        let load = self.wrench_along(direction, metric.length());
        match metric {
            Metric::Total { .. } => {
                let mut least = LeastGrip::<T, N, 0>::new();
                match least.solve(self, &[FingerLimits::none(); N], &load) {
                    GripOutcome::Held(grip) if grip.cost > T::zero() => (T::one() / grip.cost, least.twist()),
                    _ => (T::zero(), None),
                }
            }
            Metric::Each { .. } => {
                let Ok(limits) = FingerLimits::<T, 1>::none().with_greatest_normal(T::one()) else {
                    return (T::zero(), None);
                };
                match self.reach_and_twist(&[limits; N], &Wrench::zero(), &load) {
                    (Reach::Times(times), twist) => (times, Some(twist)),
                    _ => (T::zero(), None),
                }
            }
        }
    }
}
