//! What limits, bristles, detectors, estimators and the grip answer is held bit for bit.

use core::fmt::Debug;

use fingertip_friction::testing::Draws;
use fingertip_friction::*;
use fingertip_test_support::Unchanged;
use fingertip_wrench::{ContactForce, Real};
use nalgebra::{SVector, Vector3};

fn unchanged(file: &str) -> Unchanged {
    Unchanged::new(env!("CARGO_MANIFEST_DIR"), &format!("tests/unchanged/{file}.txt"))
}

/// Forces of all strengths, of which some lie just at the limit and some hardly slide.
fn forces<T: Real>(limit: &impl FrictionLimit<T>) -> Vec<ContactForce<T>> {
    let mut draws = Draws::new(51);
    (0..400)
        .map(|k| {
            let force: ContactForce<T> = draws.force(T::literal(0.004));
            let scale = T::literal([1.0, 1.0, 1e-9, 1e9][k % 4]);
            let scaled = ContactForce {
                normal: force.normal * scale,
                tangential: force.tangential.scaled(scale),
                spin: force.spin * scale,
            };
            if k % 3 == 0 { limit.project(&scaled) } else { scaled }
        })
        .collect()
}

fn limit<T: Real>(unchanged: &mut Unchanged, name: &str, limit: &impl FrictionLimit<T>) {
    let answers = forces(limit).into_iter().map(|force| {
        let (margin, holds) = (limit.slip_margin(&force), limit.holds(&force));
        let [safe, bare] = [1.5, 1.0].map(|safety| limit.least_normal_force(&force, T::literal(safety)));
        let keeping = [0.0, 0.3].map(|margin| limit.normal_force_keeping(&force, T::literal(margin)));
        let (projected, slides) = (limit.project(&force), limit.slip_direction(&force));
        (margin, holds, limit.factor_of_safety(&force), safe, bare, keeping, projected, slides)
    });
    unchanged.note(name, answers);
}

fn limits_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let n = T::literal;
    limit(unchanged, &format!("coulomb {kind}"), &Coulomb::new(n(0.4)).unwrap());
    limit(unchanged, &format!("soft finger {kind}"), &SoftFingerLimit::new(n(0.6), n(0.004)).unwrap());
    limit(unchanged, &format!("power {kind}"), &PowerLimit::new(n(0.6), n(0.004), n(1.6)).unwrap());
    let along = [Vector3::x(), Vector3::y()];
    let anisotropic = AnisotropicCoulomb::new(along, [n(0.9), n(0.2)]).unwrap();
    limit(unchanged, &format!("anisotropic {kind}"), &anisotropic);
    let growing = LoadDependentLimit::new(n(0.5), n(0.003), n(2.0), n(0.33)).unwrap();
    limit(unchanged, &format!("load dependent {kind}"), &growing);
    let noise = ForceNoise { normal: n(0.02), tangential: n(0.03) };
    let uncertain = UncertainCoulomb::new(n(0.5), n(0.06), Some(noise)).unwrap();
    let mut draws = Draws::new(53);
    let answers = (0..200).map(|_| {
        let force: ContactForce<T> = draws.force(T::zero());
        let least = [0.5, 0.99].map(|p| uncertain.least_normal_force(&force, p));
        (uncertain.slip_probability(&force), least, uncertain.quantile(draws.share()))
    });
    unchanged.note(&format!("uncertain {kind}"), answers);
}

#[test]
fn limits() {
    let mut unchanged = unchanged("limits");
    limits_of::<f64>(&mut unchanged, "f64");
    limits_of::<f32>(&mut unchanged, "f32");
    use PressureDistribution::{Hertz, PowerLaw, Uniform, Winkler};
    let curves = [Uniform, Hertz, PowerLaw(3.0), Winkler].map(|pressure| {
        let curve = LimitCurve::new(pressure);
        let points: Vec<_> = (0..60).map(|k| curve.point(f64::from(k * k) * 1e-3)).collect();
        let angles: Vec<_> = (0..=40).map(|k| curve.at_angle(f64::from(k) * 0.04)).collect();
        (points, angles, curve.table(9), pressure.relative_arm(), pressure.limit_exponent())
    });
    unchanged.note("limit curves", curves);
    unchanged.check();
}

