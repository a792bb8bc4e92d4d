//! The last step of shape from motion: sensor, zero and all directions at their most likely values, and
//! what they are worth.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::linear::{Factors, Triangular};

/// A weight of unit size at one place: the load that it is (components × 3, times its direction), and the
/// readings under it (samples × gauges).
pub(super) struct Hung<'a> {
    pub(super) load: DMatrix<f64>,
    pub(super) signals: &'a DMatrix<f64>,
}

/// The most likely sensor.
pub(super) struct MostLikely {
    /// Gauges × components.
    pub(super) map: DMatrix<f64>,
    pub(super) zero: DVector<f64>,
    /// Of the rows of the map, one after another, and the zero; without what cannot be observed.
    pub(super) covariance: DMatrix<f64>,
    /// Standard deviation of one reading of one gauge.
    pub(super) noise: f64,
    /// Degrees of freedom behind it.
    pub(super) freedom: f64,
    /// Directions of all weights.
    pub(super) directions: Vec<Vector3<f64>>,
}

const MOST_ITERATIONS: usize = 30;

/// Maximum likelihood of `signals = map · load · direction + zero + noise` over map, zero and all directions,
/// the noise being alike in all gauges: Gauss-Newton in which each direction is solved for first and projected
/// out (variable projection; Golub & Pereyra 1973), from a start near by. `turnable` says that all forces may
/// be turned together (one place, loads of three components); the map stays as it is in that respect.
///
/// `None` if there are no more readings than unknowns, they do not determine these, or a number is not finite.
pub(super) fn most_likely(
    hung: &[Hung<'_>],
    map: &DMatrix<f64>,
    zero: &DVector<f64>,
    turnable: bool,
) -> Option<MostLikely> {
    let (gauges, components) = map.shape();
    let unknowns = gauges * (components + 1);
    let observed = if turnable { unknowns.checked_sub(3)? } else { unknowns };
    let samples: usize = hung.iter().map(|hung| hung.signals.nrows()).sum();
    let freedom = (samples * gauges).checked_sub(2 * samples + observed).filter(|f| *f > 0)?;
    let mut best = (map.clone(), zero.clone());
    let (mut system, mut directions) = linearised(hung, &best.0, &best.1)?;
    let mut factors = system.factors();
    for _ in 0..MOST_ITERATIONS {
        let (factors_of_step, _) = without_turns(&system, &best.0, turnable)?;
        let step = factors_of_step.coefficients().ok()?;
        let mut next = best.clone();
        for gauge in 0..gauges {
            for j in 0..components {
                next.0[(gauge, j)] += step[gauge * components + j];
            }
            next.1[gauge] += step[gauges * components + gauge];
        }
        let (mut changed, turned) = linearised(hung, &next.0, &next.1)?;
        let left_over = changed.factors();
        // What rounding leaves does not fall any further.
        if !(left(&left_over) < left(&factors)) {
            break;
        }
        let settled = step.norm() < 1e-13 * best.0.norm();
        (best, system, directions, factors) = (next, changed, turned, left_over);
        if settled {
            break;
        }
    }
    let freedom = freedom as f64;
    let noise = left(&factors) / freedom.sqrt();
    let (factors, turns) = without_turns(&system, &best.0, turnable)?;
    let covariance = (factors.inverse_gram().ok()? - &turns * turns.transpose()) * (noise * noise);
    let finite = covariance.iter().chain(best.0.iter()).chain(best.1.iter()).all(|x| x.is_finite());
    finite.then_some(MostLikely { map: best.0, zero: best.1, covariance, noise, freedom, directions })
}

/// The system with what a turn of all forces would change held at zero, and an orthonormal basis of that:
/// the inverse of its Gram matrix is the pseudo-inverse of the system's and the projector on that basis.
fn without_turns(system: &Triangular, map: &DMatrix<f64>, turnable: bool) -> Option<(Factors, DMatrix<f64>)> {
    let (gauges, components) = map.shape();
    let unknowns = gauges * (components + 1);
    let mut system = system.clone();
    if !turnable {
        return Some((system.factors(), DMatrix::zeros(unknowns, 1)));
    }
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(3);
    for axis in 0..3 {
        let turned = map * Vector3::ith(axis, 1.0).cross_matrix();
        let mut turn = DVector::zeros(unknowns);
        for gauge in 0..gauges {
            (0..3).for_each(|j| turn[3 * gauge + j] = turned[(gauge, j)]);
        }
        for other in &basis {
            let along = other.dot(&turn);
            turn -= other * along;
        }
        let turn = turn.try_normalize(0.0)?;
        system.push(turn.as_slice(), &[0.0]);
        basis.push(turn);
    }
    Some((system.factors(), DMatrix::from_columns(&basis)))
}

/// Root of the sum of squares that the directions leave.
fn left(factors: &Factors) -> f64 {
    factors.projected.norm().hypot(factors.residual.norm())
}

/// Directions for this sensor, and the residuals and their slopes by the map and the zero with what a turn of
/// a direction can take up projected out.
fn linearised(
    hung: &[Hung<'_>],
    map: &DMatrix<f64>,
    zero: &DVector<f64>,
) -> Option<(Triangular, Vec<Vector3<f64>>)> {
    let (gauges, components) = map.shape();
    let mut system = Triangular::new(gauges * (components + 1), 1);
    let mut directions = Vec::new();
    let mut row = vec![0.0; gauges * (components + 1)];
    for hung in hung {
        let signal = map * &hung.load;
        for reading in hung.signals.row_iter() {
            let reading = reading.transpose() - zero;
            let (direction, tangents) = direction_of(&signal, &reading)?;
            let residual = reading - &signal * direction;
            let load = &hung.load * direction;
            let beside = |target: &mut DVector<f64>| {
                for tangent in &tangents {
                    let along = tangent.dot(target);
                    *target -= tangent * along;
                }
            };
            for gauge in 0..gauges {
                // A row of the projector, which is symmetric.
                let mut projector = DVector::zeros(gauges);
                projector[gauge] = 1.0;
                beside(&mut projector);
                for (other, share) in projector.iter().enumerate() {
                    for (j, component) in load.iter().enumerate() {
                        row[other * components + j] = share * component;
                    }
                    row[gauges * components + other] = *share;
                }
                if !system.push(&row, &[projector.dot(&residual)]) {
                    return None;
                }
            }
            directions.push(direction);
        }
    }
    Some((system, directions))
}

/// The unit vector whose signals are nearest to a reading, and orthonormal signals of its two turns.
fn direction_of(signal: &DMatrix<f64>, reading: &DVector<f64>) -> Option<(Vector3<f64>, [DVector<f64>; 2])> {
    let gram = (signal.transpose() * signal).cholesky()?;
    let free = gram.solve(&(signal.transpose() * reading));
    let mut direction = Vector3::new(free[0], free[1], free[2]).try_normalize(0.0)?;
    let tangents = |direction: &Vector3<f64>| {
        let first = direction.cross(&Vector3::ith(direction.iamin(), 1.0)).normalize();
        [first, direction.cross(&first)]
    };
    // Newton's steps on the sphere converge at least by the noise over the signal each.
    for _ in 0..20 {
        let basis = tangents(&direction);
        let slope = DMatrix::from_columns(&[signal * basis[0], signal * basis[1]]);
        let residual = reading - signal * direction;
        let step = (slope.transpose() * &slope).cholesky()?.solve(&(slope.transpose() * residual));
        direction = (direction + basis[0] * step[0] + basis[1] * step[1]).try_normalize(0.0)?;
        if step.amax() < 1e-15 {
            break;
        }
    }
    let basis = tangents(&direction);
    let first = (signal * basis[0]).try_normalize(0.0)?;
    let mut second = signal * basis[1];
    let along = first.dot(&second);
    second -= &first * along;
    Some((direction, [first, second.try_normalize(0.0)?]))
}

#[cfg(test)]
mod tests {
    use super::{Hung, direction_of, most_likely};
    use crate::fit::testing::{gaussian_matrix, sensor};
    use nalgebra::{DMatrix, DVector, Vector3};
    use rand::SeedableRng as _;

    /// What a turn of all forces changes has no variance: nothing tells of it.
    #[test]
    fn the_covariance_is_without_what_cannot_be_observed() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(18);
        let truth = sensor(&mut random, 3, 4).transpose();
        let zero = gaussian_matrix(&mut random, 4, 1).column(0).into_owned();
        let mut signals = gaussian_matrix(&mut random, 20, 4) * 0.01;
        for mut row in signals.row_iter_mut() {
            let force = Vector3::from_fn(|_, _| gaussian_matrix(&mut random, 1, 1)[(0, 0)]).normalize();
            row += (&truth * force + &zero).transpose();
        }
        let hung = [Hung { load: DMatrix::identity(3, 3), signals: &signals }];
        let found = most_likely(&hung, &truth, &zero, true).unwrap();
        let most = found.covariance.amax();
        for axis in 0..3 {
            let turned = &found.map * Vector3::ith(axis, 1.0).cross_matrix();
            let turn = DVector::from_fn(16, |k, _| if k < 12 { turned[(k / 3, k % 3)] } else { 0.0 });
            assert!((&found.covariance * turn).amax() < 1e-9 * most, "{axis}");
        }
        let eigenvalues = found.covariance.symmetric_eigenvalues();
        assert!(eigenvalues.min() > -1e-12 * most, "{eigenvalues}");
        assert_eq!(eigenvalues.iter().filter(|value| **value > 1e-9 * most).count(), 13);
    }

    /// The nearest direction leaves nothing along its two turns, and no other one leaves less.
    #[test]
    fn a_direction_is_the_one_whose_signals_are_nearest() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(17);
        for _ in 0..50 {
            let signal = sensor(&mut random, 3, 5).transpose();
            let truth = Vector3::from_fn(|_, _| gaussian_matrix(&mut random, 1, 1)[(0, 0)]).normalize();
            let reading = &signal * truth + gaussian_matrix(&mut random, 5, 1).column(0) * 0.02;
            let (direction, [first, second]) = direction_of(&signal, &reading).unwrap();
            assert!((direction.norm() - 1.0).abs() < 1e-14);
            let left = &reading - &signal * direction;
            assert!(left.dot(&first).abs() < 1e-12 && left.dot(&second).abs() < 1e-12, "{left}");
            assert!((first.norm() - 1.0).abs() < 1e-14 && (second.norm() - 1.0).abs() < 1e-14);
            assert!(first.dot(&second).abs() < 1e-13);
            for _ in 0..20 {
                let other =
                    direction + Vector3::from_fn(|_, _| 0.3 * gaussian_matrix(&mut random, 1, 1)[(0, 0)]);
                assert!((&reading - &signal * other.normalize()).norm() >= left.norm());
                // Signals of a turn are of these two.
                let turned = &signal * direction.cross(&other);
                let rest = &turned - &first * first.dot(&turned) - &second * second.dot(&turned);
                assert!(rest.norm() < 1e-12);
            }
        }
        // Gauges that see two directions only do not tell the third.
        let flat = DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
        assert!(direction_of(&flat, &flat.column(0).into_owned()).is_none());
    }
}
