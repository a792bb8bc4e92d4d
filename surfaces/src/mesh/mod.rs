//! Triangle meshes.

mod bvh;
mod closest;
mod crossing;
mod facing;
mod fans;
mod fetch;
mod lanes;
mod list;
mod node;
mod obj;
mod packet;
mod probe;
mod split;
mod stl;
#[cfg(feature = "serde")]
mod stored;
mod topology;

use alloc::boxed::Box;
use alloc::vec::Vec;

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix3, Vector3};

use self::bvh::Bvh;
use self::facing::{Asked, Facings};
use self::fans::Fans;
use crate::numeric::vectors::{foot, is_finite};
use crate::{ActiveSurface, ClosestApproach, Corner, Crossing, Extent, Level, SmoothSurface};

pub use self::topology::MeshError;

/// A closed surface of triangles.
///
/// Crossings are watertight: no line slips through an edge or a vertex, and none is counted twice
/// there. The tree over the triangles is built once; a query takes a time that grows with the
/// logarithm of their number.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Mesh};
/// use nalgebra::Vector3;
///
/// // A corner of a cube, drawn in millimetres.
/// let obj = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/// let tip = Mesh::from_obj(obj, 0.001)?;
/// assert_eq!(tip.triangle_count(), 4);
/// // Its slanted face is where x + y + z is 9 mm.
/// assert!(tip.contains(&Vector3::repeat(0.0029)) && !tip.contains(&Vector3::repeat(0.0031)));
/// let normal = tip.normal(&Vector3::repeat(0.003));
/// assert!((normal - Vector3::repeat(1.0_f64 / 3.0_f64.sqrt())).amax() < 1e-15);
/// # Ok::<(), fingertip_surfaces::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<T: Real> {
    centre: Vector3<T>,
    /// A power of two that brings the mesh near size 1; vertices are stored so.
    scale: T,
    radius: T,
    vertices: Vec<Vector3<T>>,
    /// In the order of the tree's leaves.
    triangles: Vec<[u32; 3]>,
    fans: Fans,
    /// Out of the way of those who never ask.
    facings: Box<Facings>,
    bvh: Bvh<T>,
}

/// Vertices, and triangles that index them.
type Parts<T> = (Vec<Vector3<T>>, Vec<[u32; 3]>);

/// A unit that lengths can be counted in. A negative one would give the mirror image.
fn checked_unit<T: Real>(metres_per_unit: T) -> Result<T, MeshError> {
    let is_length = metres_per_unit > T::zero() && metres_per_unit.is_number();
    if is_length { Ok(metres_per_unit) } else { Err(MeshError::BadUnit) }
}

fn of_obj<T: Real>(text: &str, metres_per_unit: T) -> Result<Parts<T>, MeshError> {
    obj::read(text, checked_unit(metres_per_unit)?)
}

