//! First derivatives of a contact.

use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Matrix3, Matrix3x6, Matrix6, Vector2, Vector3, Vector6};

use super::skin::Sinking;
use super::{GeometrySensitivity, WrenchSpread};
use crate::numeric::vectors::{larger, tangents};
use crate::{Contact, Corner, ForceLine, SmoothSurface};

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
/// * **soft finger** (theory 3.4): `τ W dc + n dτ + dc × f = b` gives
///   `(τ EᵀWE + (f·n) J₂) Eᵀdc = Eᵀb`, `dτ = n·b − n·(dc × f)`. The determinant is
///   `τ²κ + (f·n)²`: a spin torque makes a convex surface *less* sensitive.
/// * **point contact** (theory 2.2), of whatever pitch `p`: `dc × f = b − p df − f dp` gives
///   `dc = n × (b − p df − f dp)/(f·n)`, which is `Π[f] dm/|f|² − Π[f]([c] + p) df/|f|²` with
///   `Π = I − f nᵀ/(f·n)`.
///
/// * **through a skin**, either of these on the parallel surface on which the contact lies, which sinks as
///   the normal force grows:
///   [`CompliantSoftFinger::jacobian`](crate::CompliantSoftFinger::jacobian),
///   [`CompliantPointContact::jacobian`](crate::CompliantPointContact::jacobian).
///
/// Every surface will do: `W` comes from [`SmoothSurface`](crate::SmoothSurface) or
/// from differences of its normal
/// ([`shape_operator_by_differences`](crate::shape_operator_by_differences)). The position of a
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactJacobian<T: Real> {
    pub(super) tangents: [Vector3<T>; 2],
    pub(super) normal: Vector3<T>,
    point: Vector3<T>,
    force: Vector3<T>,
    spin: T,
    /// What a point contact takes for its pitch; zero for a soft finger.
    pitch: T,
    is_soft: bool,
    /// Shape operator in the tangent plane.
    pub(super) bend: Matrix2<T>,
    /// The inverse of the matrix of the two equations in the plane, as its adjugate and the reciprocal
    /// of its determinant.
    adjugate: Matrix2<T>,
    inverse: T,
    /// The directions of torque that the two equations in the plane are about.
    across: [Vector3<T>; 2],
    /// What a skin adds.
    pub(super) sinking: Option<Sinking<T>>,
    /// On an edge or a tip, how the normal turns with the right-hand sides of the two equations.
    turn: Option<Matrix2<T>>,
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
        wrench: &impl WrenchSpread<T>,
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
        wrench: &impl WrenchSpread<T>,
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
        let (e1, e2) = tangents(&contact.normal);
        let bend = bend_of(shape_operator, &e1, &e2);
        let f = &contact.force;
        let inverse = T::one() / f.dot(&contact.normal);
        let adjugate = Matrix2::new(T::zero(), -inverse, inverse, T::zero());
        let scale = f.amax().normalising_factor();
        let scaled = f * scale;
        let squared = scaled.norm_squared();
        let pitch = scaled.dot(&(wrench.torque() * scale)) / squared;
        // dp = f·(dm − c × df − p df)/|f|² takes what is along the force.
        let across = [e1, e2].map(|e| e - scaled * (scaled.dot(&e) / squared));
        (across[0].sum() + across[1].sum() + inverse + bend.sum() + pitch).is_number().then_some(Self {
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
        })
    }

    /// The row of `e·(dm − c × df − p df)`.
    #[inline(always)]
    fn row(&self, e: &Vector3<T>) -> Vector6<T> {
        let arm = self.point.cross(e) - e * self.pitch;
        Vector6::new(arm.x, arm.y, arm.z, e.x, e.y, e.z)
    }

    /// The covariance of the position along the tangents.
    ///
    /// First that of the right-hand sides of the two equations in the plane, which waits for neither
    /// curvature nor load; then of their solution, by a congruence.
    #[inline(always)]
    pub(super) fn position_covariance(&self, wrench: &impl WrenchSpread<T>) -> Matrix2<T> {
        if self.sinking.is_some() {
            let [first, second] = self.position_rows();
            let [c11, c12, c22] = wrench.combined(&first, &second);
            return Matrix2::new(c11, c12, c12, c22);
        }
        let [e1, e2] = &self.across;
        let [c11, c12, c22] = if self.is_soft {
            let [xx, xy, xz, yy, yz, zz] = wrench.torque_about(&self.point);
            let with = |e: &Vector3<T>| {
                Vector3::new(
                    xx * e.x + xy * e.y + xz * e.z,
                    xy * e.x + yy * e.y + yz * e.z,
                    xz * e.x + yz * e.y + zz * e.z,
                )
            };
            let (with_first, with_second) = (with(e1), with(e2));
            [e1.dot(&with_first), e1.dot(&with_second), e2.dot(&with_second)]
        } else {
            wrench.combined(&self.row(e1), &self.row(e2))
        };
        let (s, inverse) = (&self.adjugate, self.inverse * self.inverse);
        let (a11, a12) = (s.m11 * c11 + s.m12 * c12, s.m11 * c12 + s.m12 * c22);
        let (a21, a22) = (s.m21 * c11 + s.m22 * c12, s.m21 * c12 + s.m22 * c22);
        let mixed = a11 * s.m21 + a12 * s.m22;
        Matrix2::new(a11 * s.m11 + a12 * s.m12, mixed, mixed, a21 * s.m21 + a22 * s.m22) * inverse
    }

    /// From the two equations in the plane to the position in it.
    #[inline]
    fn solve(&self) -> Matrix2<T> {
        self.adjugate * self.inverse
    }

    /// The rows of the two positions, on a surface that does not sink.
    #[inline]
    fn rigid_position_rows(&self) -> [Vector6<T>; 2] {
        let ([first, second], s) = (self.across.map(|e| self.row(&e)), self.solve());
        [first * s.m11 + second * s.m12, first * s.m21 + second * s.m22]
    }

    /// The rows of the two positions.
    #[inline]
    fn position_rows(&self) -> [Vector6<T>; 2] {
        let [first, second] = self.rigid_position_rows();
        match &self.sinking {
            None => [first, second],
            Some(sinking) => {
                let deeper = sinking.deeper(&self.rigid_local());
                [first - deeper * sinking.answer[0], second - deeper * sinking.answer[1]]
            }
        }
    }

    /// The two tangents that positions and tangential forces refer to: unit vectors, right-handed
    /// with the normal.
    #[inline]
    #[must_use]
    pub const fn tangents(&self) -> [Vector3<T>; 2] {
        self.tangents
    }

    /// Outward unit normal at the contact.
    #[inline]
    #[must_use]
    pub const fn normal(&self) -> Vector3<T> {
        self.normal
    }

    /// Derivatives of (two positions \[m\], normal force, two tangential forces \[N\], spin torque
    /// \[N·m\]), as rows, with respect to `Fx … Tz`, as columns.
    #[must_use]
    pub fn local(&self) -> Matrix6<T> {
        let rigid = self.rigid_local();
        self.sinking
            .as_ref()
            .map_or(rigid, |sinking| rigid - sinking.answer * sinking.deeper(&rigid).transpose())
    }

    fn rigid_local(&self) -> Matrix6<T> {
        let [a1, a2] = self.rigid_position_rows();
        let [e1, e2] = self.tangents;
        let n = self.normal;
        let [tilt1, tilt2] = self.tilts(&[a1, a2]);
        let from_force = |e: &Vector3<T>| Vector6::new(e.x, e.y, e.z, T::zero(), T::zero(), T::zero());
        let (f1, f2, pressing) = (self.force.dot(&e1), self.force.dot(&e2), -self.force.dot(&n));
        let twist = if self.is_soft {
            let across = self.force.cross(&n);
            self.row(&n) - a1 * e1.dot(&across) - a2 * e2.dot(&across)
        } else {
            Vector6::zeros()
        };
        Matrix6::from_columns(&[
            a1,
            a2,
            -from_force(&n) - tilt1 * f1 - tilt2 * f2,
            from_force(&e1) + tilt1 * pressing,
            from_force(&e2) + tilt2 * pressing,
            twist,
        ])
        .transpose()
    }

    /// `∂c/∂(f, m)` in the sensor frame; its columns lie in the tangent plane, but for a skin's.
    #[must_use]
    pub fn point(&self) -> Matrix3x6<T> {
        let [a1, a2] = self.position_rows();
        let along = self.tangents[0] * a1.transpose() + self.tangents[1] * a2.transpose();
        if self.sinking.is_none() { along } else { along + self.normal * self.height().transpose() }
    }

    /// How the contact's height along the normal answers to the wrench: zero, as it stays on the surface,
    /// except where a skin sinks under it.
    #[must_use]
    pub fn height(&self) -> Vector6<T> {
        self.sinking.as_ref().map_or_else(Vector6::zeros, |sinking| -sinking.deeper(&self.rigid_local()))
    }

    /// `∂n/∂(f, m)`: how the normal at the contact turns.
    #[must_use]
    pub fn normal_change(&self) -> Matrix3x6<T> {
        let [tilt1, tilt2] = self.tilts(&self.position_rows());
        self.tangents[0] * tilt1.transpose() + self.tangents[1] * tilt2.transpose()
    }

    /// The rows of the turn of the normal along the tangents, from those of the two positions.
    #[inline]
    fn tilts(&self, [a1, a2]: &[Vector6<T>; 2]) -> [Vector6<T>; 2] {
        match &self.turn {
            None => [a1 * self.bend.m11 + a2 * self.bend.m12, a1 * self.bend.m21 + a2 * self.bend.m22],
            Some(turn) => {
                let [first, second] = self.across.map(|e| self.row(&e));
                [first * turn.m11 + second * turn.m12, first * turn.m21 + second * turn.m22]
            }
        }
    }

    /// How the contact answers to a change of the surface, the wrench staying what it is: the same
    /// six numbers as the rows of [`local`](Self::local), per unit of the parameter. The point
    /// moves along the normal too, by [`GeometrySensitivity::displacement`] less what a skin sinks.
    ///
    /// Through a skin, of a change of the surface that it deformed to:
    /// [`of_deformed`](Self::of_deformed). On an edge or a tip a change is what its offset does; of what
    /// moves it as a whole, [`answer_to_motion`](Self::answer_to_motion).
    #[must_use]
    pub fn answer_to(&self, change: &GeometrySensitivity<T>) -> Vector6<T> {
        let rigid = self.rigid_answer_to(change);
        self.sinking.as_ref().map_or(rigid, |sinking| rigid - sinking.answer * sinking.feedback.dot(&rigid))
    }

    /// How far the contact rises along the normal as the surface changes.
    pub(super) fn rise_with(&self, change: &GeometrySensitivity<T>) -> T {
        let sinks = |sinking: &Sinking<T>| sinking.feedback.dot(&self.rigid_answer_to(change));
        change.displacement - self.sinking.as_ref().map_or_else(T::zero, sinks)
    }

    pub(super) fn rigid_answer_to(&self, change: &GeometrySensitivity<T>) -> Vector6<T> {
        let [e1, e2] = self.tangents;
        let n = self.normal;
        let (f, rise) = (&self.force, change.displacement);
        let pushed = n.cross(f) * rise + change.tilt * self.spin;
        let sides = Vector2::new(-e1.dot(&pushed), -e2.dot(&pushed));
        let in_plane = self.solve() * sides;
        let tilt = match &self.turn {
            None => self.bend * in_plane + Vector2::new(e1.dot(&change.tilt), e2.dot(&change.tilt)),
            Some(turn) => turn * sides,
        };
        let across = f.cross(&n);
        let pressing = -f.dot(&n);
        let twist = if self.is_soft {
            -(in_plane.x * e1.dot(&across) + in_plane.y * e2.dot(&across))
        } else {
            T::zero()
        };
        Vector6::new(
            in_plane.x,
            in_plane.y,
            -(f.dot(&e1) * tilt.x + f.dot(&e2) * tilt.y),
            tilt.x * pressing,
            tilt.y * pressing,
            twist,
        )
    }

    /// How the contact answers to a motion of the surface as a whole, `x → x + shift + turn × x` per unit,
    /// the wrench staying what it is: the six local numbers, and the height along the normal.
    ///
    /// Seen from the surface the wrench moves the other way, and the contact answers to that; then it is
    /// carried along. So it holds on every surface, through a skin, on edges and tips.
    #[must_use]
    pub fn answer_to_motion(&self, shift: &Vector3<T>, turn: &Vector3<T>) -> (Vector6<T>, T) {
        let [e1, e2] = &self.tangents;
        let (f, n) = (&self.force, &self.normal);
        let torque = self.point.cross(f) + n * self.spin + f * self.pitch;
        let (by_force, by_torque) = (f.cross(turn), torque.cross(turn) + f.cross(shift));
        let seen = Vector6::new(by_force.x, by_force.y, by_force.z, by_torque.x, by_torque.y, by_torque.z);
        let carried = shift + turn.cross(&self.point);
        // The tangents that the tangential force refers to do not turn about the normal.
        let about = turn.dot(n);
        let zero = T::zero();
        let along =
            Vector6::new(carried.dot(e1), carried.dot(e2), zero, -about * f.dot(e2), about * f.dot(e1), zero);
        (self.local() * seen + along, self.height().dot(&seen) + carried.dot(n))
    }

    /// `∂c/∂θ` in the sensor frame for a change of the surface.
    #[must_use]
    pub fn point_answer_to(&self, change: &GeometrySensitivity<T>) -> Vector3<T> {
        let local = self.answer_to(change);
        self.tangents[0] * local.x + self.tangents[1] * local.y + self.normal * self.rise_with(change)
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
