//! What a kernel is: one line of action and one surface, no branch, no call but to the square root.
//!
//! Where a line that misses costs a division and a dozen choices more than one that meets, the kernel
//! comes in two versions that give the same bits: a block of lines is taken to meet, and done over for
//! any lines if one of them does not.

use fingertip_surfaces::{ForceLine, ForceParts};
use fingertip_wrench::Real;

use super::Lines;

/// A surface that many lines of action can be met with at once.
pub(crate) trait Kernel<T: Real> {
    /// Whether it gains from not expecting all lines.
    const VERSIONS: Versions;

    /// Its centre is the origin of the sensor frame, and so torques need not be moved there.
    #[inline(always)]
    fn centred(&self) -> bool {
        false
    }

    /// Where one line meets it; whatever depends on the surface alone, the compiler takes out of the loop.
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T>;
}

/// A force, what it turns about the origin, its square and the reciprocal of that.
#[derive(Clone, Copy)]
pub(crate) struct Push<T> {
    pub(crate) force: [T; 3],
    pub(crate) torque: [T; 3],
    pub(crate) squared: T,
    pub(crate) inverse: T,
    /// The surface is centred at the origin. Known before the loop, and so nothing that is asked in it.
    at_origin: bool,
}

impl<T: Real> Push<T> {
    /// And whether its square is in range.
    #[inline(always)]
    pub(crate) fn new(force: [T; 3], torque: [T; 3], at_origin: bool) -> (Self, bool) {
        let squared = dot(force, force);
        let in_range = (squared >= ForceLine::least_squared()) & (squared <= ForceLine::greatest_squared());
        (Self { force, torque, squared, inverse: T::one() / squared, at_origin }, in_range)
    }

    /// The point of the line of action closest to a centre, seen from there, times a factor.
    #[inline(always)]
    pub(crate) fn foot(&self, centre: [T; 3], factor: T) -> [T; 3] {
        let torque = if self.at_origin {
            self.torque
        } else {
            zip(self.torque, cross(self.force, centre), |m, t| m + t)
        };
        scale(cross(self.force, torque), self.inverse * factor)
    }

    /// `centre + k·v`.
    #[inline(always)]
    pub(crate) fn beyond(&self, centre: [T; 3], v: [T; 3], k: T) -> [T; 3] {
        if self.at_origin { scale(v, k) } else { add(centre, v, k) }
    }
}

/// What a kernel says of a line.
pub(crate) struct Answer<T: Real> {
    pub(crate) point: [T; 3],
    pub(crate) normal: [T; 3],
    pub(crate) gap: T,
    /// The parts of the force; made from the normal if the kernel does not know better, and only if
    /// somebody asks.
    pub(crate) parts: Option<ForceParts<T>>,
    /// The line meets the surface and nothing has left the range on the way.
    pub(crate) certain: bool,
}

impl<T: Real> Answer<T> {
    /// Of a kernel that does not know whether all is finite, nor whether the line meets.
    #[inline(always)]
    pub(crate) fn new(point: [T; 3], normal: [T; 3], gap: T) -> Self {
        Self::of(point, normal, gap, gap == T::zero())
    }

    /// Of a kernel that does not know whether all is finite.
    #[inline(always)]
    pub(crate) fn of(point: [T; 3], normal: [T; 3], gap: T, meets: bool) -> Self {
        let answer = Self { point, normal, gap, parts: None, certain: meets };
        Self { certain: meets & answer.is_finite(), ..answer }
    }

    /// Anything not finite on the way ends up here.
    #[inline(always)]
    pub(crate) fn is_finite(&self) -> bool {
        (self.gap + dot(self.point, self.normal)).abs() <= T::GREATEST
    }
}

/// Whether it gains from not expecting all.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Versions {
    One,
    Two,
}

#[inline(always)]
pub(crate) fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
    a * x + b * y + c * z
}

#[inline(always)]
pub(crate) fn add<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3], k: T) -> [T; 3] {
    [a + x * k, b + y * k, c + z * k]
}

#[inline(always)]
pub(crate) fn cross<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

#[inline(always)]
pub(crate) fn zip<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3], join: impl Fn(T, T) -> T) -> [T; 3] {
    [join(a, x), join(b, y), join(c, z)]
}

#[inline(always)]
pub(crate) fn times<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    zip(a, b, |a, b| a * b)
}

#[inline(always)]
pub(crate) fn scale<T: Real>([a, b, c]: [T; 3], k: T) -> [T; 3] {
    [a * k, b * k, c * k]
}

#[inline(always)]
pub(crate) fn pick<T: Real>(condition: bool, yes: T, no: T) -> T {
    if condition { yes } else { no }
}

/// How a quadric scaled to the unit sphere is met, given the foot's and the direction's squares.
#[derive(Clone, Copy)]
pub(crate) struct Chord<T> {
    /// What the foot is to be multiplied by, to reach the surface where the line misses.
    pub(crate) shrink: T,
    /// How far back along the direction the line enters.
    pub(crate) back: T,
    /// How far the foot is outside.
    pub(crate) outside: T,
    pub(crate) meets: bool,
}

impl<T: Real> Chord<T> {
    /// One root serves the line that meets and the line that misses.
    #[inline(always)]
    pub(crate) fn new(foot_squared: T, inverse_direction_squared: T, lines: Lines) -> Self {
        let remainder = T::one() - foot_squared;
        let meets = remainder >= T::zero();
        let half_chord = remainder * inverse_direction_squared;
        if lines == Lines::Meeting {
            return Self { shrink: T::one(), back: half_chord.root(), outside: T::zero(), meets };
        }
        let root = pick(meets, half_chord, foot_squared).root();
        Self {
            shrink: T::one() / pick(meets, T::one(), root),
            back: pick(meets, root, T::zero()),
            outside: pick(meets, T::zero(), root - T::one()),
            meets,
        }
    }
}

/// A force's part along a unit normal, and the square of the rest.
#[inline(always)]
pub(crate) fn split<T: Real>(force: [T; 3], normal: [T; 3]) -> (T, T) {
    let along = dot(force, normal);
    let across = add(force, normal, -along);
    (along, dot(across, across))
}

/// What a force's parts measure at a tangent plane, within the range where squares are numbers.
#[inline(always)]
pub(crate) fn parts_at<T: Real>(force: [T; 3], normal: [T; 3]) -> ForceParts<T> {
    let (along, squared) = split(force, normal);
    ForceParts { normal: -along, tangential: squared.root() }
}
