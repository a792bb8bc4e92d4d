//! Covariances of a wrench, as full as they need to be.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector3, Vector6};

/// How noise spreads a wrench about the origin of the sensor frame, as far as the covariance of a
/// contact's position asks. The less is said, the less it costs.
///
/// ```
/// use fingertip_contact::{ContactCovariance, ContactModel, PointContact, WrenchSpread};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// // A sensor of 10 mN and 0.1 N·mm on every axis, and the same as a covariance.
/// let alike = WrenchSpread::Isotropic { force: 1e-4, torque: 1e-8 };
/// let covariance = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let wrench = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.01), Vector3::new(0.2, 0.0, -1.0));
/// let contact = PointContact::new(0.05)?.resolve(&wrench, &Sphere::centred(0.01)?).into_result()?;
/// let position = |spread: WrenchSpread<'_, f64>| {
///     ContactCovariance::point_contact_position(&contact, &wrench, spread).ok_or("it grazes")
/// };
/// assert!((position(alike)? - position((&covariance).into())?).norm() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrenchSpread<'a, T: Real> {
    /// Any covariance `[Fx … Tz]` \[N², N·N·m, (N·m)²\], symmetric, as
    /// [`SensorUncertainty`](crate::SensorUncertainty) and a solver's covariance are.
    Full(&'a Matrix6<T>),
    /// The six components are noisy independently of one another: their variances \[N², (N·m)²\].
    Independent(Vector6<T>),
    /// All forces are equally noisy, and so are all torques, independently of one another.
    Isotropic {
        /// Variance of each component of the force \[N²\].
        force: T,
        /// Variance of each component of the torque \[(N·m)²\].
        torque: T,
    },
}

impl<'a, T: Real> From<&'a Matrix6<T>> for WrenchSpread<'a, T> {
    #[inline(always)]
    fn from(covariance: &'a Matrix6<T>) -> Self {
        Self::Full(covariance)
    }
}

impl<T: Real> WrenchSpread<'_, T> {
    /// The covariance `xx, xy, xz, yy, yz, zz` \[(N·m)²\] of the torque about another point,
    /// `m − c × f`: `Σ_mm − [c]Σ_fm − ([c]Σ_fm)ᵀ + [c]Σ_ff[c]ᵀ`.
    #[inline(always)]
    pub(super) fn torque_about(&self, c: &Vector3<T>) -> [T; 6] {
        match self {
            Self::Full(full) => full_torque_about(full, c),
            Self::Independent(v) => {
                let (x, y, z) = (c * v[0], c * v[1], c * v[2]);
                [
                    v[3] + (z.y * c.y + y.z * c.z),
                    -(z.x * c.y),
                    -(y.x * c.z),
                    v[4] + (z.x * c.x + x.z * c.z),
                    -(x.y * c.z),
                    v[5] + (y.x * c.x + x.y * c.y),
                ]
            }
            Self::Isotropic { force, torque } => {
                let arm = c * *force;
                let (x, y, z) = (arm.x * c.x, arm.y * c.y, arm.z * c.z);
                [
                    *torque + (y + z),
                    -(arm.x * c.y),
                    -(arm.x * c.z),
                    *torque + (x + z),
                    -(arm.y * c.z),
                    *torque + (x + y),
                ]
            }
        }
    }

    /// The same of what is left of the torque beside a wrench of the pitch `p` whose line runs through that point,
    /// `m − c × f − p f`: with `K = [c] + p` it is `Σ_mm − KΣ_fm − (KΣ_fm)ᵀ + KΣ_ffKᵀ`.
    #[inline(always)]
    pub(super) fn torque_beside(&self, c: &Vector3<T>, p: T) -> [T; 6] {
        let [xx, xy, xz, yy, yz, zz] = match self {
            Self::Full(full) => return full_torque_beside(full, c, p),
            _ => self.torque_about(c),
        };
        match self {
            Self::Independent(v) => {
                let square = p * p;
                [
                    xx + square * v[0],
                    xy + p * c.z * (v[0] - v[1]),
                    xz + p * c.y * (v[2] - v[0]),
                    yy + square * v[1],
                    yz + p * c.x * (v[1] - v[2]),
                    zz + square * v[2],
                ]
            }
            Self::Isotropic { force, .. } => {
                let more = p * p * *force;
                [xx + more, xy, xz, yy + more, yz, zz + more]
            }
            Self::Full(_) => [xx, xy, xz, yy, yz, zz],
        }
    }

    /// The covariances of two linear combinations of `Fx … Tz`: first with first, first with second,
    /// second with second.
    #[inline(always)]
    pub(super) fn combined(&self, first: &Vector6<T>, second: &Vector6<T>) -> [T; 3] {
        let (with_first, with_second) = match self {
            Self::Full(full) => {
                // Column by column, in sums that do not wait for one another.
                let [c0, c1, c2, c3, c4, c5] = full.data.0.map(Vector6::from);
                let times = |v: &Vector6<T>| {
                    ((c0 * v[0] + c1 * v[1]) + (c2 * v[2] + c3 * v[3])) + (c4 * v[4] + c5 * v[5])
                };
                (times(first), times(second))
            }
            Self::Independent(v) => (first.component_mul(v), second.component_mul(v)),
            Self::Isotropic { force: f, torque: t } => {
                let v = Vector6::new(*f, *f, *f, *t, *t, *t);
                (first.component_mul(&v), second.component_mul(&v))
            }
        };
        [first.dot(&with_first), first.dot(&with_second), second.dot(&with_second)]
    }
}