fn of_stl<T: Real>(bytes: &[u8], metres_per_unit: T) -> Result<Parts<T>, MeshError> {
    let corners = stl::read(bytes, checked_unit(metres_per_unit)?)?;
    let count = u32::try_from(corners.len() / 3).map_err(|_| MeshError::TooLarge)?;
    Ok((corners, (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect()))
}

/// The bytes of a file, as long as it is no longer than any mesh that is meant.
#[cfg(feature = "std")]
fn read(path: &std::path::Path) -> Result<Vec<u8>, MeshError> {
    use std::io::Read as _;

    /// Ten million triangles of a binary STL.
    const LONGEST: u64 = 512 << 20;
    let unreadable = |error: std::io::Error| MeshError::Unreadable(error.kind());
    let file = std::fs::File::open(path).map_err(unreadable)?;
    // A device without an end has no length either.
    if !file.metadata().map_err(unreadable)?.is_file() {
        return Err(MeshError::Unreadable(std::io::ErrorKind::InvalidInput));
    }
    let mut bytes = Vec::new();
    let length = file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if length as u64 > LONGEST { Err(MeshError::TooLarge) } else { Ok(bytes) }
}

impl<T: Real> Mesh<T> {
    /// From vertices \[m\] and triangles that index them.
    ///
    /// Vertices at the same place are merged, triangles without area in the wake of that dropped;
    /// slivers are kept. If all triangles are wound to face inward, they are turned.
    ///
    /// # Errors
    /// [`MeshError`] if an index or a coordinate is bad, if edges are open or wound inconsistently
    /// (with their number), or if nothing is enclosed.
    pub fn new(vertices: &[Vector3<T>], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let parts = topology::check(vertices, triangles)?;
        let (bvh, order) = Bvh::build(&parts.vertices, &parts.triangles);
        let triangles: Vec<[u32; 3]> =
            order.iter().filter_map(|k| parts.triangles.get(*k as usize).copied()).collect();
        let (vertices, triangles) = in_order_of_use(&parts.vertices, &triangles);
        let radius = vertices.iter().fold(T::zero(), |r, v| r.max(v.norm_squared())).root();
        let mut mesh = Self {
            fans: Fans::new(vertices.len(), &triangles),
            facings: Box::default(),
            centre: parts.centre,
            scale: parts.scale,
            radius: radius * T::literal(1.0001),
            vertices,
            triangles,
            bvh,
        };
        *mesh.facings = Facings::new(&mesh, &mesh.bvh);
        Ok(mesh)
    }

    /// From the text or bytes of an STL file, ASCII or binary, in units of `metres_per_unit`
    /// (0.001 for millimetres; STL does not say).
    ///
    /// # Errors
    /// [`MeshError`] if the unit is not positive and finite, the file is malformed or the mesh is not closed.
    pub fn from_stl(bytes: &[u8], metres_per_unit: T) -> Result<Self, MeshError> {
        let (corners, triangles) = of_stl(bytes, metres_per_unit)?;
        Self::new(&corners, &triangles)
    }

    /// From the text of a Wavefront OBJ file, in units of `metres_per_unit`; faces with more than
    /// three corners are cut into triangles, everything but `v` and `f` is ignored.
    ///
    /// # Errors
    /// [`MeshError`] if the unit is not positive and finite, the file is malformed or the mesh is not closed.
    pub fn from_obj(text: &str, metres_per_unit: T) -> Result<Self, MeshError> {
        let (vertices, triangles) = of_obj(text, metres_per_unit)?;
        Self::new(&vertices, &triangles)
    }

    /// Reads an `.stl` or `.obj` file, told apart by its name.
    ///
    /// # Errors
    /// [`MeshError`] if the unit is not positive and finite, the file cannot be read or is malformed, or the mesh is
    /// not closed.
    #[cfg(feature = "std")]
    pub fn from_file(path: impl AsRef<std::path::Path>, metres_per_unit: T) -> Result<Self, MeshError> {
        let (vertices, triangles) = Self::parts_from_file(path, metres_per_unit)?;
        Self::new(&vertices, &triangles)
    }

    /// The vertices \[m\] and triangles of such a file as [`new`](Self::new) takes them, for those who write them
    /// elsewhere. Those of an STL file have no vertex in common.
    ///
    /// # Errors
    /// [`MeshError`] if the unit is not positive and finite, or the file cannot be read or is malformed.
    #[cfg(feature = "std")]
    pub fn parts_from_file(
        path: impl AsRef<std::path::Path>,
        metres_per_unit: T,
    ) -> Result<Parts<T>, MeshError> {
        let path = path.as_ref();
        let bytes = read(path)?;
        if path.extension().is_some_and(|name| name.eq_ignore_ascii_case("obj")) {
            of_obj(core::str::from_utf8(&bytes).map_err(|_| MeshError::NotText)?, metres_per_unit)
        } else {
            of_stl(&bytes, metres_per_unit)
        }
    }

    /// How many triangles there are.
    #[inline]
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The vertices \[m\].
    pub fn vertices(&self) -> impl Iterator<Item = Vector3<T>> + '_ {
        self.vertices.iter().map(|v| v / self.scale + self.centre)
    }

    /// The triangles, as indices of [`vertices`](Self::vertices).
    #[inline]
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    #[inline]
    fn corners(&self, triangle: usize) -> Option<[&Vector3<T>; 3]> {
        let [a, b, c] = self.triangles.get(triangle)?;
        Some([
            self.vertices.get(*a as usize)?,
            self.vertices.get(*b as usize)?,
            self.vertices.get(*c as usize)?,
        ])
    }

    /// The triangle nearest to a point.
    fn facet_at(&self, point: &Vector3<T>) -> usize {
        let point = (point - self.centre) * self.scale;
        closest::to_point(self, &if is_finite(&point) { point } else { Vector3::zeros() })
    }

    /// The origin of the stored vertices \[m\], and the factor that they are scaled by.
    #[inline]
    #[doc(hidden)]
    pub const fn frame(&self) -> (Vector3<T>, T) {
        (self.centre, self.scale)
    }

    /// A vertex as stored.
    #[inline(always)]
    #[doc(hidden)]
    pub fn stored(&self, vertex: u32) -> Option<&Vector3<T>> {
        self.vertices.get(vertex as usize)
    }

    /// The triangles around a vertex, each by its two other corners in their order.
    #[inline(always)]
    #[doc(hidden)]
    pub fn fan(&self, vertex: u32) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.fans.around(vertex).iter().filter_map(move |k| {
            let [a, b, c] = *self.triangles.get(*k as usize)?;
            let (from_a, from_b) = (a == vertex, b == vertex);
            // Without a branch, since any of the corners may be it.
            let next = if from_a {
                b
            } else if from_b {
                c
            } else {
                a
            };
            let last = if from_a {
                c
            } else if from_b {
                a
            } else {
                b
            };
            Some([next, last])
        })
    }

    /// Calls `visit` with ranges of triangles and of vertices: all that a wrench, about the origin of the
    /// stored vertices and in their unit, may touch as a soft finger does, and few others. `side` is 1 if the
    /// torque that is left at a contact points along the normal, −1 if against it, and 0 if it may do either.
    #[inline]
    #[doc(hidden)]
    pub fn may_be_touched(
        &self,
        force: &Vector3<T>,
        torque: &Vector3<T>,
        side: T,
        visit: impl FnMut(core::ops::Range<usize>, core::ops::Range<u32>),
    ) {
        self.facings.visit(&self.bvh, &Asked::new(force, torque, side), visit);
    }

    #[inline]
    #[doc(hidden)]
    pub fn normal_of(&self, triangle: usize) -> Vector3<T> {
        self.corners(triangle).map_or_else(Vector3::z, |corners| packet::normal_of(&corners.map(|v| *v)))
    }
}

