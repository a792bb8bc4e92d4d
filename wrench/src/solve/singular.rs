//! Which gauge makes a matrix singular.

use nalgebra::Matrix6;
use thiserror::Error;

use crate::Real;

/// The sensor matrix cannot be inverted.
///
/// ```
/// use fingertip_wrench::{GaussianElimination, SensorMatrix, SingularMatrix};
/// use nalgebra::{Matrix6, Vector6};
///
/// let mut matrix = Matrix6::<f64>::identity();
/// matrix[(5, 4)] = 1.0;
/// matrix[(5, 5)] = 0.0; // gauge 5 sees what gauge 4 sees
/// matrix[(0, 5)] = 1.0;
/// let sensor = SensorMatrix::new(matrix, Vector6::repeat(1.0))?;
/// let refused = GaussianElimination::new(&sensor).unwrap_err();
/// assert!(matches!(refused, SingularMatrix::DependentGauge { gauge: 4 | 5, .. }));
/// assert!(refused.to_string().starts_with("the sensor matrix is singular to working precision: "));
/// # Ok::<(), fingertip_wrench::SensorMatrixError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SingularMatrix {
    /// The gauges do not span six directions.
    #[error(
        "the sensor matrix is singular to working precision: what gauge {gauge} measures the other gauges \
         measure already (all but {pivot:e} of its row)"
    )]
    DependentGauge {
        /// The gauge that adds least to the others (counts from 0).
        gauge: usize,
        /// What is left of its row once the other gauges are taken out, relative to the row.
        pivot: f64,
    },
    /// The entries, or their ratio to the nominal loads, leave the range of the scalar type.
    #[error("the sensor matrix or a nominal load is too large or too small for the scalar type")]
    OutOfRange,
}

/// Names the gauge, by elimination with complete pivoting: the row that is left over last is a
/// combination of those before it. `scaled` is equilibrated.
#[cold]
pub(crate) fn dependent_gauge<T: Real>(scaled: &Matrix6<T>) -> SingularMatrix {
    let mut a = *scaled;
    let mut order = [0, 1, 2, 3, 4, 5_usize];
    let mut last = (0, T::zero());
    for k in 0..6 {
        let (mut row, mut column) = (k, k);
        for i in k..6 {
            for j in k..6 {
                if a[(i, j)].abs() > a[(row, column)].abs() {
                    (row, column) = (i, j);
                }
            }
        }
        let pivot = a[(row, column)].abs();
        last = (order[row], pivot);
        if !(pivot > T::EPSILON * T::literal(16.0)) {
            break;
        }
        a.swap_rows(k, row);
        a.swap_columns(k, column);
        order.swap(k, row);
        for i in k + 1..6 {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..6 {
                let change = factor * a[(k, j)];
                a[(i, j)] -= change;
            }
        }
    }
    SingularMatrix::DependentGauge { gauge: last.0, pivot: last.1.to_f64() }
}
