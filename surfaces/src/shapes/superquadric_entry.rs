//! Where a line enters a superquadric, in few steps.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::superquadric::Superquadric;
use super::superquadric_gauge::{Gauge, Powers};
use crate::numeric::vectors::larger;
use crate::{Entry, ForceLine, LineInDouble};

/// Steps from a start that is near, and from one that may be near tangency.
const QUICK_STEPS: usize = 10;
const STEPS: usize = 40;

/// The least cosine of incidence that [`quickly`] answers for: below, rounding grows more than threefold.
const STEEP: f64 = 0.3;

/// Where a force enters that presses steeply.
///
/// It begins where the line enters the ellipsoid with the same semi-axes. `None`, which says nothing, where the force presses at a flat angle, misses or is beside a plane of two axes
/// where the surface is bent sharply; and of numbers that carry more than a value, such as dual ones: the steps that are
/// enough for the value are too few for its derivative.
#[inline(never)]
pub(super) fn quickly<T: Real>(shape: &Superquadric<T>, push: &ForceLine<T>) -> Option<Entry<T>> {
    if T::CARRIES_MORE {
        return None;
    }
    let Line { point, direction } = push.line();
    let scaled = Scaled::new(&point, &direction, &shape.curvatures);
    let remainder = larger(T::one() - scaled.foot.norm_squared(), T::zero());
    let start = -(remainder / scaled.squared).root();
    let arrival = scaled.arrive(shape, start, QUICK_STEPS)?;
    let (point, normal) = arrival.in_place(shape);
    let incidence = -normal.dot(&direction);
    (arrival.is_smooth & (incidence >= T::literal(STEEP))).then(|| {
        Entry { point, normal, incidence_squared: incidence * incidence, parts: None, active: true }
            .within_range()
    })
}

/// Where a line enters, in double precision: the point and the outward unit normal, from a point that is near.
#[cold]
#[inline(never)]
pub(super) fn finely<T: Real>(
    shape: &Superquadric<T>,
    line: &Line<f64>,
    near: &Vector3<f64>,
) -> Option<LineInDouble> {
    let shape = shape.in_double()?;
    let scaled = Scaled::new(&line.point, &line.direction, &shape.curvatures);
    let start = (near.component_mul(&shape.curvatures) - scaled.foot).dot(&scaled.direction) / scaled.squared;
    let arrival = scaled.arrive(&shape, start, STEPS)?;
    let (point, normal) = arrival.in_place(&shape);
    (point.sum() + normal.sum()).is_number().then_some(LineInDouble::Enters { point, normal })
}

/// A line in coordinates over the semi-axes, from its point nearest to the centre.
struct Scaled<T: Real> {
    foot: Vector3<T>,
    direction: Vector3<T>,
    /// Of the direction, the square.
    squared: T,
}

/// A place on a line, and its normal on a superquadric.
struct Arrival<T: Real> {
    /// Over the semi-axes.
    point: Vector3<T>,
    /// Of the gauge by those.
    gradient: Vector3<T>,
    /// The gradient is the one there to the last digits: the last step was none at all, or so short that the curvature
    /// did not change on it.
    is_smooth: bool,
}

impl<T: Real> Scaled<T> {
    #[inline(always)]
    fn new(point: &Vector3<T>, direction: &Vector3<T>, curvatures: &Vector3<T>) -> Self {
        let (point, direction) = (point.component_mul(curvatures), direction.component_mul(curvatures));
        let squared = direction.norm_squared();
        Self { foot: point - direction * (point.dot(&direction) / squared), direction, squared }
    }

    /// Steps to where the line enters, until one is so fine, of the size and of each coordinate, that its square is
    /// nothing. Powers are quick ones, until a step of these is so fine that the next one will be.
    ///
    /// The gauge is convex along a line, so that a step of Newton's method from without never oversteps the entry
    /// (`docs/theory/surfaces.md#convex-bodies-with-a-gauge`); Halley's, with the second derivative, is shorter and
    /// better where that changes little. A start from where the line leads outward is exchanged for one before the solid,
    /// and Newton's steps alone are taken from there: if the line leads outward again, it misses.
    #[inline(always)]
    fn arrive(&self, shape: &Superquadric<T>, start: T, most: usize) -> Option<Arrival<T>> {
        let (one, two, direction) = (T::one(), T::literal(2.0), &self.direction);
        // Scaled, the solid lies within a cube of half edge 1, that within a ball.
        let before = -(larger(T::literal(3.03) - self.foot.norm_squared(), T::zero()) / self.squared).root();
        let (mut t, mut exchanged) = (larger(start, before), false);
        let (mut powers, mut fine) = (Powers::Quick, Powers::Quick.fine());
        for _ in 0..most {
            let point = self.foot + direction * t;
            let Gauge { value, gradient, bends: [(k1, q), (k2, s)], .. } = shape.gauge_scaled(&point, powers);
            let slope = gradient.dot(direction);
            // False for a NaN, too.
            if !(slope < T::zero()) {
                if exchanged {
                    return None;
                }
                (t, exchanged) = (before, true);
                continue;
            }
            let (along_q, along_s) = (q.dot(direction), s.dot(direction));
            let newton = (one - value) / slope;
            let bent = newton * (k1 * along_q * along_q + k2 * along_s * along_s) / (slope + slope);
            let step =
                if !exchanged & (bent.abs() < T::literal(0.25)) { newton / (one + bent) } else { newton };
            let away = direction * step;
            // Next to a plane of two axes the curvature changes within as much as the place is away from it.
            let within = (0..3).fold(true, |within, k| within & (away[k].abs() <= point[k].abs() * fine));
            let nothing = away.amax() <= T::EPSILON * two;
            if (within | nothing) & (powers == Powers::Quick) {
                powers = Powers::of_last_step::<T>();
                fine = powers.fine();
            } else if within | nothing {
                let turn = q * (k1 * along_q * step) + s * (k2 * along_s * step);
                let gradient = if within { gradient + turn } else { gradient };
                return Some(Arrival { point: point + away, gradient, is_smooth: within });
            }
            t += step;
        }
        None
    }
}

impl<T: Real> Arrival<T> {
    /// The point \[m\] and the unit normal.
    #[inline(always)]
    fn in_place(&self, shape: &Superquadric<T>) -> (Vector3<T>, Vector3<T>) {
        let gradient = self.gradient.component_mul(&shape.curvatures);
        // Near 1, since lengths may be anything.
        let scaled = gradient * gradient.amax().normalising_factor();
        (self.point.component_mul(&shape.semi_axes), scaled / scaled.norm_squared().root())
    }
}