/// The same triangles, their vertices numbered as the triangles need them: neighbours in space
/// become neighbours in memory. Vertices that no triangle needs are dropped.
fn in_order_of_use<T: Real>(
    vertices: &[Vector3<T>],
    triangles: &[[u32; 3]],
) -> (Vec<Vector3<T>>, Vec<[u32; 3]>) {
    let mut renamed: Vec<Option<u32>> = alloc::vec![None; vertices.len()];
    let mut used = Vec::with_capacity(vertices.len());
    let mut next = 0;
    let mut rename = |old: u32| {
        let (Some(name), Some(vertex)) = (renamed.get_mut(old as usize), vertices.get(old as usize)) else {
            return old;
        };
        *name.get_or_insert_with(|| {
            used.push(*vertex);
            next += 1;
            next - 1
        })
    };
    let triangles = triangles.iter().map(|triangle| triangle.map(&mut rename)).collect();
    (used, triangles)
}

impl<T: Real> ActiveSurface<T> for Mesh<T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (start, along) = foot(line, &self.centre);
        let start = start * self.scale;
        if !(start.norm_squared() <= self.radius * self.radius) {
            return;
        }
        let back = T::one() / self.scale;
        self.bvh.visit_line(&start, &line.direction, |t, normal| {
            visit(Crossing {
                along: along + t * back,
                point: (start + line.direction * t) * back + self.centre,
                normal: *normal,
                active: true,
            });
        });
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (start, _) = foot(line, &self.centre);
        let start = if is_finite(&start) { start * self.scale } else { Vector3::zeros() };
        let near = Line { point: start, direction: line.direction };
        let found = closest::to_line(self, &near);
        let point = found.point / self.scale + self.centre;
        Some(ClosestApproach { gap: (found.gap / self.scale).min(T::GREATEST), point, ..found })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.normal_of(self.facet_at(point))
    }
}

/// The height over the nearest facet, which is flat: for the curvature of the shape that was meshed ask
/// [`shape_operator_by_differences`](crate::shape_operator_by_differences) over some facets.
impl<T: Real> SmoothSurface<T> for Mesh<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let facet = self.facet_at(point);
        let normal = self.normal_of(facet);
        let corner = self.corners(facet).map_or_else(Vector3::zeros, |[a, _, _]| *a);
        let value = normal.dot(&(point - (corner / self.scale + self.centre)));
        Level { value, gradient: normal, hessian: Matrix3::zeros() }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre, radius: self.radius / self.scale }
    }

    /// A vertex: on a straight edge no spin torque holds a contact.
    fn corner(&self, _point: &Vector3<T>, _normal: &Vector3<T>) -> Option<Corner<T>> {
        Some(Corner::Tip)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;
    use crate::testing::ball_of_triangles;

    fn survives_any_line<T: Real>(mut any: impl FnMut() -> T) -> Result<(), MeshError> {
        let (vertices, triangles) = ball_of_triangles::<T>(20, 21, None);
        let mesh = Mesh::new(&vertices, &triangles)?;
        for k in 0..20_000 {
            let mut any = || Vector3::from_fn(|_, _| any());
            let (mut point, mut direction) = (any(), any());
            if k % 2 == 0 {
                // One that reaches the mesh: of any length, or not a number.
                point = point.map(|x| if x.abs() <= T::one() { x } else { T::zero() });
            }
            if k % 3 == 0 {
                direction /= direction.norm();
            }
            mesh.crossings(&Line { point, direction }, |crossing| {
                let numbers = crossing.point.iter().chain(&crossing.normal).all(|x| !x.to_f64().is_nan());
                assert!(numbers, "{point:?} {direction:?} {crossing:?}");
            });
        }
        Ok(())
    }

    #[test]
    fn no_line_breaks_a_mesh() {
        let mut random = Pcg64Mcg::seed_from_u64(11);
        let narrow = survives_any_line(|| f32::from_bits(random.random()));
        let mut random = Pcg64Mcg::seed_from_u64(12);
        let wide = survives_any_line(|| f64::from_bits(random.random()));
        assert_eq!((narrow, wide), (Ok(()), Ok(())));
    }
}
