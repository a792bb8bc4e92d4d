//! The estimators of friction against closed forms and plain minimisation, on samples without noise.

use fingertip_friction::{ForceNoise, FrictionEstimate, KineticFriction, StaticFriction, UncertainCoulomb};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

const NOISE: ForceNoise<f64> = ForceNoise { normal: 0.02, tangential: 0.05 };

fn force(normal: f64, ratio: f64) -> ContactForce<f64> {
    ContactForce::new(normal, Vector3::new(0.0, normal * ratio, 0.0), 0.0)
}

/// What is taken of a ratio at 4 N: without the biases of a length and of a quotient.
fn unbiased(ratio: f64) -> f64 {
    (ratio * ratio - (NOISE.tangential / 4.0).powi(2)).sqrt() * (1.0 - (NOISE.normal / 4.0).powi(2))
}

fn close(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
}

/// Of a window of eight, the last eight samples count, wherever the window starts anew: steep ramps, whose
/// greatest mean has no rival.
#[test]
fn peak_is_the_greatest_mean_of_five_in_the_window() {
    for count in 5..40_i32 {
        for slope in [0.3, -0.3] {
            let mut friction = StaticFriction::<f64, 8>::new(NOISE, 0.05, 0.01).unwrap();
            let at = |index: i32| 20.0 + slope * f64::from(index);
            for index in 0..count {
                friction.observe(&force(4.0, at(index)));
            }
            let middle = if slope > 0.0 { count - 3 } else { (count - 8).max(0) + 2 };
            let (peak, deviation) = friction.peak().unwrap();
            close(peak, (middle - 2..=middle + 2).map(|index| unbiased(at(index)) / 5.0).sum());
            let variance = |index: i32| NOISE.tangential.powi(2) + (at(index) * NOISE.normal).powi(2);
            let sum: f64 = (middle - 2..=middle + 2).map(variance).sum();
            close(deviation, sum.sqrt() / 4.0 / 5.0);
        }
    }
    let mut friction = StaticFriction::<f64, 8>::new(NOISE, 0.05, 0.01).unwrap();
    for _ in 0..4 {
        friction.observe(&force(4.0, 0.5));
        assert_eq!(friction.peak(), None);
        assert_eq!(friction.onset(), None);
    }
    // Faulty samples neither count nor forget, unpressed ones forget.
    friction.observe(&force(f64::NAN, 0.5));
    friction.observe(&ContactForce::new(4.0, Vector3::x(), f64::INFINITY));
    friction.observe(&force(4.0, 0.5));
    assert!(friction.peak().is_some());
    friction.observe(&force(0.2, 0.5));
    assert_eq!(friction.peak(), None);
}

/// Where all means are equal, the bias is that of the greatest of half as many normal deviates; its
/// expectation is an integral.
#[test]
fn bias_of_a_plateau_is_the_expected_greatest() {
    let greatest = |count: i32| {
        let h = 1e-3;
        let (mut below, mut sum) = (0.0, 0.0);
        for k in -8000..8000 {
            let x = h * (f64::from(k) + 0.5);
            let share = h * (-0.5 * x * x).exp() / core::f64::consts::TAU.sqrt();
            let before = below;
            below += share;
            sum += x * (f64::powi(below, count) - f64::powi(before, count));
        }
        sum
    };
    // As many samples of a plateau after low ones, and half as many independent means.
    for (plateau, independent) in [(64, 30), (44, 20), (24, 10), (8, 2), (5, 1)] {
        let mut friction = StaticFriction::<f64, 64>::new(NOISE, 0.05, 0.01).unwrap();
        for index in 0..64 {
            friction.observe(&force(4.0, if index < 64 - plateau { 0.2 } else { 0.6 }));
        }
        let (peak, deviation) = friction.peak().unwrap();
        close(deviation, NOISE.ratio_deviation(4.0, 0.6) / 5.0_f64.sqrt());
        let bias = (unbiased(0.6) - peak) / deviation;
        // Blom's formula is within 0.026 of it for two, and within 0.01 for ten and more.
        let bound = if independent == 2 { 0.026 } else { 0.01 };
        assert!((bias - greatest(independent)).abs() < bound, "{plateau}: {bias} {}", greatest(independent));
    }
}

/// Learns from five samples of one ratio, which have no rival.
fn slip(friction: &mut StaticFriction<f64, 8>, ratio: f64) -> FrictionEstimate<f64> {
    for _ in 0..5 {
        friction.observe(&force(4.0, ratio));
    }
    let estimate = friction.onset().unwrap();
    assert_eq!(friction.peak(), None);
    let again = friction.estimate().unwrap();
    assert_eq!(
        (again.coefficient, again.deviation, again.surface_changed),
        (estimate.coefficient, estimate.deviation, false)
    );
    estimate
}

