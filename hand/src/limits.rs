//! What a finger can give.

use fingertip_wrench::{Frame, Real};
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
    /// `jacobian` has a column for each joint, the motion of the fingertip as a rigid body for a unit rate of the
    /// joint: the velocity of the point at the origin of the grasp's frame, then the angular velocity. A torque is
    /// then `column · wrench on the fingertip`. Limits of joints that were given before are replaced.
    ///
    /// # Errors
    /// [`BadLimit`] unless the Jacobian is finite and the torques positive and finite, or if there is no room.
    pub fn with_joint_torques<const JOINTS: usize>(
        mut self,
        jacobian: &SMatrix<T, 6, JOINTS>,
        greatest: &[T; JOINTS],
    ) -> Result<Self, BadLimit> {
        if !jacobian.iter().all(|x| x.is_number()) {
            return Err(BadLimit::BadNumber { parameter: "Jacobian of the joints", requirement: "finite" });
        }
        let used = usize::from(self.least.is_some()) + usize::from(self.greatest.is_some());
        let needed = used + 2 * JOINTS;
        if needed > ROWS {
            return Err(BadLimit::NoRoom { room: ROWS, needed });
        }
        self.joints = [None; ROWS];
        for ((joint, column), greatest) in self.joints.iter_mut().zip(jacobian.column_iter()).zip(greatest) {
            *joint = Some((column.into_owned(), positive(*greatest, "greatest torque of a joint")?));
        }
        Ok(self)
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

    fn checked(self) -> Result<Self, BadLimit> {
        if let (Some(least), Some(greatest)) = (self.least, self.greatest)
            && greatest < least
        {
            return Err(BadLimit::BadNumber {
                parameter: "greatest normal force",
                requirement: "at least the least normal force",
            });
        }
        let needed = usize::from(self.least.is_some())
            + usize::from(self.greatest.is_some())
            + 2 * self.joints.iter().flatten().count();
        if needed > ROWS { Err(BadLimit::NoRoom { room: ROWS, needed }) } else { Ok(self) }
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
        let simple = [(self.greatest, T::one(), false), (self.least, -T::one(), both)];
        let simple = simple.into_iter().filter_map(|(bound, sign, opposite)| {
            bound.map(|bound| Row { normal: along(sign), bound: bound * sign * per_newton, opposite })
        });
        let origin = nalgebra::Vector3::zeros();
        let joints = self.joints.iter().flatten().flat_map(|(column, greatest)| {
            // Torque of the force on the object; on the fingertip it has the other sign, and both are bounded.
            let normal = contact.columns(&origin, T::one()).tr_mul(column);
            let bound = *greatest * per_newton;
            // A row near 1, so that it is worth as much as another.
            let size = normal.amax().max(bound * T::EPSILON);
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
