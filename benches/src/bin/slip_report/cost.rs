//! What one update costs: the least over many short batches, which is what the code takes when the
//! machine does nothing else.

use core::fmt::Write as _;
use core::hint::black_box;
use std::time::Instant;

use fingertip_friction::{
    DropDetector, ForceNoise, IncipientSlip, KineticFriction, LikelihoodRatioDetector, NormalForceGate,
    RatioThreshold, SlipDetector, StickSlipDetector,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::Failure;

/// Updates per batch: long enough for the clock, short enough to fall between interruptions.
const BATCH: usize = 1000;
const BATCHES: usize = 3000;

/// A hold with just the stated noise, which is the hardest for the estimate of its roughness.
fn hold<T: Real>() -> Vec<ContactForce<T>> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut noise = || -> f64 { 0.02 * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
    (0..BATCH)
        .map(|_| {
            ContactForce::new(
                T::literal(4.0 + noise()),
                Vector3::new(
                    T::literal(1.2 + noise()),
                    T::literal(0.9 + noise()),
                    T::literal(noise() * 1e-3),
                ),
                T::zero(),
            )
        })
        .collect()
}

/// Nanoseconds per call.
fn time(mut batch: impl FnMut()) -> f64 {
    let least = (0..BATCHES)
        .map(|_| {
            let start = Instant::now();
            batch();
            start.elapsed()
        })
        .min()
        .unwrap_or_default();
    least.as_secs_f64() * 1e9 / BATCH as f64
}

fn detector<T: Real>(samples: &[ContactForce<T>], step: f64, mut detector: impl SlipDetector<T>) -> f64 {
    let step = T::literal(step);
    time(|| {
        for force in samples {
            black_box(detector.update(black_box(force), step));
        }
    })
}

fn column<T: Real>() -> Result<Vec<(&'static str, f64)>, Failure> {
    let samples = hold::<T>();
    let noise = ForceNoise::isotropic(T::literal(0.02))?;
    let gate = NormalForceGate::from_noise(&noise);
    let drops = DropDetector::new(noise)?;
    let mut rows = vec![
        (
            "ratio threshold",
            detector(
                &samples,
                1e-3,
                RatioThreshold::new(gate, T::literal(0.6))?.with_warning_share(T::literal(0.9))?,
            ),
        ),
        ("drop, 1 kHz", detector(&samples, 1e-3, drops)),
        ("drop, 10 kHz (averages)", detector(&samples, 1e-4, drops)),
        ("stick-slip, 1 kHz", detector(&samples, 1e-3, StickSlipDetector::new(drops))),
        (
            "likelihood ratio, 16 samples",
            detector(&samples, 1e-3, LikelihoodRatioDetector::<T, 16>::new(noise, 1.0, 1000.0)?),
        ),
        (
            "likelihood ratio, 64 samples",
            detector(&samples, 1e-3, LikelihoodRatioDetector::<T, 64>::new(noise, 1.0, 1000.0)?),
        ),
    ];
    let mut incipient = IncipientSlip::new(gate, T::literal(4e-6))?.with_warning_share(T::literal(0.65))?;
    // To and fro by 0.2 mm at 0.2 mm/s, sampled at 1 kHz: a place every third sample.
    let places: Vec<_> = (0..BATCH)
        .map(|index| {
            let phase = index as f64 / BATCH as f64;
            Vector3::new(T::literal(2e-4 * (1.0 - (2.0 * phase - 1.0).abs())), T::zero(), T::zero())
        })
        .collect();
    rows.push((
        "incipient slip (motion known)",
        time(|| {
            for (force, place) in samples.iter().zip(&places) {
                black_box(incipient.update(black_box(force), black_box(place)));
            }
        }),
    ));
    let mut kinetic = KineticFriction::new(noise, T::one())?;
    rows.push((
        "kinetic friction, estimate on line",
        time(|| {
            for force in &samples {
                kinetic.observe(black_box(force), T::literal(1e-3));
            }
        }),
    ));
    Ok(rows)
}

/// The table of costs, as Markdown.
pub(crate) fn table() -> Result<String, Failure> {
    let mut text = format!(
        "\n## Cost of one update\n\nThe least over {BATCHES} batches of {BATCH} updates, on this machine; a hold with \
         the stated noise.\n\n| detector | f64 ns | f32 ns |\n|---|---|---|\n"
    );
    for ((name, wide), (_, narrow)) in column::<f64>()?.into_iter().zip(column::<f32>()?) {
        writeln!(text, "| {name} | {wide:.1} | {narrow:.1} |")?;
    }
    Ok(text)
}
