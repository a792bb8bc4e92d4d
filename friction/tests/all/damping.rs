//! The force that a step returns: elastic, damping and viscous part, each against what it stands for.

use fingertip_friction::testing::Draws;
use fingertip_friction::{
    Bristle, BristleLaw, ElastoPlastic, Exponential, Implicit, Integrator, LuGre, ReturnMap, Stribeck,
};
use fingertip_test_support::Worst;
use fingertip_wrench::Real;
use nalgebra::{SVector, Vector1, Vector3};

use crate::reference;

const STIFFNESS: f64 = 2e3;
const DAMPING: f64 = 3.0;
const VISCOUS: f64 = 0.5;

fn law() -> LuGre<f64> {
    LuGre::new(STIFFNESS, DAMPING, VISCOUS, Stribeck::new(0.8, 1.2, 1e-2).unwrap()).unwrap()
}

/// From rest at a constant velocity the deflection is `g/σ₀ (1 − e^{−σ₀vt/g})`, which gives the force at any time, and,
/// by Simpson's rule, its mean.
#[test]
fn force_at_a_constant_velocity_is_the_closed_form() {
    let direction = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    for load in [1.0, 2.5] {
        for speed in [1e-3, 1e-2, 0.3_f64] {
            for h in [1e-5, 1e-3, 1e-2] {
                let mut bristle = Bristle::<f64, _, 3>::new(law());
                bristle.set_load(load);
                let limit = (0.8 + 0.4 * (-(speed / 1e-2).powi(2)).exp()) / STIFFNESS;
                let deflection = |t: f64| -limit * (-speed * t / limit).exp_m1();
                for step in 0..20 {
                    let force = bristle.step(&(direction * speed), h);
                    let (start, end) = (deflection(h * f64::from(step)), deflection(h * f64::from(step + 1)));
                    let count = 2000;
                    let mean = (0..=count).map(|index| {
                        let weight = if index % count == 0 { 1.0 } else { f64::from(2 + 2 * (index % 2)) };
                        let share = f64::from(index) / f64::from(count);
                        weight / (3.0 * f64::from(count)) * deflection(h * (f64::from(step) + share))
                    });
                    let elastic = STIFFNESS * mean.sum::<f64>();
                    let exact = load * (elastic + DAMPING * (end - start) / h + VISCOUS * speed);
                    // The difference of deflections that are nearly equal has lost digits, and Simpson's rule some.
                    let rounding = 64.0 * f64::EPSILON * load * (2.0 + DAMPING * limit / h) + 1e-11 * load;
                    let error = (force.mean - direction * exact).norm();
                    assert!(error <= rounding, "{load} {speed} {h} {step}: {force:?} {exact}");
                    let pace = speed * (1.0 - end / limit);
                    let exact = load * (STIFFNESS * end + DAMPING * pace + VISCOUS * speed);
                    let error = (force.end - direction * exact).norm();
                    assert!(error <= rounding, "{load} {speed} {h} {step}: {force:?} {exact}");
                }
            }
        }
    }
}

/// A law without its σ₁ and σ₂.
#[derive(Clone, Copy)]
struct Undamped<L>(L);

impl<L: BristleLaw<f64>> BristleLaw<f64> for Undamped<L> {
    fn stiffness(&self) -> f64 {
        self.0.stiffness()
    }

    fn steady(&self, speed: f64) -> f64 {
        self.0.steady(speed)
    }

    fn greatest(&self) -> f64 {
        self.0.greatest()
    }

    fn plastic_share(&self, deflection: f64, opposed: bool, speed: f64) -> f64 {
        self.0.plastic_share(deflection, opposed, speed)
    }
}

/// The damping force is that of σ₁, or the greatest below it with which no energy comes out: found by
/// bisection over the balance of energy itself.
fn damping_is_the_greatest_passive<L: BristleLaw<f64> + Copy, M: Integrator, const D: usize>(
    law: L,
    draws: &mut Draws,
) -> (usize, usize) {
    let (mut limited, mut plain) = (0, 0);
    let mut bristle = Bristle::<f64, L, D, M>::with_method(law);
    // The same without damping, whose mean force is that of the mean deflection.
    let mut undamped = Bristle::<f64, _, D, M>::with_method(Undamped(law));
    let mut slow = SVector::zeros();
    for index in 0..3000 {
        // Slow for long, up to the static friction; fast the same way, where friction is less; anywhere.
        let any = SVector::<f64, D>::from_fn(|_, _| draws.signed());
        let (v, h) = match index % 3 {
            0 => (any * 1e-3, 1.0),
            1 => (slow * (1e4 * draws.share()) + any, 1e-6 * 1e2_f64.powf(draws.share())),
            _ => (any * 10.0 * draws.share().powi(3), 1e-6 * 1e4_f64.powf(draws.share())),
        };
        slow = v;
        let before = *bristle.deflection();
        let force = bristle.step(&v, h).mean;
        let elastic = undamped.step(&v, h).mean;
        let after = *bristle.deflection();
        let (path, change) = (v * h, after - before);
        if path.norm() < 1e-6 * after.norm() {
            // Of so short a way the change of the deflection keeps too few digits.
            continue;
        }
        // ½σ₀(|z⁺|² − |z|²), without its cancellation.
        let stored = 0.5 * law.stiffness() * change.dot(&(after + before));
        let passive = |damping: f64| path.dot(&(elastic + change * (damping / h))) >= stored;
        let mut damping = law.damping();
        if passive(damping) {
            plain += 1;
        } else {
            limited += 1;
            let (mut low, mut high) = (0.0, damping);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if passive(middle) { low = middle } else { high = middle }
            }
            damping = low;
        }
        let exact = elastic + change * (damping / h) + v * law.viscous();
        // Where the change is nearly across the path, much damping gives little energy.
        let power = change.dot(&path).abs();
        let across = if power > 0.0 { change.norm() * (path.norm() + change.norm()) / power } else { 1.0 };
        let size = law.stiffness() * (after.norm() + before.norm()) + v.norm() * law.viscous();
        let rounding = 64.0 * f64::EPSILON * (size * across + law.damping() * after.norm() / h);
        assert!((force - exact).norm() <= rounding, "{force:?} {exact:?} damping {damping}");
    }
    (limited, plain)
}

