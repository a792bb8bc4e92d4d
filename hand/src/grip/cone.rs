//! The second-order cone of one contact: `|(y₁, y₂, y₃)| ≤ y₀`.
//!
//! Scaling after Nesterov & Todd 1997, in the form of Andersen, Roos & Terlaky 2003.

use fingertip_wrench::Real;
use nalgebra::{Matrix6x4, Vector4};

use crate::grip::kernels::scale_columns;

/// Length of the part that the cone bounds, without over- or underflow for entries near 1.
#[inline]
pub(crate) fn tail<T: Real>(y: &Vector4<T>) -> T {
    (y.y * y.y + y.z * y.z + y.w * y.w).root()
}

/// `y₀² − |y₁₂₃|²`, as a product so that it does not cancel at the boundary.
#[inline]
fn det<T: Real>(y: &Vector4<T>) -> T {
    let tail = tail(y);
    (y.x - tail) * (y.x + tail)
}

/// `u ∘ v = (u·v, u₀v₁ + v₀u₁)`.
#[inline]
pub(crate) fn product<T: Real>(u: &Vector4<T>, v: &Vector4<T>) -> Vector4<T> {
    Vector4::new(u.dot(v), u.x * v.y + v.x * u.y, u.x * v.z + v.x * u.z, u.x * v.w + v.x * u.w)
}

/// The `x` with `u ∘ x = d`, for `u` inside the cone and its determinant.
#[inline]
pub(crate) fn divide<T: Real>(u: &Vector4<T>, det: T, d: &Vector4<T>) -> Vector4<T> {
    let inner = u.y * d.y + u.z * d.z + u.w * d.w;
    let first = (u.x * d.x - inner) / det;
    let inverse = T::one() / u.x;
    Vector4::new(
        first,
        (d.y - u.y * first) * inverse,
        (d.z - u.z * first) * inverse,
        (d.w - u.w * first) * inverse,
    )
}

/// The greatest step from `y`, inside the cone with that determinant, along `d` that stays in it; at most `most`.
#[inline]
pub(crate) fn step_to_boundary<T: Real>(y: &Vector4<T>, det: T, d: &Vector4<T>, most: T) -> T {
    // det(y + αd) = a α² + 2b α + c, and the first component must stay positive.
    let b = y.x * d.x - (y.y * d.y + y.z * d.z + y.w * d.w);
    let a = d.x * d.x - (d.y * d.y + d.z * d.z + d.w * d.w);
    // Where the end is inside, all before it is: most often it is, and no root is needed.
    if y.x + d.x * most >= T::zero() && det + most * (b + b + a * most) >= T::zero() {
        return most;
    }
    let discriminant = b * b - a * det;
    let mut step = most;
    if y.x + d.x * step < T::zero() {
        step = -y.x / d.x;
    }
    if discriminant >= T::zero() && (b < T::zero() || a < T::zero()) {
        // The smallest positive root, without cancellation.
        let root = discriminant.root();
        let found = if b < T::zero() { det / (root - b) } else { -(b + root) / a };
        if found >= T::zero() && found < step {
            step = found;
        }
    }
    step
}

/// The Nesterov-Todd scaling `W` of a pair inside the cone: `W z = W⁻¹ y`, symmetric.
///
/// `W v = s (w₀v₀ + w₁·v₁, v₁ + (v₀ + w₁·v₁/(1 + w₀)) w₁)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaling<T: Real> {
    /// `w`, with `w₀² − |w₁|² = 1`.
    w: Vector4<T>,
    /// `1/(1 + w₀)`.
    share: T,
    size: T,
    /// The scaled point, `W z`, and its determinant.
    pub(crate) point: Vector4<T>,
    pub(crate) det: T,
}

impl<T: Real> Scaling<T> {
    /// Of nothing.
    pub(crate) fn none() -> Self {
        let (zero, none) = (T::zero(), Vector4::zeros());
        Self { w: none, share: zero, size: zero, point: none, det: zero }
    }

