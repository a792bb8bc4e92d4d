//! The kernels: no branch, no call but to the square root.

use fingertip_wrench::Real;

use super::{BatchSurface, Contacts, Wrenches};
use crate::{Capsule, Cylinder, Ellipsoid, Plane, Sphere};

/// A line of action, and what remains to be known of its contact.
#[derive(Clone, Copy)]
struct Axis<T> {
    point: [T; 3],
    direction: [T; 3],
}

struct Answer<T> {
    point: [T; 3],
    normal: [T; 3],
    gap: T,
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
fn sub<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [a - x, b - y, c - z]
}

#[inline(always)]
fn times<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [a * x, b * y, c * z]
}

#[inline(always)]
fn scale<T: Real>([a, b, c]: [T; 3], k: T) -> [T; 3] {
    [a * k, b * k, c * k]
}

#[inline(always)]
fn pick<T: Real>(condition: bool, yes: T, no: T) -> T {
    if condition { yes } else { no }
}

/// Runs a kernel over all wrenches.
#[inline(always)]
fn run<T: Real>(wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>, kernel: impl Fn(Axis<T>) -> Answer<T>) {
    let [fx, fy, fz] = wrenches.force;
    let [tx, ty, tz] = wrenches.torque;
    let [px, py, pz] = contacts.point;
    let [nx, ny, nz] = contacts.normal;
    let gap = contacts.gap;
    let lengths = [
        fx.len(),
        fy.len(),
        fz.len(),
        tx.len(),
        ty.len(),
        tz.len(),
        px.len(),
        py.len(),
        pz.len(),
        nx.len(),
        ny.len(),
        nz.len(),
        gap.len(),
    ];
    let n = lengths.into_iter().fold(usize::MAX, usize::min);
    // Slices of one known length let the compiler drop every bounds check from the loop.
    let (fx, fy, fz) = (&fx[..n], &fy[..n], &fz[..n]);
    let (tx, ty, tz) = (&tx[..n], &ty[..n], &tz[..n]);
    let (px, py, pz) = (&mut px[..n], &mut py[..n], &mut pz[..n]);
    let (nx, ny, nz, gap) = (&mut nx[..n], &mut ny[..n], &mut nz[..n], &mut gap[..n]);
    for k in 0..n {
        let (f, m) = ([fx[k], fy[k], fz[k]], [tx[k], ty[k], tz[k]]);
        // Scaled by the greatest component, squares neither over- nor underflow.
        let greatest = f[0].abs().max(f[1].abs()).max(f[2].abs());
        let shrink = T::one() / greatest;
        let (f, m) = (scale(f, shrink), scale(m, shrink));
        let root = dot(f, f).root();
        let inverse = T::one() / root;
        let u = scale(f, inverse);
        let m = scale(m, inverse);
        let point = [u[1] * m[2] - u[2] * m[1], u[2] * m[0] - u[0] * m[2], u[0] * m[1] - u[1] * m[0]];
        let answer = kernel(Axis { point, direction: u });
        // Anything not finite on the way ends up here.
        let witness = answer.gap + dot(answer.point, answer.normal);
        let good = witness.abs() <= T::GREATEST;
        let keep = |x: T| pick(good, x, T::zero());
        [px[k], py[k], pz[k]] = answer.point.map(keep);
        [nx[k], ny[k], nz[k]] = answer.normal.map(keep);
        gap[k] = pick(good, answer.gap, T::GREATEST);
    }
}

impl<T: Real> BatchSurface<T> for Sphere<T> {
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, radius) = (self.centre().into(), self.radius());
        let curvature = T::one() / radius;
        run(wrenches, contacts, |axis| {
            let from_centre = sub(axis.point, centre);
            let along = dot(from_centre, axis.direction);
            let foot = scale(add(from_centre, axis.direction, -along), curvature);
            let squared = dot(foot, foot);
            let hit = squared <= T::one();
            let half_chord = (T::one() - squared).max(T::zero()).root();
            let length = squared.root();
            // A line that misses has a foot outside the sphere, whose direction is the normal.
            let shrink = pick(hit, T::one(), T::one() / length);
            let normal = add(scale(foot, shrink), axis.direction, -half_chord);
            Answer {
                point: add(centre, normal, radius),
                normal,
                gap: (length - T::one()).max(T::zero()) * radius,
            }
        });
    }
}

impl<T: Real> BatchSurface<T> for Plane<T> {
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (origin, normal): ([T; 3], [T; 3]) = (self.point().into(), self.outward().into());
        run(wrenches, contacts, |axis| {
            let slope = dot(axis.direction, normal);
            let along = -dot(sub(axis.point, origin), normal) / slope;
            let point = add(axis.point, axis.direction, along);
            Answer { point, normal, gap: pick(slope < T::zero(), T::zero(), T::one() / T::zero()) }
        });
    }
}

