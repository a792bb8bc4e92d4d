//! Creep: times and shares found from load cycles, what they leave of cycles never seen, and what has none.

use fingertip_calibration::Axis;
use fingertip_calibration::creep::{Creep, CreepError, fit};
use fingertip_calibration::file::SignalUnit;
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use crate::random::gaussian;

/// Six gauges of which each answers to all axes.
fn sensitivities() -> DMatrix<f64> {
    DMatrix::from_fn(6, 6, |i, j| if i == j { 1.0 } else { 0.2 * ((3 * i + 5 * j) as f64).sin() })
}

/// One solid of the sensor: its time \[s\], and the share that a lasting load adds to each gauge.
type Solid = (f64, [f64; 6]);

/// Loads that rise in 2 s, stay, fall and are gone for a while, another one each cycle.
fn load(cycle: usize, phase: f64) -> DVector<f64> {
    let height = (phase / 2.0).min((34.0 - phase) / 2.0).clamp(0.0, 1.0);
    DVector::from_fn(6, |axis, _| {
        height * [10.0, 10.0, 20.0, 0.2, 0.2, 0.1][axis] * ((1 + axis + cycle * (2 * axis + 3)) as f64).sin()
    })
}

/// Readings of a sensor that creeps, by Euler's rule in very small steps: `y = s + Σ a z`, `θ ż = s − z`.
struct Session {
    table: LoadTable,
    /// The readings that the loads alone would give.
    without: DMatrix<f64>,
}

fn session(random: &mut Pcg64Mcg, solids: &[Solid], cycles: usize, step: f64, noise: f64) -> Session {
    const PERIOD: f64 = 54.0;
    const FINE: usize = 200;
    let full = DVector::from_vec(vec![10.0, 10.0, 20.0, 0.2, 0.2, 0.1]);
    let signal = |time: f64| {
        let time = time - 4.0;
        let cycle = (time / PERIOD).floor().max(0.0);
        let load = load(cycle as usize, if time < 0.0 { 0.0 } else { time - cycle * PERIOD });
        (sensitivities() * load.component_div(&full), load)
    };
    let samples = ((4.0 + PERIOD * cycles as f64) / step) as usize;
    let (mut loads, mut readings) = (DMatrix::zeros(samples, 6), DMatrix::zeros(samples, 6));
    let mut without = DMatrix::zeros(samples, 6);
    let zero = |gauge: usize| 0.3 * (gauge as f64 - 2.0);
    let mut states = vec![DVector::<f64>::zeros(6); solids.len()];
    for sample in 0..samples {
        let time = sample as f64 * step;
        let (clean, load) = signal(time);
        for gauge in 0..6 {
            let crept: f64 = solids.iter().zip(&states).map(|((_, a), z)| a[gauge] * z[gauge]).sum();
            without[(sample, gauge)] = zero(gauge) + clean[gauge];
            readings[(sample, gauge)] = zero(gauge) + clean[gauge] + crept + noise * gaussian(random);
            loads[(sample, gauge)] = load[gauge];
        }
        for fine in 0..FINE {
            let h = step / FINE as f64;
            let (clean, _) = signal(time + h * (fine as f64 + 0.5));
            for ((theta, _), state) in solids.iter().zip(&mut states) {
                *state += (&clean - &*state) * (h / theta);
            }
        }
    }
    let mut table = LoadTable::new(&Axis::ALL, loads, readings, SignalUnit::Volt).unwrap();
    table.times = Some((0..samples).map(|sample| sample as f64 * step).collect());
    Session { table, without }
}

const SLOW: Solid = (25.0, [0.02, 0.018, 0.025, 0.01, 0.015, 0.02]);
const QUICK: Solid = (3.0, [0.01, 0.012, 0.008, 0.01, 0.009, 0.011]);