    #[inline(never)]
    pub(crate) fn new(y: &Vector4<T>, z: &Vector4<T>) -> Self {
        let (of_y, of_z) = (det(y).root(), det(z).root());
        let one = T::one();
        let (of_y_inverse, of_z_inverse) = (one / of_y, one / of_z);
        let (y, unit_z) = (y * of_y_inverse, z * of_z_inverse);
        let half = T::literal(0.5);
        let gamma = ((one + y.dot(&unit_z)) * half).root();
        let unit = half / gamma;
        let tail = Vector4::new(
            T::zero(),
            (y.y - unit_z.y) * unit,
            (y.z - unit_z.z) * unit,
            (y.w - unit_z.w) * unit,
        );
        // From the tail, so that w is on the hyperboloid to rounding.
        let w = tail + Vector4::new((one + tail.norm_squared()).root(), T::zero(), T::zero(), T::zero());
        let size = (of_y * of_z_inverse).root();
        let (share, det) = (one / (one + w.x), of_y * of_z);
        let mut scaling = Self { w, share, size, point: Vector4::zeros(), det };
        scaling.point = scaling.apply(z);
        scaling
    }

    /// `W v`.
    #[inline]
    pub(crate) fn apply(&self, v: &Vector4<T>) -> Vector4<T> {
        let w = &self.w;
        let inner = w.y * v.y + w.z * v.z + w.w * v.w;
        let along = v.x + inner * self.share;
        let size = self.size;
        Vector4::new(
            (w.x * v.x + inner) * size,
            (v.y + along * w.y) * size,
            (v.z + along * w.z) * size,
            (v.w + along * w.w) * size,
        )
    }

    /// The first row of `W`, `s w`.
    #[inline]
    pub(crate) fn first_row(&self) -> Vector4<T> {
        self.w * self.size
    }

    /// Writes `map·W`.
    #[inline]
    pub(crate) fn map(&self, map: &Matrix6x4<T>, scaled: &mut Matrix6x4<T>) {
        scale_columns(map, &self.w, self.share, self.size, scaled);
    }

    /// The greatest step from the scaled point along `d` that stays in the cone; at most `most`.
    #[inline(never)]
    pub(crate) fn step_to_boundary(&self, d: &Vector4<T>, most: T) -> T {
        step_to_boundary(&self.point, self.det, d, most)
    }
}

#[cfg(test)]
mod tests {
    use super::{Scaling, det, divide, product, step_to_boundary, tail};
    use nalgebra::{Matrix6x4, Vector4};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// A vector inside the cone, its distance from the border relative to its size down to the sixth power of ten.
    fn inside(rng: &mut Pcg64Mcg) -> Vector4<f64> {
        let direction = Vector4::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let margin = 10.0_f64.powf(rng.random_range(-6.0..0.0));
        let mut v = direction * 10.0_f64.powf(rng.random_range(-2.0..2.0));
        v.x = tail(&v) * (1.0 + margin);
        v
    }

