//! The torus: every contact, as a root of a function of one angle.

use fingertip_surfaces::numeric::roots::{bisected, bracketed};
use fingertip_surfaces::numeric::vectors::{larger, largest, unit_or, wide};
use fingertip_surfaces::{ActiveSurface, LocalSurface, SmoothSurface, Torus};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::{is_pure_force_of, soft_finger};
use crate::soft_finger::double::{in_type, narrow};
use crate::soft_finger::newton::Problem;
use crate::soft_finger::unit_sphere::OnUnitSphere;
use crate::{GeometrySensitivity, Search, SoftContact};

/// Cells that the circle is cut into to begin with.
const CELLS: u8 = 24;
/// How often a cell is halved at most.
const DEPTH: usize = 10;

/// The soft-finger contacts on a torus.
///
/// A contact has the place `c = R ρ + r n` with `ρ = (cos θ, sin θ, 0)` and a normal `n` across the
/// tangent `t = (−sin θ, cos θ, 0)` of the ring. So the equations `τ n + c × f = m` read
///
/// ```text
/// τ n + r n × f = m − R ρ(θ) × f,    n·t(θ) = 0
/// ```
///
/// of which the first is the soft finger on a sphere of radius `r` around a point of the ring: it has
/// one solution `n(θ)` that presses, in closed form, since `f·(m − R ρ × f) = f·m` is the same for
/// all `θ`. The contacts of the torus are therefore exactly the zeros of `F(θ) = n(θ)·t(θ)`, a
/// continuous function on a circle if `f·m ≠ 0`: **simple zeros come in an even number**. (If
/// `f·m = 0`, for all that the numbers of the wrench say, the contacts are where the line of action enters.)
///
/// Zeros are bracketed between samples of `F` and its derivative; the cells are refined where a
/// cubic through their ends does not tell their middle. `F` has kinks, in the limit of no spin
/// torque, where the line of action touches the sphere, `|m − R ρ × f| = r|f|`; these angles and
/// those at which the line passes the ring most closely are made ends of cells. Where `F` turns so near
/// zero that the rounding of the wrench reaches it, two contacts merge in a fold: that is one contact.
///
/// `epsilon` is by how much the numbers of the wrench are rounded, relative to them.
fn search<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    epsilon: T,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let ring = torus.ring_radius();
    let lever = wrench.torque() / ring;
    let scale = larger(largest(&wrench.force()), largest(&lever)).normalising_factor();
    let (force, torque) = (wrench.force() * scale, lever * scale);
    let tube = torus.tube_radius() / ring;
    let power = force.dot(&torque) * tube;
    let problem = Problem::new(torus, &wrench.force(), &wrench.torque());
    if is_pure_force_of(&force, &torque, epsilon) {
        if let Ok(axis) = wrench.line_of_action() {
            torus.crossings(&axis.line, |crossing| {
                if crossing.normal.dot(&axis.line.direction) < T::zero() {
                    let (point, normal) = (crossing.point, crossing.normal);
                    let entry = SoftContact { point, normal, spin_torque: T::zero(), active: true };
                    visit(problem.polished(&entry).unwrap_or(entry));
                }
            });
        }
        return Search::Complete;
    }
    let around = Around { force, torque, tube, power, epsilon };
    let mut search = Search::Complete;
    around.roots(|angle, is_fold| {
        let at = around.at(angle);
        let found = SoftContact {
            point: (at.outward + at.normal * tube) * ring,
            normal: at.normal,
            spin_torque: at.spin * ring / scale,
            active: true,
        };
        // A last step on all equations at once takes the rounding of the angle away, and carries the
        // derivative of a dual number.
        match problem.polished(&found) {
            Some(contact) => visit(contact),
            None if is_fold || problem.explains(&found) => visit(found),
            None => search = Search::Incomplete,
        }
    });
    search
}

/// More contacts than that are asked for in double precision.
const MOST: usize = 8;

