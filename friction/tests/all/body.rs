//! A body held by friction: its balance of momentum, its steps solved another way, its steady states.

use fingertip_friction::testing::Draws;
use fingertip_friction::{Bristle, BristleLaw, Drive, ElastoPlastic, LuGre, Stribeck};
use nalgebra::{SVector, Vector1, Vector3};

const STIFFNESS: f64 = 2e3;

fn law(damping: f64) -> LuGre<f64> {
    LuGre::new(STIFFNESS, damping, 0.5, Stribeck::new(0.8, 1.2, 1e-2).unwrap()).unwrap()
}

/// `m (v⁺ − v) = h (drive − friction)`, the drive's spring at its end.
#[test]
fn momentum_is_balanced_in_every_direction() {
    let mut draws = Draws::new(51);
    let mut bristle = Bristle::<f64, _, 3>::new(law(3.0));
    bristle.set_load(2.5);
    let mass = Vector3::new(0.1, 0.5, 3.0);
    let mut v = Vector3::zeros();
    for _ in 0..3000 {
        let force = Vector3::from_fn(|_, _| 6.0 * draws.signed());
        let stiffness = if draws.share() < 0.3 { 0.0 } else { 100.0 * draws.share() };
        let h = 1e-5 * 1e3_f64.powf(draws.share());
        let end = bristle.step_body(&v, &Drive { mass, force, stiffness }, h);
        let pulled = (force - end.velocity * (h * stiffness) - end.friction) * h;
        let gained = mass.component_mul(&(end.velocity - v));
        let size = h * (force.norm() + end.friction.norm()) + 3.0 * (end.velocity.norm() + v.norm());
        assert!((gained - pulled).norm() <= 64.0 * f64::EPSILON * size, "{gained:?} {pulled:?}");
        v = end.velocity;
    }
}

/// One step along a line from the law's own equations: velocity at the end and the deflection, for a slide
/// rate λ. The balance is linear in the velocity, so that two trials solve it.
fn solved(
    rate: f64,
    z: f64,
    v: f64,
    drive: &Drive<f64, 1>,
    load: f64,
    damping: f64,
    h: f64,
) -> (f64, f64, f64) {
    let damping = if rate > 0.0 { damping.min(4.0 * STIFFNESS / rate) } else { damping };
    let end = |w: f64| {
        let after = (z + h * w) / (1.0 + h * rate);
        (after, load * (STIFFNESS * after + damping * (after - z) / h + 0.5 * w))
    };
    let lack = |w: f64| drive.mass[0] * (w - v) - h * (drive.force[0] - drive.stiffness * h * w - end(w).1);
    let (none, one) = (lack(0.0), lack(1.0));
    let w = -none / (one - none);
    (w, end(w).0, end(w).1)
}

/// The rate of the slide is taken at the old velocity to foretell the new, and then at the foretold.
fn steps_are_solved<L: BristleLaw<f64> + Copy>(law: L, seed: u64) {
    let mut draws = Draws::new(seed);
    let load = 1.5;
    let mut bristle = Bristle::<f64, _, 1>::new(law);
    bristle.set_load(load);
    let (mut v, mut slid) = (0.0, 0);
    for index in 0..4000 {
        let push = if index % 400 < 200 { 1.0 } else { -1.0 };
        let drive = Drive {
            mass: Vector1::new(0.2),
            force: Vector1::new(push * (1.2 + 2.0 * draws.share())),
            stiffness: 20.0 * draws.share(),
        };
        let h = 1e-5 * 1e3_f64.powf(draws.share());
        let z = bristle.deflection()[0];
        let rate = |w: f64| {
            law.plastic_share(z.abs(), z * w < 0.0, w.abs()) * w.abs() * STIFFNESS / law.steady(w.abs())
        };
        let foretold = solved(rate(v), z, v, &drive, load, law.damping(), h).0;
        let (wanted, after, friction) = solved(rate(foretold), z, v, &drive, load, law.damping(), h);
        let end = bristle.step_body(&Vector1::new(v), &drive, h);
        let size = v.abs() + wanted.abs() + 1e-3;
        assert!((end.velocity[0] - wanted).abs() <= 1e-10 * size, "{index}: {end:?} {wanted}");
        // The friction of a short step is a difference of momenta over the step.
        assert!(
            (end.friction[0] - friction).abs() <= 1e-10 * (size / h + 10.0),
            "{index}: {end:?} {friction}"
        );
        let cut = after.clamp(-1.2 / STIFFNESS, 1.2 / STIFFNESS);
        assert!((bristle.deflection()[0] - cut).abs() <= 1e-10 * (h * size + 1e-3), "{index}");
        slid += usize::from(h * rate(foretold) > 0.1);
        v = end.velocity[0];
    }
    assert!(slid > 300, "{slid}");
}

