//! The point of a mesh closest to a line or a point.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::Mesh;
use crate::ClosestApproach;

/// The point of a segment closest to a line, and its squared distance.
fn segment_to_line<T: Real>(a: &Vector3<T>, b: &Vector3<T>, line: &Line<T>) -> (T, Vector3<T>) {
    let across = |v: &Vector3<T>| v - line.direction * v.dot(&line.direction);
    let (start, edge) = (across(&(a - line.point)), across(&(b - a)));
    let squared = edge.norm_squared();
    let place = -start.dot(&edge) / squared;
    let place = if place.is_number() { place.max(T::zero()).min(T::one()) } else { T::zero() };
    ((start + edge * place).norm_squared(), a + (b - a) * place)
}

/// The closest point of a triangle (Ericson, "Real-Time Collision Detection", 5.1.5) and its squared
/// distance.
fn triangle_to_point<T: Real>([a, b, c]: [&Vector3<T>; 3], p: &Vector3<T>) -> T {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= T::zero() && d2 <= T::zero() {
        return ap.norm_squared();
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= T::zero() && d4 <= d3 {
        return bp.norm_squared();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= T::zero() && d1 >= T::zero() && d3 <= T::zero() {
        return (ap - ab * (d1 / (d1 - d3))).norm_squared();
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= T::zero() && d5 <= d6 {
        return cp.norm_squared();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= T::zero() && d2 >= T::zero() && d6 <= T::zero() {
        return (ap - ac * (d2 / (d2 - d6))).norm_squared();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= T::zero() && d4 - d3 >= T::zero() && d5 - d6 >= T::zero() {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (bp - (c - b) * w).norm_squared();
    }
    let total = va + vb + vc;
    (ap - ab * (vb / total) - ac * (vc / total)).norm_squared()
}

/// A line that misses is closest to an edge or a vertex; the normal there is taken across the line.
pub(super) fn to_line<T: Real>(mesh: &Mesh<T>, line: &Line<T>) -> ClosestApproach<T> {
    let distance = |p: &Vector3<T>| {
        let away = p - line.point;
        (away - line.direction * away.dot(&line.direction)).norm_squared().root()
    };
    let (mut least, mut point, mut nearest) = (T::GREATEST, Vector3::zeros(), 0);
    mesh.bvh.visit_nearest(distance, |triangle| {
        if let Some([a, b, c]) = mesh.corners(triangle) {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                let (squared, closest) = segment_to_line(a, b, line);
                if squared < least {
                    (least, point, nearest) = (squared, closest, triangle);
                }
            }
        }
        least.root()
    });
    ClosestApproach { gap: least.root(), point, normal: mesh.normal_of(nearest), active: true }
}

/// The triangle closest to a point.
pub(super) fn to_point<T: Real>(mesh: &Mesh<T>, point: &Vector3<T>) -> usize {
    let (mut least, mut nearest) = (T::GREATEST, 0);
    mesh.bvh.visit_nearest(
        |p| (p - point).norm_squared().root(),
        |triangle| {
            if let Some(corners) = mesh.corners(triangle) {
                let squared = triangle_to_point(corners, point);
                if squared < least {
                    (least, nearest) = (squared, triangle);
                }
            }
            least.root()
        },
    );
    nearest
}
