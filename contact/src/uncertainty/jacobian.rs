//! First derivatives of a contact.

use fingertip_surfaces::numeric::vectors::{larger, tangents};
use fingertip_surfaces::{Corner, ForceLine, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Matrix3, Vector3, Vector6};

use super::WrenchSpread;
use super::line_spread::{Across, congruence};
use super::sinking::Sinking;
use crate::Contact;

/// The first derivatives of a contact with respect to the wrench `(f, m)` \[N, N·m\] about the
/// origin of the sensor frame, and to the geometry of the surface.
///
/// The contact is described in its tangent plane by six numbers: its position along the two
/// tangents \[m\], the normal force, the tangential force along the two tangents \[N\], the spin
/// torque \[N·m\]. As the contact moves over a curved surface the tangents are carried along
/// without turning about the normal.
///
/// With outward normal `n`, shape operator `W` (the normal changes by `W dc`), tangents `E` and
/// `b = dm − c × df`:
///
/// * **soft finger** (`docs/theory/contact.md#errors-of-a-soft-finger`): `τ W dc + n dτ + dc × f = b` gives
///   `(τ EᵀWE + (f·n) J₂) Eᵀdc = Eᵀb`, `dτ = n·b − n·(dc × f)`. The determinant is
///   `τ²κ + (f·n)²`: a spin torque makes a convex surface *less* sensitive.
/// * **point contact** (`docs/theory/contact.md#errors-of-a-point-contact`), of whatever pitch `p`:
///   `dc × f = b − p df − f dp` gives `dc = n × (b − p df − f dp)/(f·n)`, which is
///   `Π[f] dm/|f|² − Π[f]([c] + p) df/|f|²` with `Π = I − f nᵀ/(f·n)`.
///
/// * **through a skin**, either of these on the parallel surface on which the contact lies, which sinks as
///   the normal force grows:
///   [`CompliantSoftFinger::jacobian`](crate::CompliantSoftFinger::jacobian),
///   [`CompliantPointContact::jacobian`](crate::CompliantPointContact::jacobian).
///
/// Every surface will do: `W` comes from [`SmoothSurface`](fingertip_surfaces::SmoothSurface) or
/// from differences of its normal
/// ([`shape_operator_by_differences`](fingertip_surfaces::shape_operator_by_differences)). The position of a
/// point contact does not depend on it.
///
/// On an edge or a tip ([`Corner`]) there is no `W`, but the point has less freedom and the normal more:
/// along an edge with the direction `t`, `τ b (t·dc) = t·b` for its bend `b`; a tip stays where it is. The
/// rest of the equations tells how the normal turns.
///
/// Only what the derivatives are made of is kept: the two equations in the tangent plane, about
/// `e·(dm − c × df − p df)`, and the 2 × 2 matrix that solves them. So a covariance of the position
/// costs two products of a matrix and a vector, and no 6 × 6 matrix is made unless
/// [`local`](Self::local) is asked for.
///
/// ```
/// use fingertip_contact::{ContactJacobian, ContactModel, SoftFinger};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N at the top of a sphere of 10 mm.
/// let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(Vector3::z() * -2.0, Vector3::zeros()));
/// let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// // 1 N·mm about y moves the contact by 1 N·mm/2 N = 0.5 mm along x.
/// let metres_per_newton_metre = jacobian.point()[(0, 4)];
/// assert!((metres_per_newton_metre - 0.5_f64).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ContactJacobian<T: Real> {
    pub(super) tangents: [Vector3<T>; 2],
    pub(super) normal: Vector3<T>,
    pub(super) point: Vector3<T>,
    pub(super) force: Vector3<T>,
    pub(super) spin: T,
    /// What a point contact takes for its pitch; zero for a soft finger.
    pub(super) pitch: T,
    pub(super) is_soft: bool,
    /// Shape operator in the tangent plane.
    pub(super) bend: Matrix2<T>,
    /// The inverse of the matrix of the two equations in the plane, as its adjugate and the reciprocal
    /// of its determinant.
    pub(super) adjugate: Matrix2<T>,
    pub(super) inverse: T,
    /// The directions of torque that the two equations in the plane are about.
    pub(super) across: [Vector3<T>; 2],
    /// What a skin adds.
    pub(super) sinking: Option<Sinking<T>>,
    /// On an edge or a tip, how the normal turns with the right-hand sides of the two equations.
    pub(super) turn: Option<Matrix2<T>>,
}

