//! Does a line cross a triangle? Watertight.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// The frame in which the line is the third axis: a shear of space (Woop, Benthin & Wald,
/// "Watertight Ray/Triangle Intersection", 2013).
///
/// Each vertex goes to the same place in the plane whichever triangle asks, so that neighbouring
/// triangles decide about their common edge from the same numbers; the sign of an edge function is
/// exact, since two rounded products compare as their exact values do unless they are equal, in
/// which case their rounding errors decide. A line exactly through an edge or a vertex is treated as
/// if it were moved aside by an infinitesimal amount, the same for all triangles: it crosses
/// exactly one of those that meet there and face the same way.
pub(super) struct Shear<T: Real> {
    axes: [usize; 3],
    x: T,
    y: T,
    inverse: T,
    start: [T; 3],
}

#[inline]
fn component<T: Real>(v: &Vector3<T>, axis: usize) -> T {
    match axis {
        0 => v.x,
        1 => v.y,
        _ => v.z,
    }
}

/// `true` if the origin lies to the left of the directed edge from `a` to `b`, `None` if the edge
/// is a point.
#[inline]
fn is_left<T: Real>(a: [T; 2], b: [T; 2]) -> (T, Option<bool>) {
    let [ax, ay] = a;
    let [bx, by] = b;
    let rounded = ax * by - ay * bx;
    if rounded != T::zero() {
        return (rounded, Some(rounded > T::zero()));
    }
    let ((p, p_error), (q, q_error)) = (ax.two_product(by), ay.two_product(bx));
    let exact = (p - q) + (p_error - q_error);
    let side = if exact != T::zero() {
        Some(exact > T::zero())
    } else if by != ay {
        // Moved aside by (ε, ε²).
        Some(by < ay)
    } else if bx != ax {
        Some(bx > ax)
    } else {
        None
    };
    (exact, side)
}

/// The areas opposite the corners, without the rounding that is as large as they on a sliver: it
/// would slide the crossing along the sliver's length.
#[inline]
fn sharpened<T: Real>([a, b, c]: [[T; 2]; 3], rounded: [T; 3]) -> (T, T, T) {
    let [u, v, w] = rounded;
    let reach = |[x, y]: [T; 2]| x.abs().max(y.abs());
    let size = reach(a).max(reach(b)).max(reach(c));
    if (u + v + w).abs() >= size * size * T::literal(1.0 / 64.0) {
        return (u, v, w);
    }
    let exact = |[ax, ay]: [T; 2], [bx, by]: [T; 2]| {
        let ((p, p_error), (q, q_error)) = (ax.two_product(by), ay.two_product(bx));
        (p - q) + (p_error - q_error)
    };
    (exact(b, c), exact(c, a), exact(a, b))
}

impl<T: Real> Shear<T> {
    /// `None` unless the direction is one.
    #[inline]
    pub(super) fn new(start: &Vector3<T>, direction: &Vector3<T>) -> Option<Self> {
        let main = direction.iamax();
        let steep = component(direction, main);
        let inverse = T::one() / steep;
        if !inverse.is_number() {
            return None;
        }
        let (first, second) = ((main + 1) % 3, (main + 2) % 3);
        let (first, second) = if steep < T::zero() { (second, first) } else { (first, second) };
        Some(Self {
            axes: [first, second, main],
            x: component(direction, first) * inverse,
            y: component(direction, second) * inverse,
            inverse,
            start: [component(start, first), component(start, second), component(start, main)],
        })
    }

    #[inline]
    fn sheared(&self, v: &Vector3<T>) -> ([T; 2], T) {
        let [first, second, main] = self.axes;
        let [sx, sy, sz] = self.start;
        let z = component(v, main) - sz;
        ([component(v, first) - sx - self.x * z, component(v, second) - sy - self.y * z], z)
    }

    /// Position along the line where it crosses the triangle.
    #[inline]
    pub(super) fn crosses(&self, [a, b, c]: [&Vector3<T>; 3]) -> Option<T> {
        let ((a, az), (b, bz), (c, cz)) = (self.sheared(a), self.sheared(b), self.sheared(c));
        let (u, left_u) = is_left(b, c);
        let (v, left_v) = is_left(c, a);
        if left_u? != left_v? {
            return None;
        }
        let (w, left_w) = is_left(a, b);
        if left_v? != left_w? {
            return None;
        }
        let (u, v, w) = sharpened([a, b, c], [u, v, w]);
        let total = u + v + w;
        let z = (u * az + v * bz + w * cz) / total;
        // A sliver seen edge-on may divide zero by zero: its middle, then.
        let z = if z.is_number() { z } else { (az + bz + cz) / T::literal(3.0) };
        let (low, high) = (az.min(bz).min(cz), az.max(bz).max(cz));
        Some(z.max(low).min(high) * self.inverse)
    }

    /// `false` only if the line misses the box, given by its centre and half its extents; these
    /// include what rounding may do here.
    #[inline]
    pub(super) fn may_cross(&self, centre: &Vector3<T>, half: &Vector3<T>) -> bool {
        let ([x, y], z) = self.sheared(centre);
        let [first, second, main] = self.axes;
        let (hx, hy, hz) = (component(half, first), component(half, second), component(half, main));
        let (sx, sy) = (self.x.abs(), self.y.abs());
        // The third axis that can separate line and box; `z` cancels in it.
        let _ = z;
        (x.abs() <= hx + sx * hz)
            & (y.abs() <= hy + sy * hz)
            & ((x * self.y - y * self.x).abs() <= hx * sy + hy * sx + hz * T::EPSILON)
    }
}
