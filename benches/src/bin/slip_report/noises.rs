//! False alarms and delays by the kind of the noise.

use core::fmt::Write as _;

use fingertip_friction::{
    AdaptiveDropDetector, DropDetector, ForceNoise, LikelihoodRatioDetector, SlipDetector, SlipVerdict,
};
use rand::RngExt;

use crate::Failure;
use crate::detectors::quantile;
use crate::page::Page;

#[path = "../../../../friction/tests/support/noise_kinds.rs"]
mod noise_kinds;

use noise_kinds::{KINDS, Kind, Noise, STATED};

const RATES: [f64; 4] = [200.0, 1000.0, 2000.0, 10_000.0];
/// Sizes of the drops that are looked for, in stated deviations of the ratio.
const DROPS: [f64; 4] = [5.0, 10.0, 20.0, 40.0];

/// Alarms a minute that are asked for, where delay is told against them.
const ASKED: [f64; 4] = [0.1, 1.0, 5.0, 20.0];

type Detector = Box<dyn SlipDetector<f64>>;
type Maker = fn(f64) -> Result<Detector, Failure>;

/// The detector that learns the noise.
fn adaptive(asked: f64, rate: f64) -> Result<Detector, Failure> {
    Ok(Box::new(AdaptiveDropDetector::new(ForceNoise::isotropic(STATED)?, asked, rate)?))
}

const DETECTORS: [(&str, Maker); 3] = [
    ("adaptive drop, for 1/min", |rate| adaptive(1.0, rate)),
    ("drop, default", |_| Ok(Box::new(DropDetector::new(ForceNoise::isotropic(STATED)?)?))),
    ("likelihood ratio, 16 samples, for 1/min", |rate| {
        Ok(Box::new(LikelihoodRatioDetector::<f64, 16>::new(ForceNoise::isotropic(STATED)?, 1.0, rate)?))
    }),
];

/// Alarms a minute in a hold of 5 N, 2 N.
fn in_a_hold(mut detector: Detector, kind: Kind, rate: f64, samples: u64) -> f64 {
    let mut noise = Noise::new(kind, rate, 11);
    let slipping = |_: &u64| detector.update(&noise.on(5.0, 2.0), 1.0 / rate) == SlipVerdict::Slipping;
    let alarms = (0..samples).filter(slipping).count();
    alarms as f64 / (samples as f64 / rate / 60.0)
}

/// The same in touches of a second or so with a tenth of a second between them, each of which ends in a release of two
/// samples.
fn in_touches(mut detector: Detector, kind: Kind, rate: f64, samples: u64) -> f64 {
    let mut noise = Noise::new(kind, rate, 12);
    let (mut alarms, mut passed) = (0_u32, 0);
    while passed < samples {
        let length = (rate * noise.random().random_range(0.2..2.2)) as u64;
        let rise = rate * noise.random().random_range(0.02..0.12);
        for step in 0..length {
            let release = match length - step {
                2 => 0.6,
                1 => 0.2,
                _ => 1.0,
            };
            let normal = 0.3 + 4.7 * (step as f64 / rise).min(1.0) * release;
            let verdict = detector.update(&noise.on(normal, 0.4 * normal), 1.0 / rate);
            alarms += u32::from(verdict == SlipVerdict::Slipping);
        }
        let pause = (0.1 * rate) as u64;
        for _ in 0..pause {
            detector.update_open(1.0 / rate);
        }
        passed += length + pause;
    }
    f64::from(alarms) / (passed as f64 / rate / 60.0)
}