#[inline(always)]
fn full_torque_about<T: Real>(full: &Matrix6<T>, c: &Vector3<T>) -> [T; 6] {
    // Both halves of [c]Σ_ff[c]ᵀ go to the two mixed terms: Σ_mm − [c]H − ([c]H)ᵀ with
    // H = Σ_fm − Σ_ff[c]ᵀ/2, row i of which is that of Σ_fm, and half of c × that of Σ_ff less.
    let half = c * T::literal(0.5);
    let [x, y, z, mx, my, mz] = &full.data.0;
    let row = |v: &[T; 6]| {
        Vector3::new(
            v[3] + (half.z * v[1] - half.y * v[2]),
            v[4] + (half.x * v[2] - half.z * v[0]),
            v[5] + (half.y * v[0] - half.x * v[1]),
        )
    };
    let (x, y, z) = (row(x), row(y), row(z));
    let (xx, yy, zz) = (z.x * c.y - y.x * c.z, x.y * c.z - z.y * c.x, y.z * c.x - x.z * c.y);
    let xy = (z.y * c.y - y.y * c.z) + (x.x * c.z - z.x * c.x);
    let xz = (z.z * c.y - y.z * c.z) + (y.x * c.x - x.x * c.y);
    let yz = (x.z * c.z - z.z * c.x) + (y.y * c.x - x.y * c.y);
    [mx[3] - (xx + xx), my[3] - xy, mz[3] - xz, my[4] - (yy + yy), mz[4] - yz, mz[5] - (zz + zz)]
}

/// As [`full_torque_about`], in sums that each go on from a number which is needed no more: a machine that multiplies
/// and adds in one instruction so copies none.
#[inline(always)]
fn full_torque_beside<T: Real>(full: &Matrix6<T>, c: &Vector3<T>, p: T) -> [T; 6] {
    let half = T::literal(0.5);
    let (h, q) = (c * half, p * half);
    let [x, y, z, mx, my, mz] = &full.data.0;
    let row = |v: &[T; 6]| {
        Vector3::new(
            v[3] + h.z * v[1] - h.y * v[2] - q * v[0],
            v[4] + h.x * v[2] - h.z * v[0] - q * v[1],
            v[5] + h.y * v[0] - h.x * v[1] - q * v[2],
        )
    };
    let (x, y, z) = (row(x), row(y), row(z));
    let (d, r) = (c + c, p + p);
    [
        mx[3] - d.y * z.x + d.z * y.x - r * x.x,
        my[3] - c.y * z.y + c.z * y.y - c.z * x.x + c.x * z.x - p * (x.y + y.x),
        mz[3] - c.y * z.z + c.z * y.z - c.x * y.x + c.y * x.x - p * (x.z + z.x),
        my[4] - d.z * x.y + d.x * z.y - r * y.y,
        mz[4] - c.z * x.z + c.x * z.z - c.x * y.y + c.y * x.y - p * (y.z + z.y),
        mz[5] - d.x * y.z + d.y * x.z - r * z.z,
    ]
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix6, Vector3, Vector6};

    use super::WrenchSpread;

    fn agree(some: WrenchSpread<'_, f64>, full: &Matrix6<f64>) {
        let c = Vector3::new(0.3, -0.7, 1.1);
        // The torque about the point is `m − c × f`: three combinations.
        let row = |k: usize| {
            let e = Vector3::ith(k, 1.0);
            let arm = c.cross(&e);
            Vector6::new(arm.x, arm.y, arm.z, e.x, e.y, e.z)
        };
        let torque = some.torque_about(&c);
        for (k, (i, j)) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].into_iter().enumerate() {
            let exact = row(i).dot(&(full * row(j)));
            assert!((torque[k] - exact).abs() < 1e-13 * full.amax(), "{i} {j}: {} {exact}", torque[k]);
        }
        let beside = some.torque_beside(&c, 0.3);
        let row_beside = |k: usize| row(k) - Vector6::ith(k, 0.3);
        for (k, (i, j)) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].into_iter().enumerate() {
            let exact = row_beside(i).dot(&(full * row_beside(j)));
            assert!((beside[k] - exact).abs() < 1e-13 * full.amax(), "{i} {j}: {} {exact}", beside[k]);
        }
        let both = some.combined(&row(0), &row(1));
        for (found, exact) in both.iter().zip([torque[0], torque[1], torque[3]]) {
            assert!((found - exact).abs() < 1e-13 * full.amax());
        }
    }

    #[test]
    fn every_kind_agrees_with_the_full_matrix() {
        let root = Matrix6::from_fn(|i, j| ((7 * i + 3 * j) % 5) as f64 - 1.7 + 0.1 * i as f64);
        let full = root * root.transpose();
        agree((&full).into(), &full);
        let variances = Vector6::new(1.0, 2.0, 3.0, 0.4, 0.5, 0.6);
        agree(WrenchSpread::Independent(variances), &Matrix6::from_diagonal(&variances));
        let isotropic = Vector6::new(2.0, 2.0, 2.0, 0.7, 0.7, 0.7);
        agree(WrenchSpread::Isotropic { force: 2.0, torque: 0.7 }, &Matrix6::from_diagonal(&isotropic));
    }
}
