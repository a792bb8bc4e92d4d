//! Bounded, passive, exact where they can be, and against an independent stiff solver.

use fingertip_friction::testing::Draws;
use fingertip_friction::{
    Bristle, BristleLaw, Dahl, Drive, ElastoPlastic, Exponential, Implicit, Integrator, LuGre, ReturnMap,
    Stribeck, StribeckFriction,
};
use fingertip_test_support::Worst;
use fingertip_wrench::Real;
use nalgebra::{SVector, Vector1};

use crate::reference;

/// From `low` to `high`, evenly in the logarithm.
fn spread(draws: &mut Draws, low: f64, high: f64) -> f64 {
    low * (high / low).powf(draws.share())
}

fn random_law(draws: &mut Draws) -> (f64, f64, f64, f64, f64, f64) {
    let stiffness = spread(draws, 1e2, 1e8);
    let damping = if draws.share() < 0.2 { 0.0 } else { spread(draws, 1e-3, 1e5) };
    let viscous = if draws.share() < 0.5 { 0.0 } else { draws.share() };
    let kinetic = spread(draws, 1e-2, 1e2);
    let breakaway = kinetic * (1.0 + draws.share());
    (stiffness, damping, viscous, kinetic, breakaway, spread(draws, 1e-9, 0.1))
}

/// Random motion of one law: `|z|` stays below `F_s/σ₀`, no energy comes out, nothing is NaN, and
/// the mirrored motion gives the mirrored force.
fn run<T: Real, L: BristleLaw<T> + Copy, M: Integrator, const D: usize>(law: L, draws: &mut Draws) {
    let mut bristle = Bristle::<T, L, D, M>::with_method(law);
    let mut mirror = bristle;
    let bound = law.greatest() / law.stiffness();
    let rounding = T::literal(64.0) * T::EPSILON;
    let speed = spread(draws, 1e-6, 100.0);
    for _ in 0..20 {
        let h = T::literal(spread(draws, 1e-6, 1.0));
        let v = SVector::<T, D>::from_fn(|_, _| T::literal(speed * draws.signed()));
        let before = bristle.energy();
        let force = bristle.step(&v, h).mean;
        let after = bristle.energy();
        let length = bristle.deflection().norm();
        assert!(length <= bound * (T::one() + rounding), "|z| {length:?} above {bound:?}");
        let work = force.dot(&v) * h;
        // The damping force may cancel the elastic one, whose own work rounds.
        let elastic = law.stiffness() * length;
        let size = after + before + (force.norm() + elastic) * v.norm() * h;
        assert!(
            work - (after - before) >= -rounding * size,
            "energy from nothing: {work:?} {before:?} {after:?}"
        );
        let back = mirror.step(&-v, h).mean;
        assert!((back + force).norm() <= rounding * force.norm(), "odd: {force:?} {back:?}");
    }
}

fn runs<T: Real, const D: usize>(count: usize, seed: u64) {
    let mut draws = Draws::new(seed);
    for _ in 0..count {
        let (stiffness, damping, viscous, kinetic, breakaway, speed) = random_law(&mut draws);
        let l = T::literal;
        let curve = Stribeck::new(l(kinetic), l(breakaway), l(speed)).unwrap();
        let lugre = LuGre::new(l(stiffness), l(damping), l(viscous), curve).unwrap();
        let plastic = ElastoPlastic::new(lugre, l(0.95 * kinetic / breakaway * draws.share())).unwrap();
        let stribeck = StribeckFriction::new(l(stiffness), l(viscous), curve).unwrap();
        let dahl = Dahl::new(l(stiffness), l(kinetic)).unwrap();
        match (12.0 * draws.share()) as usize {
            0 => run::<T, _, Exponential, D>(dahl, &mut draws),
            1 => run::<T, _, Implicit, D>(dahl, &mut draws),
            2 => run::<T, _, ReturnMap, D>(dahl, &mut draws),
            3 | 4 => run::<T, _, Exponential, D>(lugre, &mut draws),
            5 => run::<T, _, Implicit, D>(lugre, &mut draws),
            6 => run::<T, _, ReturnMap, D>(lugre, &mut draws),
            7 | 8 => run::<T, _, Exponential, D>(plastic, &mut draws),
            9 => run::<T, _, Implicit, D>(plastic, &mut draws),
            10 => run::<T, _, ReturnMap, D>(plastic, &mut draws),
            _ => run::<T, _, ReturnMap, D>(stribeck, &mut draws),
        }
    }
}

