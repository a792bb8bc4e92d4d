//! Searches of spaces whose minima are known by hand.

use core::f64::consts::{PI, TAU};
use core::sync::atomic::{AtomicU64, Ordering};

use fingertip_calibration::design::{
    Criterion, DesignError, DesignSpace, Findings, NominalLoads, Parameter, ParameterUnit, Search,
    choose_sites, search,
};
use fingertip_calibration::linear::Singular;
use fingertip_calibration::nalgebra::{DMatrix, Vector6};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::gaussian;

/// Six gauges, one for each load, of which the first is so many times as sensitive as the others: the condition
/// number is that, or its reciprocal.
struct OneStronger<F> {
    parameters: Vec<Parameter>,
    strength: F,
    calls: AtomicU64,
}

impl<F: Fn(&[f64]) -> Option<f64> + Sync> DesignSpace for OneStronger<F> {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn channels(&self) -> usize {
        6
    }

    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let strength = (self.strength)(values).ok_or(DesignError::Singular { reason: "no such sensor" })?;
        for (axis, row) in rows.iter_mut().enumerate() {
            *row = Vector6::ith(axis, if axis == 0 { strength } else { 1.0 });
        }
        Ok(())
    }
}

fn space<F: Fn(&[f64]) -> Option<f64> + Sync>(parameters: Vec<Parameter>, strength: F) -> OneStronger<F> {
    OneStronger { parameters, strength, calls: AtomicU64::new(0) }
}

