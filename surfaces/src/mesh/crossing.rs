//! Does a line cross a triangle? Watertight.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::lanes::Lanes;

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
    /// The axis that the line is nearest to; the two others follow in turn.
    main: Axis,
    x: T,
    y: T,
    inverse: T,
    start: [T; 3],
}

#[derive(Clone, Copy)]
enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    /// The coordinates in turn, the one along this axis last.
    #[inline]
    fn last<C>(self, [x, y, z]: [C; 3]) -> [C; 3] {
        match self {
            Self::X => [y, z, x],
            Self::Y => [z, x, y],
            Self::Z => [x, y, z],
        }
    }
}

/// Twice the area between the origin and the directed edge from `a` to `b`: positive if the origin
/// lies to its left.
#[inline]
fn edge<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    let ([ax, ay], [bx, by]) = (a, b);
    ax * by - ay * bx
}

/// As [`edge`], and `true` if the origin lies to the left, exactly; `None` if the edge is a point.
#[inline]
fn is_left<T: Real>(a: [T; 2], b: [T; 2]) -> (T, Option<bool>) {
    let rounded = edge(a, b);
    if rounded != T::zero() {
        return (rounded, Some(rounded > T::zero()));
    }
    let ([ax, ay], [bx, by]) = (a, b);
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
        let main = match direction.iamax() {
            0 => Axis::X,
            1 => Axis::Y,
            _ => Axis::Z,
        };
        let [x, y, steep] = main.last((*direction).into());
        let inverse = T::one() / steep;
        inverse.is_number().then(|| Self {
            main,
            x: x * inverse,
            y: y * inverse,
            inverse,
            start: main.last((*start).into()),
        })
    }

    #[inline]
    fn sheared(&self, [x, y, z]: [T; 3]) -> ([T; 2], T) {
        let [sx, sy, sz] = self.start;
        let z = z - sz;
        ([x - sx - self.x * z, y - sy - self.y * z], z)
    }

    /// Which of some triangles, given by their corners, the line may cross: `false` is certain.
    #[inline]
    pub(super) fn may_cross<const N: usize>(&self, corners: [&[[T; N]; 3]; 3]) -> [bool; N] {
        let [sx, sy, sz] = self.start;
        let [(ax, ay), (bx, by), (cx, cy)] = corners.map(|[x, y, z]| {
            let [x, y, z] = self.main.last([x, y, z]).map(|axis| Lanes(*axis));
            let z = z - sz;
            (x - sx - z * self.x, y - sy - z * self.y)
        });
        let (u, v, w) = (bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx);
        let (least, most) = (u.smaller(v).smaller(w), u.greater(v).greater(w));
        core::array::from_fn(|k| (least.0[k] >= T::zero()) | (most.0[k] <= T::zero()))
    }

    /// Position along the line where it crosses the triangle.
    #[inline]
    pub(super) fn crosses(&self, corners: [[T; 3]; 3]) -> Option<T> {
        let [(a, az), (b, bz), (c, cz)] = corners.map(|corner| self.sheared(self.main.last(corner)));
        let (u, left_u) = is_left(b, c);
        let (v, left_v) = is_left(c, a);
        let (w, left_w) = is_left(a, b);
        if left_u? != left_v? || left_v? != left_w? {
            return None;
        }
        let (u, v, w) = sharpened([a, b, c], [u, v, w]);
        let z = (u * az + v * bz + w * cz) / (u + v + w);
        // A sliver seen edge-on may divide zero by zero: its middle, then.
        let z = if z.is_number() { z } else { (az + bz + cz) / T::literal(3.0) };
        let (low, high) = (az.min(bz).min(cz), az.max(bz).max(cz));
        Some(z.max(low).min(high) * self.inverse)
    }
}
