//! The paper's fast path: small whole numbers that untangle the signals.

use core::fmt::Write as _;

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

/// A matrix **M** of small whole numbers such that `M·C` can be solved one load after another:
/// row `j` of `M·C` holds load `j` and loads that have been found before it (equations (19), (20) of
/// Bicchi & Dario 1987, for any layout that has one).
///
/// ```
/// use fingertip_calibration::design::Decoupling;
/// use fingertip_calibration::nalgebra::{DMatrix, DVector};
///
/// // The first two gauges feel Fx + Fy and Fx − Fy, the others an axis each.
/// let mut signals = DMatrix::identity(6, 6);
/// (signals[(0, 1)], signals[(1, 0)], signals[(1, 1)]) = (1.0, 1.0, -1.0);
/// let decoupling = Decoupling::find(&signals).ok_or("none")?;
/// // Sums and differences suffice: no load must be known to find another.
/// assert_eq!(decoupling.couplings(), 0);
/// let load = decoupling.solve(&DVector::from_vec(vec![0.7, 0.3, 0.0, 0.0, 0.0, 0.1])).ok_or("wrong number")?;
/// assert!((load[0] - 0.5).abs() < 1e-12 && (load[1] - 0.2).abs() < 1e-12 && (load[5] - 0.1).abs() < 1e-12);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Decoupling {
    /// Row `j` is the combination of signals for axis `j`: `rows[j][channel]`.
    pub rows: Vec<Vec<i8>>,
    /// The axes (0 is Fx, 5 is Tz) in the order in which they are found.
    pub order: [usize; 6],
    /// `M·C`, with what is zero up to rounding set to zero.
    pub combined: Matrix6<f64>,
}

/// Part of the largest possible sum below which a coupling is rounding and not a coupling.
const ZERO: f64 = 1e-10;

struct Candidate {
    factors: Vec<i8>,
    combined: Vector6<f64>,
    /// Sum of the factors' sizes.
    size: f64,
}

impl Decoupling {
    /// Tries all combinations with factors −1, 0, 1, and −2 to 2. `None` if the layout has none, has
    /// more than eight channels, or is not a finite matrix of six columns.
    ///
    /// Of several, the one with the fewest couplings is taken, then the one with the best signal to
    /// noise, then the one with the smallest factors.
    #[must_use]
    pub fn find(normalised: &DMatrix<f64>) -> Option<Self> {
        let channels = normalised.nrows();
        if normalised.ncols() != 6 || !(6..=8).contains(&channels) {
            return None;
        }
        // Only the pattern counts: columns of size 1.
        let sizes: Vec<f64> = normalised.column_iter().map(|column| column.amax()).collect();
        if sizes.iter().any(|size| !(*size > 0.0 && size.is_finite())) {
            return None;
        }
        let found =
            [1, 2].into_iter().filter_map(|greatest| Self::with_factors(normalised, &sizes, greatest));
        // The first of equals, so that small factors are preferred.
        found.min_by_key(Self::couplings)
    }

    /// How many loads must be known to find others: 0 if `M·C` is diagonal.
    #[must_use]
    pub fn couplings(&self) -> usize {
        self.combined.iter().filter(|x| **x != 0.0).count() - 6
    }

    fn with_factors(normalised: &DMatrix<f64>, sizes: &[f64], greatest: i8) -> Option<Self> {
        let candidates = candidates(normalised, sizes, greatest);
        let mut known = [false; 6];
        let mut chosen: [Option<&Candidate>; 6] = [None; 6];
        let mut order = [0; 6];
        for place in &mut order {
            let (axis, candidate) = next(&candidates, known)?;
            known[axis] = true;
            chosen[axis] = Some(candidate);
            *place = axis;
        }
        let chosen: Vec<&Candidate> = chosen.into_iter().flatten().collect();
        let combined = Matrix6::from_fn(|i, j| chosen[i].combined[j] * sizes[j]);
        let rows = chosen.into_iter().map(|candidate| candidate.factors.clone()).collect();
        Some(Self { rows, order, combined })
    }