/// Variance of the logarithm of one peak.
fn variance(ratio: f64, scatter: f64) -> f64 {
    (NOISE.ratio_deviation(4.0, ratio) / unbiased(ratio)).powi(2) / 5.0 + scatter * scatter
}

/// Without wander, the mean of logarithms weighed by their variances; with it, what is known grows less sure.
#[test]
fn peaks_are_fused_by_their_variances() {
    for (scatter, wander) in [(0.05, 0.0), (0.0, 0.0), (0.1, 0.03)] {
        let mut friction = StaticFriction::<f64, 8>::new(NOISE, scatter, wander).unwrap();
        let first = slip(&mut friction, 0.5);
        close(first.coefficient, unbiased(0.5));
        close(first.deviation, unbiased(0.5) * variance(0.5, scatter).sqrt());
        assert!(!first.surface_changed);
        let (mut log, mut known) = (unbiased(0.5).ln(), variance(0.5, scatter));
        for ratio in [0.52, 0.49, 0.505, 0.51] {
            let fresh = variance(ratio, scatter);
            // Precisions add.
            let prior = known + wander * wander;
            let precision = 1.0 / prior + 1.0 / fresh;
            log = (log / prior + unbiased(ratio).ln() / fresh) / precision;
            known = 1.0 / precision;
            let found = slip(&mut friction, ratio);
            assert!(!found.surface_changed);
            close(found.coefficient, log.exp());
            close(found.deviation, log.exp() * known.sqrt());
        }
    }
}

#[test]
fn a_miss_by_four_deviations_is_another_surface() {
    for (factor, changed) in [(3.9, false), (4.1, true), (-3.9, false), (-4.1, true)] {
        let mut friction = StaticFriction::<f64, 8>::new(NOISE, 0.1, 0.05).unwrap();
        slip(&mut friction, 0.5);
        // The noise of the new peak depends a little on where it is.
        let mut ratio = 0.5;
        for _ in 0..50 {
            let total = variance(0.5, 0.1) + 0.05 * 0.05 + variance(ratio, 0.1);
            ratio = 0.5 * (factor * total.sqrt()).exp();
        }
        let found = slip(&mut friction, ratio);
        assert_eq!(found.surface_changed, changed, "{factor}");
        if changed {
            close(found.coefficient, unbiased(ratio));
            close(found.deviation, unbiased(ratio) * variance(ratio, 0.1).sqrt());
        }
    }
}

#[test]
fn quantiles_of_an_estimate_are_those_of_a_lognormal() {
    let estimate = FrictionEstimate { coefficient: 0.5, deviation: 0.1, surface_changed: false };
    for (probability, z) in [(0.025, -1.959_963_984_540_054), (0.5, 0.0), (0.975, 1.959_963_984_540_054)] {
        close(estimate.quantile(probability), 0.5 * f64::exp(0.2 * z));
    }
    assert_eq!((estimate.quantile(0.0), estimate.quantile(1.0)), (0.0, 0.0));
    let model = UncertainCoulomb::new(0.5, 0.1, Some(NOISE)).unwrap();
    assert_eq!((model.coefficient(), model.deviation()), (0.5, 0.1));
    close(model.quantile(0.025), 0.5 - 0.1 * 1.959_963_984_540_054);
    assert_eq!(model.quantile(1e-9), 0.0);
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(
            UncertainCoulomb::new(bad, 0.1, None).is_err() && UncertainCoulomb::new(0.5, bad, None).is_err()
        );
        assert!(UncertainCoulomb::new(0.5, 0.1, Some(ForceNoise { normal: bad, ..NOISE })).is_err());
        assert!(StaticFriction::<f64, 8>::new(NOISE, bad, 0.0).is_err());
        assert!(StaticFriction::<f64, 8>::new(NOISE, 0.0, bad).is_err());
        assert!(StaticFriction::<f64, 8>::new(ForceNoise { tangential: bad, ..NOISE }, 0.0, 0.0).is_err());
        assert!(StaticFriction::<f64, 64>::with_noise(ForceNoise { tangential: bad, ..NOISE }).is_err());
        assert!(KineticFriction::new(NOISE, bad).is_err());
        assert!(KineticFriction::new(ForceNoise { tangential: bad, ..NOISE }, 1.0).is_err());
    }
    assert!(StaticFriction::<f64, 5>::new(NOISE, 0.0, 0.0).is_ok());
}

