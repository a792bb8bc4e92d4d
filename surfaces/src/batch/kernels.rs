//! The kernels: no branch, no call but to the square root.
//!
//! Where a line that misses costs a division and a dozen choices more than one that meets, the kernel
//! comes in two versions that give the same bits: a block of lines is taken to meet, and done over for
//! any lines if one of them does not.

use fingertip_wrench::Real;

use super::{BatchSurface, Contacts, Wrenches};
use crate::{Capsule, Cylinder, Ellipsoid, ForceLine, Plane, Sphere};

/// A force, what it turns about the origin, and the reciprocal of its square.
#[derive(Clone, Copy)]
struct Push<T> {
    force: [T; 3],
    torque: [T; 3],
    inverse: T,
}

impl<T: Real> Push<T> {
    /// The point of the line of action closest to a centre, seen from there, times a factor.
    #[inline(always)]
    fn foot(&self, centre: [T; 3], factor: T) -> [T; 3] {
        let turned = cross(self.force, centre);
        let torque = zip(self.torque, turned, |m, t| m + t);
        scale(cross(self.force, torque), self.inverse * factor)
    }
}

struct Answer<T> {
    point: [T; 3],
    normal: [T; 3],
    gap: T,
    /// The line meets the surface and nothing has left the range on the way.
    certain: bool,
}

impl<T: Real> Answer<T> {
    /// Of a kernel that does not know whether all is finite.
    #[inline(always)]
    fn new(point: [T; 3], normal: [T; 3], gap: T) -> Self {
        let answer = Self { point, normal, gap, certain: gap == T::zero() };
        Self { certain: answer.certain & answer.is_finite(), ..answer }
    }

    /// Anything not finite on the way ends up here.
    #[inline(always)]
    fn is_finite(&self) -> bool {
        (self.gap + dot(self.point, self.normal)).abs() <= T::GREATEST
    }
}

/// Which lines a kernel has to expect.
#[derive(Clone, Copy, PartialEq)]
enum Lines {
    /// Those that meet; of others, only that they do not.
    Meeting,
    Any,
}

/// Whether it gains from not expecting all.
#[derive(Clone, Copy, PartialEq)]
enum Versions {
    One,
    Two,
}

#[inline(always)]
fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
    a * x + b * y + c * z
}

#[inline(always)]
fn add<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3], k: T) -> [T; 3] {
    [a + x * k, b + y * k, c + z * k]
}

#[inline(always)]
fn cross<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

#[inline(always)]
fn zip<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3], join: impl Fn(T, T) -> T) -> [T; 3] {
    [join(a, x), join(b, y), join(c, z)]
}

#[inline(always)]
fn times<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    zip(a, b, |a, b| a * b)
}

#[inline(always)]
fn scale<T: Real>([a, b, c]: [T; 3], k: T) -> [T; 3] {
    [a * k, b * k, c * k]
}

#[inline(always)]
fn pick<T: Real>(condition: bool, yes: T, no: T) -> T {
    if condition { yes } else { no }
}

/// How a quadric scaled to the unit sphere is met, given the foot's and the direction's squares.
#[derive(Clone, Copy)]
struct Meeting<T> {
    /// What the foot is to be multiplied by, to reach the surface where the line misses.
    shrink: T,
    /// How far back along the direction the line enters.
    back: T,
    /// How far the foot is outside.
    outside: T,
    meets: bool,
}

impl<T: Real> Meeting<T> {
    /// One root serves the line that meets and the line that misses.
    #[inline(always)]
    fn new(foot_squared: T, inverse_direction_squared: T, lines: Lines) -> Self {
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

    #[inline(always)]
    fn answer(&self, point: [T; 3], normal: [T; 3], gap: T) -> Answer<T> {
        let answer = Answer { point, normal, gap, certain: self.meets };
        Answer { certain: self.meets & answer.is_finite(), ..answer }
    }
}

/// How many wrenches are taken together.
const BLOCK: usize = 64;

/// Runs a kernel over all wrenches.
#[inline(always)]
fn run<T: Real>(
    wrenches: Wrenches<'_, T>,
    contacts: Contacts<'_, T>,
    versions: Versions,
    kernel: impl Fn(Push<T>, Lines) -> Answer<T>,
) {
    let Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap } = contacts;
    let [fx, fy, fz] = wrenches.force;
    let [tx, ty, tz] = wrenches.torque;
    let (given, found) = ([fx, fy, fz, tx, ty, tz], [px, py, pz, nx, ny, nz, gap]);
    let shortest = given.iter().map(|column| column.len()).fold(usize::MAX, usize::min);
    let count = found.iter().map(|column| column.len()).fold(shortest, usize::min);
    if versions == Versions::One {
        let [px, py, pz, nx, ny, nz, gap] = found.map(|column| &mut column[..count]);
        return sweep(given, px, py, pz, nx, ny, nz, gap, &kernel);
    }
    let [px, py, pz, nx, ny, nz, gap] = found;
    let mut start = 0;
    while start < count {
        let block = start..count.min(start + BLOCK);
        start = block.end;
        let given = given.map(|column| &column[block.clone()]);
        let (px, py, pz) = (&mut px[block.clone()], &mut py[block.clone()], &mut pz[block.clone()]);
        let (nx, ny, nz) = (&mut nx[block.clone()], &mut ny[block.clone()], &mut nz[block.clone()]);
        let gap = &mut gap[block];
        if !all_meet(given, px, py, pz, nx, ny, nz, gap, &kernel) {
            sweep(given, px, py, pz, nx, ny, nz, gap, &kernel);
        }
    }
}

