//! What a finger can give.

use fingertip_wrench::{ContactForce, Frame, Real};
use nalgebra::{SMatrix, Vector4, Vector6};

use crate::grip::Row;
use crate::{BadLimit, GraspContact};

/// The limits of a finger, and what its normal force costs: at most `ROWS` half-spaces. A limit of the normal force
/// takes one, a joint two.
///
/// ```
/// use fingertip_hand::FingerLimits;
///
/// // Between 0.2 N, so that it does not lose the object, and 15 N.
/// let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2)?.with_greatest_normal(15.0)?;
/// // It is twice as dear as the others.
/// let limits = limits.with_cost(2.0)?;
/// assert_eq!(limits.greatest_normal(), Some(15.0));
/// # Ok::<(), fingertip_hand::BadLimit>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerLimits<T: Real, const ROWS: usize> {
    least: Option<T>,
    greatest: Option<T>,
    cost: T,
    /// Of joints: what a wrench on the fingertip is as torque, and the greatest torque.
    joints: [Option<(Vector6<T>, T)>; ROWS],
}

impl<T: Real, const ROWS: usize> FingerLimits<T, ROWS> {
    /// A finger that can give any force.
    #[must_use]
    pub fn none() -> Self {
        Self { least: None, greatest: None, cost: T::one(), joints: [None; ROWS] }
    }

    /// With a greatest normal force \[N\].
    ///
    /// # Errors
    /// [`BadLimit`] unless it is positive, finite and not below the least one, or if there is no room.
    pub fn with_greatest_normal(self, newtons: T) -> Result<Self, BadLimit> {
        let limits = Self { greatest: Some(positive(newtons, "greatest normal force")?), ..self };
        limits.checked()
    }

    /// With a least normal force \[N\] for as long as it touches.
    ///
    /// # Errors
    /// [`BadLimit`] unless it is positive, finite and not above the greatest one, or if there is no room.
    pub fn with_least_normal(self, newtons: T) -> Result<Self, BadLimit> {
        let limits = Self { least: Some(positive(newtons, "least normal force")?), ..self };
        limits.checked()
    }

    /// With limits of the torques at the joints of the finger \[N·m\], or of the forces of its linear drives \[N\]:
    /// `jacobian` has a column for each joint, as [`with_joint`](Self::with_joint) takes them. Limits of joints that were
    /// given before are replaced.
    ///
    /// # Errors
    /// [`BadLimit`] unless the Jacobian is finite and the torques positive and finite, or if there is no room.
    pub fn with_joint_torques<const JOINTS: usize>(
        self,
        jacobian: &SMatrix<T, 6, JOINTS>,
        greatest: &[T; JOINTS],
    ) -> Result<Self, BadLimit> {
        let free = Self { joints: [None; ROWS], ..self };
        let mut each = jacobian.column_iter().zip(greatest);
        each.try_fold(free, |limits, (column, greatest)| limits.with_joint(&column.into_owned(), *greatest))
    }

    /// With one joint more, that gives at most so much torque \[N·m\] either way, or force \[N\] of a linear drive. The
    /// column of the hand's Jacobian is the motion of the fingertip as a rigid body for a unit rate of the joint: the velocity
    /// of the point at the origin of the grasp's frame, then the angular velocity. The torque is
    /// `column · wrench on the fingertip`.
    ///
    /// ```
    /// use fingertip_hand::FingerLimits;
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// // A hinge along y, 8 cm below the origin of the hand, of 0.2 N·m.
    /// let (axis, at) = (Vector3::y(), Vector3::new(0.0, 0.0, -0.08));
    /// let velocity = -axis.cross(&at);
    /// let column = Vector6::from_iterator(velocity.iter().chain(&axis).copied());
    /// let limits = FingerLimits::<f64, 2>::none().with_joint(&column, 0.2)?;
    /// // There is room for one: the second says what it lacks.
    /// assert!(limits.with_joint(&column, 0.2).is_err());
    /// # Ok::<(), fingertip_hand::BadLimit>(())
    /// ```
    ///
    /// # Errors
    /// [`BadLimit`] unless the column is finite and the torque positive and finite, or if there is no room.
    pub fn with_joint(mut self, column: &Vector6<T>, greatest: T) -> Result<Self, BadLimit> {
        if !column.iter().all(|x| x.is_number()) {
            return Err(BadLimit::BadNumber { parameter: "Jacobian of the joints", requirement: "finite" });
        }
        let greatest = positive(greatest, "greatest torque of a joint")?;
        let used = self.joints.iter().flatten().count();
        match self.joints.get_mut(used) {
            Some(place) => *place = Some((*column, greatest)),
            None => return Err(BadLimit::NoRoom { room: ROWS, needed: self.simple() + 2 * (used + 1) }),
        }
        self.checked()
    }

    /// With a cost for each newton of its normal force; 1 if none is given. Only ratios between fingers matter.
    ///
    /// # Errors
    /// [`BadLimit`] unless it is positive and finite.
    pub fn with_cost(self, cost: T) -> Result<Self, BadLimit> {
        Ok(Self { cost: positive(cost, "cost of a finger")?, ..self })
    }

    /// The greatest normal force \[N\].
    #[must_use]
    pub const fn greatest_normal(&self) -> Option<T> {
        self.greatest
    }

    /// The least normal force \[N\].
    #[must_use]
    pub const fn least_normal(&self) -> Option<T> {
        self.least
    }