/// The same, in double precision if the type is narrower and two contacts are about to merge in a fold: how far
/// they are apart answers to the root of what rounding does. What rounding does to the wrench itself may have
/// made both vanish; then the fold is their contact still.
fn on_torus<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    if T::EPSILON.to_f64() <= f64::EPSILON {
        return search(torus, wrench, T::EPSILON, &mut visit);
    }
    let mut found = [None; MOST];
    let (mut count, mut steady) = (0, true);
    let ended = search(torus, wrench, T::EPSILON, &mut |contact| {
        let slot = found.get_mut(count);
        steady &= slot.is_some() && !is_folding(torus, &wrench.force(), &contact);
        if let Some(slot) = slot {
            *slot = Some(contact);
            count += 1;
        }
    });
    if !steady && let Ok(double) = Torus::new(torus.ring_radius().to_f64(), torus.tube_radius().to_f64()) {
        let wrench = Wrench::on_fingertip(wide(&wrench.force()), wide(&wrench.torque()));
        let epsilon = T::EPSILON.to_f64();
        return in_type(search(&double, &wrench, epsilon, &mut |contact| visit(narrow(&contact))));
    }
    found.into_iter().flatten().for_each(visit);
    ended
}

/// Whether `τ²κ + (f·n)²` is nearly nothing for the size of its parts.
fn is_folding<T: Real>(torus: &Torus<T>, force: &Vector3<T>, contact: &SoftContact<T>) -> bool {
    let (c, n) = (contact.point, contact.normal);
    let outward = (c.x * n.x + c.y * n.y) / (c.x * c.x + c.y * c.y);
    let scale = largest(force).normalising_factor();
    let (pressing, spin) = ((force * scale).dot(&n), contact.spin_torque * scale);
    let index = spin * (spin * outward) / torus.tube_radius() + pressing * pressing;
    !(index.abs() >= T::literal(64.0) * T::EPSILON.root() * pressing * pressing)
}

/// The wrench, in units of the ring's radius.
struct Around<T: Real> {
    force: Vector3<T>,
    torque: Vector3<T>,
    tube: T,
    /// `r f·m`.
    power: T,
    /// How far the numbers of the wrench are rounded, relative to them.
    epsilon: T,
}

/// What the sphere around one point of the ring says.
#[derive(Clone, Copy)]
struct At<T: Real> {
    angle: T,
    outward: Vector3<T>,
    normal: Vector3<T>,
    spin: T,
    /// `F` and `dF/dθ`.
    value: T,
    slope: T,
}

impl<T: Real> Around<T> {
    fn frame(angle: T) -> (Vector3<T>, Vector3<T>) {
        let (sin, cos) = angle.sin_cos();
        (Vector3::new(cos, sin, T::zero()), Vector3::new(-sin, cos, T::zero()))
    }

    fn at(&self, angle: T) -> At<T> {
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
    fn roots(&self, mut found: impl FnMut(T, bool)) {
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
        let (half, eighth) = (T::literal(0.5), T::literal(0.125));
        let mut stack = [(low, high, 0); DEPTH + 2];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let Some(&(low, high, halvings)) = stack.get(depth) else { return };
            let width = high.angle - low.angle;
            if halvings < DEPTH {
                let middle = self.at(low.angle + width * half);
                let guess = (low.value + high.value) * half + (low.slope - high.slope) * width * eighth;
                let size = low.value.abs() + high.value.abs() + middle.value.abs();
                let wrong = (middle.value - guess).abs();
                if !(wrong <= size * T::literal(0.02) + T::EPSILON * T::literal(64.0)) {
                    for (slot, part) in [(depth, (middle, high)), (depth + 1, (low, middle))] {
                        if let Some(place) = stack.get_mut(slot) {
                            *place = (part.0, part.1, halvings + 1);
                        }
                    }
                    depth += 2;
                    continue;
                }
            }
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
}

soft_finger!(
    Torus,
    |shape, wrench, _, visit| on_torus(shape, wrench, visit),
    patch | shape,
    _ | Some(LocalSurface::Torus { ring: shape.ring_radius().to_f64(), tube: shape.tube_radius().to_f64() }),
    sizes | shape,
    size,
    point | of_torus(shape, point).get(size).copied()
);

/// The radius of the ring, then that of the tube. A larger ring moves each section of the tube
/// outward.
fn of_torus<T: Real>(shape: &Torus<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    let normal = shape.normal(point);
    let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
    let level = shape.level(point);
    // The derivative across the tube; that around the ring stays out.
    let around = Vector3::new(-outward.y, outward.x, T::zero());
    let along = around.cross(&normal);
    let turned = -along * (along.dot(&outward) / shape.tube_radius());
    let ring = GeometrySensitivity::of_level(-normal.dot(&outward), &turned, &normal, &level.hessian);
    [ring, GeometrySensitivity::offset()]
}