impl<T: Real> ContactJacobian<T> {
    /// Of a contact that [`SoftFinger`](crate::SoftFinger) found. `None` where the derivative does
    /// not exist: the force grazes and no curvature holds the contact, two contacts merge, or the
    /// curvature is not finite.
    #[must_use]
    pub fn of_soft_finger(contact: &Contact<T>, shape_operator: &Matrix3<T>) -> Option<Self> {
        Self::soft_finger_bent(contact, |e1, e2| bend_of(shape_operator, e1, e2))
    }

    /// The same, on a surface that knows its curvature: the faster way, as only the tangent plane's
    /// part of the shape operator is computed. On edges and tips, too, that the surface knows.
    #[inline]
    #[must_use]
    pub fn of_soft_finger_on<S: SmoothSurface<T>>(contact: &Contact<T>, surface: &S) -> Option<Self> {
        Self::soft_finger_bent(contact, |e1, e2| surface.bend(&contact.point, &contact.normal, [e1, e2]))
            .or_else(|| Self::of_soft_finger_in(contact, &surface.corner(&contact.point, &contact.normal)?))
    }

    /// On an edge or a tip. With the point at `s` along an edge and its normal turned by `θ` about it,
    /// `dc = t ds` and `dn = t b ds + (n × t) dθ`, for which the equations of the soft finger read
    /// `τ b ds = t·b`, `τ dθ − (f·n) ds = (n × t)·b`.
    #[cold]
    fn of_soft_finger_in(contact: &Contact<T>, corner: &Corner<T>) -> Option<Self> {
        let (zero, one) = (T::zero(), T::one());
        let spin = contact.spin_torque;
        let (first, along, inverse, turn) = match *corner {
            Corner::Edge { direction, bend } => {
                let pressing = contact.force.dot(&contact.normal);
                let turn = Matrix2::new(one, zero, pressing / (spin * bend), one) / spin;
                (direction, one, one / (spin * bend), turn)
            }
            Corner::Tip => (tangents(&contact.normal).0, zero, one, Matrix2::identity() / spin),
        };
        let (jacobian, _) = Self::unchecked(contact, |_, _| Matrix2::zeros());
        let both = [first, contact.normal.cross(&first)];
        (turn.sum() + inverse + both[0].sum()).is_number().then_some(Self {
            tangents: both,
            across: both,
            adjugate: Matrix2::new(along, zero, zero, zero),
            inverse,
            turn: Some(turn),
            ..jacobian
        })
    }

    #[inline(always)]
    pub(super) fn soft_finger_bent(
        contact: &Contact<T>,
        bend: impl FnOnce(&Vector3<T>, &Vector3<T>) -> Matrix2<T>,
    ) -> Option<Self> {
        let (jacobian, in_range) = Self::unchecked(contact, bend);
        if in_range {
            return Some(jacobian);
        }
        let pressing = contact.force.dot(&contact.normal);
        let (adjugate, inverse) = scaled_solution(jacobian.bend, contact.spin_torque, pressing)?;
        Some(Self { adjugate, inverse, ..jacobian })
    }

    /// Of a contact of a soft finger, and whether it exists and its numbers are in the range in which
    /// squares have all digits.
    #[inline(always)]
    fn unchecked(
        contact: &Contact<T>,
        bend: impl FnOnce(&Vector3<T>, &Vector3<T>) -> Matrix2<T>,
    ) -> (Self, bool) {
        let (e1, e2) = tangents(&contact.normal);
        let bend = bend(&e1, &e2);
        let pressing = contact.force.dot(&contact.normal);
        let Solution { adjugate, inverse, in_range } =
            Solution::new(bend, contact.spin_torque, pressing, T::one());
        let jacobian = Self {
            tangents: [e1, e2],
            normal: contact.normal,
            point: contact.point,
            force: contact.force,
            spin: contact.spin_torque,
            pitch: T::zero(),
            is_soft: true,
            bend,
            adjugate,
            inverse,
            across: [e1, e2],
            sinking: None,
            turn: None,
        };
        (jacobian, in_range)
    }

