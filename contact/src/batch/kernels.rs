//! The kernels of the shapes.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::Lines;
use super::kernel::{Answer, Chord, Kernel, Push, Versions, add, cross, dot, pick, scale, split, times, zip};
use fingertip_surfaces::{Capsule, Cylinder, Ellipsoid, ForceParts, Plane, Sphere};

impl<T: Real> Kernel<T> for Sphere<T> {
    const VERSIONS: Versions = Versions::Two;

    #[inline(always)]
    fn centred(&self) -> bool {
        self.centre() == Vector3::zeros()
    }

    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let (centre, radius) = (self.centre().into(), self.radius());
        // Then nothing can leave the range where a line meets.
        let has_room = self.centre().amax() + radius < T::GREATEST * T::literal(0.125);
        let foot = push.foot(centre, self.curvature());
        let sine_squared = dot(foot, foot);
        let chord = Chord::new(sine_squared, push.inverse, lines);
        let normal = add(scale(foot, chord.shrink), push.force, -chord.back);
        let (mut pressing, mut across) = (push.squared * chord.back, push.squared * sine_squared);
        if lines == Lines::Any {
            let (along, squared) = split(push.force, normal);
            pressing = pick(chord.meets, pressing, -along);
            across = pick(chord.meets, across, squared);
        }
        Answer {
            point: push.beyond(centre, normal, radius),
            normal,
            gap: chord.outside * radius,
            parts: Some(ForceParts { normal: pressing, tangential: across.root() }),
            certain: chord.meets & has_room,
        }
    }
}

impl<T: Real> Kernel<T> for Plane<T> {
    const VERSIONS: Versions = Versions::One;

    #[inline(always)]
    fn answer(&self, push: Push<T>, _: Lines) -> Answer<T> {
        let (origin, normal): ([T; 3], [T; 3]) = (self.point().into(), self.outward().into());
        let slope = dot(push.force, normal);
        let foot = push.foot(origin, T::one());
        let across = add(foot, push.force, -dot(foot, normal) / slope);
        let gap = pick(slope < T::zero(), T::zero(), T::one() / T::zero());
        Answer::new(zip(origin, across, |o, a| o + a), normal, gap)
    }
}

impl<T: Real> Kernel<T> for Cylinder<T> {
    const VERSIONS: Versions = Versions::Two;

    /// The ends are not looked at: the side is unbounded here.
    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let (centre, core, radius) = (self.centre().into(), self.axis().into(), self.radius());
        let curvature = T::one() / radius;
        let start = push.foot(centre, T::one());
        let (height, rise) = (dot(start, core), dot(push.force, core));
        let across = add(start, core, -height);
        let drift = add(push.force, core, -rise);
        let inverse = T::one() / dot(drift, drift);
        let along = -dot(across, drift) * inverse;
        let foot = scale(add(across, drift, along), curvature);
        let chord = Chord::new(dot(foot, foot), inverse, lines);
        let normal = add(scale(foot, chord.shrink), drift, -chord.back);
        let height = height + (along - chord.back * radius) * rise;
        let point = add(add(centre, core, height), normal, radius);
        Answer::of(point, normal, chord.outside * radius, chord.meets)
    }
}

impl<T: Real> Kernel<T> for Ellipsoid<T> {
    const VERSIONS: Versions = Versions::Two;

    /// Of a line that misses, the point is the one on which a scaled copy of the ellipsoid would be
    /// touched: close to the closest for small gaps, but not the same; the gap is the distance
    /// between the line and that point's tangent plane.
    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let semi_axes: [T; 3] = self.semi_axes().into();
        let curvatures = semi_axes.map(|a| T::one() / a);
        let start = times(scale(cross(push.force, push.torque), push.inverse), curvatures);
        let direction = times(push.force, curvatures);
        let inverse = T::one() / dot(direction, direction);
        let foot = add(start, direction, -dot(start, direction) * inverse);
        let chord = Chord::new(dot(foot, foot), inverse, lines);
        let scaled = add(scale(foot, chord.shrink), direction, -chord.back);
        let gradient = times(scaled, curvatures);
        let flatness = T::one() / dot(gradient, gradient).root();
        let (point, normal) = (times(scaled, semi_axes), scale(gradient, flatness));
        Answer::of(point, normal, chord.outside * flatness, chord.meets)
    }
}

impl<T: Real> Kernel<T> for Capsule<T> {
    const VERSIONS: Versions = Versions::One;

    #[inline(always)]
    fn answer(&self, push: Push<T>, _: Lines) -> Answer<T> {
        let (centre, core): ([T; 3], [T; 3]) = (self.centre().into(), self.axis().into());
        let (half, radius) = (self.half_length(), self.radius());
        let curvature = T::one() / radius;
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
    }
}