/// A probability of slip by its own formula, and by chance where a force does not press.
#[test]
fn slip_probability_is_first_order() {
    let model = UncertainCoulomb::new(0.5, 0.1, Some(NOISE)).unwrap();
    // One deviation above and below: √(σ_t² + μ²σ_n² + N²σ_μ²).
    let deviation = (0.05_f64.powi(2) + (0.5 * 0.02_f64).powi(2) + (4.0 * 0.1_f64).powi(2)).sqrt();
    let at = |load: f64| model.slip_probability(&ContactForce::new(4.0, Vector3::new(load, 0.0, 0.0), 0.0));
    assert!((at(2.0) - 0.5).abs() < 1e-15);
    assert!((at(2.0 - deviation) - 0.158_655_253_931_457).abs() < 1e-14);
    assert!((at(2.0 + 2.0 * deviation) - 0.977_249_868_051_821).abs() < 1e-14);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(model.slip_probability(&force(bad, 0.0)), 1.0);
    }
    assert_eq!(model.slip_probability(&ContactForce::new(4.0, Vector3::zeros(), f64::NAN)), 1.0);
    // No load, or one that is no number; a sure slip is asked for; a probability that is none.
    let least = |load: f64, probability: f64| model.least_normal_force(&force(1.0, load), probability);
    assert_eq!(
        (least(f64::NAN, 0.5), least(f64::NAN, 0.9), least(f64::INFINITY, 1.0)),
        (f64::MAX, f64::MAX, f64::MAX)
    );
    let sure = UncertainCoulomb::new(0.5, 0.0, None).unwrap();
    assert_eq!(sure.slip_probability(&ContactForce::new(2.0, Vector3::x(), 0.0)), 0.0);
    assert_eq!((least(f64::NAN, 0.1), least(1.0, 0.0), least(1.0, 1.0)), (f64::MAX, f64::MAX, 0.0));
    assert_eq!(UncertainCoulomb::new(0.5, 0.0, None).unwrap().least_normal_force(&force(1.0, 0.0), 0.1), 0.0);
    // A quarter of the coefficient is not known, so that four deviations are too many.
    let vague = UncertainCoulomb::new(0.4, 0.1, None).unwrap();
    assert!(vague.least_normal_force(&force(1.0, 1.0), 1e-4) < 1e6);
    assert_eq!(vague.least_normal_force(&force(1.0, 1.0), 1e-5), f64::MAX);
}

/// Loads of a slide with a little of everything, and the weights that exponential forgetting gives them.
fn slide(friction: &mut KineticFriction<f64>, step: f64, memory: f64) -> Vec<(f64, f64, f64)> {
    let mut seen: Vec<(f64, f64, f64)> = Vec::new();
    for index in 0..60 {
        let phase = f64::from(index);
        let (n, t) = (3.0 + phase.sin(), 0.6 * (3.0 + phase.sin()) + 0.05 * (1.7 * phase).cos());
        friction.observe(&ContactForce::new(n, Vector3::new(0.6 * t, 0.0, -0.8 * t), 0.0), step);
        for sample in &mut seen {
            sample.2 *= memory / (memory + step);
        }
        seen.push((n, t, 1.0));
    }
    seen
}

/// The moments of squares without those of the noise, and their spread.
#[test]
fn kinetic_friction_is_the_quotient_of_moments() {
    for noise in
        [NOISE, ForceNoise { normal: 0.05, tangential: 0.02 }, ForceNoise { normal: 0.2, tangential: 1e-3 }]
    {
        for (step, memory) in [(1e-3, 10.0), (1e-3, 0.02), (0.0, 1.0), (0.5, 0.1)] {
            let mut friction = KineticFriction::new(noise, memory).unwrap();
            let seen = slide(&mut friction, step, memory);
            let (of_t, of_n) = (noise.tangential.powi(2), noise.normal.powi(2));
            let sum = |term: &dyn Fn(f64, f64, f64) -> f64| {
                seen.iter().map(|(n, t, w)| term(*n, *t, *w)).sum::<f64>()
            };
            let normal = sum(&|n, _, w| w * (n * n - of_n));
            let square = sum(&|_, t, w| w * (t * t - 2.0 * of_t)) / normal;
            let found = friction.estimate().unwrap();
            assert!((found.coefficient / square.sqrt() - 1.0).abs() < 1e-10, "{noise:?} {step}: {found:?}");
            let first = (of_t + square * of_n) * sum(&|n, _, w| w * w * (n * n - of_n));
            let second = (of_t * of_t / square + 0.5 * square * of_n * of_n) * sum(&|_, _, w| w * w);
            let wanted = (first + second).sqrt() / normal;
            assert!((found.deviation / wanted - 1.0).abs() < 1e-10, "{noise:?} {step}: {found:?} {wanted}");
        }
    }
}