    /// The cost of a newton.
    #[must_use]
    pub const fn cost(&self) -> T {
        self.cost
    }

    /// Half-spaces of the normal force.
    fn simple(&self) -> usize {
        usize::from(self.least.is_some()) + usize::from(self.greatest.is_some())
    }

    fn checked(self) -> Result<Self, BadLimit> {
        if let (Some(least), Some(greatest)) = (self.least, self.greatest)
            && greatest < least
        {
            return Err(BadLimit::BadNumber {
                parameter: "greatest normal force",
                requirement: "at least the least normal force",
            });
        }
        let needed = self.simple() + 2 * self.joints.iter().flatten().count();
        if needed > ROWS { Err(BadLimit::NoRoom { room: ROWS, needed }) } else { Ok(self) }
    }

    /// How many times `more` a finger that gives `force` can give beside it: zero if there is no room, the
    /// greatest number if there is no end.
    pub(crate) fn room<F: Frame>(
        &self,
        contact: &GraspContact<T, F>,
        force: &ContactForce<T>,
        more: &ContactForce<T>,
    ) -> T {
        let mut room = T::GREATEST;
        let mut bound = |value: T, more: T, greatest: T| {
            if more > T::zero() {
                room = room.min(((greatest - value) / more).max(T::zero()));
            }
        };
        if let Some(greatest) = self.greatest {
            bound(force.normal, more.normal, greatest);
        }
        if let Some(least) = self.least {
            bound(-force.normal, -more.normal, -least);
        }
        for (column, greatest) in self.joints.iter().flatten() {
            let torque = |force| contact.wrench(force).components().dot(column);
            let (value, more) = (torque(force), torque(more));
            bound(value, more, *greatest);
            bound(-value, -more, *greatest);
        }
        room
    }

    /// The half-spaces of `[f_n, f_t1/μ, f_t2/μ, τ/(μe)]`, forces in units of `1/per_newton`.
    pub(crate) fn rows<F: Frame>(
        &self,
        contact: &GraspContact<T, F>,
        per_newton: T,
    ) -> [Option<Row<T>>; ROWS] {
        let mut rows = [None; ROWS];
        let along = |first: T| Vector4::new(first, T::zero(), T::zero(), T::zero());
        let both = self.greatest.is_some() && self.least.is_some();
        // A limit far above the load is brought near 1, and both rows alike, so that one is the other's opposite.
        let much = self.greatest.map_or(T::zero(), |greatest| greatest * per_newton);
        let size =
            if much > T::literal(1024.0) && much.is_number() { much.normalising_factor() } else { T::one() };
        let simple = [(self.greatest, size, false), (self.least, -size, both)];
        let simple = simple.into_iter().filter_map(|(bound, sign, opposite)| {
            bound.map(|bound| Row { normal: along(sign), bound: bound * sign * per_newton, opposite })
        });
        let origin = nalgebra::Vector3::zeros();
        let joints = self.joints.iter().flatten().flat_map(|(column, greatest)| {
            // Torque of the force on the object; on the fingertip it has the other sign, and both are bounded.
            let normal = contact.columns(&origin, T::one()).tr_mul(column);
            let bound = *greatest * per_newton;
            // A row near 1, so that it is worth as much as another; and a slack near 1 of a joint that feels little or nothing.
            let size = normal.amax().max(bound);
            let size = size.normalising_factor();
            [(T::one(), false), (-T::one(), true)].map(|(sign, opposite)| Row {
                normal: normal * (sign * size),
                bound: bound * size,
                opposite,
            })
        });
        for (row, found) in rows.iter_mut().zip(simple.chain(joints)) {
            *row = Some(found);
        }
        rows
    }
}

fn positive<T: Real>(value: T, parameter: &'static str) -> Result<T, BadLimit> {
    if value > T::zero() && value.is_number() {
        Ok(value)
    } else {
        Err(BadLimit::BadNumber { parameter, requirement: "positive and finite" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Hand;
    use nalgebra::Vector3;

    #[test]
    fn room_ends_at_each_limit() {
        let contact = GraspContact::<f64, Hand>::soft(Vector3::zeros(), Vector3::x(), 0.5, 1e-3).unwrap();
        let press = |newtons| ContactForce::new(newtons, Vector3::zeros(), 0.0);
        let none = FingerLimits::<f64, 2>::none();
        let simple = none.with_least_normal(0.5).unwrap().with_greatest_normal(3.0).unwrap();
        for (force, more, expected) in
            [(1.0, 0.5, 4.0), (1.0, -0.25, 2.0), (1.0, 0.0, f64::MAX), (4.0, 0.5, 0.0), (0.2, -1.0, 0.0)]
        {
            let found = simple.room(&contact, &press(force), &press(more));
            assert!(found == expected, "{force} {more}: {found}");
            assert!(none.room(&contact, &press(force), &press(more)) == f64::MAX);
        }
        // A drive along the normal of 2 N, either way.
        for sign in [1.0, -1.0] {
            let limits = none.with_joint(&Vector6::new(sign, 0.0, 0.0, 0.0, 0.0, 0.0), 2.0).unwrap();
            for (more, expected) in [(0.5, 2.0), (-1.5, 2.0), (0.0, f64::MAX)] {
                let found = limits.room(&contact, &press(1.0), &press(more));
                assert!(found == expected, "{sign} {more}: {found}");
            }
        }
    }
}
