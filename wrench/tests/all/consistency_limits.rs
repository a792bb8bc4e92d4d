//! Where a residual stops being noise: limits by their definition, faults at the very ends of a range.

use crate::support::{generator, greatest, of_condition, random_vector, sensor};
use fingertip_wrench::{
    BadCheck, ConsistencyCheck, DriftMonitor, Fault, LeastSquares, SensorMatrix, Verdict,
};
use nalgebra::{SMatrix, SVector, Vector6};

const GAUGES: usize = 12;
type Signals = SVector<f64, GAUGES>;

/// Standard deviations that all differ.
fn noise() -> Signals {
    Signals::from_fn(|gauge, _| 1e-3 * (1.0 + 0.25 * gauge as f64))
}

fn watched() -> (SensorMatrix<f64, GAUGES>, LeastSquares<f64, GAUGES>) {
    let sensor = sensor::<f64, GAUGES>(&of_condition::<GAUGES>(&mut generator(150), 3.0));
    let solver = LeastSquares::new(&sensor).expect("regular");
    (sensor, solver)
}

/// `I − C (CᵀC)⁻¹ Cᵀ`, which a condition number of 3 lets normal equations find.
fn complement(sensor: &SensorMatrix<f64, GAUGES>) -> SMatrix<f64, GAUGES, GAUGES> {
    let c = sensor.normalised();
    let gram = (c.transpose() * c).try_inverse().expect("regular");
    SMatrix::identity() - c * gram * c.transpose()
}

const RATE: f64 = 1e-3;

/// What a normal variable exceeds to one side with a 24th of that probability, by the inverse error function.
const DEVIATIONS: f64 = 3.934_605_861_560_757_6;

#[test]
fn limits_are_what_noise_makes_of_residuals() {
    let (sensor, solver) = watched();
    let projection = complement(&sensor);
    let limits = Signals::from_fn(|gauge, _| {
        let variance: f64 = (0..GAUGES).map(|j| (projection[(gauge, j)] * noise()[j]).powi(2)).sum();
        variance.sqrt() * DEVIATIONS
    });
    for scale in [1.0, 2.0_f64.powi(-500), 2.0_f64.powi(500)] {
        let check = ConsistencyCheck::new(&solver, &(noise() * scale), RATE).expect("valid");
        let off = (check.residual_limit() / scale).component_div(&limits).add_scalar(-1.0);
        assert!(greatest(&off) < 3e-9, "{off}");
    }
    let check = ConsistencyCheck::new(&solver, &noise(), RATE).expect("valid");
    let any = random_vector::<GAUGES>(&mut generator(151));
    // The signals of any load explain themselves; what is left of others, no load explains.
    let unexplained = projection * any;
    for gauge in 0..GAUGES {
        // As much of it as the gauge is allowed, if none is allowed less.
        let allowed = (0..GAUGES).map(|k| limits[k] / unexplained[k].abs()).fold(f64::INFINITY, f64::min);
        let load = solver_signals(&sensor, gauge);
        for sign in [1.0, -1.0] {
            let just = |share: f64| load + unexplained * (sign * share * allowed);
            assert_eq!(check.verdict(&solver, &just(0.999)), Verdict::Consistent);
            assert_ne!(check.verdict(&solver, &just(1.001)), Verdict::Consistent);
        }
    }
}

fn solver_signals(sensor: &SensorMatrix<f64, GAUGES>, axis: usize) -> Signals {
    let mut load = Vector6::repeat(0.25);
    load[axis % 6] = -0.5;
    sensor.normalised() * load
}

/// A sensor of which the first gauge alone is at fault, reading `value`; its true reading is 0.5.
fn fault_of(value: f64, range: Option<(f64, f64)>) -> (Fault, f64) {
    let (sensor, solver) = watched();
    let mut check = ConsistencyCheck::new(&solver, &noise(), RATE).expect("valid");
    if let Some((least, greatest)) = range {
        check = check.with_range(Signals::repeat(least), Signals::repeat(greatest));
    }
    let row = sensor.normalised().row(0).transpose();
    let load = row * (0.5 / row.norm_squared());
    let mut signals = sensor.normalised() * load;
    assert!((signals[0] - 0.5).abs() < 1e-15);
    signals[0] = value;
    match check.verdict(&solver, &signals) {
        Verdict::Faulty { gauge: 0, fault, error } => (fault, error),
        other => panic!("{value}: {other:?}"),
    }
}

