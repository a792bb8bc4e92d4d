//! Orthogonal columns by one-sided Jacobi rotations (Hestenes 1958; rotations as in Rutishauser 1966; columns
//! sorted as in de Rijk 1989).

use nalgebra::allocator::Allocator;
use nalgebra::storage::{Storage, StorageMut};
use nalgebra::{DefaultAllocator, Dim, Matrix};

use crate::Real;

/// Sweeps over all pairs of columns; five to ten are usual, and convergence is quadratic.
const MAX_SWEEPS: usize = 40;

/// What was done to two columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn<T> {
    /// They changed places.
    Swapped,
    /// They were rotated by the angle with this cosine and sine.
    Rotated(T, T),
}

impl<T: Real> Turn<T> {
    /// Does the same to columns `p` and `q` of a matrix.
    pub fn apply<R: Dim, C: Dim, S: StorageMut<T, R, C>>(
        self,
        a: &mut Matrix<T, R, C, S>,
        p: usize,
        q: usize,
    ) {
        match self {
            Self::Swapped => a.swap_columns(p, q),
            Self::Rotated(cos, sin) => {
                for i in 0..a.nrows() {
                    let (x, y) = (a[(i, p)], a[(i, q)]);
                    a[(i, p)] = cos * x - sin * y;
                    a[(i, q)] = sin * x + cos * y;
                }
            }
        }
    }
}

/// Rotates the columns of a matrix against each other until they are orthogonal, and tells `follow` of every
/// turn. The squares of the largest entries must be within the range of the type.
///
/// The lengths of the columns are then the singular values: each is right to a few rounding errors of the
/// *largest*, and of itself where only the sizes of the columns make the matrix ill-conditioned (Demmel &
/// Veselić 1992). The number of sweeps is bounded.
pub fn orthogonalise<T: Real, R: Dim, C: Dim, S: StorageMut<T, R, C>>(
    a: &mut Matrix<T, R, C, S>,
    mut follow: impl FnMut(Turn<T>, usize, usize),
) where
    DefaultAllocator: Allocator<R>,
{
    let columns = a.ncols();
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for p in 0..columns.saturating_sub(1) {
            // The longest remaining column first: small ones are then rotated by small angles.
            let longest = (p..columns).fold(p, |best, j| {
                if a.column(j).norm_squared() > a.column(best).norm_squared() { j } else { best }
            });
            if longest != p {
                Turn::Swapped.apply(a, p, longest);
                follow(Turn::Swapped, p, longest);
            }
            for q in p + 1..columns {
                if let Some(turn) = between(a, p, q) {
                    turn.apply(a, p, q);
                    follow(turn, p, q);
                    rotated = true;
                }
            }
        }
        if !rotated {
            break;
        }
    }
}

/// The length of a column, whatever its size.
pub fn column_norm<T: Real, R: Dim, C: Dim, S: Storage<T, R, C>>(a: &Matrix<T, R, C, S>, j: usize) -> T
where
    DefaultAllocator: Allocator<R>,
{
    let scale = a.column(j).amax().normalising_factor();
    (a.column(j) * scale).norm_squared().root() / scale
}

/// The rotation that makes columns `p` and `q` orthogonal; `None` if they are.
fn between<T: Real, R: Dim, C: Dim, S: Storage<T, R, C>>(
    a: &Matrix<T, R, C, S>,
    p: usize,
    q: usize,
) -> Option<Turn<T>>
where
    DefaultAllocator: Allocator<R>,
{
    let (long, short) = (column_norm(a, p), column_norm(a, q));
    // The cosine between them, from unit vectors: no under- or overflow. With a column of zeros it is NaN, which
    // is orthogonal enough.
    let cosine = (a.column(p) / long).dot(&(a.column(q) / short));
    // What rounding makes of it; of many rows, errors cancel.
    let orthogonal = T::EPSILON * T::literal(0.25 * a.nrows().min(16) as f64);
    if !(cosine.abs() > orthogonal) {
        return None;
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
    Some(Turn::Rotated(cos, cos * tangent))
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// What is told of the turns is what was done: a matrix that follows them is orthogonal, takes the columns
        /// as they were to those that are left, and these are orthogonal to one another.
        #[test]
        fn followed_turns_take_the_columns_to_orthogonal_ones(
            entries in proptest::array::uniform12(-1.0_f64..1.0),
            sizes in proptest::array::uniform3(-6_i32..6),
        ) {
            let sizes = SVector::<f64, 3>::from(sizes.map(|power| 10_f64.powi(power)));
            let before = SMatrix::<f64, 4, 3>::from_iterator(entries) * SMatrix::from_diagonal(&sizes);
            let (mut columns, mut turned) = (before, SMatrix::<f64, 3, 3>::identity());
            orthogonalise(&mut columns, |turn, p, q| turn.apply(&mut turned, p, q));

            let not_orthogonal = (turned.transpose() * turned - SMatrix::identity()).amax();
            prop_assert!(not_orthogonal < 1e-14, "V'V differs from 1 by {not_orthogonal:e}");
            let differ = (before * turned - columns).amax();
            prop_assert!(differ < 1e-14 * before.amax(), "AV differs from the columns by {differ:e}");
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let cosine = columns.column(p).normalize().dot(&columns.column(q).normalize());
                prop_assert!(cosine.abs() < 1e-14, "columns {p} and {q} are at a cosine of {cosine:e}");
            }
        }
    }
}
