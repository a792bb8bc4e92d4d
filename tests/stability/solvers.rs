//! Signals to wrench: conditioning, scaling, range, machining errors.

use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
use fingertip_wrench::{
    BicchiDario, Decoupled, ErrorBound, GaussianElimination, Inverse, LeastSquares, Real, Refined,
    SensorMatrix, Uncertainty, Wrench, WrenchSolver,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::big::Big;
use super::matrix::Row;
use super::solve::least_squares;

#[path = "../../wrench/tests/support/mod.rs"]
pub(crate) mod support;

use support::{cast, generator, greatest, of_condition, random_vector, sensor, wide};

/// The loads in units of the nominal ones that explain the signals, in 220 bits.
pub(crate) fn exact<T: Real, const N: usize>(
    sensor: &SensorMatrix<T, N>,
    signals: &SVector<T, N>,
) -> Option<Vec<Big>> {
    let matrix = wide(sensor.normalised());
    let rows: Vec<_> =
        (0..N).map(|i| (matrix.row(i).iter().copied().collect(), signals[i].to_f64(), 1.0)).collect();
    least_squares(&rows)
}

/// Differences to the exact loads, in units of the nominal loads.
pub(crate) fn differences<T: Real, const N: usize>(
    sensor: &SensorMatrix<T, N>,
    wrench: &Wrench<T>,
    exact: &[Big],
) -> Vector6<f64> {
    let found = wrench.components();
    Vector6::from_fn(|i, _| {
        let load = &Big::new(found[i].to_f64()) / &Big::new(sensor.nominal()[i].to_f64());
        (&load - &exact[i]).to_f64()
    })
}

/// `true` where all numbers are: an answer that is not has no 220-bit counterpart.
fn finite<T: Real>(wrench: &Wrench<T>) -> bool {
    wrench.is_finite()
}

struct Case<T: Real, const N: usize> {
    name: &'static str,
    sensor: SensorMatrix<T, N>,
    condition: f64,
    /// Of the columns, by which errors are weighed.
    columns: Vector6<f64>,
    /// By which the signals are multiplied.
    range: f64,
}

fn cases<T: Real, const N: usize>(random: &mut Pcg64Mcg) -> Vec<Case<T, N>> {
    let mut cases = Vec::new();
    let even = Vector6::repeat(1.0);
    for (name, condition) in [
        ("condition 1", 1.0),
        ("condition 1e3", 1e3),
        ("condition 1e5", 1e5),
        ("condition 1e8", 1e8),
        ("condition 1e10", 1e10),
        ("condition 1e12", 1e12),
    ] {
        if condition * T::EPSILON.to_f64() < 0.02 {
            let sensor = sensor(&of_condition::<N>(random, condition));
            cases.push(Case { name, sensor, condition, columns: even, range: 1.0 });
        }
    }
    let columns = Vector6::from_fn(|_, _| 2.0_f64.powi(random.random_range(-20..20)));
    let matrix = of_condition::<N>(random, 10.0);
    let scaled = sensor(&(matrix * Matrix6::from_diagonal(&columns)));
    cases.push(Case { name: "columns of 1e-6 to 1e6", sensor: scaled, condition: 10.0, columns, range: 1.0 });
    let far = if T::EPSILON.to_f64() > 1e-10 { 1e30 } else { 1e280 };
    for (name, range) in [("tiny signals", 1.0 / far), ("huge signals", far)] {
        cases.push(Case { name, sensor: sensor(&matrix), condition: 10.0, columns: even, range });
    }
    if N == 6 {
        let hilbert = SMatrix::<f64, N, 6>::from_fn(|i, j| 1.0 / (i + j + 1) as f64);
        if 1.5e7 * T::EPSILON.to_f64() < 0.02 {
            let case = Case {
                name: "Hilbert's matrix",
                sensor: sensor(&hilbert),
                condition: 1.5e7,
                columns: even,
                range: 1.0,
            };
            cases.push(case);
        }
    }
    cases
}

/// Error in the norm of the scaled loads, against `factor` rounding units of them.
fn run<T: Real, const N: usize, S: WrenchSolver<T, N>>(
    row: &mut Row,
    case: &Case<T, N>,
    solver: &S,
    factor: f64,
    trials: usize,
    random: &mut Pcg64Mcg,
) {
    for _ in 0..trials {
        let load = random_vector::<6>(random).component_div(&case.columns);
        let signals = cast(&(wide(case.sensor.normalised()) * load * case.range));
        let exact = exact(&case.sensor, &signals).expect("regular");
        let wrench = solver.solve(&signals);
        if !finite(&wrench) {
            row.error(f64::NAN, 1.0, || format!("{signals:?}"));
            continue;
        }
        let error = greatest(&differences(&case.sensor, &wrench, &exact).component_mul(&case.columns));
        let size = (0..6).map(|i| exact[i].to_f64().abs() * case.columns[i]).fold(0.0, f64::max);
        row.error(error, factor * T::EPSILON.to_f64() * size, || {
            format!("relative error {:.1e}", error / size)
        });
    }
}

/// NaN and infinities among the signals never give a wrench that looks sound.
fn bad_signals<T: Real, const N: usize, S: WrenchSolver<T, N>>(name: &str, solver: &S, rows: &mut Vec<Row>) {
    let mut row = Row::new::<T>(name, "a signal NaN or infinite");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for gauge in 0..N {
            let mut signals = SVector::<T, N>::repeat(T::one());
            signals[gauge] = T::literal(bad);
            row.expect(!solver.solve(&signals).is_finite(), || format!("{bad} in gauge {gauge}"));
        }
    }
    rows.push(row);
}

