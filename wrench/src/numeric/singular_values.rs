//! Singular values, by one-sided Jacobi rotations.

use nalgebra::{SMatrix, Vector6};

use crate::Real;

/// Sweeps over all pairs of columns; five or six are usual, and convergence is quadratic.
const MAX_SWEEPS: usize = 40;

/// The six singular values of an N×6 matrix, largest first (Hestenes 1958; rotations as in
/// Rutishauser 1966; columns sorted as in de Rijk 1989).
///
/// Each is right to a few rounding errors of the *largest*, and of itself where only the sizes of
/// the columns make the matrix ill-conditioned (Demmel & Veselić 1992). Vectors are not computed.
/// The number of sweeps is bounded; entries that are not finite give values that are not finite.
///
/// ```
/// use fingertip_wrench::singular_values;
/// use nalgebra::SMatrix;
///
/// let mut matrix = SMatrix::<f64, 8, 6>::zeros();
/// for (i, size) in [3.0, 1e-9, 5.0, 1.0, 2.0, 4.0].into_iter().enumerate() {
///     matrix[(i, i)] = size;
/// }
/// assert_eq!(singular_values(&matrix).as_slice(), [5.0, 4.0, 3.0, 2.0, 1.0, 1e-9]);
/// ```
#[must_use]
pub fn singular_values<T: Real, const N: usize>(matrix: &SMatrix<T, N, 6>) -> Vector6<T> {
    let scale = matrix.amax().normalising_factor();
    let mut a = matrix * scale;
    let orthogonal = T::EPSILON * T::literal(0.25);
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for p in 0..5 {
            // The longest remaining column first: small ones are then rotated by small angles.
            let squared = |a: &SMatrix<T, N, 6>, j: usize| a.column(j).norm_squared();
            let longest = (p..6).fold(p, |best, j| if squared(&a, j) > squared(&a, best) { j } else { best });
            a.swap_columns(p, longest);
            for q in p + 1..6 {
                rotated |= rotate(&mut a, p, q, orthogonal);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut values = Vector6::from_fn(|j, _| column_norm(&a, j) / scale);
    for i in 1..6 {
        let mut j = i;
        while j > 0 && values[j] > values[j - 1] {
            values.swap_rows(j, j - 1);
            j -= 1;
        }
    }
    values
}

/// The length of a column, whatever its size.
fn column_norm<T: Real, const N: usize>(a: &SMatrix<T, N, 6>, j: usize) -> T {
    let scale = a.column(j).amax().normalising_factor();
    (a.column(j) * scale).norm_squared().root() / scale
}

/// Makes columns `p` and `q` orthogonal; `false` if they were.
fn rotate<T: Real, const N: usize>(a: &mut SMatrix<T, N, 6>, p: usize, q: usize, orthogonal: T) -> bool {
    let (long, short) = (column_norm(a, p), column_norm(a, q));
    // The cosine between them, from unit vectors: no under- or overflow. With a column of zeros it is NaN, which
    // is orthogonal enough.
    let cosine = (a.column(p) / long).dot(&(a.column(q) / short));
    if !(cosine.abs() > orthogonal * T::literal(N as f64)) {
        return false;
    }
    // tan 2φ = 2 (p·q)/(|p|² − |q|²), with lengths as ratios.
    let ratio = short / long;
    let two = T::literal(2.0);
    let zeta = (ratio - T::one() / ratio) / (two * cosine);
    let tangent = {
        let sign = if zeta < T::zero() { -T::one() } else { T::one() };
        // For |ζ| so large that ζ² overflows the tangent is 1/(2ζ) to the last digit.
        if zeta.abs() > T::one() / T::EPSILON {
            T::one() / (two * zeta)
        } else {
            sign / (zeta.abs() + (T::one() + zeta * zeta).root())
        }
    };
    let cos = T::one() / (T::one() + tangent * tangent).root();
    let sin = cos * tangent;
    for i in 0..N {
        let (x, y) = (a[(i, p)], a[(i, q)]);
        a[(i, p)] = cos * x - sin * y;
        a[(i, q)] = sin * x + cos * y;
    }
    true
}