#[test]
fn bounded_and_passive_in_a_hundred_thousand_runs() {
    runs::<f64, 1>(30_000, 1);
    runs::<f64, 2>(20_000, 2);
    runs::<f64, 3>(20_000, 3);
    runs::<f32, 1>(15_000, 4);
    runs::<f32, 3>(15_000, 5);
}

/// The same for a mass: `½mv² + ½σ₀z²` grows by no more than the work of the drive.
fn body_runs<T: Real, const D: usize>(count: usize, seed: u64) {
    let mut draws = Draws::new(seed);
    let rounding = T::literal(256.0) * T::EPSILON;
    for _ in 0..count {
        let (stiffness, damping, viscous, kinetic, breakaway, speed) = random_law(&mut draws);
        let l = T::literal;
        let curve = Stribeck::new(l(kinetic), l(breakaway), l(speed)).unwrap();
        let law = LuGre::new(l(stiffness), l(damping), l(viscous), curve).unwrap();
        let mut bristle = Bristle::<T, _, D>::new(law);
        let mass = SVector::<T, D>::repeat(l(spread(&mut draws, 1e-4, 10.0)));
        let mut v = SVector::<T, D>::from_fn(|_, _| l(100.0 * draws.signed().powi(5)));
        let h = l(spread(&mut draws, 1e-6, 1.0));
        let kinetic_energy = |v: &SVector<T, D>| l(0.5) * mass[0] * v.norm_squared();
        let bound = law.greatest() / law.stiffness() * (T::one() + rounding);
        for _ in 0..20 {
            let force = SVector::<T, D>::from_fn(|_, _| l(5.0 * breakaway * draws.signed()));
            let before = kinetic_energy(&v) + bristle.energy();
            let end = bristle.step_body(&v, &Drive { mass, force, stiffness: T::zero() }, h).velocity;
            let after = kinetic_energy(&end) + bristle.energy();
            let work = force.dot(&end) * h;
            assert!(end.iter().all(|x| x.is_number()));
            // The solve rounds at the size of the kinetic energy before it.
            let size = before + after + work.abs();
            assert!(
                after - before - work <= rounding * size,
                "{before:?} {after:?} {work:?} h {h:?} {law:?}"
            );
            assert!(bristle.deflection().norm() <= bound);
            v = end;
        }
    }
}

#[test]
fn a_body_gains_no_energy() {
    body_runs::<f64, 1>(20_000, 6);
    body_runs::<f64, 3>(10_000, 7);
    body_runs::<f32, 2>(10_000, 8);
}

#[test]
fn exponential_step_is_exact_for_constant_velocity() {
    let law = LuGre::<f64>::reference().unwrap();
    for v in [1e-5, 1e-3, 0.1] {
        let mut whole = Bristle::<f64, _, 1>::new(law);
        let mut split = whole;
        whole.step(&Vector1::new(v), 3e-3);
        for _ in 0..30 {
            split.step(&Vector1::new(v), 1e-4);
        }
        let limit = law.steady(v) / law.stiffness();
        let exact = limit * -(-v * 3e-3 / limit).exp_m1();
        assert!((whole.deflection()[0] - exact).abs() <= 4.0 * f64::EPSILON * limit);
        assert!((split.deflection()[0] - exact).abs() <= 64.0 * f64::EPSILON * limit);
    }
}

