//! The experiment of `docs/theory/friction.md#drop-of-the-ratio`, and what must not alarm.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;
use rand::{Rng, RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::DropDetector;
use crate::{ForceNoise, SlipDetector, SlipVerdict};

fn normal(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}

fn sample<T: Real>(f_n: f64, f_t: f64) -> ContactForce<T> {
    ContactForce::new(
        T::literal(f_n),
        Vector3::new(T::literal(0.6 * f_t), T::literal(-0.8 * f_t), T::zero()),
        T::zero(),
    )
}

/// One ramp: an object of 0.1 kg under a growing pull, held by LuGre friction that is integrated
/// with steps of 1 µs (its own integration, not the crate's). Returns the samples (normal,
/// tangential) at 1 kHz and the time when the speed passed the Stribeck speed.
fn lugre_ramp(rng: &mut impl Rng) -> (Vec<(f64, f64)>, f64) {
    let f_n = rng.random_range(1.0..10.0);
    let static_force = f_n * rng.random_range(0.4..1.0);
    let kinetic = static_force * rng.random_range(0.6..0.85);
    // The parameters of Canudas de Wit et al. 1995, per newton of normal force.
    let (stiffness, damping, stribeck) = (1e5 * f_n, 1e5_f64.sqrt() * f_n, 1e-3);
    let (mass, rate) = (0.1, static_force / rng.random_range(0.3..1.0));
    let (mut v, mut z, mut slip) = (0.0_f64, 0.0_f64, f64::NAN);
    let h = 1e-6;
    let mut samples = Vec::new();
    let mut step = 0_u64;
    loop {
        let time = step as f64 * h;
        let g = kinetic + (static_force - kinetic) * (-(v / stribeck) * (v / stribeck)).exp();
        let before = z;
        let decay = (-stiffness * v.abs() / g * h).exp();
        let settled = g.copysign(v) / stiffness;
        z = settled + (z - settled) * decay;
        let friction = stiffness * z + damping * (z - before) / h + 0.4 * f_n * v;
        v += h * (rate * time - friction) / mass;
        if slip.is_nan() && v.abs() > stribeck {
            slip = time;
        }
        if step.is_multiple_of(1000) {
            samples.push((f_n, friction.max(0.0)));
        }
        if time > slip + 0.05 || time > 3.0 {
            return (samples, slip);
        }
        step += 1;
    }
}

fn theory_ramps<T: Real>(seed: u64) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let (mut delays, mut missed, mut early) = (Vec::new(), 0, 0);
    for _ in 0..40 {
        let (samples, slip) = lugre_ramp(&mut rng);
        let noise = ForceNoise::isotropic(T::literal(0.02)).unwrap();
        let mut detector = DropDetector::new(noise).unwrap();
        let mut found = false;
        for (index, (f_n, f_t)) in samples.iter().enumerate() {
            let noisy = sample(f_n + 0.02 * normal(&mut rng), f_t + 0.02 * normal(&mut rng));
            let verdict = detector.update(&noisy, T::literal(1e-3));
            let time = index as f64 * 1e-3;
            if verdict == SlipVerdict::Slipping {
                // The mass already creeps a few samples before it passes the Stribeck speed.
                if time < slip - 0.005 {
                    early += 1;
                } else if !found {
                    found = true;
                    delays.push(time - slip);
                }
            }
        }
        missed += usize::from(!found);
    }
    delays.sort_by(f64::total_cmp);
    let quantile = |share: f64| delays[((delays.len() - 1) as f64 * share).round() as usize];
    println!("median {:.2e} s, 95 % {:.2e} s, missed {missed}, early {early}", quantile(0.5), quantile(0.95));
    assert_eq!(missed, 0);
    assert_eq!(early, 0);
    assert!(quantile(0.5) <= 1e-3 && quantile(0.95) <= 3e-3, "{} {}", quantile(0.5), quantile(0.95));
}

#[test]
fn finds_the_slip_of_lugre_ramps() {
    theory_ramps::<f64>(1);
    theory_ramps::<f32>(2);
}

/// Counts alarms over `count` samples of a scripted contact, after a start-up of 100.
fn alarms<T: Real>(
    count: usize,
    step: impl Fn(usize) -> f64,
    mut script: impl FnMut(usize) -> (f64, f64),
    deviation: f64,
) -> usize {
    let mut detector = DropDetector::new(ForceNoise::isotropic(T::literal(deviation)).unwrap()).unwrap();
    (0..count)
        .filter(|&index| {
            let (f_n, f_t) = script(index);
            detector.update(&sample(f_n, f_t), T::literal(step(index))) == SlipVerdict::Slipping
        })
        .count()
}

