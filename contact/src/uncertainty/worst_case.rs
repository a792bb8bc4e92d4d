//! Worst cases of the linearised contact over a box of errors.

use fingertip_wrench::Real;
use nalgebra::{Vector3, Vector6};

use super::ContactJacobian;
use fingertip_surfaces::numeric::vectors::larger;

/// How far errors within a box push a contact, to first order.
///
/// ```
/// use fingertip_contact::{ContactJacobian, ContactModel, SoftFinger, WorstCase};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Vector3, Vector6};
///
/// // 1 N at the top of a sphere of 10 mm; each force is wrong by at most 10 mN, each torque by 0.1 N·mm.
/// let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// let worst: WorstCase<f64> = jacobian.worst_case(&Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4));
/// // (0.1 N·mm + 10 mm · 10 mN)/1 N along x, and along y.
/// assert!((worst.components.x - 0.2e-3).abs() < 1e-9 && (worst.distance - 0.2e-3 * 2.0_f64.sqrt()).abs() < 1e-9);
/// assert!((worst.normal_force - 0.01).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstCase<T: Real> {
    /// Greatest change of each coordinate of the contact in the sensor frame \[m\]: attained by
    /// some errors of the box, in general others for each coordinate.
    pub components: Vector3<T>,
    /// Greatest distance that the contact moves \[m\]: attained by some corner of the box.
    pub distance: T,
    /// Greatest change of the normal force \[N\].
    pub normal_force: T,
    /// Greatest change of the spin torque \[N·m\].
    pub spin_torque: T,
}

impl<T: Real> ContactJacobian<T> {
    /// Over all errors of the wrench with `|dw_j| ≤ |box_j|` \[N, N·m\]; NaN if one of these is. The
    /// distance is the maximum of a convex function over a box, so one of its 64 corners attains it;
    /// corners that are opposite count once.
    #[must_use]
    pub fn worst_case(&self, errors: &Vector6<T>) -> WorstCase<T> {
        let absolute = |row: Vector6<T>| row.abs().dot(&errors.abs());
        let point = self.point();
        let local = self.local();
        let row = |i: usize| local.row(i).transpose();
        let (a1, a2) = (row(0).component_mul(errors), row(1).component_mul(errors));
        // Only a skin moves the contact along the normal.
        let a3 = self.height().component_mul(errors);
        let mut greatest = T::zero();
        for corner in 0..32_u8 {
            let (mut x, mut y, mut z) = (a1[5], a2[5], a3[5]);
            for axis in 0..5 {
                if corner >> axis & 1 == 1 {
                    x += a1[axis];
                    y += a2[axis];
                    z += a3[axis];
                } else {
                    x -= a1[axis];
                    y -= a2[axis];
                    z -= a3[axis];
                }
            }
            // Of a NaN and a number, the NaN: it is in every corner.
            greatest = larger(greatest, x * x + y * y + z * z);
        }
        WorstCase {
            components: Vector3::new(
                absolute(point.row(0).transpose()),
                absolute(point.row(1).transpose()),
                absolute(point.row(2).transpose()),
            ),
            distance: greatest.root(),
            normal_force: absolute(row(2)),
            spin_torque: absolute(row(5)),
        }
    }
}
