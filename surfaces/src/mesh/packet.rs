//! Some triangles side by side, tested together.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::crossing::Shear;
use crate::numeric::vectors::{any_perpendicular, unit_or};

/// How many triangles a packet holds, and children a node.
pub(super) const LANES: usize = 4;

/// Triangles of one leaf of the tree: their corners, axis by axis, lane by lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Packet<T: Real> {
    /// Index of the first triangle; the others follow.
    first: u32,
    count: u32,
    corners: [[[T; LANES]; 3]; 3],
    normals: [Vector3<T>; LANES],
}

impl<T: Real> Packet<T> {
    /// From the corners of up to [`LANES`] triangles, of which the first has the index `first`.
    pub(super) fn new(triangles: impl Iterator<Item = [Vector3<T>; 3]>, first: u32) -> Self {
        let mut packet = Self {
            corners: [[[T::zero(); LANES]; 3]; 3],
            normals: [Vector3::zeros(); LANES],
            first,
            count: 0,
        };
        for ((lane, triangle), normal) in triangles.enumerate().zip(&mut packet.normals) {
            packet.count += 1;
            *normal = normal_of(&triangle);
            for (corner, place) in triangle.iter().zip(&mut packet.corners) {
                for (x, lanes) in corner.iter().zip(place) {
                    // The unused lanes repeat the last triangle.
                    lanes.iter_mut().skip(lane).for_each(|slot| *slot = *x);
                }
            }
        }
        packet
    }

    /// The indices of its triangles.
    #[inline]
    pub(super) fn triangles(&self) -> core::ops::Range<usize> {
        let first = self.first as usize;
        first..first + self.count as usize
    }

    /// Calls `visit` for every triangle that the line crosses, with the position along the line and
    /// the triangle's normal.
    #[inline]
    pub(super) fn visit_line(&self, shear: &Shear<T>, mut visit: impl FnMut(T, &Vector3<T>)) {
        let [a, b, c] = &self.corners;
        let may_cross = shear.may_cross([a, b, c]);
        for (lane, normal) in self.normals.iter().enumerate().take(self.count as usize) {
            if may_cross.get(lane).copied().unwrap_or(false) {
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
