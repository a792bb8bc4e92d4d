//! The contacts on a torus by the spheres around the points of its ring: a search that misses none, however near two of
//! them are.

use fingertip_surfaces::numeric::roots::{bisected, bracketed};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::zeros::Doubts;
use crate::soft_finger::unit_sphere::OnUnitSphere;

/// Cells that the circle is cut into to begin with.
const CELLS: u8 = 24;
/// How often a cell is halved at most.
const DEPTH: usize = 10;

/// The wrench, in units of the ring's radius.
pub(super) struct Around<T: Real> {
    pub(super) force: Vector3<T>,
    pub(super) torque: Vector3<T>,
    pub(super) tube: T,
    /// `r f·m`.
    pub(super) power: T,
    /// How far the numbers of the wrench are rounded, relative to them.
    pub(super) epsilon: T,
    /// What the force was multiplied by.
    pub(super) scale: T,
    /// Where two zeros may be too near to each other for the polynomial to tell.
    pub(super) doubts: Doubts<T>,
}

/// What the sphere around one point of the ring says.
#[derive(Clone, Copy)]
pub(super) struct At<T: Real> {
    angle: T,
    pub(super) outward: Vector3<T>,
    pub(super) normal: Vector3<T>,
    pub(super) spin: T,
    /// `F` and `dF/dθ`.
    value: T,
    slope: T,
}

impl<T: Real> Around<T> {
    fn frame(angle: T) -> (Vector3<T>, Vector3<T>) {
        let (sin, cos) = angle.sine_and_cosine();
        (Vector3::new(cos, sin, T::zero()), Vector3::new(-sin, cos, T::zero()))
    }

    pub(super) fn at(&self, angle: T) -> At<T> {
        let (outward, tangent) = Self::frame(angle);
        let (force, torque) = (self.force * self.tube, self.torque - outward.cross(&self.force));
        let solved = OnUnitSphere::new(&force, &torque, force.norm_squared(), self.power);
        let (normal, spin) = (solved.point(), solved.spin);
        // τ n′ + (r f·n) n′ × n = (dM/dθ − its part along n), dM/dθ = −t × f.
        let turning = -tangent.cross(&self.force);
        let turning = turning - normal * normal.dot(&turning);
        let pressing = force.dot(&normal);
        let turned =
            (turning * spin - turning.cross(&normal) * pressing) / (spin * spin + pressing * pressing);
        At {
            angle,
            outward,
            normal,
            spin,
            value: normal.dot(&tangent),
            slope: turned.dot(&tangent) - normal.dot(&outward),
        }
    }

    /// By how much the line of action misses the sphere at an angle, `|M|² − r²|f|²`, and its first two
    /// derivatives.
    fn miss(&self, angle: T) -> [T; 3] {
        let (outward, tangent) = Self::frame(angle);
        let (aside, along) = (outward.cross(&self.force), tangent.cross(&self.force));
        let torque = self.torque - aside;
        let (slope, bend) = (-torque.dot(&along), along.norm_squared() + torque.dot(&aside));
        let touch = self.force.norm_squared() * self.tube * self.tube;
        [torque.norm_squared() - touch, slope + slope, bend + bend]
    }

    /// What rounding of the wrench, and of what follows, does to `F`: a torque turns `n` by itself over
    /// `√(τ² + (r f·n)²)`.
    fn noise(&self, at: &At<T>) -> T {
        let pressing = self.force.dot(&at.normal) * self.tube;
        let torque = self.torque.amax() + self.force.amax();
        T::literal(4.0) * self.epsilon * torque / (at.spin * at.spin + pressing * pressing).root()
    }