impl<T: Real> BatchSurface<T> for Cylinder<T> {
    /// The ends are not looked at: the side is unbounded here.
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, core, radius) = (self.centre().into(), self.axis().into(), self.radius());
        let curvature = T::one() / radius;
        run(wrenches, contacts, |axis| {
            let from_centre = sub(axis.point, centre);
            let across = add(from_centre, core, -dot(from_centre, core));
            let drift = add(axis.direction, core, -dot(axis.direction, core));
            let inverse = T::one() / dot(drift, drift);
            let along = -dot(across, drift) * inverse;
            let foot = scale(add(across, drift, along), curvature);
            let squared = dot(foot, foot);
            let hit = squared <= T::one();
            let half_chord = ((T::one() - squared).max(T::zero()) * inverse).root();
            let length = squared.root();
            let shrink = pick(hit, T::one(), T::one() / length);
            let normal = add(scale(foot, shrink), drift, -half_chord);
            let height = dot(from_centre, core) + (along - half_chord * radius) * dot(axis.direction, core);
            Answer {
                point: add(add(centre, core, height), normal, radius),
                normal,
                gap: (length - T::one()).max(T::zero()) * radius,
            }
        });
    }
}

impl<T: Real> BatchSurface<T> for Ellipsoid<T> {
    /// Of a line that misses, the point is the one on which a scaled copy of the ellipsoid would be
    /// touched: close to the closest for small gaps, but not the same; the gap is the distance
    /// between the line and that point's tangent plane.
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let semi_axes: [T; 3] = self.semi_axes().into();
        let curvatures = semi_axes.map(|a| T::one() / a);
        run(wrenches, contacts, |axis| {
            let p = times(axis.point, curvatures);
            let u = times(axis.direction, curvatures);
            let inverse = T::one() / dot(u, u);
            let foot = add(p, u, -dot(p, u) * inverse);
            let squared = dot(foot, foot);
            let hit = squared <= T::one();
            let half_chord = ((T::one() - squared).max(T::zero()) * inverse).root();
            let length = squared.root();
            let shrink = pick(hit, T::one(), T::one() / length);
            let scaled = add(scale(foot, shrink), u, -half_chord);
            let gradient = times(scaled, curvatures);
            let inverse = T::one() / dot(gradient, gradient).root();
            Answer {
                point: times(scaled, semi_axes),
                normal: scale(gradient, inverse),
                gap: (length - T::one()).max(T::zero()) * inverse,
            }
        });
    }
}

impl<T: Real> BatchSurface<T> for Capsule<T> {
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        let (centre, core): ([T; 3], [T; 3]) = (self.centre().into(), self.axis().into());
        let (half, radius) = (self.half_length(), self.radius());
        let curvature = T::one() / radius;
        run(wrenches, contacts, |axis| {
            let u = axis.direction;
            let from_centre = sub(axis.point, centre);
            let start = add(from_centre, u, -dot(from_centre, u));
            let (height, rise) = (dot(start, core), dot(u, core));
            let across = add(start, core, -height);
            let drift = add(u, core, -rise);
            // Where the line enters the unbounded side, or comes closest to it; from infinitely far
            // along the axis if it never does.
            let squared = dot(drift, drift).max(T::LEAST_NORMAL.root());
            let nearest = -dot(across, drift) / squared;
            let foot = scale(add(across, drift, nearest), curvature);
            let left = T::one() - dot(foot, foot);
            let chord = (left.max(T::zero()) / squared).root() * radius;
            // The end of the segment that governs: where the entry is beyond one, that.
            let entry = height + (nearest - chord) * rise;
            let middle = entry.max(-half).min(half);
            let inside = entry == middle;
            // On the side.
            let side = nearest - chord;
            // On the ball about the end.
            let from_end = add(start, core, -middle);
            let to_end = -dot(from_end, u);
            let ball_foot = scale(add(from_end, u, to_end), curvature);
            let ball_left = T::one() - dot(ball_foot, ball_foot);
            let ball = to_end - ball_left.max(T::zero()).root() * radius;
            let along = pick(inside, side, ball);
            let point = add(start, u, along);
            let reached = dot(point, core).max(-half).min(half);
            let outward = add(point, core, -reached);
            let distance = dot(outward, outward).root();
            let normal = scale(outward, T::one() / distance);
            let hit = pick(inside, left, ball_left) >= T::zero();
            Answer {
                point: add(add(centre, core, reached), normal, radius),
                normal,
                gap: pick(hit, T::zero(), (distance - radius).max(T::zero())),
            }
        });
    }
}