impl<T: Real> Push<T> {
    /// And whether its square is in range.
    #[inline(always)]
    fn new(force: [T; 3], torque: [T; 3]) -> (Self, bool) {
        let squared = dot(force, force);
        let in_range = (squared >= ForceLine::least_squared()) & (squared <= ForceLine::greatest_squared());
        (Self { force, torque, inverse: T::one() / squared }, in_range)
    }
}

/// A block of lines that meet: `false` if one of them does not, and then what is written means nothing.
///
/// Columns that are arguments of their own are known not to overlap, which the compiler would have to
/// test otherwise, and would rather not vectorise.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn all_meet<T: Real>(
    given: [&[T]; 6],
    px: &mut [T],
    py: &mut [T],
    pz: &mut [T],
    nx: &mut [T],
    ny: &mut [T],
    nz: &mut [T],
    gap: &mut [T],
    kernel: &impl Fn(Push<T>, Lines) -> Answer<T>,
) -> bool {
    let count = gap.len();
    let [fx, fy, fz, tx, ty, tz] = given.map(|column| &column[..count]);
    let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
    let (nx, ny, nz) = (&mut nx[..count], &mut ny[..count], &mut nz[..count]);
    let mut all = true;
    for k in 0..count {
        let (push, in_range) = Push::new([fx[k], fy[k], fz[k]], [tx[k], ty[k], tz[k]]);
        let answer = kernel(push, Lines::Meeting);
        all &= in_range & answer.certain;
        [px[k], py[k], pz[k]] = answer.point;
        [nx[k], ny[k], nz[k]] = answer.normal;
        gap[k] = T::zero();
    }
    all
}

/// Any lines, as many as the slices hold, which are equally long.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn sweep<T: Real>(
    given: [&[T]; 6],
    px: &mut [T],
    py: &mut [T],
    pz: &mut [T],
    nx: &mut [T],
    ny: &mut [T],
    nz: &mut [T],
    gap: &mut [T],
    kernel: &impl Fn(Push<T>, Lines) -> Answer<T>,
) {
    let count = gap.len();
    // Slices of one known length let the compiler drop every bounds check from the loop.
    let [fx, fy, fz, tx, ty, tz] = given.map(|column| &column[..count]);
    let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
    let (nx, ny, nz) = (&mut nx[..count], &mut ny[..count], &mut nz[..count]);
    for k in 0..count {
        let (push, in_range) = Push::new([fx[k], fy[k], fz[k]], [tx[k], ty[k], tz[k]]);
        let answer = kernel(push, Lines::Any);
        let good = in_range & answer.is_finite();
        let keep = |x: T| pick(good, x, T::zero());
        [px[k], py[k], pz[k]] = answer.point.map(keep);
        [nx[k], ny[k], nz[k]] = answer.normal.map(keep);
        gap[k] = pick(good, answer.gap, T::GREATEST);
    }
}

impl<T: Real> BatchSurface<T> for Sphere<T> {
    #[inline(always)]
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, radius) = (self.centre().into(), self.radius());
        let curvature = T::one() / radius;
        // Then nothing can leave the range where a line meets.
        let has_room = self.centre().amax() + radius < T::GREATEST * T::literal(0.125);
        run(
            wrenches,
            contacts,
            Versions::Two,
            #[inline(always)]
            |push, lines| {
                let foot = push.foot(centre, curvature);
                let meeting = Meeting::new(dot(foot, foot), push.inverse, lines);
                let normal = add(scale(foot, meeting.shrink), push.force, -meeting.back);
                Answer {
                    point: add(centre, normal, radius),
                    normal,
                    gap: meeting.outside * radius,
                    certain: meeting.meets & has_room,
                }
            },
        );
    }
}