    /// The load (in nominal loads) that signals tell of; `None` for a wrong number of signals.
    #[must_use]
    pub fn solve(&self, signals: &DVector<f64>) -> Option<Vector6<f64>> {
        let mut load = Vector6::zeros();
        for axis in self.order {
            let row = self.rows.get(axis)?;
            if row.len() != signals.len() {
                return None;
            }
            let sum: f64 =
                row.iter().zip(signals.iter()).map(|(factor, signal)| f64::from(*factor) * signal).sum();
            // Loads not found yet are zero here, and their couplings too.
            let coupled = self.combined.row(axis).transpose().dot(&load);
            load[axis] = (sum - coupled) / self.combined[(axis, axis)];
        }
        Some(load)
    }

    /// The type that `fingertip_wrench::Decoupled` takes, as Rust source for firmware. `name` is what
    /// to call it.
    #[must_use]
    pub fn rust_source(&self, name: &str) -> String {
        let channels = self.rows.first().map_or(0, Vec::len);
        let mut text = format!("/// Untangles the signals of a designed sensor.\npub struct {name};\n\n");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "impl fingertip_wrench::Combination<{channels}> for {name} {{");
        let _ = writeln!(text, "    const MATRIX: [[f64; {channels}]; 6] = [");
        for row in &self.rows {
            let row: Vec<String> = row.iter().map(|factor| format!("{factor}.0")).collect();
            let _ = writeln!(text, "        [{}],", row.join(", "));
        }
        text.push_str("    ];\n    const KEPT: [[bool; 6]; 6] = [\n");
        for row in self.combined.row_iter() {
            let row: Vec<String> = row.iter().map(|x| (*x != 0.0).to_string()).collect();
            let _ = writeln!(text, "        [{}],", row.join(", "));
        }
        text.push_str("    ];\n}\n");
        text
    }
}

/// All combinations up to sign, with their row of `M·C`.
fn candidates(normalised: &DMatrix<f64>, sizes: &[f64], greatest: i8) -> Vec<Candidate> {
    let channels = normalised.nrows();
    let rows: Vec<Vector6<f64>> =
        (0..channels).map(|i| Vector6::from_fn(|j, _| normalised[(i, j)] / sizes[j])).collect();
    let mut found = Vec::new();
    let mut factors = vec![-greatest; channels];
    loop {
        let first = factors.iter().find(|factor| **factor != 0);
        if first.is_some_and(|factor| *factor > 0) {
            let mut combined = Vector6::zeros();
            let mut size = 0.0;
            for (row, factor) in rows.iter().zip(&factors) {
                if *factor != 0 {
                    combined += row * f64::from(*factor);
                    size += f64::from(factor.abs());
                }
            }
            combined.apply(|x| {
                if x.abs() <= ZERO * size {
                    *x = 0.0;
                }
            });
            found.push(Candidate { factors: factors.clone(), combined, size });
        }
        // Count up, as an odometer does.
        let Some(place) = factors.iter().position(|factor| *factor < greatest) else { return found };
        for factor in &mut factors[..place] {
            *factor = -greatest;
        }
        factors[place] += 1;
    }
}

/// The best combination that tells one more load from those not known.
fn next(candidates: &[Candidate], known: [bool; 6]) -> Option<(usize, &Candidate)> {
    let mut best: Option<(usize, &Candidate, (usize, f64, f64))> = None;
    for candidate in candidates {
        let mut unknown = (0..6).filter(|axis| candidate.combined[*axis] != 0.0 && !known[*axis]);
        let (Some(axis), None) = (unknown.next(), unknown.next()) else { continue };
        let couplings = candidate.combined.iter().filter(|x| **x != 0.0).count();
        let noise = candidate.factors.iter().map(|factor| f64::from(*factor).powi(2)).sum::<f64>().sqrt();
        let signal = candidate.combined[axis].abs() / noise;
        let better = best.as_ref().is_none_or(|(_, _, (fewest, largest, smallest))| {
            couplings < *fewest
                || couplings == *fewest
                    && (signal > largest * (1.0 + 1e-9)
                        || signal > largest * (1.0 - 1e-9) && candidate.size < *smallest)
        });
        if better {
            best = Some((axis, candidate, (couplings, signal, candidate.size)));
        }
    }
    best.map(|(axis, candidate, _)| (axis, candidate))
}

