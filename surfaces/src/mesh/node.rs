//! A node of the tree: boxes, and whether a line crosses them.

use fingertip_wrench::Real;
use nalgebra::Vector3;
use wide::f32x4;

use super::split::Bounds;

/// Children of a node.
pub(super) const WIDTH: usize = 4;
/// Marks a child that is a packet, in the highest bit of its index.
pub(super) const LEAF: u32 = 1 << 31;

/// Boxes of four children side by side, in single precision whatever the precision of the mesh:
/// they only have to be certain to contain the triangles, and what is small stays in the cache.
///
/// The mesh has a size of 1 to 2 by now. A node fills two lines of a usual cache.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Node {
    centre: [[f32; WIDTH]; 3],
    /// Half the extents; negative where there is no child.
    half: [[f32; WIDTH]; 3],
    pub(super) child: [u32; WIDTH],
    /// A bit for each child that is a packet.
    pub(super) leaves: u32,
}

impl Node {
    pub(super) const EMPTY: Self =
        Self { centre: [[0.0; WIDTH]; 3], half: [[-1.0; WIDTH]; 3], child: [u32::MAX; WIDTH], leaves: 0 };

    /// Puts a child in its place; `child` is an index, marked by [`LEAF`] or not.
    pub(super) fn put<T: Real>(&mut self, lane: usize, bounds: &Bounds<T>, child: u32) {
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis].to_f64(), bounds.high[axis].to_f64());
            #[allow(clippy::cast_possible_truncation)]
            let centre = ((low + high) * 0.5) as f32;
            let half = (high - f64::from(centre)).max(f64::from(centre) - low);
            // This covers all rounding, here, of the test on the box and of that on a triangle.
            #[allow(clippy::cast_possible_truncation)]
            let half = half as f32 + 64.0 * f32::EPSILON;
            if let (Some(c), Some(h)) = (self.centre.get_mut(axis), self.half.get_mut(axis))
                && let (Some(c), Some(h)) = (c.get_mut(lane), h.get_mut(lane))
            {
                (*c, *h) = (centre, half);
            }
        }
        if let Some(slot) = self.child.get_mut(lane) {
            *slot = child & !LEAF;
            self.leaves |= u32::from(child & LEAF != 0) << lane;
        }
    }

    /// Each child, with centre and radius of the ball around its box.
    pub(super) fn balls<T: Real>(&self) -> impl Iterator<Item = (u32, Vector3<T>, T)> + '_ {
        let t = |x: f32| T::literal(f64::from(x));
        let at = move |lanes: &[[f32; WIDTH]; 3], lane: usize| {
            Vector3::from(lanes.each_ref().map(|axis| axis.get(lane).copied().map_or_else(T::zero, t)))
        };
        self.child.iter().enumerate().filter_map(move |(lane, child)| {
            let half = at(&self.half, lane);
            (half.x >= T::zero()).then(|| {
                (
                    *child | (((self.leaves >> lane) & 1) * LEAF),
                    at(&self.centre, lane),
                    half.norm_squared().root(),
                )
            })
        })
    }
}

/// A line in single precision: its direction `u` and moment `p × u`.
pub(super) struct Probe {
    direction: [f32x4; 3],
    moment: [f32x4; 3],
    /// Magnitudes of the direction's components, not below what may have underflowed.
    spread: [f32x4; 3],
}

impl Probe {
    #[inline]
    pub(super) fn new<T: Real>(start: &Vector3<T>, direction: &Vector3<T>) -> Self {
        #[allow(clippy::cast_possible_truncation)]
        let narrow = |v: &Vector3<T>| <[f32; 3]>::from(v.map(|x| x.to_f64() as f32)).map(f32x4::splat);
        let direction_narrow = narrow(direction);
        Self {
            direction: direction_narrow,
            moment: narrow(&start.cross(direction)),
            spread: direction_narrow.map(|x| x.abs().fast_max(f32x4::splat(1e-30))),
        }
    }

    /// Which children's boxes the line may cross, a bit for each: along each axis across it and one
    /// of the box's, do their shadows overlap? (The separating axes of a line and a box.)
    #[inline]
    pub(super) fn may_cross(&self, node: &Node) -> u32 {
        let ([x, y, z], [a, b, c]) = (node.centre.map(f32x4::new), node.half.map(f32x4::new));
        let ([ux, uy, uz], [mx, my, mz], [sx, sy, sz]) = (self.direction, self.moment, self.spread);
        let over_x = (y * uz - z * uy - mx).abs() - (b * sz + c * sy);
        let over_y = (z * ux - x * uz - my).abs() - (c * sx + a * sz);
        let over_z = (x * uy - y * ux - mz).abs() - (a * sy + b * sx);
        over_x.fast_max(over_y).fast_max(over_z).simd_le(f32x4::ZERO).to_bitmask()
    }
}
