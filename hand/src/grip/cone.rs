//! The second-order cone of one contact: `|(y₁, y₂, y₃)| ≤ y₀`.
//!
//! Scaling after Nesterov & Todd 1997, in the form of Andersen, Roos & Terlaky 2003.

use fingertip_wrench::Real;
use nalgebra::{Matrix4, Vector4};

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

/// The `x` with `u ∘ x = d`, for `u` inside the cone.
#[inline]
pub(crate) fn divide<T: Real>(u: &Vector4<T>, d: &Vector4<T>) -> Vector4<T> {
    let inner = u.y * d.y + u.z * d.z + u.w * d.w;
    let first = (u.x * d.x - inner) / det(u);
    let inverse = T::one() / u.x;
    Vector4::new(
        first,
        (d.y - u.y * first) * inverse,
        (d.z - u.z * first) * inverse,
        (d.w - u.w * first) * inverse,
    )
}

/// The greatest step from `y`, inside the cone, along `d` that stays in it; at most `most`.
#[inline]
pub(crate) fn step_to_boundary<T: Real>(y: &Vector4<T>, d: &Vector4<T>, most: T) -> T {
    // det(y + αd) = a α² + 2b α + c, and the first component must stay positive.
    let b = y.x * d.x - (y.y * d.y + y.z * d.z + y.w * d.w);
    let a = d.x * d.x - (d.y * d.y + d.z * d.z + d.w * d.w);
    let c = det(y).max(T::zero());
    let discriminant = b * b - a * c;
    let mut step = most;
    if d.x < T::zero() {
        step = step.min(-y.x / d.x);
    }
    if discriminant >= T::zero() && (b < T::zero() || a < T::zero()) {
        // The smallest positive root, without cancellation.
        let root = discriminant.root();
        let found = if b < T::zero() { c / (root - b) } else { -(b + root) / a };
        if found >= T::zero() {
            step = step.min(found);
        }
    }
    step
}

/// The Nesterov-Todd scaling `W` of a pair inside the cone: `W z = W⁻¹ y`, symmetric.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaling<T: Real> {
    /// `w`, with `w₀² − |w₁|² = 1`.
    w: Vector4<T>,
    size: T,
    /// `W z`.
    pub(crate) point: Vector4<T>,
}

impl<T: Real> Scaling<T> {
    #[inline]
    pub(crate) fn new(y: &Vector4<T>, z: &Vector4<T>) -> Self {
        let (of_y, of_z) = (det(y).root(), det(z).root());
        let (y, z) = (y / of_y, z / of_z);
        let half = T::literal(0.5);
        let gamma = ((T::one() + y.dot(&z)) * half).root();
        let unit = half / gamma;
        let tail = Vector4::new(T::zero(), (y.y - z.y) * unit, (y.z - z.z) * unit, (y.w - z.w) * unit);
        // From the tail, so that w is on the hyperboloid to rounding.
        let w = tail + Vector4::new((T::one() + tail.norm_squared()).root(), T::zero(), T::zero(), T::zero());
        let mut scaling = Self { w, size: (of_y / of_z).root(), point: Vector4::zeros() };
        scaling.point = scaling.apply(&(z * of_z));
        scaling
    }

    /// `W v`.
    #[inline]
    pub(crate) fn apply(&self, v: &Vector4<T>) -> Vector4<T> {
        Self::hyperbolic(&self.w, v) * self.size
    }

    /// `W⁻¹ v`.
    #[inline]
    pub(crate) fn undo(&self, v: &Vector4<T>) -> Vector4<T> {
        let mirrored = Vector4::new(self.w.x, -self.w.y, -self.w.z, -self.w.w);
        Self::hyperbolic(&mirrored, v) / self.size
    }

    /// `W` as a matrix.
    #[inline]
    pub(crate) fn matrix(&self) -> Matrix4<T> {
        let w = self.w * self.size;
        let share = T::one() / (T::one() + self.w.x);
        let s = self.size;
        let e = |a: T, b: T| a * b * share;
        let (a, b, c) = (self.w.y, self.w.z, self.w.w);
        Matrix4::new(
            w.x,
            w.y,
            w.z,
            w.w,
            w.y,
            s + e(a, w.y),
            e(a, w.z),
            e(a, w.w),
            w.z,
            e(b, w.y),
            s + e(b, w.z),
            e(b, w.w),
            w.w,
            e(c, w.y),
            e(c, w.z),
            s + e(c, w.w),
        )
    }

    #[inline]
    fn hyperbolic(w: &Vector4<T>, v: &Vector4<T>) -> Vector4<T> {
        let inner = w.y * v.y + w.z * v.z + w.w * v.w;
        let along = v.x + inner / (T::one() + w.x);
        Vector4::new(w.x * v.x + inner, v.y + along * w.y, v.z + along * w.z, v.w + along * w.w)
    }
}

#[cfg(test)]
mod tests {
    use super::{Scaling, det, divide, product, step_to_boundary, tail};
    use nalgebra::Vector4;
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
            assert!(near(&scaling.apply(&z), &scaling.undo(&y), scaling.point.norm()));
            assert!(near(&scaling.point, &scaling.apply(&z), scaling.point.norm()));
            assert!(near(&scaling.undo(&scaling.apply(&y)), &y, y.norm() * scaling.w.norm_squared()));
            let matrix = scaling.matrix();
            assert!(near(&(matrix * y), &scaling.apply(&y), matrix.norm() * y.norm()));
            assert!((matrix - matrix.transpose()).amax() < 1e-12 * matrix.amax());
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
            let off = divide(&u, &product(&u, &x)) - x;
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
            let step = step_to_boundary(&y, &d, 2.0);
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

    /// Along the border and almost along it, where the equation of the step is almost linear.
    #[test]
    fn steps_along_the_border_lose_no_digits() {
        let y = Vector4::new(1.0, 0.0, 0.0, 0.0);
        for slack in [0.0_f64, 1e-300, 1e-17, 1e-12, 1e-9, -1e-9, -1e-12] {
            // 1 − α = α(1 − slack).
            let d = Vector4::new(-1.0, 0.0, 1.0 - slack, 0.0);
            let step = step_to_boundary(&y, &d, 2.0);
            assert!((step - 1.0 / (2.0 - slack)).abs() < 1e-15, "{slack}: {step}");
        }
        assert_eq!(step_to_boundary(&y, &Vector4::new(1.0, 1.0, 0.0, 0.0), 2.0), 2.0);
        assert_eq!(step_to_boundary(&y, &Vector4::new(0.0, 0.0, 0.0, 1.0), 2.0), 1.0);
        assert_eq!(step_to_boundary(&y, &Vector4::new(-4.0, 0.0, 0.0, 0.0), 2.0), 0.25);
        assert_eq!(step_to_boundary(&y, &Vector4::zeros(), 2.0), 2.0);
    }
}