#[test]
fn kinetic_friction_keeps_to_the_scale_of_the_forces() {
    let wanted = {
        let mut friction = KineticFriction::new(NOISE, 0.1).unwrap();
        slide(&mut friction, 1e-3, 0.1);
        friction.estimate().unwrap()
    };
    for scale in [2.0_f64.powi(-490), 2.0_f64.powi(490)] {
        let noise = ForceNoise { normal: NOISE.normal * scale, tangential: NOISE.tangential * scale };
        let mut friction = KineticFriction::new(noise, 0.1).unwrap();
        for index in 0..60 {
            let phase = f64::from(index);
            let (n, t) = (3.0 + phase.sin(), 0.6 * (3.0 + phase.sin()) + 0.05 * (1.7 * phase).cos());
            let force = ContactForce::new(n * scale, Vector3::new(0.6 * t, 0.0, -0.8 * t) * scale, 0.0);
            friction.observe(&force, 1e-3);
        }
        let found = friction.estimate().unwrap();
        close(found.coefficient, wanted.coefficient);
        close(found.deviation, wanted.deviation);
    }
}

/// A residual of two deviations adds one to the sum, whose threshold is 8; one of many adds three.
#[test]
fn a_new_surface_is_noticed_by_its_residuals() {
    for (deviations, wanted) in [(1.92, 9), (100.0, 3), (-1.92, 9), (-100.0, 3), (0.9, 60), (-0.9, 60)] {
        let mut friction = KineticFriction::new(NOISE, 1e4).unwrap();
        for _ in 0..20_000 {
            friction.observe(&force(4.0, 0.6), 1e-3);
        }
        let unit = NOISE.ratio_deviation(4.0, 0.6);
        let ratio = (0.6 + deviations * unit).abs();
        let mut noticed = 0;
        while !friction.estimate().is_some_and(|estimate| estimate.surface_changed) && noticed < 60 {
            friction.observe(&force(4.0, ratio), 1e-3);
            noticed += 1;
            // After the change, two samples of the new surface are needed.
            if friction.estimate().is_none() {
                friction.observe(&force(4.0, ratio), 1e-3);
            }
        }
        assert_eq!(noticed, wanted, "{deviations}");
        if wanted < 60 {
            close(friction.estimate().unwrap().coefficient, moments([4.0, 4.0], ratio));
            friction.acknowledge();
            assert!(!friction.estimate().unwrap().surface_changed);
        }
    }
}

/// Of two samples of one ratio, by the moments.
fn moments(normals: [f64; 2], ratio: f64) -> f64 {
    let squares: f64 = normals.iter().map(|n| n * n).sum();
    let (of_t, of_n) = (NOISE.tangential.powi(2), NOISE.normal.powi(2));
    ((squares * ratio * ratio - 4.0 * of_t) / (squares - 2.0 * of_n)).sqrt()
}

#[test]
fn kinetic_friction_needs_two_loaded_samples() {
    let mut friction = KineticFriction::new(NOISE, 1.0).unwrap();
    friction.observe(&force(4.0, 0.6), 1e-3);
    assert_eq!(friction.estimate(), None);
    let before = friction;
    for (bad, step) in [
        (force(0.2, 0.6), 1e-3),
        (force(4.0, 0.6), -1e-3),
        (force(4.0, 0.6), f64::NAN),
        (force(4.0, 0.6), f64::INFINITY),
        (force(4.0, f64::NAN), 1e-3),
        (ContactForce::new(4.0, Vector3::x(), f64::NAN), 1e-3),
        (force(1e200, 0.6), 1e-3),
        (ContactForce::new(4.0, Vector3::x() * 1e200, 0.0), 1e-3),
    ] {
        friction.observe(&bad, step);
        assert_eq!(friction, before, "{bad:?} {step}");
    }
    friction.observe(&force(0.2001, 0.6), 0.0);
    close(friction.estimate().unwrap().coefficient, moments([4.0, 0.2001], 0.6));
    let mut idle = KineticFriction::new(NOISE, 1.0).unwrap();
    for _ in 0..5 {
        idle.observe(&force(4.0, 0.0), 1e-3);
    }
    assert_eq!(idle.estimate(), None);
}
