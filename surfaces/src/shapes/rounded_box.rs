//! The box with round edges and corners.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::closest::to_convex;
use crate::numeric::roots::first_of_convex;
use crate::numeric::twofold::{Twofold, outside_ball};
use crate::numeric::vectors::{foot, length, unit_or, wide};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Entry, Extent, ForceLine, Level, Shortcuts,
    SignedDistance, SmoothSurface, Topology,
};

/// A box about the origin, its edges along x, y and z and rounded; [`Posed`](crate::Posed) puts it
/// elsewhere.
///
/// ```
/// use fingertip_surfaces::{RoundedBox, SignedDistance};
/// use nalgebra::Vector3;
///
/// // 20 mm × 20 mm × 10 mm, its edges rounded with 2 mm.
/// let pad = RoundedBox::new(Vector3::new(0.01, 0.01, 0.005), 0.002)?;
/// assert!((pad.signed_distance(&Vector3::new(0.0, 0.0, 0.006)).distance - 0.001_f64).abs() < 1e-15);
/// // Where the sharp edge was, the round one is 2 mm · (√2 − 1) away.
/// let edge = pad.signed_distance(&Vector3::new(0.01, 0.0, 0.005));
/// assert!((edge.distance - 0.002 * (2.0_f64.sqrt() - 1.0)).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedBox<T: Real> {
    /// Of the sharp box that is one rounding radius smaller all around.
    core: Vector3<T>,
    half_extents: Vector3<T>,
    rounding: T,
}

impl<T: Real> RoundedBox<T> {
    /// From half its extents along x, y and z and the radius of its edges \[m\], which may be
    /// zero.
    ///
    /// # Errors
    /// [`BadShape`] unless the half extents are positive finite lengths and the radius is between
    /// zero and the least of them.
    pub fn new(half_extents: Vector3<T>, rounding: T) -> Result<Self, BadShape> {
        for half in half_extents.iter() {
            BadShape::check_length("rounded box", "half extents", *half)?;
        }
        BadShape::check(
            "rounded box",
            "rounding radius",
            "between zero and the least half extent",
            rounding >= T::zero() && rounding <= half_extents.min(),
        )?;
        Ok(Self { core: half_extents.map(|half| half - rounding), half_extents, rounding })
    }