impl<T: Real> BatchSurface<T> for Plane<T> {
    #[inline(always)]
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (origin, normal): ([T; 3], [T; 3]) = (self.point().into(), self.outward().into());
        run(
            wrenches,
            contacts,
            Versions::One,
            #[inline(always)]
            |push, _| {
                let slope = dot(push.force, normal);
                let foot = push.foot(origin, T::one());
                let across = add(foot, push.force, -dot(foot, normal) / slope);
                let gap = pick(slope < T::zero(), T::zero(), T::one() / T::zero());
                Answer::new(zip(origin, across, |o, a| o + a), normal, gap)
            },
        );
    }
}

impl<T: Real> BatchSurface<T> for Cylinder<T> {
    /// The ends are not looked at: the side is unbounded here.
    #[inline(always)]
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, core, radius) = (self.centre().into(), self.axis().into(), self.radius());
        let curvature = T::one() / radius;
        run(
            wrenches,
            contacts,
            Versions::Two,
            #[inline(always)]
            |push, lines| {
                let start = push.foot(centre, T::one());
                let (height, rise) = (dot(start, core), dot(push.force, core));
                let across = add(start, core, -height);
                let drift = add(push.force, core, -rise);
                let inverse = T::one() / dot(drift, drift);
                let along = -dot(across, drift) * inverse;
                let foot = scale(add(across, drift, along), curvature);
                let meeting = Meeting::new(dot(foot, foot), inverse, lines);
                let normal = add(scale(foot, meeting.shrink), drift, -meeting.back);
                let height = height + (along - meeting.back * radius) * rise;
                let point = add(add(centre, core, height), normal, radius);
                meeting.answer(point, normal, meeting.outside * radius)
            },
        );
    }
}

impl<T: Real> BatchSurface<T> for Ellipsoid<T> {
    /// Of a line that misses, the point is the one on which a scaled copy of the ellipsoid would be
    /// touched: close to the closest for small gaps, but not the same; the gap is the distance
    /// between the line and that point's tangent plane.
    #[inline(always)]
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let semi_axes: [T; 3] = self.semi_axes().into();
        let curvatures = semi_axes.map(|a| T::one() / a);
        run(
            wrenches,
            contacts,
            Versions::Two,
            #[inline(always)]
            |push, lines| {
                let start = times(scale(cross(push.force, push.torque), push.inverse), curvatures);
                let direction = times(push.force, curvatures);
                let inverse = T::one() / dot(direction, direction);
                let foot = add(start, direction, -dot(start, direction) * inverse);
                let meeting = Meeting::new(dot(foot, foot), inverse, lines);
                let scaled = add(scale(foot, meeting.shrink), direction, -meeting.back);
                let gradient = times(scaled, curvatures);
                let flatness = T::one() / dot(gradient, gradient).root();
                let (point, normal) = (times(scaled, semi_axes), scale(gradient, flatness));
                meeting.answer(point, normal, meeting.outside * flatness)
            },
        );
    }
}

impl<T: Real> BatchSurface<T> for Capsule<T> {
    #[inline(always)]
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, core): ([T; 3], [T; 3]) = (self.centre().into(), self.axis().into());
        let (half, radius) = (self.half_length(), self.radius());
        let curvature = T::one() / radius;
        run(
            wrenches,
            contacts,
            Versions::One,
            #[inline(always)]
            |push, _| {
                let u = scale(push.force, push.inverse.root());
                let start = push.foot(centre, T::one());
                let (height, rise) = (dot(start, core), dot(u, core));
                let across = add(start, core, -height);
                let drift = add(u, core, -rise);
                // Where the line enters the unbounded side, or comes closest to it; from infinitely far
                // along the axis if it never does.
                let inverse = T::one() / dot(drift, drift).max(T::LEAST_NORMAL.root());
                let nearest = -dot(across, drift) * inverse;
                let foot = scale(add(across, drift, nearest), curvature);
                let left = T::one() - dot(foot, foot);
                let side = nearest - (left.max(T::zero()) * inverse).root() * radius;
                // The end of the segment that governs: where the entry is beyond one, that.
                let entry = height + side * rise;
                let middle = entry.max(-half).min(half);
                let inside = entry == middle;
                // On the ball about the end.
                let from_end = add(start, core, -middle);
                let to_end = -dot(from_end, u);
                let ball_foot = scale(add(from_end, u, to_end), curvature);
                let ball_left = T::one() - dot(ball_foot, ball_foot);
                let ball = to_end - ball_left.max(T::zero()).root() * radius;
                let point = add(start, u, pick(inside, side, ball));
                let reached = dot(point, core).max(-half).min(half);
                let outward = add(point, core, -reached);
                let distance = dot(outward, outward).root();
                let normal = scale(outward, T::one() / distance);
                let hit = pick(inside, left, ball_left) >= T::zero();
                let gap = pick(hit, T::zero(), (distance - radius).max(T::zero()));
                Answer::new(add(add(centre, core, reached), normal, radius), normal, gap)
            },
        );
    }
}
