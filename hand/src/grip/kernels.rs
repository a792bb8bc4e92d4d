//! Products with the map of a contact, `6 × 4`. Each is a function of its own: put into larger ones, their sums would not
//! stay in registers, nor go side by side.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Matrix6x4, Vector4, Vector6};

/// `wrench + map·force`.
#[inline(never)]
pub(crate) fn add<T: Real>(map: &Matrix6x4<T>, force: &Vector4<T>, wrench: &mut Vector6<T>) {
    let ([sum], [force]) = (&mut wrench.data.0, &force.data.0);
    for (column, force) in map.data.0.iter().zip(force) {
        for (sum, entry) in sum.iter_mut().zip(column) {
            *sum += *entry * *force;
        }
    }
}

/// `wrench − map·force`.
#[inline(never)]
pub(crate) fn subtract<T: Real>(map: &Matrix6x4<T>, force: &Vector4<T>, wrench: &mut Vector6<T>) {
    let ([sum], [force]) = (&mut wrench.data.0, &force.data.0);
    for (column, force) in map.data.0.iter().zip(force) {
        for (sum, entry) in sum.iter_mut().zip(column) {
            *sum -= *entry * *force;
        }
    }
}

/// `force + mapᵀ·twist`.
#[inline(never)]
pub(crate) fn add_pull<T: Real>(map: &Matrix6x4<T>, twist: &Vector6<T>, force: &mut Vector4<T>) {
    let ([twist], [force]) = (&twist.data.0, &mut force.data.0);
    for (column, force) in map.data.0.iter().zip(force) {
        let mut sum = *force;
        for (entry, twist) in column.iter().zip(twist) {
            sum += *entry * *twist;
        }
        *force = sum;
    }
}

/// Adds `map·mapᵀ` to the lower half of a sum, and to what else lets its rows go in pairs.
#[inline(never)]
pub(crate) fn add_square<T: Real>(map: &Matrix6x4<T>, sum: &mut Matrix6<T>) {
    let sum = &mut sum.data.0;
    for column in &map.data.0 {
        for j in 0..6 {
            for i in (j & !1)..6 {
                sum[j][i] += column[i] * column[j];
            }
        }
    }
}

/// `map·(I − β u uᵀ)`.
#[inline(never)]
pub(crate) fn reflect_columns<T: Real>(map: &mut Matrix6x4<T>, u: &Vector4<T>, beta: T) {
    let [u] = &u.data.0;
    let mut along = [T::zero(); 6];
    for (column, u) in map.data.0.iter().zip(u) {
        for (sum, entry) in along.iter_mut().zip(column) {
            *sum += *entry * *u;
        }
    }
    for along in &mut along {
        *along *= beta;
    }
    for (column, u) in map.data.0.iter_mut().zip(u) {
        for (entry, along) in column.iter_mut().zip(&along) {
            *entry -= *along * *u;
        }
    }
}

/// `map·W` of a scaling `W = size·[w₀ w₁ᵀ; w₁ I + share·w₁w₁ᵀ]`: the first column is `A w`, the others are `aⱼ + wⱼ c`
/// with `c = a₀ + share·A w₁`, all times the size.
#[inline(never)]
pub(crate) fn scale_columns<T: Real>(
    map: &Matrix6x4<T>,
    w: &Vector4<T>,
    share: T,
    size: T,
    scaled: &mut Matrix6x4<T>,
) {
    let (a, [w], scaled) = (&map.data.0, &w.data.0, &mut scaled.data.0);
    let (mut inner, mut c) = ([T::zero(); 6], [T::zero(); 6]);
    for i in 0..6 {
        inner[i] = a[1][i] * w[1] + a[2][i] * w[2] + a[3][i] * w[3];
    }
    for i in 0..6 {
        c[i] = a[0][i] + inner[i] * share;
    }
    for i in 0..6 {
        scaled[0][i] = (a[0][i] * w[0] + inner[i]) * size;
    }
    for j in 1..4 {
        for i in 0..6 {
            scaled[j][i] = (a[j][i] + c[i] * w[j]) * size;
        }
    }
}