fn noisy_script(seed: u64, f: impl Fn(f64) -> (f64, f64)) -> impl FnMut(usize) -> (f64, f64) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    move |index| {
        let (f_n, f_t) = f(index as f64 * 1e-3);
        (f_n + 0.02 * normal(&mut rng), f_t + 0.02 * normal(&mut rng))
    }
}

fn quiet_holds<T: Real>() {
    let steady = |_| 1e-3;
    // Ten minutes at 1 kHz each: constant; the ratio drifting down and up; hum of two deviations.
    let count = 600_000;
    let constant = alarms::<T>(count, steady, noisy_script(3, |_| (4.0, 1.6)), 0.02);
    let drift = alarms::<T>(count, steady, noisy_script(4, |t| (4.0, 1.6 + 0.8 * (t * 0.05).cos())), 0.02);
    let hum = alarms::<T>(
        count,
        steady,
        noisy_script(5, |t| (4.0, 1.6 + 0.04 * (t * core::f64::consts::TAU * 50.0).sin())),
        0.02,
    );
    // An object moved to and fro twice a second.
    let moved = alarms::<T>(
        count,
        steady,
        noisy_script(13, |t| (4.0, 1.6 + 0.8 * (t * core::f64::consts::TAU * 2.0).sin())),
        0.02,
    );
    println!("alarms in 10 min: constant {constant}, drift {drift}, hum {hum}, moved {moved}");
    // Less than one in ten minutes, as documented.
    assert!(constant.max(drift).max(hum).max(moved) <= 1, "{constant} {drift} {hum} {moved}");
}

#[test]
fn stays_quiet_in_long_holds() {
    quiet_holds::<f64>();
    quiet_holds::<f32>();
}

#[test]
fn steps_of_the_normal_force_do_not_alarm() {
    // Held: the tangential force stays while the normal force doubles or halves every 100 ms.
    let grip = |t: f64| if ((t * 10.0) as u64).is_multiple_of(2) { 3.0 } else { 6.0 };
    let held = alarms::<f64>(120_000, |_| 1e-3, noisy_script(6, |t| (grip(t), 1.0)), 0.02);
    // Sliding: the tangential force follows the normal force at once.
    let sliding = alarms::<f64>(120_000, |_| 1e-3, noisy_script(7, |t| (grip(t), 0.5 * grip(t))), 0.02);
    println!("alarms in 2 min of steps: held {held}, sliding {sliding}");
    assert!(held <= 1 && sliding <= 1, "{held} {sliding}");
}

#[test]
fn repeated_dropped_and_quantised_samples_do_not_alarm() {
    // Every value sent three times.
    let mut inner = noisy_script(8, |t| (4.0, 1.6 + 0.2 * (0.3 * t).sin()));
    let mut value = (0.0, 0.0);
    let repeated = alarms::<f64>(
        300_000,
        |_| 1e-3,
        |index| {
            if index % 3 == 0 {
                value = inner(index);
            }
            value
        },
        0.02,
    );
    // Steps of 0.1, 1 and 3 sample times in turn, and a ratio that moves.
    let lengths = [1e-4, 1e-3, 3e-3];
    let mut time = 0.0;
    let mut rng = Pcg64Mcg::seed_from_u64(9);
    let irregular = alarms::<f64>(
        300_000,
        |index| lengths[index % 3],
        |index| {
            time += lengths[index % 3];
            let f_t: f64 = 1.6 + 0.5 * (time * 2.0).sin();
            (4.0 + 0.02 * normal(&mut rng), f_t + 0.02 * normal(&mut rng))
        },
        0.02,
    );
    // A 12-bit converter of 30 N full scale, both ways; noise far below one step.
    let lsb = 60.0 / 4096.0;
    let quantise = |x: f64| (x / lsb).round() * lsb;
    let mut rng = Pcg64Mcg::seed_from_u64(10);
    let quantised = alarms::<f64>(
        300_000,
        |_| 1e-3,
        |index| {
            let f_t: f64 = 1.6 + 0.2 * (index as f64 * 3e-4).sin();
            (quantise(4.0 + 0.003 * normal(&mut rng)), quantise(f_t + 0.003 * normal(&mut rng)))
        },
        lsb / 12.0_f64.sqrt(),
    );
    println!("alarms in 5 min: repeated {repeated}, irregular {irregular}, quantised {quantised}");
    assert!(repeated.max(irregular).max(quantised) <= 1, "{repeated} {irregular} {quantised}");
}