#[test]
fn times_and_shares_of_a_solid_are_found() {
    let random = &mut Pcg64Mcg::seed_from_u64(61);
    let session = session(random, &[SLOW], 8, 0.5, 1e-4);
    let found = fit(&session.table, false).unwrap();
    assert_eq!((found.creep.times_s.len(), found.cycles), (1, 8));
    let time = found.creep.times_s[0];
    for gauge in 0..6 {
        let (share, a) = (found.creep.shares[0][gauge], SLOW.1[gauge]);
        // y/s is 1 + a/(1 + θp): of which the inverse is 1 − b/(1 + τp).
        assert!((share - a / (1.0 + a)).abs() < 5e-4, "gauge {gauge}: {share}");
        assert!(found.deviations[0][gauge] > 0.0 && found.deviations[0][gauge] < 3e-4);
    }
    assert!((time - SLOW.0 / 1.018).abs() < 1.0, "{time}");
    let [before, after] = found.left_out_percent;
    assert!(before > 10.0 * after, "{before} {after}");
    // Weights that are all alike weigh nothing.
    let weights = Some(vec![4.0; session.table.samples()]);
    let weighed = fit(&LoadTable { weights, ..session.table }, false).unwrap();
    for (one, other) in weighed.left_out_percent.iter().zip(found.left_out_percent) {
        assert!((one / other - 1.0).abs() < 1e-6, "{one} {other}");
    }
    assert!((weighed.creep.times_s[0] / time - 1.0).abs() < 1e-4, "{:?}", weighed.creep);
}

#[test]
fn two_solids_are_taken_off_to_their_noise() {
    let random = &mut Pcg64Mcg::seed_from_u64(62);
    let session = session(random, &[SLOW, QUICK], 10, 0.25, 1e-4);
    let found = fit(&session.table, false).unwrap();
    assert_eq!(found.creep.times_s.len(), 2, "{:?}", found.creep.times_s);
    let corrected = found.creep.taken_off(&session.table).unwrap();
    let rms = |table: &LoadTable| {
        let error = &table.signals - &session.without;
        (error.norm_squared() / error.len() as f64).sqrt()
    };
    assert!(
        rms(&corrected) < 1.2e-4 && rms(&session.table) > 3e-3,
        "{} {}",
        rms(&corrected),
        rms(&session.table)
    );
    // What is left of cycles that were left out is the noise, in spans of some 1.5.
    assert!(found.left_out_percent[1] < 0.02, "{:?}", found.left_out_percent);
}

#[test]
fn a_sensor_that_does_not_creep_is_left_as_it_is() {
    for seed in 70..82 {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let session = session(random, &[], 6, 1.0, 1e-3);
        let found = fit(&session.table, false).unwrap();
        assert_eq!(found.creep, Creep::default(), "seed {seed}");
        assert_eq!(found.left_out_percent[0], found.left_out_percent[1]);
        assert_eq!(found.creep.taken_off(&session.table).unwrap().signals, session.table.signals);
    }
}

/// A curve that is no creep must not be taken for one, nor one for the other.
#[test]
fn a_curved_sensor_creeps_as_a_straight_one() {
    let random = &mut Pcg64Mcg::seed_from_u64(63);
    let mut session = session(random, &[SLOW], 12, 0.5, 1e-4);
    let loads = &session.table.loads;
    let bend = DMatrix::from_fn(loads.nrows(), 6, |i, _| 0.1 * (loads[(i, 2)] / 20.0).powi(2));
    session.table.signals += bend;
    let found = fit(&session.table, true).unwrap();
    assert_eq!(found.creep.times_s.len(), 1);
    assert!((found.creep.times_s[0] - 24.6).abs() < 2.5, "{:?}", found.creep.times_s);
    for (share, a) in found.creep.shares[0].iter().zip(SLOW.1) {
        assert!((share - a / (1.0 + a)).abs() < 3e-3, "{share} for {a}");
    }
}

#[test]
fn a_gauge_that_never_changes_spoils_nothing() {
    let random = &mut Pcg64Mcg::seed_from_u64(65);
    let mut session = session(random, &[SLOW], 12, 0.5, 1e-4);
    let whole = fit(&session.table, false).unwrap().creep;
    session.table.signals.column_mut(5).fill(0.7);
    let found = fit(&session.table, false).unwrap().creep;
    assert_eq!(found.times_s.len(), 1);
    assert!((found.times_s[0] / whole.times_s[0] - 1.0).abs() < 0.05, "{found:?} {whole:?}");
    for gauge in 0..5 {
        assert!((found.shares[0][gauge] - whole.shares[0][gauge]).abs() < 2e-3, "{found:?} {whole:?}");
    }
    assert!(found.shares[0][5].abs() < 1e-9, "{found:?}");
}