#[cfg(test)]
mod tests {
    use super::Decoupling;
    use crate::design::test_spaces::{free, paper, rosettes};
    use crate::design::{NominalLoads, TubeSpace};
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, DVector, Vector6};

    fn matrix(space: &TubeSpace, values: &[f64]) -> DMatrix<f64> {
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        space.layout(values).unwrap().normalised(1e6, &loads).unwrap()
    }

    fn check(matrix: &DMatrix<f64>) -> Decoupling {
        let found = Decoupling::find(matrix).unwrap();
        for axis in 0..6 {
            let mut load = Vector6::repeat(0.3);
            load[axis] = -2.0;
            let signals = matrix * DVector::from_column_slice(load.as_slice());
            assert!((found.solve(&signals).unwrap() - load).largest() < 1e-12);
        }
        found
    }

    #[test]
    fn paper_has_its_own() {
        let found = check(&matrix(&paper(), &[5e-3, 0.25, 10e-3]));
        assert_eq!(found.rows[0], [1, 1, 1, 1, 0, 0]);
        // The paper's M couples two rows to one load each; no combination avoids that.
        assert_eq!(found.couplings(), 2);
        assert!(found.combined[(4, 1)] != 0.0 && found.combined[(5, 2)] != 0.0);
    }

    #[test]
    fn rosettes_need_no_order() {
        for count in [3, 4] {
            let found = check(&matrix(&rosettes(count), &[8e-3, 0.3, 0.0]));
            assert_eq!(found.couplings(), 0, "{count}");
            assert!(found.rows[3].iter().all(|factor| factor.abs() == 1));
            let source = found.rust_source("Designed");
            assert!(source.contains(&format!("Combination<{}>", 2 * count)));
            assert_eq!(source.matches("true").count(), 6);
        }
    }

    /// Factors are 2 at most. Signals 0 and 1 see loads x and y: the one as x + 2y, or x − 3y, the other y.
    #[test]
    fn factors_are_two_at_most() {
        for (share, couplings) in [(2.0, 0), (-2.0, 0), (3.0, 1), (-3.0, 1)] {
            let mut matrix = DMatrix::identity(6, 6);
            matrix[(0, 1)] = share;
            // The column of y then is of size 1 as that of x.
            matrix.column_mut(1).scale_mut(1.0 / share);
            let mut alike = DMatrix::identity(6, 6);
            (alike[(0, 1)], alike[(1, 1)]) = (1.0, 1.0 / share);
            assert!((&matrix - &alike).largest() < 1e-15);
            let found = check(&matrix);
            assert_eq!(found.couplings(), couplings, "{share}: {found:?}");
            assert!(found.rows.iter().flatten().all(|factor| factor.abs() <= 2), "{found:?}");
        }
    }

    #[test]
    fn free_layouts_have_none() {
        let values: Vec<f64> = (0..18).map(|i| 0.01 * f64::from(i * i % 17) + 1e-3).collect();
        assert_eq!(Decoupling::find(&matrix(&free(), &values)), None);
        assert_eq!(Decoupling::find(&DMatrix::zeros(6, 6)), None);
        assert_eq!(Decoupling::find(&DMatrix::identity(5, 6)), None);
        assert_eq!(Decoupling::find(&(DMatrix::identity(6, 6) * f64::NAN)), None);
    }
}