/// Errors against the bound that the solver itself states.
fn own_bound<T: Real, const N: usize, S: WrenchSolver<T, N>>(
    name: &str,
    case: &str,
    sensor: &SensorMatrix<T, N>,
    solver: &S,
    trials: usize,
    random: &mut Pcg64Mcg,
) -> Row {
    let mut row = Row::new::<T>(name, case);
    let Ok(bound) = ErrorBound::new(sensor, solver, &Uncertainty::none()) else {
        row.expect(false, || "no bound".to_owned());
        return row;
    };
    for _ in 0..trials {
        let signals = cast(&(wide(sensor.normalised()) * random_vector::<6>(random)));
        let exact = exact(sensor, &signals).expect("regular");
        let wrench = solver.solve(&signals);
        let errors = differences(sensor, &wrench, &exact);
        let stated = bound.at(&signals, &wrench);
        for i in 0..6 {
            let stated = stated[i].to_f64() / sensor.nominal()[i].to_f64();
            row.error(errors[i], stated, || format!("component {i}: {:.1e} of {stated:.1e}", errors[i]));
        }
    }
    row
}

/// The paper's sensor, and the same with machining errors.
pub(crate) fn paper<T: Real>(machining: f64, random: &mut Pcg64Mcg) -> Option<SensorMatrix<T, 6>> {
    let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
    let gauges = GaugeLayout::bicchi_dario_gauges(14.0_f64.to_radians(), 0.01);
    let nominal = Vector6::new(32.0, 32.0, 32.0, 0.25, 0.25, 0.25);
    let drawn = GaugeLayout::new(&beam, gauges).ok()?.sensor_matrix(1e4, nominal).ok()?;
    let largest = drawn.normalised().amax();
    let made = drawn.normalised().map(|x| x + machining * largest * random.random_range(-1.0..1.0));
    SensorMatrix::new(cast(&made), nominal.map(T::literal)).ok()
}

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let mut random = generator(31);
    for case in cases::<T, 6>(&mut random) {
        let backward = 10.0 * case.condition;
        macro_rules! solver {
            ($name:literal, $solver:expr, $factor:expr, $steps:expr) => {
                let mut row = Row::new::<T>($name, case.name);
                match $solver {
                    Ok(solver) => {
                        if let Some(steps) = $steps(&solver) {
                            row.iterated(steps);
                        }
                        run(&mut row, &case, &solver, $factor, trials, &mut random);
                    }
                    Err(error) => row.expect(false, || format!("{error}")),
                }
                rows.push(row);
            };
        }
        solver!("GaussianElimination", GaussianElimination::new(&case.sensor), backward, |_: &_| None);
        solver!("Refined (steps)", Refined::new(&case.sensor), 4.0, |s: &Refined<T>| Some(usize::from(
            s.steps()
        )));
        solver!("Inverse", Inverse::new(&case.sensor), backward, |_: &_| None);
        solver!("LeastSquares, 6 gauges", LeastSquares::new(&case.sensor), backward, |_: &_| None);
    }
    for case in cases::<T, 9>(&mut random) {
        let mut row = Row::new::<T>("LeastSquares, 9 gauges", case.name);
        match LeastSquares::new(&case.sensor) {
            Ok(solver) => run(&mut row, &case, &solver, 10.0 * case.condition, trials, &mut random),
            Err(error) => row.expect(false, || format!("{error}")),
        }
        rows.push(row);
    }
    for (case, machining) in
        [("as drawn", 0.0), ("machining errors 1e-3", 1e-3), ("machining errors 1 %", 1e-2)]
    {
        let sensor = paper::<T>(machining, &mut random).expect("the paper's sensor");
        let solver = Decoupled::<T, BicchiDario, 6>::new(&sensor).expect("decoupled");
        let name = "Decoupled against its own bound";
        rows.push(own_bound(name, case, &sensor, &solver, trials, &mut random));
        let solver = GaussianElimination::new(&sensor).expect("regular");
        let name = "GaussianElimination against its own bound";
        rows.push(own_bound(name, case, &sensor, &solver, trials, &mut random));
    }
    let sensor = paper::<T>(0.0, &mut random).expect("the paper's sensor");
    macro_rules! bad {
        ($name:literal, $solver:expr) => {
            bad_signals::<T, 6, _>($name, &$solver.expect("regular"), rows);
        };
    }
    bad!("GaussianElimination", GaussianElimination::new(&sensor));
    bad!("Refined (steps)", Refined::new(&sensor));
    bad!("Inverse", Inverse::new(&sensor));
    bad!("LeastSquares, 6 gauges", LeastSquares::new(&sensor));
    bad!("Decoupled against its own bound", Decoupled::<T, BicchiDario, 6>::new(&sensor));
}