#[test]
fn what_tells_nothing_of_creep_is_refused() {
    let random = &mut Pcg64Mcg::seed_from_u64(64);
    let good = session(random, &[SLOW], 4, 1.0, 1e-4).table;
    assert!(fit(&good, false).is_ok());
    let without = LoadTable { times: None, ..good.clone() };
    assert_eq!(fit(&without, false), Err(CreepError::NoTimes));
    let mut back = good.clone();
    back.times.as_mut().unwrap()[7] = -1.0;
    assert_eq!(fit(&back, false), Err(CreepError::TimeGoesBack { sample: "sample 8".to_owned() }));
    let loaded = good.select(|sample| sample > 20);
    assert_eq!(fit(&loaded, false), Err(CreepError::BeginsLoaded { sample: "sample 22".to_owned() }));
    let few = good.select(|sample| sample < 100);
    assert_eq!(fit(&few, false), Err(CreepError::TooFewCycles { found: 2, needed: 3 }));
    // All at the same time, and times too far apart.
    let at_once = LoadTable { times: Some(vec![3.0; good.samples()]), ..good.clone() };
    assert_eq!(fit(&at_once, false), Err(CreepError::TooCoarse));
    let sparse = good.select(|sample| sample % 22 == 0);
    assert!(matches!(fit(&sparse, false), Err(CreepError::TooCoarse)), "{:?}", fit(&sparse, false));
    let creep = Creep { times_s: vec![3.0], shares: vec![vec![0.1; 5]] };
    assert_eq!(creep.taken_off(&good), Err(CreepError::OtherGauges { expected: 6 }));
}

/// Groups begin anew, whatever the clock says, and each has a zero of its own.
#[test]
fn groups_are_sessions_of_their_own() {
    let random = &mut Pcg64Mcg::seed_from_u64(65);
    let [first, second] = [(); 2].map(|()| session(random, &[SLOW], 4, 0.5, 1e-4));
    let mut shifted = second.table.clone();
    shifted.signals.add_scalar_mut(5.0);
    let both = LoadTable::merged(&[first.table.clone(), shifted]).unwrap();
    let found = fit(&both, false).unwrap();
    assert_eq!((found.cycles, found.creep.times_s.len()), (8, 1));
    let corrected = found.creep.taken_off(&both).unwrap();
    let half = first.table.samples();
    for sample in 0..half {
        for gauge in 0..6 {
            let off = corrected.signals[(sample, gauge)] - first.without[(sample, gauge)];
            let other = corrected.signals[(half + sample, gauge)] - 5.0 - second.without[(sample, gauge)];
            assert!(off.abs() < 8e-4 && other.abs() < 8e-4, "{sample}: {off} {other}");
        }
    }
}

/// The zero of a session is found beside all else: what disturbs the rest that it begins with moves neither time nor share.
#[test]
fn a_zero_that_was_read_badly_is_found_anew() {
    let random = &mut Pcg64Mcg::seed_from_u64(66);
    let session = session(random, &[SLOW], 8, 0.5, 1e-4);
    let plain = fit(&session.table, false).unwrap();
    let mut disturbed = session.table.clone();
    // The first reading of eight at rest, which does not count: the zero of the group is off by an eighth of it.
    disturbed.signals.row_mut(0).add_scalar_mut(0.2);
    disturbed.weights = Some((0..disturbed.samples()).map(|row| if row == 0 { 1e-9 } else { 1.0 }).collect());
    let found = fit(&disturbed, false).unwrap();
    let (time, other) = (plain.creep.times_s[0], found.creep.times_s[0]);
    assert!(found.creep.times_s.len() == 1 && (other / time - 1.0).abs() < 0.15, "{other} and not {time}");
    for (share, other) in plain.creep.shares[0].iter().zip(&found.creep.shares[0]) {
        assert!((other - share).abs() < 0.15 * share.abs(), "{other} and not {share}");
    }
}
