//! Margins, reach, force closure and the ball, against formulas, other programs and many directions.

use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, Hand, LeastGrip, Metric, Reach};
use fingertip_wrench::{ContactForce, Wrench};
use nalgebra::{Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::clarabel_oracle::{self, OracleReach};
use crate::support::{Problem, TestHand, places, problem, vector};

/// Just below the reach the least grip exists; just above it does not.
#[test]
fn reach_is_where_the_least_grip_ends() {
    let mut rng = Pcg64Mcg::seed_from_u64(11);
    let (mut finite, mut unlimited, mut not, mut undecided) = (0, 0, 0, 0);
    for index in 0..400 {
        let Problem { grasp, limits, load } = problem::<5>(&mut rng);
        let disturbance =
            Wrench::from_force_at(&(grasp.centre() + vector(&mut rng) * 0.02), vector(&mut rng));
        let held = |times: f64| {
            let load = load + disturbance * times;
            match LeastGrip::new().solve(&grasp, &limits, &load) {
                GripOutcome::Held(_) => Some(true),
                GripOutcome::CannotHold(_) => Some(false),
                GripOutcome::Undecided => None,
                GripOutcome::NotFinite => panic!("{index}: these are numbers"),
            }
        };
        match grasp.reach(&limits, &load, &disturbance) {
            Reach::Times(times) => {
                finite += 1;
                let step = 1e-3 * (times + 0.1 * load.force().norm() / disturbance.force().norm());
                let (below, above) = (held((times - step).max(0.0)), held(times + step));
                // What is held is an interval: it begins at nothing if nothing more is held.
                assert!(held(0.0) != Some(true) || below != Some(false), "{index}: {times}");
                assert!(above != Some(true), "{index}: {times}");
                undecided += u32::from(below.is_none()) + u32::from(above.is_none());
            }
            Reach::Unlimited => {
                unlimited += 1;
                // A load that is not held may be with such a disturbance.
                assert_ne!(held(1e4), Some(false), "{index}");
            }
            Reach::NotHeld => {
                not += 1;
                assert_eq!(held(0.0), Some(false), "{index}");
            }
            Reach::Unknown => undecided += 1,
        }
    }
    // Right at the edge half the digits may not tell.
    assert!(undecided * 100 <= finite, "{undecided} of {finite}");
    assert!(finite > 80 && unlimited > 20 && not > 50, "{finite} {unlimited} {not}");
}

/// A grasp with force closure bears every load; without it there are loads that it does not.
#[test]
fn force_closure_is_to_bear_every_load() {
    let mut rng = Pcg64Mcg::seed_from_u64(12);
    let (mut closed, mut open) = (0, 0);
    for _ in 0..300 {
        let touching = rng.random_range(1..=5);
        let grasp = Grasp::new(places::<5>(&mut rng, touching).map(|p| p.map(|p| p.contact::<f64>())));
        let limits = [FingerLimits::<f64, 0>::none(); 5];
        // Loads along the axes, both ways: they span all.
        let held = (0..12).all(|i| {
            let mut axis = Vector6::zeros();
            axis[i / 2] = if i % 2 == 0 { 1.0 } else { -1.0 };
            if i >= 6 {
                axis *= grasp.length();
            }
            let about = Wrench::<f64, TestHand>::from_components(&axis);
            let load =
                Wrench::on_fingertip(about.force(), about.torque() + grasp.centre().cross(&about.force()));
            LeastGrip::new().solve(&grasp, &limits, &load).grip().is_some()
        });
        assert_eq!(grasp.force_closure(), Some(held));
        if held { closed += 1 } else { open += 1 }
    }
    assert!(closed > 30 && open > 30, "{closed} {open}");
}

/// The support in a direction, from scratch.
fn support<const N: usize>(grasp: &Grasp<f64, N, TestHand>, u: &Vector6<f64>, metric: Metric<f64>) -> f64 {
    let (force, torque) = (u.fixed_rows::<3>(0).into_owned(), u.fixed_rows::<3>(3) / metric.length());
    let gains = grasp.contacts().iter().flatten().map(|contact| {
        let velocity = force + torque.cross(&(contact.place() - grasp.centre()));
        let along = velocity.dot(&contact.normal());
        let sideways = (velocity - contact.normal() * along).norm();
        let spin = torque.dot(&contact.normal()) * contact.arm();
        (along + contact.friction() * sideways.hypot(spin)).max(0.0)
    });
    match metric {
        Metric::Total { .. } => gains.fold(0.0, f64::max),
        Metric::Each { .. } => gains.sum(),
    }
}

fn sweep(count: u32, directions: u32) {
    let mut rng = Pcg64Mcg::seed_from_u64(13);
    let (mut closed, mut share) = (0, 0.0);
    for _ in 0..count {
        let grasp = Grasp::new(places::<5>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        for metric in [Metric::Total { length: 0.03 }, Metric::Each { length: 0.03 }] {
            let ball = grasp.ball(metric).unwrap();
            assert!(ball.certified <= ball.found);
            if grasp.force_closure() == Some(true) {
                closed += 1;
                share += ball.certified / ball.found;
                assert!(ball.certified > 0.0);
            } else {
                assert_eq!(ball.found, 0.0);
            }
            for _ in 0..directions {
                let u = Vector6::from_fn(|_, _| {
                    // Nearly normal.
                    (0..4).map(|_| rng.random_range(-1.0..1.0)).sum::<f64>()
                })
                .normalize();
                let here = support(&grasp, &u, metric);
                assert!(here >= ball.certified * (1.0 - 1e-6), "the certified ball fits");
                assert!(here >= ball.found * (1.0 - 1e-2), "nothing less is found: {here} {}", ball.found);
            }
            // The weakest load is of unit length, and borne as much as is said.
            let torque = ball.weakest.torque_about(&grasp.centre()) / metric.length();
            let force = ball.weakest.force();
            let u = -Vector6::from_iterator(force.iter().chain(torque.iter()).copied());
            assert!((u.norm() - 1.0).abs() < 1e-9);
            assert!((support(&grasp, &u, metric) - ball.found).abs() < 1e-7);
        }
    }
    println!("{closed} balls; certified over found {:.2} in the mean", share / f64::from(closed));
    assert!(closed > count / 4);
}

#[test]
fn ball_fits_and_touches() {
    sweep(40, 2_000);
}

#[test]
fn margins_are_those_of_the_contacts() {
    let left = GraspContact::<f64, Hand>::soft(-Vector3::x() * 0.02, Vector3::x(), 0.5, 3e-3).unwrap();
    let right = GraspContact::point(Vector3::x() * 0.02, -Vector3::x(), 0.5).unwrap();
    let grasp = Grasp::new([Some(left), Some(right), None]);
    let forces = [
        ContactForce::new(2.0, Vector3::z() * 0.6, 0.8 * 3e-3),
        ContactForce::new(2.0, Vector3::z() * 0.5, 0.0),
        ContactForce::zero(),
    ];
    let margins = grasp.slip_margins(&forces);
    assert!(margins[0].unwrap().newtons.abs() < 1e-15 && margins[2].is_none());
    assert!((margins[1].unwrap().newtons - 0.5 / 1.25_f64.sqrt()).abs() < 1e-15);
    assert!(grasp.least_slip_margin(&forces).unwrap().newtons.abs() < 1e-15);
    let nothing = Grasp::<f64, 3, Hand>::new([None; 3]);
    assert!(nothing.least_slip_margin(&forces).is_none());
    assert_eq!(nothing.force_closure(), Some(false));
    assert_eq!(nothing.ball(Metric::Total { length: 0.03 }).unwrap().found, 0.0);
    assert!(nothing.ball(Metric::Each { length: f64::NAN }).is_none());
    assert!(nothing.ball(Metric::Each { length: 0.0 }).is_none());
    // No fingers bear no load, and nothing beside it without end.
    let (none, push) =
        ([FingerLimits::<f64, 1>::none(); 3], Wrench::from_force_at(&Vector3::x(), Vector3::z()));
    assert_eq!(nothing.reach(&none, &Wrench::zero(), &Wrench::zero()), Reach::Unlimited);
    assert_eq!(nothing.reach(&none, &push, &Wrench::zero()), Reach::NotHeld);
}

/// The reach is what another's solver finds for it.
#[test]
fn reach_agrees_with_clarabel() {
    let mut rng = Pcg64Mcg::seed_from_u64(15);
    let (mut finite, mut unlimited, mut not, mut unclear) = (0, 0, 0, 0);
    for index in 0..500 {
        let Problem { grasp, limits, load } = problem::<5>(&mut rng);
        let about = grasp.centre() + vector(&mut rng) * 0.02;
        let disturbance = Wrench::from_force_at(&about, vector(&mut rng)) * 10_f64.powi(index % 7 - 3);
        let ours = grasp.reach(&limits, &load, &disturbance);
        match (ours, clarabel_oracle::reach(&grasp, &limits, &load, &disturbance)) {
            (Reach::Times(ours), OracleReach::Times(theirs)) => {
                finite += 1;
                let scale = ours + load.force().norm() / disturbance.force().norm();
                assert!((ours - theirs).abs() < 1e-4 * scale, "{index}: {ours} {theirs}");
            }
            (Reach::Unlimited, OracleReach::Unlimited) => unlimited += 1,
            (Reach::NotHeld, OracleReach::NotHeld) => not += 1,
            (Reach::Unknown, _) | (_, OracleReach::Unclear) => unclear += 1,
            (ours, oracle) => panic!("{index}: {ours:?}, but {oracle:?}"),
        }
    }
    println!("{finite} finite, {unlimited} unlimited, {not} not held, {unclear} unclear");
    assert!(
        finite > 100 && unlimited > 20 && not > 50 && unclear <= 10,
        "{finite} {unlimited} {not} {unclear}"
    );
}

/// Without a disturbance the reach tells whether the load is held; in proportion, in any unit of force and length.
#[test]
fn reach_without_a_disturbance_and_in_any_units() {
    let mut rng = Pcg64Mcg::seed_from_u64(16);
    let (mut held, mut not) = (0, 0);
    for _ in 0..100 {
        let Problem { grasp, limits, load } = problem::<5>(&mut rng);
        let reach = grasp.reach(&limits, &load, &Wrench::zero());
        match LeastGrip::new().solve(&grasp, &limits, &load) {
            GripOutcome::Held(_) => {
                held += 1;
                assert_eq!(reach, Reach::Unlimited);
            }
            _ => {
                not += 1;
                assert_eq!(reach, Reach::NotHeld);
            }
        }
    }
    assert!(held > 30 && not > 10, "{held} {not}");
    for size in [1e-150, 1e-9, 1.0, 1e9, 1e150] {
        for newtons in [1e-150, 1e-6, 1.0, 1e6, 1e150] {
            let at = |x: f64| {
                GraspContact::<f64, Hand>::soft(Vector3::x() * x, -Vector3::x() * x, 0.5, 0.1 * size)
            };
            let grasp = Grasp::new([at(-size).ok(), at(size).ok()]);
            let limits = [FingerLimits::<f64, 1>::none().with_greatest_normal(10.0 * newtons).unwrap(); 2];
            let down = |times: f64| Wrench::on_fingertip(-Vector3::z() * (newtons * times), Vector3::zeros());
            // Two fingers of 10 with friction 0.5 carry 10: 2 now, and four times 2 more.
            let Reach::Times(more) = grasp.reach(&limits, &down(2.0), &down(2.0)) else {
                panic!("{size} {newtons}")
            };
            assert!((more - 4.0).abs() < 1e-6, "{size} {newtons}: {more}");
            // Of what exceeds the limit the other way, nothing; a load beyond them is not held.
            assert_eq!(grasp.reach(&limits, &down(12.0), &down(1.0)), Reach::NotHeld);
            let Reach::Times(back) = grasp.reach(&limits, &down(12.0), &down(-1.0)) else { panic!() };
            assert!((back - 22.0).abs() < 1e-5, "{size} {newtons}: {back}");
            // From nothing, five times 2.
            let Reach::Times(all) = grasp.reach(&limits, &Wrench::zero(), &down(2.0)) else {
                panic!("{size} {newtons}")
            };
            assert!((all - 5.0).abs() < 1e-6, "{size} {newtons}: {all}");
        }
    }
}

/// Two points whose line runs along the edge of both friction cones: what is across it takes the more force the less is
/// pressed into the cones, without bound. With a little pressed in there is no end, with a little pulled out there is
/// nothing, and with neither no number of times is made up.
#[test]
fn at_the_edge_of_friction_no_reach_is_made_up() {
    let mut unknown = 0;
    for friction in [0.2, 0.5, 1.0] {
        for turn in 0..12 {
            let axis = Vector3::new(0.3, -0.5, 0.8).normalize();
            let turn =
                nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), f64::from(turn));
            let at = |side: f64| {
                let inward = turn * Vector3::new(-side, friction, 0.0);
                GraspContact::<f64, Hand>::point(turn * Vector3::x() * (0.03 * side), inward, friction).ok()
            };
            let grasp = Grasp::new([at(-1.0), at(1.0)]);
            let none = [FingerLimits::<f64, 0>::none(); 2];
            let across = Wrench::on_fingertip(turn * Vector3::z(), Vector3::zeros());
            let pressed =
                |newtons: f64| Wrench::on_fingertip(turn * Vector3::y() * -newtons, Vector3::zeros());
            let pressed_in = grasp.reach(&none, &pressed(0.1), &across);
            assert!(matches!(pressed_in, Reach::Unlimited | Reach::Unknown), "{friction}: {pressed_in:?}");
            let pulled_out = grasp.reach(&none, &pressed(-0.1), &across);
            assert!(matches!(pulled_out, Reach::NotHeld | Reach::Unknown), "{friction}: {pulled_out:?}");
            match grasp.reach(&none, &pressed(0.0), &across) {
                Reach::Times(times) => assert!(times < 1e-3, "{friction}: {times}"),
                Reach::Unknown => unknown += 1,
                other => panic!("{friction}: {other:?}"),
            }
        }
    }
    println!("{unknown} unknown");
}
