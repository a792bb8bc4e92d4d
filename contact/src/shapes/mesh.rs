//! Bodies of flat facets.

use fingertip_surfaces::numeric::vectors::largest;
use fingertip_surfaces::{LocalSurface, Mesh};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::is_pure_force;
use crate::soft_finger::mended::mended_on_facet;
use crate::{Patch, Search, SoftContact, SoftFingerSurface};

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
/// The time grows with the logarithm of the number of triangles: the tree of the mesh knows which way the
/// triangles of each part face (`docs/theory/surfaces.md#where-a-mesh-may-be-touched`).
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
        // As the wrench was given, since moving it rounds.
        let power = force.dot(&wrench.torque()) * scale;
        let pure = is_pure_force(&force, &wrench.torque());
        let asked = Asked { mesh: self, force, torque, power, pure };
        let mut found = |contact: SoftContact<T>, in_facet: bool| {
            if (contact.point.sum() + contact.normal.sum() + contact.spin_torque).is_number() {
                let (point, spin_torque) = (contact.point / scale + centre, contact.spin_torque / scale);
                let contact = SoftContact { point, spin_torque, ..contact };
                visit(if in_facet { mended_on_facet(wrench, &contact) } else { contact });
            }
        };
        self.may_be_touched(&force, &torque, asked.side(), |triangles, vertices| {
            for triangle in triangles.filter(|triangle| asked.is_inside(*triangle)) {
                if let Some(contact) = asked.in_facet(triangle) {
                    found(contact, true);
                }
            }
            for vertex in vertices.filter(|vertex| asked.is_highest(*vertex)) {
                if let Some(contact) = asked.on_vertex(vertex) {
                    found(contact, false);
                }
            }
        });
        Search::Complete
    }

    fn patch(&self, _point: &Vector3<T>) -> Option<Patch> {
        Some(LocalSurface::Facets.into())
    }
}

/// A wrench about the origin of the stored vertices, and in their unit.
struct Asked<'a, T: Real> {
    mesh: &'a Mesh<T>,
    force: Vector3<T>,
    torque: Vector3<T>,
    /// `f·m`.
    power: T,
    /// It is zero for all that the numbers say.
    pure: bool,
}

impl<T: Real> Asked<'_, T> {
    /// 1 if the torque that is left at a contact points along the normal, −1 if against it, and 0 if that may
    /// be rounding's choice: of a moment about an edge, and of moving the wrench.
    fn side(&self) -> T {
        let (centre, scale) = self.mesh.frame();
        let before = largest(&(self.torque + centre.cross(&self.force) * scale));
        let rounding = largest(&self.force) * (before + largest(&self.torque)) * T::EPSILON;
        if self.power.abs() > rounding * T::literal(64.0) { -self.power.signum() } else { T::zero() }
    }

    /// The moment of the wrench about an edge.
    #[inline(always)]
    fn about(&self, a: u32, b: u32) -> T {
        let (Some(first), Some(second)) = (self.mesh.stored(a), self.mesh.stored(b)) else {
            return T::zero();
        };
        let moment = self.torque.dot(&(second - first)) + self.force.dot(&first.cross(second));
        // A tie is settled by the order of the vertices, the same for both facets.
        if !moment.is_zero() {
            moment
        } else if a < b {
            T::LEAST_NORMAL
        } else {
            -T::LEAST_NORMAL
        }
    }

    /// Whether the contact of a facet's plane is inside.
    #[inline(always)]
    fn is_inside(&self, triangle: usize) -> bool {
        let Some([a, b, c]) = self.mesh.triangles().get(triangle) else { return false };
        let below = |a: &u32, b: &u32| self.about(*a, *b) < T::zero();
        // All at once: no one could foretell the sign of any.
        below(a, b) & below(b, c) & below(c, a)
    }

    #[inline(never)]
    fn in_facet(&self, triangle: usize) -> Option<SoftContact<T>> {
        let [a, b, c] = *self.mesh.triangles().get(triangle)?;
        let (bc, ca, ab) = (self.about(b, c), self.about(c, a), self.about(a, b));
        let normal = self.mesh.normal_of(triangle);
        let pressing = self.force.dot(&normal);
        let (a, b, c) = (self.mesh.stored(a)?, self.mesh.stored(b)?, self.mesh.stored(c)?);
        let point = (a * bc + b * ca + c * ab) / (bc + ca + ab);
        (pressing < T::zero()).then(|| SoftContact {
            point,
            normal,
            spin_torque: self.power / pressing,
            active: true,
        })
    }

    /// Whether no neighbour is higher along `n = −sign(f·m) M/|M|`.
    #[inline(always)]
    fn is_highest(&self, vertex: u32) -> bool {
        let rising = self.power < T::zero();
        let mut highest = !self.pure;
        for [other, _] in self.mesh.fan(vertex) {
            highest &= (self.about(vertex, other) > T::zero()) != rising;
        }
        highest
    }

    #[inline(never)]
    fn on_vertex(&self, vertex: u32) -> Option<SoftContact<T>> {
        if self.is_dent(vertex) {
            return None;
        }
        let point = *self.mesh.stored(vertex)?;
        let rest = self.torque - point.cross(&self.force);
        let size = rest.amax().normalising_factor();
        let length = (rest * size).norm_squared().root();
        let sign = if self.power < T::zero() { T::one() } else { -T::one() };
        Some(SoftContact {
            point,
            normal: rest * (sign * size / length),
            spin_torque: sign * (length / size),
            active: true,
        })
    }

    /// Whether the inside is what lies on the far side of a vertex at which no neighbour is higher: then it can
    /// be touched from within only.
    ///
    /// The plane that lies one below the vertex cuts the triangles around it in a polygon, which runs the one
    /// way around the inside or the other. Where it cuts an edge, the edge is divided by what it descends.
    fn is_dent(&self, vertex: u32) -> bool {
        let Some(point) = self.mesh.stored(vertex) else { return true };
        let sum =
            |part: &dyn Fn([u32; 2]) -> T| self.mesh.fan(vertex).map(part).fold(T::zero(), |a, b| a + b);
        let whole = sum(&|[other, _]| self.about(vertex, other).abs());
        let unit = whole.normalising_factor();
        let drop = |other: u32| (self.about(vertex, other).abs() * unit).max(T::EPSILON);
        let rest = (self.torque - point.cross(&self.force)) * unit;
        let area = sum(&|[a, b]| {
            let (Some(first), Some(second)) = (self.mesh.stored(a), self.mesh.stored(b)) else {
                return T::zero();
            };
            (first - point).cross(&(second - point)).dot(&rest) / (drop(a) * drop(b))
        });
        // Along `−sign(f·m) M`.
        if self.power < T::zero() { area < T::zero() } else { area > T::zero() }
    }
}