    /// Every zero of `F`, and whether it is a fold.
    pub(super) fn roots(&self, mut found: impl FnMut(T, bool)) {
        let cell = T::two_pi() / T::literal(f64::from(CELLS));
        // Off the axes, where shapes and loads like to be symmetric.
        let end_of = |k: u8| cell * T::literal(f64::from(k) + 0.3719);
        let (mut low, mut miss_low) = (end_of(0), self.miss(end_of(0)));
        let first = self.at(low);
        let mut at_low = first;
        for k in 1..=CELLS {
            let high = end_of(k);
            let miss_high = self.miss(high);
            // Where the line is nearest to the ring or farthest, and where it touches.
            let turns = (miss_low[1] < T::zero()) != (miss_high[1] < T::zero());
            let turn = if turns {
                bracketed(low, high, |t| {
                    let [_, slope, bend] = self.miss(t);
                    (slope, bend)
                })
            } else {
                high
            };
            let (mut from, mut from_misses) = (low, miss_low[0]);
            for end in [turn, high] {
                if !(end > from) {
                    continue;
                }
                let end_misses = self.miss(end)[0];
                if (from_misses < T::zero()) != (end_misses < T::zero()) {
                    let touch = bracketed(from, end, |t| {
                        let [value, slope, _] = self.miss(t);
                        (value, slope)
                    });
                    if touch > from && touch < end {
                        let at = self.at(touch);
                        self.within(at_low, at, &mut found);
                        at_low = at;
                    }
                }
                let at = if end == high && k == CELLS { At { angle: high, ..first } } else { self.at(end) };
                self.within(at_low, at, &mut found);
                at_low = at;
                (from, from_misses) = (end, end_misses);
            }
            (low, miss_low) = (high, miss_high);
        }
    }

    /// The zeros between two angles.
    fn within(&self, low: At<T>, high: At<T>, found: &mut impl FnMut(T, bool)) {
        let mut from = low;
        for angle in self.doubts.ends() {
            if angle > from.angle && angle < high.angle {
                let to = self.at(angle);
                self.in_cells(from, to, found);
                from = to;
            }
        }
        self.in_cells(from, high, found);
    }

    /// The same, with no doubt's end in between.
    fn in_cells(&self, low: At<T>, high: At<T>, found: &mut impl FnMut(T, bool)) {
        let (half, eighth) = (T::literal(0.5), T::literal(0.125));
        let mut stack = [(low, high, 0); DEPTH + 2];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let Some(&(low, high, halvings)) = stack.get(depth) else { return };
            let width = high.angle - low.angle;
            let middle = self.at(low.angle + width * half);
            let guess = (low.value + high.value) * half + (low.slope - high.slope) * width * eighth;
            let size = low.value.abs() + high.value.abs() + middle.value.abs();
            let wrong = (middle.value - guess).abs();
            let rounding = T::EPSILON * T::literal(64.0);
            let tells = wrong <= size * T::literal(0.02) + rounding;
            if tells || halvings >= DEPTH {
                self.between(&low, &middle, found);
                self.between(&middle, &high, found);
                continue;
            }
            for (slot, part) in [(depth, (middle, high)), (depth + 1, (low, middle))] {
                if let Some(place) = stack.get_mut(slot) {
                    *place = (part.0, part.1, halvings + 1);
                }
            }
            depth += 2;
        }
    }

    /// The zeros between two angles, between which `F` turns at most once.
    fn between(&self, low: &At<T>, high: &At<T>, found: &mut impl FnMut(T, bool)) {
        let negative = low.value < T::zero();
        let sample = |t: T| {
            let at = self.at(t);
            (at.value, at.slope)
        };
        if negative != (high.value < T::zero()) {
            found(bracketed(low.angle, high.angle, sample), false);
        } else if (low.slope < T::zero()) != negative && (high.slope < T::zero()) == negative {
            // It turns on its way to zero; perhaps on the other side.
            let turn = bisected(low.angle, high.angle, |t| (self.at(t).slope < T::zero()) != negative);
            let at = self.at(turn);
            if (at.value < T::zero()) != negative {
                found(bracketed(low.angle, turn, sample), false);
                found(bracketed(turn, high.angle, sample), false);
            } else if at.value.abs() <= self.noise(&at) {
                // Two contacts in a fold, for all that the wrench says.
                found(turn, true);
            }
        }
    }
}
