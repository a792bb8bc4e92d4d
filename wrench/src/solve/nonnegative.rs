//! Matrices without negative entries.

use nalgebra::Matrix6;

use crate::Real;

/// `(I − G)⁻¹ = (I + G)(I + G²)(I + G⁴)…` of a matrix without negative entries; `None` unless its
/// powers vanish. Nothing is subtracted, so nothing cancels.
pub(crate) fn neumann<T: Real>(matrix: &Matrix6<T>) -> Option<Matrix6<T>> {
    /// Powers up to 2^12: spectral radii up to 0.98.
    const DOUBLINGS: usize = 12;
    let identity = Matrix6::identity();
    let mut power = *matrix;
    let mut sum = identity + power;
    for _ in 0..DOUBLINGS {
        power *= power;
        if !power.iter().all(|x| x.is_number()) {
            return None;
        }
        sum *= identity + power;
        if power.amax() <= T::EPSILON * T::EPSILON {
            return Some(sum);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a ring of axes, each coupled to the next by `g`, the sum is known: `gᵏ/(1 − g⁶)`, `k` steps on.
    fn of_a_ring<T: Real>(coupling: f64) {
        let g = T::literal(coupling);
        let ring = Matrix6::from_fn(|i, j| if j == (i + 1) % 6 { g } else { T::zero() });
        let sum = neumann(&ring).expect("the powers vanish");
        for i in 0..6 {
            for j in 0..6 {
                let steps = (6 + j as i32 - i as i32) % 6;
                let wanted = coupling.powi(steps) / (1.0 - coupling.powi(6));
                // Thirteen products of sums of positive terms, each of seven roundings; and 1 − g⁶ magnifies
                // the rounding of g.
                let rounding = T::EPSILON.to_f64() * (100.0 + 6.0 / (1.0 - coupling));
                // Powers below ε² are left out.
                let left_out = T::EPSILON.to_f64().powi(2);
                let off = (sum[(i, j)].to_f64() - wanted).abs();
                assert!(off < rounding * wanted + left_out, "{coupling} {i} {j}");
            }
        }
    }

    #[test]
    fn the_series_of_a_ring_is_summed() {
        for coupling in [1e-9, 0.1, 0.5, 0.9, 0.98] {
            of_a_ring::<f64>(coupling);
            of_a_ring::<f32>(coupling);
        }
        assert_eq!(neumann(&Matrix6::<f64>::zeros()), Some(Matrix6::identity()));
        for coupling in [1.0, 1.5, 1e200, f64::INFINITY, f64::NAN] {
            assert_eq!(neumann(&Matrix6::from_diagonal_element(coupling)), None);
            // One entry of that kind alone.
            let mut one = Matrix6::zeros();
            one[(2, 2)] = coupling;
            assert_eq!(neumann(&one), None);
        }
    }
}
