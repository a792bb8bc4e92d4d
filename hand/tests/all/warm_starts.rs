//! The least grip again from the last solution: the same answer in fewer steps.

use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip, Precision};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::clarabel_oracle::{self, Oracle};
use crate::support::{Problem, TestHand, problem, vector};

/// Starting from the last solution changes nothing but the number of steps.
#[test]
fn warm_starts_agree_with_cold_ones() {
    let mut rng = Pcg64Mcg::seed_from_u64(32);
    let (mut warm_steps, mut cold_steps, mut samples) = (0, 0, 0);
    for _ in 0..60 {
        let Problem { grasp, limits, load } = problem::<5>(&mut rng);
        let mut warm = LeastGrip::new();
        let mut load = load;
        let mut places = grasp.contacts().map(|c| c.map(|c| (c.place(), c.normal())));
        for _ in 0..40 {
            // As in a sample of 1 ms; now and then a jump.
            let jump = if rng.random_range(0..15) == 0 { 30.0 } else { 1.0 };
            load =
                load + Wrench::on_fingertip(vector(&mut rng) * 0.02 * jump, vector(&mut rng) * 1e-4 * jump);
            for (point, normal) in places.iter_mut().flatten() {
                *point += vector(&mut rng) * 2e-5 * jump;
                *normal += vector(&mut rng) * 1e-3 * jump;
            }
            let mut contacts = [None; 5];
            for ((contact, place), old) in contacts.iter_mut().zip(&places).zip(grasp.contacts()) {
                if let (Some((point, normal)), Some(old)) = (place, old) {
                    *contact = GraspContact::soft(*point, *normal, old.friction(), old.arm().max(1e-3)).ok();
                }
            }
            let grasp = Grasp::new(contacts);
            let again = warm.solve(&grasp, &limits, &load);
            let fresh = LeastGrip::new().solve(&grasp, &limits, &load);
            match (again, fresh) {
                (GripOutcome::Held(a), GripOutcome::Held(b)) => {
                    assert!((a.cost / b.cost - 1.0).abs() < 1e-6, "{} {}", a.cost, b.cost);
                    warm_steps += a.steps;
                    cold_steps += b.steps;
                    samples += 1;
                }
                (GripOutcome::CannotHold(_), GripOutcome::CannotHold(_)) => {}
                other => panic!("{other:?}"),
            }
        }
    }
    println!("{samples} samples: {warm_steps} steps warm, {cold_steps} cold");
    assert!(samples > 800 && warm_steps * 3 < cold_steps * 2 && warm_steps < 4 * samples);
}

/// A finger more or less, another load, no load: what was remembered does not matter.
#[test]
fn what_was_remembered_never_matters() {
    let mut rng = Pcg64Mcg::seed_from_u64(33);
    let mut one = LeastGrip::new();
    for _ in 0..500 {
        let mut problem = problem::<4>(&mut rng);
        problem.load = problem.load * 10.0_f64.powf(rng.random_range(-3.0..3.0));
        let (again, fresh) = (
            one.solve(&problem.grasp, &problem.limits, &problem.load),
            LeastGrip::new().solve(&problem.grasp, &problem.limits, &problem.load),
        );
        match (again, fresh) {
            (GripOutcome::Held(a), GripOutcome::Held(b)) => assert!((a.cost / b.cost - 1.0).abs() < 1e-6),
            (GripOutcome::CannotHold(_), GripOutcome::CannotHold(_)) => {}
            other => match clarabel_oracle::solve(&problem.grasp, &problem.limits, &problem.load) {
                Oracle::Unclear => {}
                oracle => panic!("{other:?} {oracle:?}"),
            },
        }
    }
}

/// What ends without a grip, or is forgotten, leaves nothing to start from: the next grip takes as many steps as at first.
#[test]
fn after_a_load_that_was_not_held_it_starts_afresh() {
    let mut rng = Pcg64Mcg::seed_from_u64(34);
    let (mut undecided, mut cannot, mut forgotten) = (0, 0, 0);
    for _ in 0..400 {
        let Problem { grasp, limits, load } = problem::<4>(&mut rng);
        // Steps for most loads, but not for all.
        let mut least =
            LeastGrip::with_precision(Precision { steps: rng.random_range(4..8), ..Precision::usual() });
        let GripOutcome::Held(first) = least.solve(&grasp, &limits, &load) else { continue };
        let turned = Wrench::on_fingertip(load.force().yzx() * 1.3, load.torque().zxy());
        match least.solve(&grasp, &limits, &turned) {
            GripOutcome::Undecided => undecided += 1,
            GripOutcome::CannotHold(_) => cannot += 1,
            _ => {
                least.forget();
                forgotten += 1;
            }
        }
        let GripOutcome::Held(again) = least.solve(&grasp, &limits, &load) else { panic!("{first:?}") };
        assert_eq!(again, first);
    }
    assert!(undecided > 1 && cannot > 1 && forgotten > 1, "{undecided} {cannot} {forgotten}");
}

/// Nor does a grip whose cost lies beyond the range of the type, though its forces are those of the one before.
#[test]
fn after_a_cost_beyond_the_range_it_starts_afresh() {
    let at = |side: f64| GraspContact::soft(Vector3::x() * side, Vector3::x() * -side, 0.5, 1e-3).ok();
    let grasp = Grasp::<f64, 2, TestHand>::new([at(0.02), at(-0.02)]);
    let usual = FingerLimits::<f64, 1>::none();
    let costly = usual.with_cost(1e200).unwrap();
    let load = Wrench::on_fingertip(Vector3::z() * 1e200, Vector3::zeros());
    let mut least = LeastGrip::new();
    let first = least.solve(&grasp, &[usual; 2], &load);
    let mut again = least;
    let GripOutcome::Held(warm) = again.solve(&grasp, &[usual; 2], &load) else { panic!() };
    assert!(first.grip().is_some_and(|grip| warm.steps < grip.steps), "{first:?} {warm:?}");
    assert_eq!(least.solve(&grasp, &[costly; 2], &load), GripOutcome::NotFinite);
    assert_eq!(least.solve(&grasp, &[usual; 2], &load), first);
}