#[test]
fn each_step_solves_its_equations() {
    steps_are_solved(law(3.0), 52);
    // The damping is limited by 4σ₀/λ here.
    steps_are_solved(law(300.0), 53);
    steps_are_solved(law(0.0), 54);
    steps_are_solved(ElastoPlastic::new(law(30.0), 0.5).unwrap(), 55);
}

/// A constant force above break-away ends in `g(v) + σ₂v`, and one below it, on an elasto-plastic contact,
/// in the deflection of a spring.
#[test]
fn steady_states_are_the_closed_forms() {
    let load = 2.0;
    let mut bristle = Bristle::<f64, _, 2>::new(law(3.0));
    bristle.set_load(load);
    let (mass, force) = (SVector::repeat(0.2), SVector::<f64, 2>::new(3.0, 4.0));
    let mut v = SVector::zeros();
    for _ in 0..4000 {
        v = bristle.step_body(&v, &Drive { mass, force, stiffness: 0.0 }, 1e-3).velocity;
    }
    let speed = (5.0 / load - 0.8) / 0.5;
    assert!((v - force * (speed / 5.0)).norm() < 1e-6 * speed, "{v:?} {speed}");

    let plastic = ElastoPlastic::new(law(30.0), 0.5).unwrap();
    let mut bristle = Bristle::<f64, _, 2>::new(plastic);
    bristle.set_load(load);
    let mut v = SVector::zeros();
    let force = SVector::<f64, 2>::new(0.3, 0.4);
    for _ in 0..20_000 {
        v = bristle.step_body(&v, &Drive { mass, force, stiffness: 0.0 }, 1e-3).velocity;
    }
    assert!(v.norm() < 1e-12, "{v:?}");
    let settled = force / (load * STIFFNESS);
    assert!((bristle.deflection() - settled).norm() < 1e-12 * settled.norm() + 1e-15);
}

#[test]
fn without_load_the_body_is_free() {
    let mut bristle = Bristle::<f64, _, 1>::new(law(3.0));
    bristle.step(&Vector1::new(1e-2), 1e-2);
    bristle.set_load(0.0);
    let drive = Drive { mass: Vector1::new(0.5), force: Vector1::new(2.0), stiffness: 0.0 };
    let end = bristle.step_body(&Vector1::new(1.0), &drive, 0.25);
    assert_eq!((end.velocity[0], end.friction[0], bristle.deflection()[0]), (2.0, 0.0, 0.0));
}

#[test]
fn bad_input_returns_the_old_velocity_and_the_elastic_force() {
    let mut bristle = Bristle::<f64, _, 2>::new(law(3.0));
    bristle.set_load(2.0);
    bristle.step(&SVector::<f64, 2>::new(3e-2, -4e-2), 1e-3);
    let before = bristle;
    let elastic = *before.deflection() * (STIFFNESS * 2.0);
    let one = SVector::<f64, 2>::new(1.0, 1.0);
    let good = Drive { mass: one, force: one, stiffness: 1.0 };
    let mut refused = |v: SVector<f64, 2>, drive: Drive<f64, 2>, h: f64| {
        let end = bristle.step_body(&v, &drive, h);
        assert_eq!(end.friction, elastic, "{v:?} {drive:?} {h}");
        assert!(end.velocity == v || v.iter().any(|x| x.is_nan()));
        assert_eq!(bristle, before);
    };
    for bad in [f64::NAN, f64::INFINITY] {
        let part = SVector::<f64, 2>::new(1.0, bad);
        refused(part, good, 1e-3);
        refused(one, Drive { force: part, ..good }, 1e-3);
        refused(one, Drive { mass: part, ..good }, 1e-3);
        refused(one, Drive { stiffness: bad, ..good }, 1e-3);
        refused(one, good, bad);
    }
    for bad in [0.0, -1.0] {
        refused(one, Drive { mass: SVector::<f64, 2>::new(1.0, bad), ..good }, 1e-3);
        refused(one, good, bad);
    }
    refused(one, Drive { stiffness: -1.0, ..good }, 1e-3);
    // The velocity at the end is out of range.
    refused(one, Drive { force: one * 1e308, mass: one * 1e-3, stiffness: 0.0 }, 10.0);
    // A drive without a spring is good.
    let mut bristle = before;
    assert_ne!(bristle.step_body(&one, &Drive { stiffness: 0.0, ..good }, 1e-3).velocity, one);
}
