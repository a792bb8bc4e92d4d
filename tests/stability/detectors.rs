//! Slip detectors: no alarm without cause, none lost after garbage, the same at every scale.

use fingertip_friction::{
    DropDetector, ForceNoise, KineticFriction, LikelihoodRatioDetector, NormalForceGate, RatioThreshold,
    SlipDetector, SlipVerdict, StickSlipDetector,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::matrix::Row;

const STEP: f64 = 1e-3;

fn force<T: Real>(normal: f64, tangential: f64) -> ContactForce<T> {
    ContactForce::new(
        T::literal(normal),
        Vector3::new(T::literal(tangential), T::zero(), T::zero()),
        T::zero(),
    )
}

/// A hold at a ratio of 0.6 that falls to 0.4 after 300 samples, read with noise and by `scale`.
fn record<T: Real>(seed: u64, noise: f64, scale: f64) -> Vec<ContactForce<T>> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut draw = || -> f64 { noise * Distribution::<f64>::sample(&StandardNormal, &mut random) };
    (0..400)
        .map(|index| {
            let ratio = if index < 300 { 0.6 } else { 0.4 };
            // Rounded before scaling by a power of two, which is then exact.
            let (normal, tangential) = (T::literal(5.0 + draw()), T::literal(5.0 * ratio + draw()));
            force(normal.to_f64() * scale, tangential.to_f64() * scale)
        })
        .collect()
}

fn verdicts<T: Real, D: SlipDetector<T>>(detector: &mut D, record: &[ContactForce<T>]) -> Vec<SlipVerdict> {
    record.iter().map(|force| detector.update(force, T::literal(STEP))).collect()
}

/// All cases of one detector, made from a scale of force.
fn cases<T: Real, D: SlipDetector<T>>(
    name: &str,
    make: impl Fn(f64) -> Option<D>,
    trials: usize,
    rows: &mut Vec<Row>,
) {
    let slipping = |list: &[SlipVerdict]| list.iter().position(|v| *v == SlipVerdict::Slipping);
    let foretells = name.starts_with("ratio");
    for (case, noise) in [("a drop, with noise", 0.02), ("a drop, without noise", 0.0)] {
        let mut row = Row::new::<T>(name, case);
        for trial in 0..trials {
            let mut detector = make(1.0).expect("a detector");
            let list = verdicts(&mut detector, &record::<T>(trial as u64, noise, 1.0));
            // The bound: ten samples after the drop; one that foretells sees the ratio at once.
            match slipping(&list) {
                Some(at) if foretells => row.expect(at <= 300, || format!("at {at}")),
                Some(at) if at >= 300 => row.error((at - 300) as f64, 10.0, || format!("{at}")),
                other => row.expect(false, || format!("seed {trial}: {other:?}")),
            }
        }
        rows.push(row);
    }
    let extreme = if T::EPSILON.to_f64() > 1e-10 { 80 } else { 900 };
    for (case, exponent) in [("tiny forces", -extreme / 2), ("huge forces", extreme / 2)] {
        let scale = 2.0_f64.powi(exponent);
        let mut row = Row::new::<T>(name, case);
        for trial in 0..trials {
            let (mut one, mut two) = (make(1.0).expect("a detector"), make(scale).expect("at any scale"));
            let plain = verdicts(&mut one, &record::<T>(trial as u64, 0.02, 1.0));
            let scaled = verdicts(&mut two, &record::<T>(trial as u64, 0.02, scale));
            row.expect(plain == scaled, || format!("seed {trial}: another verdict at this scale"));
        }
        rows.push(row);
    }
    let mut row = Row::new::<T>(name, "NaN, infinities and extremes among samples");
    for trial in 0..trials {
        let mut detector = make(1.0).expect("a detector");
        let mut found = None;
        let l = T::literal;
        for (index, sample) in record::<T>(trial as u64, 0.02, 1.0).iter().enumerate() {
            if index < 200 && index % 5 == 0 {
                for (normal, tangential, step) in [
                    (f64::NAN, 1.0, STEP),
                    (5.0, f64::INFINITY, STEP),
                    (5.0, 3.0, f64::NAN),
                    (5.0, 3.0, -1.0),
                    (f64::NEG_INFINITY, f64::NAN, STEP),
                ] {
                    let verdict = detector.update(&force(normal, tangential), l(step));
                    let alarm = verdict == SlipVerdict::Slipping && !foretells;
                    row.expect(!alarm, || format!("alarm at garbage {normal} {tangential} {step}"));
                }
            }
            let verdict = detector.update(sample, l(STEP));
            if verdict == SlipVerdict::Slipping && found.is_none() {
                found = Some(index);
            }
        }
        row.expect(found.is_some_and(|at| foretells || at >= 300), || format!("seed {trial}: {found:?}"));
    }
    rows.push(row);
    let mut row = Row::new::<T>(name, "normal force to 0");
    let mut detector = make(1.0).expect("a detector");
    for normal in [0.0, -0.0, 1e-30, -1.0, 1e-3] {
        let verdict = detector.update(&force(normal, 1.0), T::literal(STEP));
        row.expect(verdict == SlipVerdict::NotPressing, || format!("{normal}: {verdict:?}"));
    }
    rows.push(row);
}

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let noise = |scale: f64| ForceNoise::isotropic(T::literal(0.02 * scale)).ok();
    let drops = |scale: f64| DropDetector::new(noise(scale)?).ok();
    cases::<T, _>(
        "ratio threshold",
        |scale| {
            let gate = NormalForceGate::from_noise(&noise(scale)?);
            RatioThreshold::new(gate, T::literal(0.55))
                .and_then(|detector| detector.with_warning_share(T::literal(0.9)))
                .ok()
        },
        trials,
        rows,
    );
    cases::<T, _>("drop detector", drops, trials, rows);
    cases::<T, _>("stick-slip detector", |scale| Some(StickSlipDetector::new(drops(scale)?)), trials, rows);
    cases::<T, _>(
        "likelihood ratio",
        |scale| LikelihoodRatioDetector::<T, 16>::new(noise(scale)?, 1.0, 1000.0).ok(),
        trials,
        rows,
    );
    let mut row = Row::new::<T>("kinetic friction", "NaN, infinities and extremes among samples");
    for trial in 0..trials {
        let friction = noise(1.0).and_then(|n| KineticFriction::new(n, T::one()).ok());
        let mut friction = friction.expect("a coefficient to be learnt");
        for (index, sample) in record::<T>(trial as u64, 0.02, 1.0).iter().take(300).enumerate() {
            if index % 7 == 0 {
                friction.observe(&force(f64::NAN, 1.0), T::literal(STEP));
                friction.observe(&force(5.0, f64::INFINITY), T::literal(STEP));
                friction.observe(&force(-5.0, 3.0), T::literal(STEP));
            }
            friction.observe(sample, T::literal(STEP));
        }
        match friction.estimate() {
            // Six deviations of what it claims.
            Some(estimate) => {
                row.error(estimate.coefficient.to_f64() - 0.6, 6.0 * estimate.deviation.to_f64(), || {
                    format!("{estimate:?}")
                })
            }
            None => row.expect(false, || "no estimate".to_owned()),
        }
    }
    rows.push(row);
}