    /// The law of the scaling by which it is made, `W z = W⁻¹ y`, in all the forms in which it is asked.
    #[test]
    fn scalings_take_each_to_the_other() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        for _ in 0..500 {
            let (y, z) = (inside(&mut rng), inside(&mut rng));
            let scaling = Scaling::new(&y, &z);
            let near = |a: &Vector4<f64>, b: &Vector4<f64>, size: f64| (a - b).norm() < 1e-6 * size;
            // W W z = y, and W z is the point, of that determinant.
            let size = scaling.size * scaling.w.norm();
            assert!(near(&scaling.apply(&scaling.point), &y, size * scaling.point.norm()));
            assert!(near(&scaling.point, &scaling.apply(&z), scaling.point.norm()));
            assert!((det(&scaling.point) / scaling.det - 1.0).abs() < 1e-6);
            let mut matrix = nalgebra::Matrix4::zeros();
            for j in 0..4 {
                matrix.set_column(j, &scaling.apply(&Vector4::ith(j, 1.0)));
            }
            assert!((matrix - matrix.transpose()).amax() < 1e-12 * matrix.amax());
            assert!((matrix.row(0) - scaling.first_row().transpose()).amax() < 1e-12 * matrix.amax());
            let map = Matrix6x4::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let mut scaled = Matrix6x4::zeros();
            scaling.map(&map, &mut scaled);
            assert!((scaled - map * matrix).amax() < 1e-12 * matrix.amax());
            assert!(
                (scaling.w.x * scaling.w.x - tail(&scaling.w).powi(2) - 1.0).abs()
                    < 1e-12 * scaling.w.norm_squared()
            );
        }
    }

    #[test]
    fn division_undoes_the_product() {
        let mut rng = Pcg64Mcg::seed_from_u64(2);
        for _ in 0..500 {
            let (u, x) = (inside(&mut rng), Vector4::from_fn(|_, _| rng.random_range(-1.0..1.0)));
            // The product with a vector as a matrix, whose determinant is u₀²·det u.
            let off = divide(&u, det(&u), &product(&u, &x)) - x;
            assert!(off.norm() < 1e-13 * u.norm_squared() / det(&u), "{off}");
            assert_eq!(product(&u, &x), product(&x, &u));
        }
        assert_eq!(
            product(&Vector4::new(2.0, 3.0, 5.0, 7.0), &Vector4::new(1.0, 2.0, 1.0, 3.0)),
            Vector4::new(34.0, 7.0, 7.0, 13.0)
        );
    }

    /// By bisection: the last place inside. And where both ends of the ray are inside, and the whole of it.
    #[test]
    fn steps_end_at_the_border() {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let (mut bounded, mut free) = (0, 0);
        for _ in 0..2_000 {
            let y = inside(&mut rng);
            let d = Vector4::from_fn(|_, _| rng.random_range(-1.0..1.0))
                * 10.0_f64.powf(rng.random_range(-2.0..2.0));
            let holds = |step: f64| {
                let at = y + d * step;
                at.x >= tail(&at)
            };
            let step = step_to_boundary(&y, det(&y), &d, 2.0);
            if holds(2.0) {
                free += 1;
                assert!(step > 2.0 * (1.0 - 1e-9));
                continue;
            }
            bounded += 1;
            let (mut low, mut high) = (0.0, 2.0);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if holds(middle) { low = middle } else { high = middle }
            }
            assert!((step - low).abs() < 1e-9 * low.max(1e-6), "{step} {low}");
        }
        assert!(bounded > 500 && free > 200, "{bounded} {free}");
    }

    /// Along itself a vector leaves the cone at its apex, where the equation of the step has both its roots.
    #[test]
    fn steps_to_the_apex_end_there() {
        let mut rng = Pcg64Mcg::seed_from_u64(4);
        for _ in 0..500 {
            let y = inside(&mut rng);
            let end = rng.random_range(0.1..1.9);
            let step = step_to_boundary(&y, det(&y), &(y / -end), 2.0);
            // Rounding of a double root may shorten it, by a share of the distance from the border.
            assert!(step < end * (1.0 + 1e-9) && step > 0.95 * end, "{step} {end}");
        }
    }

    /// Along the border and almost along it, where the equation of the step is almost linear.
    #[test]
    fn steps_along_the_border_lose_no_digits() {
        let y = Vector4::new(1.0, 0.0, 0.0, 0.0);
        for slack in [0.0_f64, 1e-300, 1e-17, 1e-12, 1e-9, -1e-9, -1e-12] {
            // 1 − α = α(1 − slack).
            let d = Vector4::new(-1.0, 0.0, 1.0 - slack, 0.0);
            let step = step_to_boundary(&y, det(&y), &d, 2.0);
            assert!((step - 1.0 / (2.0 - slack)).abs() < 1e-15, "{slack}: {step}");
        }
        assert_eq!(step_to_boundary(&y, 1.0, &Vector4::new(1.0, 1.0, 0.0, 0.0), 2.0), 2.0);
        assert_eq!(step_to_boundary(&y, 1.0, &Vector4::new(0.0, 0.0, 0.0, 1.0), 2.0), 1.0);
        assert_eq!(step_to_boundary(&y, 1.0, &Vector4::new(-4.0, 0.0, 0.0, 0.0), 2.0), 0.25);
        assert_eq!(step_to_boundary(&y, 1.0, &Vector4::zeros(), 2.0), 2.0);
    }
}
