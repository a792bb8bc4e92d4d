//! How exact the least grip is, by what was asked for.

use fingertip_hand::{FingerLimits, Grasp, GripOutcome, LeastGrip, Precision};
use fingertip_wrench::{Real, Wrench};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{narrow, places, vector};

/// However much is asked for: what is said to hold is as exact as a thirty-second of it, and states what it misses.
fn as_exact_as_asked<T: Real>(tolerance: f64) {
    let mut rng = Pcg64Mcg::seed_from_u64(34);
    let (mut held, mut not, mut undecided) = (0, 0, 0);
    for index in 0..600 {
        let touching = rng.random_range(2..=5);
        let grasp = Grasp::new(places::<5>(&mut rng, touching).map(|p| p.map(|p| p.contact::<T>())));
        let (force, about) = (vector(&mut rng) * 3.0, grasp.centre() + narrow::<T>(vector(&mut rng) * 0.02));
        let load = Wrench::from_force_at(&about, narrow(force));
        let mut least =
            LeastGrip::<T, 5, 0>::with_precision(Precision { tolerance: T::literal(tolerance), steps: 60 });
        match least.solve(&grasp, &[FingerLimits::none(); 5], &load) {
            GripOutcome::Held(grip) => {
                held += 1;
                // In the solver's units, in which the load is between 1 and 2.
                let tolerance = tolerance.max(64.0 * T::EPSILON.to_f64());
                let allowed = (32.0 * tolerance).min(2e-3).max(tolerance);
                let size = grip.cost.to_f64().max(1e-3 * force.norm());
                let gap = (grip.cost - grip.least_cost).abs().to_f64();
                assert!(gap <= 2.0 * allowed * size, "{index}: {gap} {grip:?}");
                let off = grip.imbalance.force().amax().to_f64();
                assert!(off <= 2.0 * allowed * force.norm(), "{index}: {off} {grip:?}");
            }
            GripOutcome::CannotHold(_) => not += 1,
            _ => undecided += 1,
        }
    }
    println!("{held} held, {not} not, {undecided} undecided");
    // Beyond what rounding leaves the best is given as it is, or nothing.
    assert!(held > if tolerance > 0.0 { 200 } else { 10 } && not > 50, "{held} {not} {undecided}");
}

#[test]
fn what_is_held_is_as_exact_as_asked() {
    for tolerance in [1e-2, 1e-5, 1e-8, 1e-11, 0.0] {
        as_exact_as_asked::<f64>(tolerance);
    }
    for tolerance in [1e-2, 1e-3, 0.0] {
        as_exact_as_asked::<f32>(tolerance);
    }
}

/// The stated least cost is one however roughly the grip was looked for: none that a finer search finds is below it.
#[test]
fn the_least_cost_is_a_bound_at_any_tolerance() {
    let mut rng = Pcg64Mcg::seed_from_u64(37);
    let (mut held, mut rough) = (0, 0);
    for index in 0..1_000 {
        let crate::support::Problem { grasp, limits, load } = crate::support::problem::<5>(&mut rng);
        let GripOutcome::Held(fine) = LeastGrip::new().solve(&grasp, &limits, &load) else { continue };
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let mut least = LeastGrip::with_precision(Precision { tolerance, steps: 30 });
            let GripOutcome::Held(grip) = least.solve(&grasp, &limits, &load) else { continue };
            held += 1;
            rough += u32::from(grip.gap() > 1e-4);
            assert!(
                grip.least_cost <= fine.cost * (1.0 + 1e-7),
                "{index}: {} {}",
                grip.least_cost,
                fine.cost
            );
        }
    }
    assert!(held > 600 && rough > 300, "{held} {rough}");
}

/// What is forgotten is not started from: the answer is that of a new one to the last bit.
#[test]
fn what_is_forgotten_is_not_started_from() {
    let mut rng = Pcg64Mcg::seed_from_u64(38);
    let mut differ = 0;
    for _ in 0..30 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        let limits = [FingerLimits::<f64, 0>::none(); 4];
        let load = Wrench::from_force_at(&grasp.centre(), vector(&mut rng));
        let mut least = LeastGrip::new();
        let fresh = least.solve(&grasp, &limits, &load);
        let again = least.solve(&grasp, &limits, &load);
        differ += u32::from(again != fresh);
        least.forget();
        assert_eq!(least.solve(&grasp, &limits, &load), fresh);
    }
    assert!(differ > 10, "{differ}");
}