    /// The covariance of the position of a soft finger, straight from the contact. Whether it exists is
    /// asked last: a question half way would cost a quarter of the time of all the rest.
    #[inline(always)]
    pub(super) fn soft_position_covariance<S: SmoothSurface<T>>(
        contact: &Contact<T>,
        surface: &S,
        wrench: WrenchSpread<'_, T>,
    ) -> Option<Matrix2<T>> {
        let bend = |e1: &_, e2: &_| surface.bend(&contact.point, &contact.normal, [e1, e2]);
        let (jacobian, in_range) = Self::unchecked(contact, bend);
        let covariance = jacobian.position_covariance(wrench);
        // The sum keeps the compiler from asking the question first after all.
        if in_range & (covariance.m11 + covariance.m22 <= T::GREATEST) {
            return Some(covariance);
        }
        // Number by number, or what is usual would go through the memory that this is answered in.
        let [m11, m12, m21, m22] = Self::extreme_covariance(contact, surface, wrench)?;
        Some(Matrix2::new(m11, m12, m21, m22))
    }

    #[cold]
    #[inline(never)]
    fn extreme_covariance<S: SmoothSurface<T>>(
        contact: &Contact<T>,
        surface: &S,
        wrench: WrenchSpread<'_, T>,
    ) -> Option<[T; 4]> {
        let c = Self::of_soft_finger_on(contact, surface)?.position_covariance(wrench);
        Some([c.m11, c.m12, c.m21, c.m22])
    }

    /// Of a contact that [`PointContact`](crate::PointContact) found in this wrench. `None` where
    /// the force grazes.
    #[must_use]
    pub fn of_point_contact(
        contact: &Contact<T>,
        wrench: &Wrench<T>,
        shape_operator: &Matrix3<T>,
    ) -> Option<Self> {
        let bend = |e1: &_, e2: &_| bend_of(shape_operator, e1, e2);
        let (jacobian, in_range) = Self::unchecked_of_point(contact, wrench, bend);
        in_range.then_some(jacobian)
    }

    /// The derivatives of a point contact, and whether all of them are numbers.
    #[inline(always)]
    fn unchecked_of_point(
        contact: &Contact<T>,
        wrench: &Wrench<T>,
        bend: impl FnOnce(&Vector3<T>, &Vector3<T>) -> Matrix2<T>,
    ) -> (Self, bool) {
        let (e1, e2) = tangents(&contact.normal);
        let bend = bend(&e1, &e2);
        let beside = Across::new(&contact.force, &contact.normal, &wrench.torque());
        let (inverse, pitch, across) = (beside.inverse, beside.pitch, [e1, e2].map(|e| beside.of(&e)));
        let adjugate = Matrix2::new(T::zero(), -inverse, inverse, T::zero());
        let in_range = (across[0].sum() + across[1].sum() + inverse + bend.sum() + pitch).is_number();
        let jacobian = Self {
            tangents: [e1, e2],
            normal: contact.normal,
            point: contact.point,
            force: contact.force,
            spin: T::zero(),
            pitch,
            is_soft: false,
            bend,
            adjugate,
            inverse: T::one(),
            across,
            sinking: None,
            turn: None,
        };
        (jacobian, in_range)
    }

    /// The row of `e·(dm − c × df − p df)`.
    #[inline(always)]
    pub(super) fn row(&self, e: &Vector3<T>) -> Vector6<T> {
        let arm = self.point.cross(e) - e * self.pitch;
        Vector6::new(arm.x, arm.y, arm.z, e.x, e.y, e.z)
    }