#[test]
fn a_reading_exactly_at_the_rail_is_saturated() {
    let range = Some((-0.75, 1.25));
    for (value, fault) in [
        (1.25, Fault::Saturated),
        (1.5, Fault::Saturated),
        (1.25 - 1e-12, Fault::Deviating),
        (-0.75, Fault::Saturated),
        (-1.0, Fault::Saturated),
        (-0.75 + 1e-12, Fault::Deviating),
        (0.0, Fault::Dead),
        (f64::NAN, Fault::NotFinite),
        (f64::INFINITY, Fault::NotFinite),
    ] {
        let (found, error) = fault_of(value, range);
        assert_eq!(found, fault, "{value}");
        if value.is_finite() {
            assert!((error - (value - 0.5)).abs() < 1e-12, "{error}");
        } else {
            assert!(!error.is_finite());
        }
    }
    // A rail at zero outweighs death; without a range nothing is at a rail.
    assert_eq!(fault_of(0.0, Some((0.0, 2.0))).0, Fault::Saturated);
    assert_eq!(fault_of(0.0, Some((-2.0, 0.0))).0, Fault::Saturated);
    for value in [1.25, -0.75, 1e9, -1e9] {
        assert_eq!(fault_of(value, None).0, Fault::Deviating);
    }
    assert_eq!([fault_of(f64::MAX, None).0, fault_of(-f64::MAX, None).0], [Fault::Saturated; 2]);
}

#[test]
fn a_gauge_is_dead_while_noise_explains_what_it_reads() {
    let limit = noise()[0] * DEVIATIONS;
    for sign in [1.0, -1.0] {
        assert_eq!(fault_of(sign * limit * 0.999, None).0, Fault::Dead);
        assert_eq!(fault_of(sign * limit * 1.001, None).0, Fault::Deviating);
    }
}

/// Several gauges that would explain a fault are all suspects, and no other is.
#[test]
fn suspects_are_those_without_whom_the_others_agree() {
    // Six gauges of one load each, and a second and a third one of the first load.
    let matrix = SMatrix::<f64, 8, 6>::from_fn(|i, j| f64::from(u8::from(i % 7 == j || (i == 6 && j == 0))));
    let sensor = SensorMatrix::new(matrix, Vector6::repeat(1.0)).expect("proper");
    let solver = LeastSquares::new(&sensor).expect("regular");
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(1e-3), RATE).expect("valid");
    let mut signals = SVector::<f64, 8>::repeat(0.5);
    signals[6] = 0.8;
    // Gauges 0, 6 and 7 watch each other: two agree against one.
    match check.verdict(&solver, &signals) {
        Verdict::Faulty { gauge: 6, fault: Fault::Deviating, error } => assert!((error - 0.3).abs() < 1e-14),
        other => panic!("{other:?}"),
    }
    signals[7] = 0.8;
    assert!(matches!(check.verdict(&solver, &signals), Verdict::Faulty { gauge: 0, .. }));
    signals[7] = 0.2;
    assert_eq!(check.verdict(&solver, &signals), Verdict::Inconsistent);
    // A gauge of its own load can neither be suspected nor, if it breaks, be replaced.
    let mut broken = SVector::<f64, 8>::repeat(0.5);
    broken[3] = f64::NAN;
    assert_eq!(check.verdict(&solver, &broken), Verdict::Inconsistent);
    broken[3] = 0.9;
    assert_eq!(check.verdict(&solver, &broken), Verdict::Consistent);
    broken[0] = f64::NAN;
    assert!(matches!(
        check.verdict(&solver, &broken),
        Verdict::Faulty { gauge: 0, fault: Fault::NotFinite, .. }
    ));
}

