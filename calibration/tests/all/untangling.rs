//! Sums and differences of signals that give one load after another, against a search by brute force.

use fingertip_calibration::design::{Decoupling, LoadedTube, Material, NominalLoads, TubeSpace, Wall};
use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector6};

fn loads() -> NominalLoads {
    NominalLoads::equal(10.0, 0.1).unwrap()
}

fn tube() -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 10e-3, length: 40e-3, loads: loads() }
}

fn paper() -> DMatrix<f64> {
    let angle = (1_f64.to_radians(), 59_f64.to_radians());
    let space =
        TubeSpace::bicchi_dario((2e-3, 15e-3), angle, (2e-3, 40e-3), tube(), Wall::Fixed(0.2e-3)).unwrap();
    space.layout(&[5e-3, 0.25, 10e-3]).unwrap().normalised(1e6, &loads()).unwrap()
}

fn rosette(count: usize) -> DMatrix<f64> {
    let angle = (1_f64.to_radians(), 59_f64.to_radians());
    let space =
        TubeSpace::rosettes(count, (2e-3, 20e-3), angle, (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3));
    space.unwrap().layout(&[8e-3, 0.3, 0.0]).unwrap().normalised(1e6, &loads()).unwrap()
}

/// One combination of signals: its factors, which loads it holds, and how much of each over the noise.
struct Combined {
    factors: Vec<i8>,
    holds: Vec<usize>,
    signal: Vector6<f64>,
    size: i32,
}

/// All combinations with factors of a size up to this.
fn all(matrix: &DMatrix<f64>, greatest: i8) -> Vec<Combined> {
    let channels = matrix.nrows() as u32;
    let base = 2 * greatest as usize + 1;
    let mut found = Vec::new();
    for number in 0..base.pow(channels) {
        let factors: Vec<i8> =
            (0..channels).map(|place| (number / base.pow(place) % base) as i8 - greatest).collect();
        let squares: f64 = factors.iter().map(|factor| f64::from(*factor).powi(2)).sum();
        if squares == 0.0 {
            continue;
        }
        // Columns of size 1, as only the pattern counts.
        let sum = |j: usize| {
            let column = matrix.column(j);
            factors.iter().zip(column.iter()).map(|(factor, x)| f64::from(*factor) * x).sum::<f64>()
                / column.amax()
        };
        let signal = Vector6::from_fn(|j, _| sum(j));
        let holds = (0..6).filter(|j| signal[*j].abs() > 1e-9).collect();
        let size = factors.iter().map(|factor| i32::from(factor.abs())).sum();
        found.push(Combined { factors, holds, signal: signal.abs() / squares.sqrt(), size });
    }
    found
}

/// Each step takes one more load, with the fewest couplings to those known; of these the strongest over the noise,
/// and of equals one of the smallest.
fn is_the_best_of_all(matrix: &DMatrix<f64>) -> Decoupling {
    let found = Decoupling::find(matrix).unwrap();
    let greatest = found.rows.iter().flatten().map(|factor| factor.abs()).max().unwrap();
    let all = all(matrix, greatest);
    let mut known: Vec<usize> = Vec::new();
    for axis in found.order {
        let useful =
            |combined: &&Combined| combined.holds.iter().filter(|load| !known.contains(load)).count() == 1;
        let new = |combined: &Combined| {
            let load = combined.holds.iter().find(|load| !known.contains(load)).unwrap();
            combined.signal[*load]
        };
        let fewest = all.iter().filter(useful).map(|combined| combined.holds.len()).min().unwrap();
        let candidates: Vec<&Combined> =
            all.iter().filter(useful).filter(|combined| combined.holds.len() == fewest).collect();
        let strongest = candidates.iter().map(|combined| new(combined)).fold(0.0, f64::max);
        let smallest = candidates
            .iter()
            .filter(|combined| new(combined) > strongest * (1.0 - 1e-6))
            .map(|combined| combined.size)
            .min()
            .unwrap();
        let taken = candidates.iter().find(|combined| combined.factors == found.rows[axis]).unwrap();
        assert!(taken.holds.contains(&axis) && new(taken) > strongest * (1.0 - 1e-6), "{axis}");
        assert_eq!(taken.size, smallest, "{axis}");
        // The sign is that of the first factor.
        assert!(taken.factors.iter().find(|factor| **factor != 0).unwrap() > &0);
        for load in 0..6 {
            let combined: f64 =
                taken.factors.iter().zip(matrix.column(load).iter()).map(|(f, x)| f64::from(*f) * x).sum();
            let expected = if taken.holds.contains(&load) { combined } else { 0.0 };
            assert!((found.combined[(axis, load)] - expected).abs() < 1e-9 * matrix.amax());
        }
        known.push(axis);
    }
    found
}