/// Speeds over many decades, reversed now and then, with steps of any length and a load that comes and goes.
fn bristle<T: Real, L: BristleLaw<T>, M: Integrator>(unchanged: &mut Unchanged, name: &str, law: L) {
    let mut bristle = Bristle::<T, L, 2, M>::with_method(law);
    let mut draws = Draws::new(57);
    let speeds = [1e-6, 1e-4, 0.01, 1.0];
    let mut velocity = SVector::<T, 2>::zeros();
    let answers = (0..600).map(|k| {
        if k % 7 == 0 {
            velocity = SVector::from_fn(|_, _| T::literal(draws.signed() * speeds[k / 7 % 4]));
        }
        if k % 40 == 13 {
            velocity = -velocity;
        }
        if k % 50 == 0 {
            bristle.set_load(T::literal([1.0, 0.3, 4.0, 0.0][k / 50 % 4]));
        }
        let step = T::literal([1e-3, 1e-5, 0.03, 1e-9][k / 5 % 4]);
        if k % 11 == 5 {
            let drive = Drive {
                mass: SVector::repeat(T::literal(0.2)),
                force: velocity * T::literal(3.0),
                stiffness: T::literal(draws.share() * 1e4),
            };
            let coupled = bristle.step_body(&velocity, &drive, step);
            format!("{coupled:?} {:?}", bristle.energy())
        } else {
            let force = bristle.step(&velocity, step);
            format!("{force:?} {:?} {:?}", bristle.deflection(), bristle.energy())
        }
    });
    unchanged.note(name, answers);
}

fn bristles_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let n = T::literal;
    let curve = Stribeck::new(n(1.0), n(1.5), n(0.001)).unwrap();
    let lugre = LuGre::new(n(1e5), n(316.0), n(0.4), curve).unwrap();
    let plastic = ElastoPlastic::new(lugre, n(0.5)).unwrap();
    let dahl = Dahl::new(n(1e5), n(1.2)).unwrap();
    let stribeck = StribeckFriction::new(n(1e6), n(0.4), curve).unwrap();
    bristle::<T, _, Exponential>(unchanged, &format!("lugre {kind}"), lugre);
    bristle::<T, _, Implicit>(unchanged, &format!("implicit lugre {kind}"), lugre);
    bristle::<T, _, Exponential>(unchanged, &format!("elasto-plastic {kind}"), plastic);
    bristle::<T, _, Exponential>(unchanged, &format!("dahl {kind}"), dahl);
    bristle::<T, _, ReturnMap>(unchanged, &format!("return map {kind}"), stribeck);
}

#[test]
fn bristles() {
    let mut unchanged = unchanged("bristles");
    bristles_of::<f64>(&mut unchanged, "f64");
    bristles_of::<f32>(&mut unchanged, "f32");
    unchanged.check();
}

/// A touch as it comes and goes: rest, a load that rises and slips by drops of many sizes, sticks and slides,
/// lift-offs, gaps, irregular steps, hum, numbers out of range.
fn course<T: Real>() -> Vec<(Option<ContactForce<T>>, T)> {
    let mut draws = Draws::new(59);
    let (mut load, mut hum) = (0.5, (0.0_f64, 1.0_f64));
    (0..6000)
        .map(|k| {
            // A rotation by about a twentieth of a turn, by products alone.
            hum = (hum.0 * 0.9511 + hum.1 * 0.309, hum.1 * 0.9511 - hum.0 * 0.309);
            load += 0.0008;
            let drop = match k % 701 {
                400 => 0.25,
                430..445 => 0.03,
                600 => 0.9,
                _ => 0.0,
            };
            load = if load - drop < 0.1 { 0.5 } else { load - drop };
            let noise = |draws: &mut Draws| draws.signed() + draws.signed() + draws.signed();
            let normal = 3.0 + 0.02 * noise(&mut draws);
            let size = if k > 4000 { 0.1 * hum.0 } else { 0.0 };
            let tangential = load + 0.02 * noise(&mut draws) + size;
            let step = match k % 997 {
                500 => 20.0,
                501..520 => 4e-4,
                _ => 1e-3,
            };
            let across = 0.02 * noise(&mut draws);
            let force = match k {
                2222 => ContactForce::new(T::literal(3.0), Vector3::repeat(T::literal(f64::NAN)), T::zero()),
                2500 => ContactForce::new(T::GREATEST, Vector3::x() * T::GREATEST, T::zero()),
                _ => {
                    let along = Vector3::new(tangential, across, 0.0).map(T::literal);
                    ContactForce::new(T::literal(normal), along, T::zero())
                }
            };
            ((k % 1500 > 20).then_some(force), T::literal(step))
        })
        .collect()
}

fn detector<T: Real, D: SlipDetector<T>, A: Debug>(
    unchanged: &mut Unchanged,
    name: &str,
    mut detector: D,
    also: impl Fn(&D) -> A,
) {
    let answers = course::<T>().into_iter().map(|(force, step)| {
        let verdict = match force {
            Some(force) => detector.update(&force, step),
            None => detector.update_open(step),
        };
        (verdict, also(&detector))
    });
    unchanged.note(name, answers);
}

