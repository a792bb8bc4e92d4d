//! Some triangles side by side, tested together.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::crossing::Shear;
use super::fetch::fetch_all;
use crate::numeric::vectors::{any_perpendicular, unit_or};

/// How many triangles a packet holds.
pub(super) const LANES: usize = 4;

/// Triangles of one leaf of the tree: their corners, axis by axis, lane by lane. In single precision it
/// fills three lines of a usual cache.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Packet<T: Real> {
    corners: [[[T; LANES]; 3]; 3],
    normals: [Vector3<T>; LANES],
}

impl<T: Real> Packet<T> {
    /// From the corners of up to [`LANES`] triangles.
    pub(super) fn new(triangles: impl Iterator<Item = [Vector3<T>; 3]>) -> Self {
        // A triangle at infinity is crossed by no line: its areas are not numbers.
        let nowhere = T::literal(f64::INFINITY);
        let mut packet = Self { corners: [[[nowhere; LANES]; 3]; 3], normals: [Vector3::zeros(); LANES] };
        for ((lane, triangle), normal) in triangles.enumerate().zip(&mut packet.normals) {
            *normal = normal_of(&triangle);
            for (corner, place) in triangle.iter().zip(&mut packet.corners) {
                for (x, lanes) in corner.iter().zip(place) {
                    if let Some(slot) = lanes.get_mut(lane) {
                        *slot = *x;
                    }
                }
            }
        }
        packet
    }

    /// Has the corners fetched, without waiting.
    #[inline(always)]
    pub(super) fn fetch(&self) {
        fetch_all(self.corners.as_flattened().as_flattened());
    }

    /// Calls `visit` for every triangle that the line crosses, with the position along the line and
    /// the triangle's normal.
    #[inline]
    pub(super) fn visit_line(&self, shear: &Shear<T>, mut visit: impl FnMut(T, &Vector3<T>)) {
        let [a, b, c] = &self.corners;
        let may_cross = shear.may_cross([a, b, c]);
        for ((lane, normal), may_cross) in self.normals.iter().enumerate().zip(may_cross) {
            if may_cross {
                let corner = |c: &[[T; LANES]; 3]| {
                    let x = |axis: &[T; LANES]| axis.get(lane).copied().unwrap_or_else(T::zero);
                    c.each_ref().map(x)
                };
                if let Some(along) = shear.crosses([corner(a), corner(b), corner(c)]) {
                    visit(along, normal);
                }
            }
        }
    }
}

/// Unit normal of a triangle; across its longest edge if it has no area.
pub(super) fn normal_of<T: Real>([a, b, c]: &[Vector3<T>; 3]) -> Vector3<T> {
    // The two shorter edges give the best product.
    let edges = [b - a, c - b, a - c];
    let longest = edges.map(|e| e.norm_squared());
    let product = if longest[0] >= longest[1] && longest[0] >= longest[2] {
        edges[1].cross(&edges[2])
    } else if longest[1] >= longest[2] {
        edges[2].cross(&edges[0])
    } else {
        edges[0].cross(&edges[1])
    };
    unit_or(&product, || any_perpendicular(&unit_or(&(b - a), Vector3::x)))
}