/// Halving the step divides the error by two to the order.
#[test]
fn orders_of_convergence() {
    fn error<M: Integrator>(steps: u32, midpoint: bool) -> f64 {
        let law = LuGre::<f64>::reference().unwrap();
        let go = |steps: u32, fine: bool| {
            let mut bristle = Bristle::<f64, _, 1, M>::with_method(law);
            let mut exact = Bristle::<f64, _, 1, Exponential>::with_method(law);
            let h = 0.02 / f64::from(steps);
            for index in 0..steps {
                let t = h * (f64::from(index) + if midpoint || fine { 0.5 } else { 1.0 });
                let v = Vector1::new(2e-3 * (t * 100.0).sin());
                bristle.step(&v, h);
                exact.step(&v, h);
            }
            if fine { exact.deflection()[0] } else { bristle.deflection()[0] }
        };
        (go(steps, false) - go(400_000, true)).abs()
    }
    let order = |a: f64, b: f64| (a / b).log2();
    let exponential = order(error::<Exponential>(1000, true), error::<Exponential>(2000, true));
    let late = order(error::<Exponential>(1000, false), error::<Exponential>(2000, false));
    let implicit = order(error::<Implicit>(1000, false), error::<Implicit>(2000, false));
    assert!((exponential - 2.0).abs() < 0.1, "{exponential}");
    assert!((late - 1.0).abs() < 0.1, "{late}");
    assert!((implicit - 1.0).abs() < 0.1, "{implicit}");
}

#[test]
fn states_of_one_law_do_not_part() {
    let mut draws = Draws::new(11);
    let law = LuGre::<f64>::reference().unwrap();
    for _ in 0..2000 {
        let mut one = Bristle::<f64, _, 2>::new(law);
        let mut two = one;
        two.step(&SVector::<f64, 2>::new(draws.signed(), draws.signed()), 1e-3);
        for _ in 0..20 {
            let v = SVector::<f64, 2>::from_fn(|_, _| draws.signed());
            let h = spread(&mut draws, 1e-6, 1.0);
            let before = (one.deflection() - two.deflection()).norm();
            one.step(&v, h);
            two.step(&v, h);
            let after = (one.deflection() - two.deflection()).norm();
            assert!(after <= before * (1.0 + 1e-14) + 1e-20);
        }
    }
}

fn stick_slip(h: f64) -> Vec<f64> {
    let mut bristle = Bristle::<f64, _, 1>::new(LuGre::reference().unwrap());
    let (mut x, mut v) = (0.0, Vector1::new(0.0));
    let steps = (20.0 / h).round() as usize;
    let every = (0.1 / h).round() as usize;
    let mut positions = vec![0.0];
    for index in 1..=steps {
        let pull = 2.0 * (0.1 * h * index as f64 - x);
        let drive = Drive { mass: Vector1::new(1.0), force: Vector1::new(pull), stiffness: 2.0 };
        v = bristle.step_body(&v, &drive, h).velocity;
        x += h * v[0];
        if index.is_multiple_of(every) {
            positions.push(x);
        }
    }
    positions
}

#[test]
fn stick_slip_agrees_with_radau() {
    let reference = reference::stick_slip().unwrap();
    assert_eq!(reference.len(), 201);
    // It slides, and sticks, and slides again.
    let travelled = *reference.last().unwrap();
    assert!(travelled > 0.7, "{travelled}");
    for (h, bound) in [(1e-5, 5e-5), (1e-4, 1e-4), (1e-3, 3e-2)] {
        let own = stick_slip(h);
        assert_eq!(own.len(), reference.len());
        let mut worst = Worst::new();
        own.iter().zip(&reference).for_each(|(x, r)| worst.see(x - r));
        let error = worst.get();
        println!("step {h:e}: greatest position error {error:.2e} m over {travelled:.3} m");
        assert!(error < bound, "step {h}: {error}");
    }
}