#[test]
fn bad_samples_change_nothing() {
    let mut script = noisy_script(11, |t| (4.0, 1.0 + t));
    let mut detector = DropDetector::new(ForceNoise::isotropic(0.02).unwrap()).unwrap();
    for index in 0..50 {
        let (f_n, f_t) = script(index);
        detector.update(&sample::<f64>(f_n, f_t), 1e-3);
    }
    let before = detector;
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        assert_eq!(detector.update(&sample(bad, 1.0), 0.0), SlipVerdict::NotPressing);
        assert_eq!(detector.update(&sample(4.0, bad), 0.0), SlipVerdict::NotPressing);
        assert_eq!(detector.update(&sample(4.0, 1.0), bad), SlipVerdict::NotPressing);
        assert_eq!(detector, before);
    }
    // The same sample again, and a clock that runs backwards.
    detector.update(&sample(4.0, 0.1), 0.0);
    detector.update(&sample(4.0, 0.1), -1.0);
    assert_eq!(detector, before);
}

#[test]
fn extremes_do_not_panic_or_alarm() {
    let huge = [0.0, 5e-324, f64::MIN_POSITIVE, 1e-30, 1.0, 1e30, f64::MAX, f64::NAN, f64::INFINITY];
    let mut detector = DropDetector::new(ForceNoise::isotropic(1e-3).unwrap()).unwrap();
    for &f_n in &huge {
        for &f_t in &huge {
            for &step in &huge {
                detector.update(&sample(f_n, f_t), step);
                assert!(detector.ratio().is_none_or(f64::is_finite));
            }
        }
    }
    // Many of the greatest, faster than they are taken.
    for index in 0..1000_u32 {
        let f_t = if index.is_multiple_of(3) { f64::MAX } else { 1.0 };
        detector.update(&sample(f64::MAX, f_t), 1e-5);
        assert!(detector.ratio().is_none_or(f64::is_finite));
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
        assert!(ForceNoise::isotropic(bad).and_then(DropDetector::new).is_err());
    }
}

#[test]
fn finds_every_drop_of_stick_slip_once() {
    // A saw tooth: 100 ms up, then down by 20 deviations within 2 ms.
    let mut detector = DropDetector::new(ForceNoise::isotropic(0.02).unwrap()).unwrap();
    let mut script = noisy_script(12, |t| {
        let phase = (t * 10.0).fract();
        (4.0, if phase < 0.98 { 1.0 + 0.4 * phase } else { 1.4 - 20.0 * (phase - 0.98) })
    });
    let alarms = (0..10_000)
        .filter(|&index| {
            let (f_n, f_t) = script(index);
            detector.update(&sample::<f64>(f_n, f_t), 1e-3) == SlipVerdict::Slipping
        })
        .count();
    assert_eq!(alarms, 100);
}

/// How many of 2000 drops of so many deviations are found, when they last; and how many of the
/// loads that turn around within a few samples are taken for slip.
#[test]
fn what_it_can_not_tell() {
    let mut rng = Pcg64Mcg::seed_from_u64(21);
    let noise = ForceNoise::isotropic(0.02).unwrap();
    let mut found = |after: &dyn Fn(usize) -> f64| {
        (0..2000)
            .filter(|_| {
                let mut detector = DropDetector::new(noise).unwrap();
                (0..160).any(|index| {
                    let f_t = if index < 60 { 1.6 } else { after(index - 60) };
                    let noisy = sample::<f64>(4.0 + 0.02 * normal(&mut rng), f_t + 0.02 * normal(&mut rng));
                    detector.update(&noisy, 1e-3) == SlipVerdict::Slipping
                })
            })
            .count() as f64
            / 2000.0
    };
    let deviation = 0.02 * (1.0_f64 + 0.4 * 0.4).sqrt();
    let shares = [2.0, 3.0, 4.0, 5.0, 6.0].map(|size| found(&|_| 1.6 - size * deviation));
    println!("found of drops by 2, 3, 4, 5, 6 deviations: {shares:?}");
    // As documented: 2 %, 40 %, 94 % and all, of which 2000 trials err by four times 1.1 % at most.
    let documented = [0.02, 0.4, 0.94, 1.0, 1.0];
    for (share, documented) in shares.iter().zip(documented) {
        assert!((share - documented).abs() < 0.045, "{shares:?}");
    }
    assert!(shares.is_sorted() && shares[0] < 0.04 && shares[3] > 0.995 && shares[4] > 0.999, "{shares:?}");
    // From 1.6 N through nothing to 1.6 N the other way, in 2, 20 and 200 samples.
    let turned = [2.0, 20.0, 200.0]
        .map(|count| found(&|index| (1.6 - 3.2 * (index as f64 + 1.0) / count).abs().min(1.6)));
    println!("taken for slip of turns in 2, 20, 200 ms: {turned:?}");
    // So the documentation says; were it to get better, this is the place to see it.
    assert!(turned.iter().all(|share| *share > 0.9), "{turned:?}");
}