/// A hand that lets go of much and takes up little, or the other way, gets as exact an answer as one that starts anew.
#[test]
fn what_was_held_before_does_not_blunt_the_next() {
    let mut rng = Pcg64Mcg::seed_from_u64(35);
    let touching = 4;
    let grasp = Grasp::new(places::<4>(&mut rng, touching).map(|p| p.map(|p| p.contact::<f64>())));
    let limits = [FingerLimits::<f64, 0>::none(); 4];
    let load = Wrench::from_force_at(&grasp.centre(), grasp.contacts()[0].unwrap().normal() * -1.0);
    let unit = LeastGrip::new().solve(&grasp, &limits, &load).grip().unwrap().cost;
    for power in -20..=20 {
        for other in [-power, power / 2, power + 1, power + 3, power - 4] {
            let (first, second) = (2_f64.powi(power), 2_f64.powi(other));
            let mut least = LeastGrip::new();
            assert!(least.solve(&grasp, &limits, &(load * first)).grip().is_some());
            let found = least.solve(&grasp, &limits, &(load * second));
            let grip = found.grip().unwrap();
            assert!((grip.cost / (unit * second) - 1.0).abs() < 1e-7, "{first} {second}: {}", grip.cost);
            assert!(
                grip.gap() < 1e-7 && grip.imbalance.force().amax() < 1e-7 * second,
                "{first} {second}: {grip:?}"
            );
        }
    }
}

/// Where limits are what holds the forces, a start from the last solution saves as many steps as where friction does.
#[test]
fn limits_that_are_met_are_started_from() {
    let mut rng = Pcg64Mcg::seed_from_u64(36);
    let (mut warm_steps, mut cold_steps, mut met) = (0, 0, 0);
    for _ in 0..60 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        let limits = FingerLimits::<f64, 2>::none().with_least_normal(1.0).unwrap();
        let limits = [limits.with_greatest_normal(60.0).unwrap(); 4];
        let mut warm = LeastGrip::new();
        let load = Wrench::from_force_at(&grasp.centre(), vector(&mut rng));
        for sample in 0..12 {
            let load = load * (1.0 + 1e-3 * f64::from(sample));
            let (again, fresh) =
                (warm.solve(&grasp, &limits, &load), LeastGrip::new().solve(&grasp, &limits, &load));
            if let (GripOutcome::Held(again), GripOutcome::Held(fresh)) = (again, fresh) {
                assert!((again.cost / fresh.cost - 1.0).abs() < 1e-7);
                met += u32::from(again.forces.iter().any(|force| force.normal < 1.0 + 1e-6));
                if sample > 0 {
                    (warm_steps, cold_steps) = (warm_steps + again.steps, cold_steps + fresh.steps);
                }
            }
        }
    }
    println!("{warm_steps} steps warm, {cold_steps} cold; {met} met");
    assert!(met > 100 && warm_steps * 2 < cold_steps, "{met} {warm_steps} {cold_steps}");
}

/// Where a start from the last solution comes to no end within the steps that are allowed, it is begun anew, and the steps
/// that were lost count.
#[test]
fn steps_that_were_lost_are_counted() {
    let mut rng = Pcg64Mcg::seed_from_u64(39);
    let mut anew = 0;
    for _ in 0..400 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        let limits = [FingerLimits::<f64, 0>::none(); 4];
        let precision = Precision { tolerance: 1e-8, steps: 6 };
        let load = |rng: &mut Pcg64Mcg| Wrench::from_force_at(&grasp.centre(), vector(rng).normalize());
        let (first, second) = (load(&mut rng), load(&mut rng));
        let mut least = LeastGrip::with_precision(precision);
        least.solve(&grasp, &limits, &first);
        let again = least.solve(&grasp, &limits, &second);
        let fresh = LeastGrip::with_precision(precision).solve(&grasp, &limits, &second);
        if let (GripOutcome::Held(again), GripOutcome::Held(fresh)) = (again, fresh) {
            assert!(again.steps <= 2 * precision.steps);
            if again.forces == fresh.forces && least != LeastGrip::with_precision(precision) {
                anew += u32::from(again.steps > fresh.steps);
                assert!(
                    again.steps == fresh.steps || again.steps > precision.steps,
                    "{} {}",
                    again.steps,
                    fresh.steps
                );
            }
        }
    }
    println!("{anew} anew");
    assert!(anew > 0);
}
