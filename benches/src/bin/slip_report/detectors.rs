//! The detectors' scores on the ramps.

use core::fmt::Write as _;

use fingertip_friction::{
    Cusum, DropDetector, ForceNoise, LikelihoodRatioDetector, NormalForceGate, RatioThreshold, SlipDetector,
    SlipVerdict,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::Failure;
use crate::page::{Page, Scale, Series};
use crate::ramps::{RAMPS, Ramp, ramps, sample, stated};

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Threshold,
    Drop,
    CumulativeSum { allowance: f64, threshold: Option<f64> },
    LikelihoodRatio,
}

impl Kind {
    fn name(self) -> String {
        match self {
            Self::Threshold => "ratio threshold at 0.9 (friction known)".into(),
            Self::Drop => "drop, default".into(),
            Self::CumulativeSum { allowance, threshold: None } => {
                format!("drop, k = {allowance}, h for 1/min")
            }
            Self::CumulativeSum { allowance, threshold: Some(h) } => {
                format!("drop, k = {allowance}, h = {h}")
            }
            Self::LikelihoodRatio => "likelihood ratio, 16 samples, for 1/min".into(),
        }
    }

    fn detector(
        self,
        noise: ForceNoise<f64>,
        rate: f64,
        mu: f64,
    ) -> Result<Box<dyn SlipDetector<f64>>, Failure> {
        Ok(match self {
            Self::Threshold => Box::new(
                RatioThreshold::new(NormalForceGate::from_noise(&noise), mu)?.with_warning_share(0.9)?,
            ),
            Self::Drop => Box::new(DropDetector::new(noise)?),
            Self::CumulativeSum { allowance, threshold } => {
                let sum = match threshold {
                    Some(h) => Cusum::new(allowance, h)?,
                    None => Cusum::for_false_alarms(allowance, 1.0, rate)?,
                };
                Box::new(DropDetector::with_sum(noise, sum)?)
            }
            Self::LikelihoodRatio => Box::new(LikelihoodRatioDetector::<f64, 16>::new(noise, 1.0, rate)?),
        })
    }
}

/// What is drawn where half an hour passed without an alarm.
const LEAST_RATE: f64 = 0.03;

struct Score {
    rate: f64,
    name: String,
    /// Delays after slip \[s\], sorted; negative where it came before.
    delays: Vec<f64>,
    missed: usize,
    /// Ramps with an alarm more than 5 ms (or two samples) before slip.
    early: usize,
    /// Times by which a warning came before slip \[s\], sorted.
    lead: Vec<f64>,
    false_alarms_per_minute: f64,
}

pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    sorted.get((last * share).round() as usize).copied().unwrap_or(f64::NAN)
}

/// False alarms a minute in holds: constant, drifting, and with steps of the normal force; noise of
/// 20 mN, some minutes.
fn false_alarms(kind: Kind, rate: f64, minutes: f64) -> Result<f64, Failure> {
    let mut rng = Pcg64Mcg::seed_from_u64(99);
    let mut detector = kind.detector(ForceNoise::isotropic(0.02)?, rate, 0.8)?;
    let samples = (minutes * 60.0 * rate) as u64;
    let mut alarms = 0;
    for index in 0..samples {
        let time = index as f64 / rate;
        let third = (3 * index) / samples;
        if third != (3 * index.saturating_sub(1)) / samples {
            // Another hold; the load between them is not part of it.
            detector.reset();
        }
        let normal = if third == 2 && (time as u64).is_multiple_of(2) { 6.0 } else { 4.0 };
        let tangential = if third == 1 { 1.6 + 0.8 * (0.2 * time).sin() } else { 1.6 };
        let force = sample(&mut rng, normal, tangential, 0.02, 0.0);
        alarms += u64::from(detector.update(&force, 1.0 / rate) == SlipVerdict::Slipping);
    }
    Ok(alarms as f64 / minutes)
}

fn score(
    kind: Kind,
    ramps: &[Ramp],
    rate: f64,
    minutes: f64,
    rows: &mut String,
    set: &str,
) -> Result<Score, Failure> {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let every = (10_000.0 / rate).round() as usize;
    let tolerance = 5e-3_f64.max(2.0 / rate);
    let (mut delays, mut lead, mut missed, mut early) = (Vec::new(), Vec::new(), 0, 0);
    for (number, ramp) in ramps.iter().enumerate() {
        let mut detector = kind.detector(stated(ramp.noise, ramp.step)?, rate, ramp.static_coefficient)?;
        // The sensor's clock does not know when it slips.
        let phase = rng.random_range(0..every);
        let (mut found, mut too_early, mut warned) = (None, false, None);
        for (index, tangential) in ramp.tangential.iter().enumerate().skip(phase).step_by(every) {
            let time = index as f64 / 10_000.0;
            let force = sample(&mut rng, ramp.normal, *tangential, ramp.noise, ramp.step);
            match detector.update(&force, 1.0 / rate) {
                SlipVerdict::Slipping if time < ramp.slip - tolerance => too_early = true,
                SlipVerdict::Slipping => found = found.or(Some(time - ramp.slip)),
                SlipVerdict::Warning if warned.is_none() => warned = Some(ramp.slip - time),
                _ => {}
            }
        }
        if kind == Kind::Threshold {
            // It foretells: a warning before slip is what counts.
            match warned {
                Some(before) => {
                    lead.push(before);
                    missed += usize::from(before < 0.0);
                }
                None => missed += 1,
            }
        } else {
            early += usize::from(too_early);
            missed += usize::from(found.is_none());
            delays.extend(found);
        }
        let show = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.6}"));
        writeln!(
            rows,
            "{set},{rate},{},{number},{:.4},{:.4},{:.5},{:.6},{:.6},{},{},{too_early}",
            kind.name().replace(',', ";"),
            ramp.normal,
            ramp.static_coefficient,
            ramp.noise,
            ramp.step,
            ramp.slip,
            show(found),
            show(warned)
        )?;
    }
    delays.sort_by(f64::total_cmp);
    lead.sort_by(f64::total_cmp);
    let false_alarms_per_minute = false_alarms(kind, rate, minutes)?;
    Ok(Score { rate, name: kind.name(), delays, missed, early, lead, false_alarms_per_minute })
}