    /// The covariance of the position along the tangents.
    ///
    /// First that of the right-hand sides of the two equations in the plane, which waits for neither
    /// curvature nor load; then of their solution, by a congruence.
    #[inline(always)]
    pub(super) fn position_covariance(&self, wrench: WrenchSpread<'_, T>) -> Matrix2<T> {
        if self.sinking.is_some() {
            let [first, second] = self.position_rows();
            let [c11, c12, c22] = wrench.combined(&first, &second);
            return Matrix2::new(c11, c12, c12, c22);
        }
        let [e1, e2] = &self.across;
        let [c11, c12, c22] = if self.is_soft {
            congruence(&wrench.torque_about(&self.point), &self.across)
        } else {
            // `dc = n × b/(f·n)`: a quarter turn, stretched.
            let [c11, c12, c22] = wrench.combined(&self.row(e1), &self.row(e2));
            let stretch = self.adjugate.m21;
            let both = -(c12 * stretch * stretch);
            return Matrix2::new(c22 * stretch * stretch, both, both, c11 * stretch * stretch);
        };
        let (s, inverse) = (&self.adjugate, self.inverse * self.inverse);
        let (a11, a12) = (s.m11 * c11 + s.m12 * c12, s.m11 * c12 + s.m12 * c22);
        let (a21, a22) = (s.m21 * c11 + s.m22 * c12, s.m21 * c12 + s.m22 * c22);
        let mixed = a11 * s.m21 + a12 * s.m22;
        Matrix2::new(a11 * s.m11 + a12 * s.m12, mixed, mixed, a21 * s.m21 + a22 * s.m22) * inverse
    }

    /// From the two equations in the plane to the position in it.
    #[inline]
    pub(super) fn solve(&self) -> Matrix2<T> {
        self.adjugate * self.inverse
    }

    /// The rows of the two positions, on a surface that does not sink.
    #[inline]
    pub(super) fn rigid_position_rows(&self) -> [Vector6<T>; 2] {
        let ([first, second], s) = (self.across.map(|e| self.row(&e)), self.solve());
        [first * s.m11 + second * s.m12, first * s.m21 + second * s.m22]
    }

    /// The rows of the two positions.
    #[inline]
    pub(super) fn position_rows(&self) -> [Vector6<T>; 2] {
        let [first, second] = self.rigid_position_rows();
        match &self.sinking {
            None => [first, second],
            Some(sinking) => {
                let deeper = sinking.deeper(&self.rigid_local());
                [first - deeper * sinking.answer[0], second - deeper * sinking.answer[1]]
            }
        }
    }
}

/// The inverse of `τ EᵀWE + (f·n) J₂`, both loads given times `scale`, as adjugate and reciprocal of the
/// determinant.
struct Solution<T: Real> {
    adjugate: Matrix2<T>,
    inverse: T,
    /// `false` where the determinant is zero, or out of the range in which squares of it have all digits.
    in_range: bool,
}

impl<T: Real> Solution<T> {
    #[inline(always)]
    fn new(bend: Matrix2<T>, spin: T, pressing: T, scale: T) -> Self {
        let (pressing, spin) = (pressing * scale, spin * scale);
        let (w11, w12, w22) = (spin * bend.m11, spin * bend.m12, spin * bend.m22);
        let determinant = w11 * w22 - w12 * w12 + pressing * pressing;
        let squared = determinant * determinant;
        Self {
            adjugate: Matrix2::new(w22, -(w12 + pressing), pressing - w12, w11),
            inverse: scale / determinant,
            in_range: (squared >= ForceLine::least_squared()) & (squared <= T::GREATEST),
        }
    }
}

/// The same for tiny and huge loads.
#[cold]
#[inline(never)]
fn scaled_solution<T: Real>(bend: Matrix2<T>, spin: T, pressing: T) -> Option<(Matrix2<T>, T)> {
    let largest_bend = larger(larger(bend.m11.abs(), bend.m12.abs()), bend.m22.abs());
    let scale = larger(pressing.abs(), spin.abs() * largest_bend).normalising_factor();
    let Solution { adjugate, inverse, in_range } = Solution::new(bend, spin, pressing, scale);
    // The square of this reciprocal need not be in range: that of one is.
    in_range.then(|| (adjugate * inverse, T::one()))
}

/// The shape operator in the tangent plane, made symmetric.
#[inline]
fn bend_of<T: Real>(shape_operator: &Matrix3<T>, e1: &Vector3<T>, e2: &Vector3<T>) -> Matrix2<T> {
    let (w1, w2) = (shape_operator * e1, shape_operator * e2);
    let mixed = (e1.dot(&w2) + e2.dot(&w1)) * T::literal(0.5);
    Matrix2::new(e1.dot(&w1), mixed, mixed, e2.dot(&w2))
}