#[test]
fn damping_is_limited_just_to_what_passivity_allows() {
    let mut draws = Draws::new(31);
    let curve = Stribeck::new(0.8, 1.2, 1e-2).unwrap();
    let mut counts = Vec::new();
    for damping in [3.0, 30.0] {
        let law = LuGre::new(STIFFNESS, damping, VISCOUS, curve).unwrap();
        let plastic = ElastoPlastic::new(law, 0.5).unwrap();
        counts.push(damping_is_the_greatest_passive::<_, Exponential, 1>(law, &mut draws));
        counts.push(damping_is_the_greatest_passive::<_, Exponential, 3>(law, &mut draws));
        counts.push(damping_is_the_greatest_passive::<_, Implicit, 2>(law, &mut draws));
        counts.push(damping_is_the_greatest_passive::<_, ReturnMap, 2>(law, &mut draws));
        counts.push(damping_is_the_greatest_passive::<_, Exponential, 2>(plastic, &mut draws));
    }
    println!("limited and plain: {counts:?}");
    // Both happen, or the test shows nothing.
    assert!(counts.iter().all(|(limited, plain)| *limited > 20 && *plain > 200), "{counts:?}");
}

/// Forces on a motion to and fro, too slow for the limit, against the deflections of Radau's method: its
/// differences give the mean damping of each step.
#[test]
fn force_on_a_prescribed_motion_agrees_with_radau() {
    let velocity = |t: f64| 1e-2 * (100.0 * t).sin();
    let h = 2e-5;
    let deflections = reference::moved(velocity, 0.1, h).unwrap();
    assert!(deflections.len() >= 5000, "{}", deflections.len());
    let mut bristle = Bristle::<f64, _, 1>::new(LuGre::reference().unwrap());
    let (mut worst, mut damped) = (Worst::new(), Worst::new());
    for (index, pair) in deflections.windows(2).enumerate() {
        let v = velocity(h * (index as f64 + 0.5));
        let damping = 1e5_f64.sqrt() * (pair[1] - pair[0]) / h;
        let exact = 1e5 * 0.5 * (pair[0] + pair[1]) + damping + 0.4 * v;
        worst.see(bristle.step(&Vector1::new(v), h).mean[0] - exact);
        damped.see(damping);
    }
    println!("force within {:.2e} N, damping up to {:.2e} N", worst.get(), damped.get());
    assert!(damped.get() > 0.5, "there is damping to be seen: {}", damped.get());
    assert!(worst.get() < 2e-3, "{}", worst.get());
}

/// A deflection at rest gives the elastic force alone, and a step of no time adds the viscous force.
#[test]
fn no_motion_and_no_time_give_the_elastic_force() {
    fn same<T: Real>() {
        let l = T::literal;
        let mut bristle = Bristle::<T, _, 2>::new(LuGre::<T>::reference().unwrap());
        bristle.set_load(l(2.0));
        bristle.step(&SVector::<T, 2>::new(l(1e-3), l(-2e-3)), l(1e-3));
        let before = bristle;
        let elastic = *before.deflection() * (l(1e5) * l(2.0));
        let still = bristle.step(&SVector::zeros(), l(1e-3));
        assert_eq!((still.mean, still.end), (elastic, elastic));
        assert_eq!(bristle, before);
        let v = SVector::<T, 2>::new(l(3.0), l(1.0));
        let force = bristle.step(&v, T::zero()).mean;
        assert_eq!(bristle, before);
        let wanted = elastic + v * (l(0.4) * l(2.0));
        assert!((force - wanted).norm() <= l(8.0) * T::EPSILON * wanted.norm(), "{force:?} {wanted:?}");
    }
    same::<f64>();
    same::<f32>();
}

/// At the ratio of kinetic to static friction steady sliding would be elastic.
#[test]
fn the_elastic_share_lies_below_the_ratio_of_the_coefficients() {
    // A ratio that is exact: 0.6 / 1.2.
    let law = LuGre::new(STIFFNESS, DAMPING, VISCOUS, Stribeck::new(0.6, 1.2, 1e-2).unwrap()).unwrap();
    for good in [0.0, 0.25, 0.5_f64.next_down()] {
        assert!(ElastoPlastic::new(law, good).is_ok(), "{good}");
    }
    for bad in [-1e-300, 0.5, 0.75, f64::NAN, f64::INFINITY] {
        assert!(ElastoPlastic::new(law, bad).is_err(), "{bad}");
    }
}