fn table(title: &str, scores: &[Score]) -> Result<String, Failure> {
    let mut text = format!("\n## {title}\n\n");
    text += "| rate Hz | detector | delay median ms | 95 % ms | missed | early | false alarms/min | lead median ms | lead 5 % ms |\n";
    text += "|---|---|---|---|---|---|---|---|---|\n";
    for s in scores {
        let ms = |x: f64| if x.is_nan() { "-".into() } else { format!("{:.2}", x * 1e3) };
        writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {:.2} | {} | {} |",
            s.rate,
            s.name,
            ms(quantile(&s.delays, 0.5)),
            ms(quantile(&s.delays, 0.95)),
            s.missed,
            s.early,
            s.false_alarms_per_minute,
            ms(quantile(&s.lead, 0.5)),
            ms(quantile(&s.lead, 0.05)),
        )?;
    }
    Ok(text)
}

/// Scores every detector; returns the rows of the file, one per ramp and detector.
pub(crate) fn report(page: &mut Page) -> Result<String, Failure> {
    let mut rows = String::from(
        "set,rate_Hz,detector,ramp,normal_N,static_coefficient,noise_N,step_N,slip_s,delay_s,lead_s,early\n",
    );
    let [plain, mixed] = ramps()?;
    let kinds = [
        Kind::Threshold,
        Kind::Drop,
        Kind::CumulativeSum { allowance: 0.75, threshold: None },
        Kind::CumulativeSum { allowance: 1.0, threshold: None },
        Kind::LikelihoodRatio,
    ];
    page.say(&format!(
        "{RAMPS} ramps of LuGre friction (parameters of 1995 per newton of normal force), static coefficient \
         0.4-1, kinetic 0.6-0.85 of it, normal force 1-10 N, mass 20-300 g. Delays count from the Stribeck \
         speed of 1 mm/s; early is an alarm more than 5 ms (or two samples) before it. False alarms are \
         counted in holds with 20 mN of noise: constant, drifting, with steps of the normal force. Lead is \
         the time by which a warning came before slip. The ratio threshold, which knows the coefficient, \
         misses where it did not warn before slip: a fast pull breaks away below the static coefficient."
    ));
    for (title, set, ramps) in [
        ("Noise 20 mN, no converter", "plain", &plain),
        ("Noise 5-50 mN; converter none, 12 or 16 bits over 60 N", "mixed", &mixed),
    ] {
        let mut scores = Vec::new();
        for rate in [100.0, 1000.0, 10_000.0] {
            for kind in kinds {
                let minutes = if rate > 5000.0 { 6.0 } else { 30.0 };
                scores.push(score(kind, ramps, rate, minutes, &mut rows, set)?);
            }
        }
        page.say(&table(title, &scores)?);
    }

    // The receiver operating curve, on slips faint enough to be missed.
    let faint: Vec<Ramp> = plain.into_iter().map(|ramp| Ramp { noise: 0.08, ..ramp }).collect();
    let (mut curve, mut scores) = (Vec::new(), Vec::new());
    for h in [1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0] {
        let kind = Kind::CumulativeSum { allowance: 0.75, threshold: Some(h) };
        let s = score(kind, &faint, 1000.0, 30.0, &mut rows, "faint")?;
        let rate = s.false_alarms_per_minute.max(LEAST_RATE);
        curve.push((rate, s.missed as f64 / RAMPS as f64, Some(h)));
        scores.push(s);
    }
    page.say(&table("Receiver operating curve: noise 80 mN (faint slips), 1 kHz", &scores)?);
    page.plot(
        "missed",
        "Missed slips against false alarms: faint slips, 1 kHz; the numbers are the threshold h",
        "false alarms per minute (0.03 or fewer at the left edge)",
        "share of slips missed",
        Scale { x: 0.02..2000.0, y: 0.0..0.25, logarithmic: false },
        &[Series { name: "drop, k = 0.75", points: curve }],
    )?;
    Ok(rows)
}