fn found<F: Fn(&[f64]) -> Option<f64> + Sync>(space: &OneStronger<F>, starts: usize) -> Findings {
    let loads = NominalLoads::equal(1.0, 1.0).unwrap();
    let how = Search { starts, ..Search::default() };
    search(space, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap()
}

fn ratio(name: &str, lower: f64, upper: f64, tolerance: f64) -> Parameter {
    Parameter { unit: ParameterUnit::Ratio, tolerance, ..Parameter::length(name, lower, upper) }
}

#[test]
fn sensitivities_are_the_changes_by_a_tolerance_down_and_up() {
    let one = space(vec![ratio("p", -0.5, 1.0, 0.1)], |values| Some(1.0 + values[0]));
    let best = &found(&one, 3).minima[0];
    assert!(best.values[0].abs() < 1e-5 && (best.criterion - 1.0).abs() < 1e-5, "{best:?}");
    let change = best.sensitivities[0];
    assert!(
        (change.lower - (1.0 / 0.9 - 1.0)).abs() < 1e-4 && (change.higher - 0.1).abs() < 1e-4,
        "{change:?}"
    );
    // At the end of the range there is no lower.
    let end = space(vec![ratio("p", 0.2, 1.0, 0.1), ratio("q", 0.0, 1.0, 0.05)], |values| {
        Some(1.0 + values[0] + 2.0 * (values[1] - 0.5).abs())
    });
    let best = &found(&end, 3).minima[0];
    assert!((best.values[0] - 0.2).abs() < 1e-6 && (best.values[1] - 0.5).abs() < 1e-5, "{best:?}");
    let [p, q] = best.sensitivities[..] else { panic!("{best:?}") };
    assert!(p.lower.abs() < 1e-6 && (p.higher - 0.1).abs() < 1e-4, "{p:?}");
    assert!((q.lower - 0.1).abs() < 1e-4 && (q.higher - 0.1).abs() < 1e-4, "{q:?}");
}

#[test]
fn places_of_the_same_sensor_are_one_minimum() {
    // Least at 0, which is 2π too, and at π.
    let twice = space(vec![Parameter::periodic_angle("turn", TAU)], |values| {
        Some(1.5 - 0.5 * (2.0 * values[0]).cos())
    });
    let findings = found(&twice, 12);
    let [minimum] = &findings.minima[..] else { panic!("{findings:?}") };
    assert_eq!((minimum.starts, minimum.share, findings.failed), (12, 1.0, 0));
    let [other] = &minimum.equivalents[..] else { panic!("{minimum:?}") };
    let apart = (minimum.values[0] - other[0]).rem_euclid(TAU);
    assert!((apart - PI).abs() < 0.02, "{minimum:?}");
    // Of a parameter that is no angle, the ends are as far apart as they can be.
    let ends = space(vec![ratio("p", 0.0, 1.0, 0.01)], |values| Some(1.5 - 0.5 * (TAU * values[0]).cos()));
    let findings = found(&ends, 12);
    let [minimum] = &findings.minima[..] else { panic!("{findings:?}") };
    let [other] = &minimum.equivalents[..] else { panic!("{minimum:?}") };
    assert!(((minimum.values[0] - other[0]).abs() - 1.0).abs() < 0.02, "{minimum:?}");
    assert_eq!(minimum.spectrum.len(), 6);
    assert!(minimum.spectrum.iter().all(|value| (value - 1.0).abs() < 1e-4), "{minimum:?}");
}

/// Sensors that are as good, but not the same one turned: one gauge is twice as sensitive as the others, or half.
#[test]
fn sensors_of_other_singular_values_are_other_minima() {
    let two = space(vec![Parameter::periodic_angle("turn", TAU)], |values| {
        let (sin, cos) = values[0].sin_cos();
        let number = 2.0 + sin * sin;
        Some(if cos > 0.0 { number } else { number.recip() })
    });
    let findings = found(&two, 12);
    let [first, second] = &findings.minima[..] else { panic!("{findings:?}") };
    assert_eq!(first.starts + second.starts, 12);
    for minimum in [first, second] {
        let others = if minimum.values[0].cos() > 0.0 { 0.5 } else { 1.0 };
        let expected = [1.0, others, others, others, others, 0.5];
        assert!((minimum.criterion - 2.0).abs() < 1e-6 && minimum.equivalents.is_empty(), "{minimum:?}");
        assert!(minimum.spectrum.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{minimum:?}");
    }
    // What does not differ at all is the same, where nothing else is.
    let flat = space(vec![ratio("p", 0.0, 1.0, 0.1)], |_| Some(1.5));
    let loads = NominalLoads::equal(1.0, 1.0).unwrap();
    let how = Search { starts: 5, same: 0.0, ..Search::default() };
    let findings = search(&flat, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
    assert_eq!(findings.minima.iter().map(|minimum| minimum.starts).collect::<Vec<_>>(), [5]);
}

#[test]
fn every_minimum_is_told_with_its_share() {
    // 1 at 0, and 1.3 at π, where the other one is not seen.
    let two = space(vec![Parameter::periodic_angle("turn", TAU)], |values| {
        let (sin, cos) = values[0].sin_cos();
        Some(1.15 - 0.15 * cos + 0.5 * sin * sin)
    });
    let findings = found(&two, 16);
    let [first, second] = &findings.minima[..] else { panic!("{findings:?}") };
    assert!((first.criterion - 1.0).abs() < 1e-6 && (second.criterion - 1.3).abs() < 1e-6);
    assert!((second.values[0] - PI).abs() < 1e-3 && first.values[0].sin().abs() < 1e-3);
    assert_eq!(first.starts + second.starts, 16);
    for minimum in [first, second] {
        assert!(
            (minimum.share - minimum.starts as f64 / 16.0).abs() < 1e-15 && minimum.equivalents.is_empty()
        );
    }
    // Singular values over the largest, which is the first gauge's.
    assert!((second.spectrum[0] - 1.0).abs() < 1e-12 && (second.spectrum[5] - 1.0 / 1.3).abs() < 1e-6);
    // What was computed: for every start, and beside that the spectrum of its end; for every minimum the criterion
    // there and a tolerance away to both sides.
    assert_eq!(two.calls.load(Ordering::Relaxed), findings.evaluations + 16 + 2 * 3);
}

#[test]
fn starts_that_find_no_sensor_are_counted() {
    // A hundred draws hit a hundredth of the range in some two of three cases.
    let rare = space(vec![ratio("p", 0.0, 1.0, 1e-4)], |values| {
        (0.5..0.515).contains(&values[0]).then_some(1.0 + values[0])
    });
    let findings = found(&rare, 40);
    let ended: usize = findings.minima.iter().map(|minimum| minimum.starts).sum();
    assert_eq!(ended + findings.failed, 40);
    assert!((4..30).contains(&findings.failed), "{}", findings.failed);
    assert!((findings.minima[0].criterion - 1.5).abs() < 1e-4, "{:?}", findings.best());
    let share: f64 = findings.minima.iter().map(|minimum| minimum.share).sum();
    assert!((share - ended as f64 / 40.0).abs() < 1e-12);
}

/// A crease, which a smooth search only comes near; of one parameter as of more.
#[test]
fn a_crease_is_met_sharply() {
    for count in 1..=3 {
        let names = ["p", "q", "r"];
        let parameters = names[..count].iter().map(|name| ratio(name, 0.0, 1.0, 0.1)).collect();
        let creased = space(parameters, |values| {
            let off = values.iter().enumerate().map(|(i, value)| (value - 0.3 - 0.1 * i as f64).abs());
            Some(1.2 + off.sum::<f64>())
        });
        for minimum in &found(&creased, 4).minima {
            assert!((minimum.criterion - 1.2).abs() < 1e-6, "{count}: {minimum:?}");
        }
    }
}

/// What is chosen cannot be mended by the exchange of one gauge for any other.
#[test]
fn no_exchange_mends_the_chosen_gauges() {
    let random = &mut Pcg64Mcg::seed_from_u64(23);
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let nominal = loads.components();
    let criterion = Criterion::ConditionNumber;
    for count in [6, 7, 9] {
        let candidates: Vec<Vector6<f64>> =
            (0..13).map(|_| Vector6::from_fn(|_, _| gaussian(random)).component_div(&nominal)).collect();
        let number = |chosen: &[usize]| {
            let rows = DMatrix::from_fn(chosen.len(), 6, |i, j| candidates[chosen[i]][j] * nominal[j]);
            Singular::new(&rows).unwrap().condition_number()
        };
        let chosen = choose_sites(&candidates, count, &criterion, &loads).unwrap();
        assert!(chosen.len() == count && chosen.windows(2).all(|pair| pair[0] < pair[1]), "{chosen:?}");
        let own = number(&chosen);
        for set in (0..1_u32 << 13).filter(|set| set.count_ones() as usize == count) {
            let others: Vec<usize> = (0..13).filter(|i| set >> i & 1 == 1).collect();
            let shared = others.iter().filter(|i| chosen.contains(i)).count();
            assert!(shared + 1 < count || number(&others) > own * (1.0 - 1e-8), "{chosen:?} {others:?}");
        }
    }
}