    /// Half the extents along x, y and z \[m\].
    #[inline]
    #[must_use]
    pub const fn half_extents(&self) -> Vector3<T> {
        self.half_extents
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<RoundedBox<f64>> {
        RoundedBox::new(wide(&self.half_extents), self.rounding.to_f64()).ok()
    }

    /// Radius of the edges \[m\].
    #[inline]
    #[must_use]
    pub const fn rounding(&self) -> T {
        self.rounding
    }

    /// Where a line comes in: through a flat face, which one division tells, or else over an edge or
    /// a corner. There the distance is convex along the line and smooth: Newton's method from
    /// outside takes a few steps and cannot miss.
    #[inline]
    fn entry(&self, start: &Vector3<T>, direction: &Vector3<T>) -> Option<T> {
        let (mut along, mut face) = (-T::GREATEST, 0);
        for k in 0..3 {
            let t = (-self.half_extents[k].copysign(direction[k]) - start[k]) / direction[k];
            if t > along {
                (along, face) = (t, k);
            }
        }
        let point = start + direction * along;
        if (0..3).all(|k| k == face || point[k].abs() <= self.core[k]) {
            return Some(along);
        }
        first_of_convex(-self.bounds().1 * T::literal(1.001), T::one(), |t| {
            let found = self.signed_distance(&(start + direction * t));
            (found.distance, found.normal.dot(direction))
        })
    }

    /// At a sharp edge, the normal of the face that a line comes to: so as it is a hair before.
    #[cold]
    #[inline(never)]
    fn normal_before(&self, point: &Vector3<T>, direction: &Vector3<T>) -> Vector3<T> {
        self.normal(&(point - direction * (self.bounds().1 * (T::EPSILON * T::literal(16.0)))))
    }

    #[inline]
    fn crossing(&self, start: &Vector3<T>, direction: &Vector3<T>, t: T, along: T) -> Crossing<T> {
        let point = start + direction * t;
        let mut normal = self.normal(&point);
        if normal.dot(direction) > T::zero() {
            normal = self.normal_before(&point, direction);
        }
        Crossing { along, point, normal, active: true }
    }
}

impl<T: Real> ActiveSurface<T> for RoundedBox<T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (start, along) = foot(line, &Vector3::zeros());
        let (forth, back) = (line.direction, -line.direction);
        // Left only where it was entered: what rounding finds else, at a sharp edge, is none.
        let Some(t) = self.entry(&start, &forth) else { return };
        visit(self.crossing(&start, &forth, t, along + t));
        if let Some(t) = self.entry(&start, &back) {
            visit(self.crossing(&start, &back, t, along - t));
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (centre, reach) = self.bounds();
        Some(to_convex(line, &centre, reach, |point| self.signed_distance(point)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.signed_distance(point).normal
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.signed_distance(point).distance < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for RoundedBox<T> {
    const CLOSED_CONVEX: bool = true;

    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let line = push.line();
        let t = self.entry(&line.point, &line.direction)?;
        Some(Entry::at(&self.crossing(&line.point, &line.direction, t, t), &line.direction))
    }

    /// An edge is bent sharply one way, and where a line passes over a seam its digits decide of which part the entry is.
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }

    /// From the nearest point of the sharp box within: a plane's, a cylinder's or a ball's distance.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let scale = self.half_extents.max().normalising_factor();
        let rounding = Twofold::new(self.rounding * scale);
        // What a coordinate exceeds the inner box by, and whether it is beyond at all.
        let beyond = |k: usize| {
            let half = self.half_extents[k] * scale;
            let excess = Twofold::difference(point[k].abs() * scale, half).plus(rounding);
            (excess, excess.value() > T::zero())
        };
        match [beyond(0), beyond(1), beyond(2)] {
            [(x, true), (_, false), (_, false)]
            | [(_, false), (x, true), (_, false)]
            | [(_, false), (_, false), (x, true)] => x.minus(rounding).value() / scale,
            [(x, false), (y, false), (z, false)] => {
                // Within them all, as it may be within a sharp box: under the nearest face.
                let nearer = |a: Twofold<T>, b: Twofold<T>| if b.value() > a.value() { b } else { a };
                nearer(nearer(x, y), z).minus(rounding).value() / scale
            }
            three => {
                let part = |(x, out): (Twofold<T>, bool)| if out { x } else { Twofold::new(T::zero()) };
                let outside = outside_ball(three.map(part), rounding.value()) / scale;
                if outside.is_number() { outside } else { T::zero() }
            }
        }
    }
}

impl<T: Real> SignedDistance<T> for RoundedBox<T> {
    const CONVEX: bool = true;

    #[inline]
    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let beyond = point.abs() - self.core;
        let signed = |v: Vector3<T>| v.zip_map(point, |v, p| if p < T::zero() { -v } else { v });
        let outside = beyond.map(|x| x.max(T::zero()));
        let away = length(&outside);
        if away > T::zero() {
            return Distance {
                distance: away - self.rounding,
                normal: signed(unit_or(&outside, Vector3::z)),
            };
        }
        let (axis, nearest) = beyond.argmax();
        let face = match axis {
            0 => Vector3::x(),
            1 => Vector3::y(),
            _ => Vector3::z(),
        };
        Distance { distance: nearest - self.rounding, normal: signed(face) }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), length(&self.half_extents))
    }
}

/// Flat faces, round edges and corners: the curvature jumps where they meet. With a rounding of
/// zero there is no normal at the edges.
impl<T: Real> SmoothSurface<T> for RoundedBox<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let core = self.half_extents().map(|half| half - self.rounding());
        let beyond = point.abs() - core;
        let sign = point.map(|x| T::one().copysign(x));
        let outside = beyond.map(|x| x.max(T::zero()));
        let distance = length(&outside);
        if distance > T::zero() {
            let normal = (outside / distance).component_mul(&sign);
            let round =
                Matrix3::from_diagonal(&beyond.map(|x| if x > T::zero() { T::one() } else { T::zero() }));
            return Level {
                value: distance - self.rounding(),
                gradient: normal,
                hessian: (round - normal * normal.transpose()) / distance,
            };
        }
        let face = beyond.imax();
        let mut gradient = Vector3::zeros();
        gradient[face] = sign[face];
        Level { value: beyond[face] - self.rounding(), gradient, hessian: Matrix3::zeros() }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: length(&self.half_extents()) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    RoundedBox<T>, [T: Real],
    |rounded| {
        half_extents_m: Vector3<T> = rounded.half_extents,
        rounding_m: T = rounded.rounding,
    },
    RoundedBox::new(half_extents_m, rounding_m)
}
