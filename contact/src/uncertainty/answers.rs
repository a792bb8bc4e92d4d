//! What the derivatives of a contact answer: by wrench, and by geometry.

use fingertip_wrench::Real;
use nalgebra::{Matrix3x6, Matrix6, Vector2, Vector3, Vector6};

use super::sinking::Sinking;
use super::{ContactJacobian, GeometrySensitivity};

impl<T: Real> ContactJacobian<T> {
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

    pub(super) fn rigid_local(&self) -> Matrix6<T> {
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