/// Of six gauges none is watched, and any signals agree; none at all, too.
#[test]
fn six_gauges_agree_about_anything() {
    let sensor = sensor::<f64, 6>(&of_condition::<6>(&mut generator(153), 3.0));
    let solver = LeastSquares::new(&sensor).expect("regular");
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(1e-3), RATE).expect("valid");
    assert_eq!(*check.residual_limit(), Vector6::zeros());
    for signals in [SVector::zeros(), SVector::repeat(1.0), random_vector::<6>(&mut generator(154))] {
        assert_eq!(check.verdict(&solver, &signals), Verdict::Consistent);
    }
}

/// Large signals may leave residuals of their rounding.
#[test]
fn rounding_is_no_fault() {
    let (sensor, solver) = watched();
    let faint = ConsistencyCheck::new(&solver, &(noise() * 1e-20), RATE).expect("valid");
    let signals = solver_signals(&sensor, 2) * 1e3;
    assert_eq!(faint.verdict(&solver, &signals), Verdict::Consistent);
    // 48 rounding units of the largest signal, over the twelve gauges; a thousand are more.
    let mut off = signals;
    off[4] += 1e3 * f64::EPSILON * signals.amax();
    assert_ne!(faint.verdict(&solver, &off), Verdict::Consistent);
}

/// The mean that a drift monitor judges, by its definition: plain at first, then with the weight.
#[test]
fn a_drift_monitor_judges_the_weighted_mean() {
    let (sensor, solver) = watched();
    let (weight, settled) = (0.125, 16);
    let averaged = (weight / (2.0_f64 - weight)).sqrt();
    let mut monitor = DriftMonitor::new(&solver, &noise(), weight, RATE).expect("valid");
    let limits = ConsistencyCheck::new(&solver, &(noise() * averaged), RATE).expect("valid");
    let mut random = generator(152);
    let mut mean = Signals::zeros();
    let (mut none, mut consistent, mut other) = (0, 0, 0);
    for i in 1..=400 {
        // A fault of the fifth gauge that comes and goes.
        let mut signals = solver_signals(&sensor, i) * (0.1 * i as f64);
        signals += random_vector::<GAUGES>(&mut random).component_mul(&noise()) * 0.1;
        signals[5] += 1e-2 * (i as f64 * 0.05).sin();
        let share = (1.0 / i as f64).max(weight);
        mean = mean * (1.0 - share) + signals * share;
        let found = monitor.update(&solver, &signals);
        // A reading that is not finite changes nothing.
        let again = monitor.update(&solver, &Signals::repeat(f64::NAN));
        assert_eq!(found.is_some(), i >= settled, "{i}");
        match (found, limits.verdict(&solver, &mean)) {
            (None, _) => none += 1,
            (Some(Verdict::Consistent), wanted) => {
                assert_eq!((wanted, again), (Verdict::Consistent, found));
                consistent += 1;
            }
            (Some(Verdict::Faulty { gauge, fault, error }), wanted) => {
                let Verdict::Faulty { gauge: g, fault: f, error: e } = wanted else { panic!("{wanted:?}") };
                assert_eq!((gauge, fault), (g, f));
                assert!((error - e).abs() < 1e-12, "{error} {e}");
                other += 1;
            }
            (Some(found), wanted) => {
                assert_eq!(found, wanted);
                other += 1;
            }
        }
    }
    assert_eq!(none, settled - 1);
    assert!(consistent > 50 && other > 50, "{consistent} {other}");
}

#[test]
fn weights_and_rates_at_their_ends() {
    let (_, solver) = watched();
    let new = |weight: f64, rate: f64| DriftMonitor::new(&solver, &noise(), weight, rate).err();
    assert_eq!([new(1.0, 0.01), new(1e-9, 0.99)], [None; 2]);
    for (weight, rate) in
        [(0.0, 0.01), (-0.1, 0.01), (1.0 + 1e-9, 0.01), (f64::NAN, 0.01), (0.5, 0.0), (0.5, 1.0)]
    {
        assert_eq!(new(weight, rate), Some(BadCheck::BadRate));
    }
    for bad in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        for gauge in 0..GAUGES {
            let mut deviations = noise();
            deviations[gauge] = bad;
            let found = ConsistencyCheck::new(&solver, &deviations, 0.01).err();
            assert_eq!(found, Some(BadCheck::BadNoise { gauge }));
        }
    }
}
