//! Bodies of flat facets.

use fingertip_surfaces::Mesh;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::{Search, SoftContact, SoftFingerSurface};

/// The soft finger on the polyhedron that the mesh *is*: facets are flat and normals are theirs, not
/// interpolated. A contact is either inside a facet, by the closed form of the plane, or on a vertex,
/// with a normal on which the vertex is the highest point of its surroundings. (On the inside of a
/// straight edge there is none but by coincidence.) The mesh of a round tip thus answers as the tip
/// up to the angle between its facets times the lever arm of the spin torque: use facets as small as
/// the contact patch, or a shape with an equation.
///
/// Both cases are told by the signs of one number for each edge from `a` to `b`,
/// `m·(b − a) + f·(a × b)`, the moment of the wrench about the edge. For the contact in a facet,
/// `m − c × f = τ n`, these numbers are the facet's `f·n` times the areas that `c` cuts off: it is
/// inside if all three have one sign, and they are its barycentric coordinates. On a vertex
/// `m − c × f` points along the normal up to sign, and all edges that leave the vertex agree. An edge
/// has the same number for both of its facets, so no contact falls between two: on a convex body with
/// `f·m ≠ 0` exactly one is found, whatever rounding does.
///
/// The time is proportional to the number of triangles.
impl<T: Real> SoftFingerSurface<T> for Mesh<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        // In the frame and unit of the stored vertices.
        let (centre, scale) = self.frame();
        let (force, torque) = (wrench.force(), wrench.torque_about(&centre) * scale);
        let power = force.dot(&torque);
        let about = |a: u32, b: u32| {
            let (Some(first), Some(second)) = (self.stored(a), self.stored(b)) else { return T::zero() };
            let moment = torque.dot(&(second - first)) + force.dot(&first.cross(second));
            // A tie is settled by the order of the vertices, the same for both facets.
            if !moment.is_zero() {
                moment
            } else if a < b {
                T::LEAST_NORMAL
            } else {
                -T::LEAST_NORMAL
            }
        };
        for (index, [a, b, c]) in self.triangles().iter().enumerate() {
            let (bc, ca, ab) = (about(*b, *c), about(*c, *a), about(*a, *b));
            if !(bc < T::zero() && ca < T::zero() && ab < T::zero()) {
                continue;
            }
            let normal = self.normal_of(index);
            let spin_torque = power / force.dot(&normal);
            let (Some(a), Some(b), Some(c)) = (self.stored(*a), self.stored(*b), self.stored(*c)) else {
                continue;
            };
            let point = (a * bc + b * ca + c * ab) / (bc + ca + ab);
            if (point.sum() + spin_torque).is_number() && force.dot(&normal) < T::zero() {
                visit(SoftContact {
                    point: point / scale + centre,
                    normal,
                    spin_torque: spin_torque / scale,
                    active: true,
                });
            }
        }
        if power.is_zero() {
            return Search::Complete;
        }
        // n = −sign(f·m) M/|M|, and no neighbour is higher.
        let rising = power < T::zero();
        for (vertex, neighbours) in self.fans() {
            if !neighbours.iter().all(|other| (about(vertex, *other) > T::zero()) != rising) {
                continue;
            }
            let Some(point) = self.stored(vertex) else { continue };
            let rest = torque - point.cross(&force);
            let size = rest.amax().normalising_factor();
            let length = (rest * size).norm_squared().root();
            let sign = if rising { T::one() } else { -T::one() };
            let normal = rest * (size * sign / length);
            if normal.sum().is_number() {
                visit(SoftContact {
                    point: point / scale + centre,
                    normal,
                    spin_torque: sign * (length / size) / scale,
                    active: true,
                });
            }
        }
        Search::Complete
    }
}