/// Each integrator on a motion to and fro against the same reference.
#[test]
fn prescribed_motion_agrees_with_radau() {
    let velocity = |t: f64| 1e-2 * (100.0 * t).sin();
    let reference = reference::moved(velocity, 0.2, 1e-3).unwrap();
    fn error<M: Integrator>(reference: &[f64], velocity: impl Fn(f64) -> f64) -> f64 {
        let mut bristle = Bristle::<f64, _, 1, M>::with_method(LuGre::reference().unwrap());
        assert_eq!(reference.len(), 201);
        let (h, mut worst) = (1e-5, Worst::new());
        for (index, exact) in reference.iter().enumerate().skip(1) {
            for step in 0..100 {
                let t = (index - 1) as f64 * 1e-3 + h * (f64::from(step) + 0.5);
                bristle.step(&Vector1::new(velocity(t)), h);
            }
            worst.see(bristle.deflection()[0] - exact);
        }
        worst.get() / 1.5e-5
    }
    let exponential = error::<Exponential>(&reference, velocity);
    let implicit = error::<Implicit>(&reference, velocity);
    println!("prescribed motion: exponential {exponential:.1e}, implicit {implicit:.1e} of the greatest");
    assert!(exponential < 2e-6 && implicit < 1e-3, "{exponential} {implicit}");
}

/// The drift of `docs/theory/friction.md#bristle-laws`: a load that oscillates below break-away.
#[test]
fn elasto_plastic_does_not_creep_and_lugre_does() {
    fn creep<L: BristleLaw<f64> + Copy>(law: L) -> f64 {
        let mut bristle = Bristle::<f64, _, 1>::new(law);
        let (mut x, mut v, h) = (0.0, Vector1::new(0.0), 1e-5);
        let mut marks = Vec::new();
        for index in 1..=200_000_u32 {
            let t = h * f64::from(index);
            let pull = 1.5 * (0.40 + 0.25 * (core::f64::consts::TAU * 10.0 * t).sin());
            let drive = Drive { mass: Vector1::new(1.0), force: Vector1::new(pull), stiffness: 0.0 };
            v = bristle.step_body(&v, &drive, h).velocity;
            x += h * v[0];
            if index.is_multiple_of(10_000) {
                marks.push(x);
            }
        }
        (marks[19] - marks[9]) / 10.0
    }
    let lugre = LuGre::reference().unwrap();
    let creeping = creep(lugre);
    // 0.7 is above F_c/F_s = 2/3, where steady sliding would be elastic: 0.66 is the most here.
    let holding = creep(ElastoPlastic::new(lugre, 0.66).unwrap());
    println!("LuGre creeps {creeping:.2e} m a cycle, elasto-plastic {holding:.2e} m");
    assert!(creeping > 1e-6, "{creeping}");
    assert!(holding.abs() < 1e-12, "{holding}");
    assert!(ElastoPlastic::new(lugre, 0.7).is_err());
}

#[test]
fn bad_input_changes_nothing() {
    let mut bristle = Bristle::<f64, _, 2>::new(LuGre::reference().unwrap());
    bristle.step(&SVector::<f64, 2>::new(1e-3, 2e-3), 1e-3);
    let before = bristle;
    let good = SVector::<f64, 2>::new(1.0, 0.0);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(bristle.step(&SVector::<f64, 2>::new(bad, 0.0), 1e-3).end.iter().all(|x| x.is_finite()));
        assert!(bristle.step(&good, bad).end.iter().all(|x| x.is_finite()));
        let drive =
            Drive { mass: good.map(|_| 1.0), force: SVector::<f64, 2>::new(bad, 0.0), stiffness: 0.0 };
        assert_eq!(bristle.step_body(&good, &drive, 1e-3).velocity, good);
        assert_eq!(bristle, before);
    }
    bristle.step(&good, -1.0);
    assert_eq!(bristle, before);
    // Without load nothing is held.
    bristle.set_load(f64::NAN);
    assert_eq!(bristle.step(&good, 1e-3).mean, SVector::<f64, 2>::zeros());
    let mut fast = before;
    assert!(fast.step(&(good * 1e300), 1e-300).end.iter().all(|x| x.is_finite()));
    assert!(fast.step(&(good * 1e-320), 1.0).end.iter().all(|x| x.is_finite()));
    for bad in [0.0, -1.0, f64::NAN] {
        assert!(Dahl::new(bad, 1.0).is_err());
        assert!(Stribeck::new(1.0, 0.5, 1e-3).is_err() && Stribeck::new(1.0, 1.5, bad).is_err());
    }
}