/// The share of drops that is missed within 30 ms, and the median delay of the others \[ms\], at 1 kHz.
fn drops(mut detector: Detector, kind: Kind, size: f64) -> (f64, f64) {
    const TRIALS: u32 = 200;
    let mut noise = Noise::new(kind, 1000.0, 13);
    let drop = size * STATED * (1.0_f64 + 0.4 * 0.4).sqrt();
    let mut slips = |level: f64| detector.update(&noise.on(5.0, level), 1e-3) == SlipVerdict::Slipping;
    for _ in 0..20_000 {
        slips(2.0);
    }
    let mut delays = Vec::new();
    for _ in 0..TRIALS {
        // Back up in a while: a rise is no drop.
        for step in 0..1000_u32 {
            slips(2.0 - drop * (1.0 - f64::from(step) / 500.0).max(0.0));
        }
        delays.extend((1..=30_u32).find(|_| slips(2.0 - drop)).map(f64::from));
        for _ in 0..100 {
            slips(2.0 - drop);
        }
    }
    delays.sort_by(f64::total_cmp);
    (1.0 - delays.len() as f64 / f64::from(TRIALS), quantile(&delays, 0.5))
}

/// `FINGERTIP_SAMPLES` says how many samples of each kind and rate; ten million by default.
pub(crate) fn report(page: &mut Page) -> Result<(), Failure> {
    let samples = match std::env::var("FINGERTIP_SAMPLES") {
        Ok(text) => text.parse()?,
        Err(_) => 10_000_000,
    };
    page.say(&format!(
        "False alarms a minute over {samples} samples each, in a hold of 5 N and 2 N, and on touches of a second or so with \
         lift-offs; then, at 1 kHz, the share of drops by 5, 10, 20 and 40 stated deviations of \
         the ratio that is missed within 30 ms, with the median delay of the others. The stated noise is 20 mN; sizes of \
         noise are in it."
    ));
    for (name, make) in DETECTORS {
        // What fails does so at once.
        let samples = if name.starts_with("adaptive") { samples } else { samples / 10 };
        let mut text = format!("\n## Kinds of noise: {name}\n\n| noise |");
        RATES.iter().try_for_each(|rate| write!(text, " {rate} Hz: hold, touches |"))?;
        DROPS.iter().try_for_each(|size| write!(text, " missed by {size}: %, ms |"))?;
        text += "\n|---|";
        text += &"---|".repeat(RATES.len() + DROPS.len());
        text += "\n";
        for (kind_name, kind) in KINDS {
            write!(text, "| {kind_name} |")?;
            for rate in RATES {
                let hold = in_a_hold(make(rate)?, kind, rate, samples);
                write!(text, " {hold:.2}, {:.2} |", in_touches(make(rate)?, kind, rate, samples))?;
            }
            for size in DROPS {
                let (missed, delay) = drops(make(1000.0)?, kind, size);
                write!(text, " {:.0}, {delay:.0} |", 100.0 * missed)?;
            }
            text += "\n";
        }
        page.say(&text);
    }
    page.say(&delay_against_alarms(samples)?);
    Ok(())
}

/// What a rarer false alarm costs: for each rate that is asked for, that which is found in a hold at 1 kHz, and the drops
/// that are missed, with the delay of the others.
fn delay_against_alarms(samples: u64) -> Result<String, Failure> {
    let mut text = "\n## Delay against false alarms: adaptive drop, 1 kHz\n\nFor each rate of false alarms that is asked \
         for: the rate found in a hold, and of drops by 5 and by 10 deviations the share missed within 30 ms, with the \
         median delay of the others.\n\n| noise |"
        .to_owned();
    ASKED.iter().try_for_each(|asked| write!(text, " {asked}/min: found | by 5: %, ms | by 10: %, ms |"))?;
    text += "\n|---|";
    text += &"---|".repeat(3 * ASKED.len());
    text += "\n";
    for (name, kind) in KINDS {
        write!(text, "| {name} |")?;
        for asked in ASKED {
            let found = in_a_hold(adaptive(asked, 1000.0)?, kind, 1000.0, samples);
            write!(text, " {found:.2} |")?;
            for size in [5.0, 10.0] {
                let (missed, delay) = drops(adaptive(asked, 1000.0)?, kind, size);
                write!(text, " {:.0}, {delay:.0} |", 100.0 * missed)?;
            }
        }
        text += "\n";
    }
    Ok(text)
}