#[test]
fn the_best_combinations_are_taken() {
    // Each signal holds one load more than the one before, the last all of them, in shares that no whole numbers undo.
    let one_after_another =
        DMatrix::from_fn(6, 6, |i, j| if j <= i { (2.0 + (i * 7 + j * 3) as f64).sqrt() } else { 0.0 });
    for matrix in [paper(), rosette(3), DMatrix::identity(6, 6), one_after_another] {
        let found = is_the_best_of_all(&matrix);
        let held: usize = found.combined.iter().filter(|entry| **entry != 0.0).count();
        assert_eq!(found.couplings(), held - 6);
        let load = Vector6::new(0.3, -0.2, 0.7, 0.5, -0.9, 0.1);
        let signals = &matrix * DVector::from_column_slice(load.as_slice());
        assert!((found.solve(&signals).unwrap() - load).iter().all(|off| off.abs() < 1e-12));
        assert!(found.solve(&DVector::zeros(5)).is_none() && found.solve(&DVector::zeros(7)).is_none());
    }
}

#[test]
fn what_has_no_six_to_eight_signals_of_six_loads_has_none() {
    assert!(Decoupling::find(&DMatrix::identity(8, 6)).is_some());
    for (rows, columns) in [(5, 6), (9, 6), (6, 5), (7, 7)] {
        assert_eq!(Decoupling::find(&DMatrix::identity(rows, columns)), None, "{rows} {columns}");
    }
    let mut blind = DMatrix::identity(6, 6);
    blind[(3, 3)] = 0.0;
    assert_eq!(Decoupling::find(&blind), None);
}

#[test]
fn the_source_for_firmware_has_all_factors() {
    let found = Decoupling::find(&rosette(3)).unwrap();
    let source = found.rust_source("Mine");
    assert!(source.starts_with("/// Untangles the signals of a designed sensor.\npub struct Mine;\n\n"));
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let start = lines.iter().position(|line| line.starts_with("const MATRIX")).unwrap();
    assert_eq!(lines[start], "const MATRIX: [[f64; 6]; 6] = [");
    for (row, line) in found.rows.iter().zip(&lines[start + 1..]) {
        let factors: Vec<String> = row.iter().map(|factor| format!("{factor}.0")).collect();
        assert_eq!(*line, format!("[{}],", factors.join(", ")));
    }
    let kept = lines.iter().position(|line| line.starts_with("const KEPT")).unwrap();
    for (axis, line) in lines[kept + 1..kept + 7].iter().enumerate() {
        let flags: Vec<String> = (0..6).map(|j| (found.combined[(axis, j)] != 0.0).to_string()).collect();
        assert_eq!(*line, format!("[{}],", flags.join(", ")));
    }
}

/// What is zero but for errors in the tenth digit is told from what is not.
#[test]
fn small_errors_are_no_couplings() {
    let exact = rosette(3);
    let off = |share: f64| {
        let mut wrong = exact.clone();
        for (j, mut column) in wrong.column_iter_mut().enumerate() {
            let size = share * column.amax();
            column
                .iter_mut()
                .enumerate()
                .for_each(|(i, entry)| *entry += size * (((i + j) * 7 % 5) as f64 / 2.0 - 1.0));
        }
        wrong
    };
    let (found, nearly) = (Decoupling::find(&exact).unwrap(), Decoupling::find(&off(0.9e-10)).unwrap());
    assert_eq!((nearly.rows, nearly.order), (found.rows, found.order));
    assert_eq!(Decoupling::find(&off(1e-8)), None);
}