/// The reversal at 0.1 m/s within a millisecond: of the mean and the end of the second step, against the law itself in
/// ten thousand small steps of fourth order.
#[test]
fn mean_and_end_of_a_step_are_those_of_the_law() {
    fn reference<L: BristleLaw<f64>>(law: &L, start: f64, v: f64, h: f64) -> (f64, f64, f64) {
        let pace = |z: f64| {
            let share = law.plastic_share(z.abs(), z * v < 0.0, v.abs());
            v - share * law.stiffness() * v.abs() * z / law.steady(v.abs())
        };
        let (mut z, mut sum) = (start, 0.0);
        let count = 10_000;
        let small = h / f64::from(count);
        let force = |z: f64| law.stiffness() * z + law.damping() * pace(z) + law.viscous() * v;
        for _ in 0..count {
            let first = pace(z);
            let second = pace(z + 0.5 * small * first);
            let third = pace(z + 0.5 * small * second);
            let fourth = pace(z + small * third);
            let next = z + small / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
            sum += 0.5 * (force(z) + force(next)) / f64::from(count);
            z = next;
        }
        (z, sum, force(z))
    }
    fn check<L: BristleLaw<f64> + Copy>(name: &str, law: L, bound: f64) {
        for (speed, h) in [(0.1, 1e-3), (0.1, 3e-5), (1e-3, 1e-3), (1e-2, 1e-2)] {
            let mut bristle = Bristle::<f64, L, 1>::new(law);
            for v in [speed, speed, -speed, -0.3 * speed, speed] {
                let start = bristle.deflection()[0];
                let force = bristle.step(&Vector1::new(v), h);
                let (deflection, mean, end) = reference(&law, start, v, h);
                let size = law.greatest() + law.damping() * speed;
                let off = (bristle.deflection()[0] - deflection) * law.stiffness();
                assert!(off.abs() < bound * size, "{name} {speed} {h} {v}: deflection off by {off} N");
                assert!((force.end[0] - end).abs() < bound * size, "{name} {speed} {h} {v}: {force:?} {end}");
                // Where passivity limits the damping the mean is another, on purpose.
                let limited = speed > 0.012 && law.damping() > 0.0;
                assert!(
                    limited || (force.mean[0] - mean).abs() < bound * size,
                    "{name} {v}: {force:?} {mean}"
                );
            }
        }
    }
    check("LuGre", LuGre::reference().unwrap(), 1e-6);
    check("Dahl", Dahl::new(1e5, 1.0).unwrap(), 1e-6);
    let undamped = LuGre::new(1e5, 0.0, 0.4, *LuGre::reference().unwrap().curve()).unwrap();
    check("elasto-plastic", ElastoPlastic::new(undamped, 0.3).unwrap(), 0.03);
    check("elasto-plastic, late", ElastoPlastic::new(undamped, 0.6).unwrap(), 0.05);
    // As it was found: −1.04 N after the reversal, and no more than 1 N of a law that slides at 1 N.
    let mut bristle = Bristle::<f64, _, 1>::new(LuGre::reference().unwrap());
    bristle.step(&Vector1::new(0.1), 1e-3);
    assert!((bristle.step(&Vector1::new(-0.1), 1e-3).end[0] + 1.04).abs() < 0.01);
    let mut bristle = Bristle::<f64, _, 1>::new(ElastoPlastic::new(undamped, 0.3).unwrap());
    for v in [0.1, 0.1, -0.1, -0.1, 0.1] {
        let end = bristle.step(&Vector1::new(v), 1e-3).end[0];
        assert!((end.abs() - 1.04).abs() < 0.01, "{v}: {end}");
    }
}