fn detectors_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let n = T::literal;
    let noise = ForceNoise { normal: n(0.035), tangential: n(0.035) };
    let drop = DropDetector::new(noise).unwrap();
    detector(unchanged, &format!("drop {kind}"), drop, DropDetector::ratio);
    let adaptive = AdaptiveDropDetector::new(noise, 1.0, 1000.0).unwrap();
    let inside = |d: &AdaptiveDropDetector<T>| (d.ratio(), d.threshold());
    detector(unchanged, &format!("adaptive drop {kind}"), adaptive, inside);
    let ratio = LikelihoodRatioDetector::<T, 16>::new(noise, 1.0, 1000.0).unwrap();
    detector(unchanged, &format!("likelihood ratio {kind}"), ratio, |d| format!("{d:?}"));
    detector(
        unchanged,
        &format!("stick-slip {kind}"),
        StickSlipDetector::new(drop),
        StickSlipDetector::motion,
    );
    let threshold = RatioThreshold::new(NormalForceGate::from_noise(&noise), n(0.5))
        .unwrap()
        .with_warning_share(n(0.4))
        .unwrap();
    detector(unchanged, &format!("threshold {kind}"), threshold, |_| ());
    let mut incipient = IncipientSlip::new(NormalForceGate::from_noise(&noise), n(1e-4))
        .unwrap()
        .with_warning_share(n(0.6))
        .unwrap();
    // Pushed to and fro against a contact that gives way more and more.
    let mut draws = Draws::new(61);
    let answers = (0..3000).map(|k| {
        let (turn, way) = (k / 500, f64::from(k % 500) * 2e-6);
        let pushed = if turn % 2 == 0 { way } else { 1e-3 - way };
        let load = 1.2 * pushed / (pushed + 2e-4) + 0.01 * draws.signed();
        let force = Vector3::new(-load, 0.01 * draws.signed(), 0.0).map(n);
        let place = Vector3::new(pushed, 1e-7 * draws.signed(), 0.0).map(n);
        let verdict = incipient.update(&ContactForce::new(n(3.0), force, n(0.0)), &place);
        (verdict, incipient.stiffness())
    });
    unchanged.note(&format!("incipient {kind}"), answers);
}

#[test]
fn detectors() {
    let mut unchanged = unchanged("detectors");
    detectors_of::<f64>(&mut unchanged, "f64");
    detectors_of::<f32>(&mut unchanged, "f32");
    unchanged.check();
}

fn estimates_of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
    let n = T::literal;
    let noise = ForceNoise { normal: n(0.02), tangential: n(0.03) };
    let mut at_rest = StaticFriction::<T>::new(noise, n(0.03), n(0.01)).unwrap();
    let mut sliding = KineticFriction::new(noise, n(0.4)).unwrap();
    let settings = GripSettings {
        safety: n(1.4),
        least: n(0.2),
        greatest: n(12.0),
        rise: n(40.0),
        fall: n(3.0),
        slip_boost: n(1.3),
    };
    let mut grip = GripController::new(settings).unwrap();
    let limit = Coulomb::new(n(0.5)).unwrap();
    let mut detector = DropDetector::new(noise).unwrap();
    let answers = course::<T>().into_iter().map(|(force, step)| {
        let Some(force) = force else {
            return (None, None, None, grip.present());
        };
        let verdict = detector.update(&force, step);
        at_rest.observe(&force);
        sliding.observe(&force, step);
        let onset = if verdict == SlipVerdict::Slipping { at_rest.onset() } else { None };
        let command = grip.command(&limit, &force, verdict, step);
        (Some((at_rest.peak(), at_rest.estimate(), onset)), sliding.estimate(), Some(verdict), command)
    });
    unchanged.note(&format!("estimates and grip {kind}"), answers);
}

#[test]
fn estimates_and_grip() {
    let mut unchanged = unchanged("estimates");
    estimates_of::<f64>(&mut unchanged, "f64");
    estimates_of::<f32>(&mut unchanged, "f32");
    unchanged.check();
}

#[test]
fn run_lengths() {
    let mut unchanged = unchanged("run_lengths");
    let places: Vec<_> = (1..30).map(|k| 0.4 * f64::from(k)).collect();
    unchanged.note(
        "of a sum",
        places.iter().map(|threshold| {
            let siegmund =
                [-0.3, 0.0, 0.4].map(|mean| run_length::siegmund_run_length(0.5, *threshold, mean));
            (siegmund, run_length::cusum_run_length(0.5, *threshold, 0.1))
        }),
    );
    unchanged.note(
        "of a likelihood ratio",
        places.iter().map(|threshold| {
            [4, 16, 50].map(|window| run_length::likelihood_ratio_run_length(window, *threshold))
        }),
    );
    let lengths = [200.0, 1e4, 1e6, 1e9];
    unchanged.note(
        "thresholds",
        lengths.map(|length| {
            let sums = [0.25, 0.5, 1.5].map(|allowance| run_length::cusum_threshold(allowance, length));
            (sums, run_length::likelihood_ratio_threshold(16, length))
        }),
    );
    unchanged.check();
}
