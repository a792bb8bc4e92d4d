//! Slip detectors: delay against false alarms.

use fingertip_friction::{
    Cusum, DropDetector, ForceNoise, LikelihoodRatioDetector, SlipDetector, SlipVerdict,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::ramps::{RAMPS, Ramp, ramps, sample, stated};
use crate::table::{Table, shown};
use crate::timing::{Effort, quantile};

/// Samples per second.
const RATE: f64 = 1000.0;
/// Noise of the normal and the tangential force \[N\]: that of the ramps, and one at which slips are
/// faint.
const NOISES: [(f64, &str); 2] = [(0.02, "noise of 20 mN"), (0.08, "noise of 80 mN")];

#[derive(Clone, Copy)]
enum Family {
    /// Page's cumulative sum with this allowance; swept over the threshold.
    Sum(f64),
    /// The generalised likelihood ratio over 16 samples; swept over the wanted rate.
    Ratio,
}

type Detector = Box<dyn SlipDetector<f64>>;

impl Family {
    fn name(self) -> String {
        match self {
            Self::Sum(allowance) => format!("drop, k = {allowance}"),
            Self::Ratio => "likelihood ratio, 16 samples".to_owned(),
        }
    }

    /// What is swept, in the order of ever fewer false alarms.
    fn settings(self, effort: Effort) -> Vec<f64> {
        let all: &[f64] = match self {
            Self::Sum(_) => &[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0],
            Self::Ratio => &[500.0, 100.0, 10.0, 1.0, 0.1, 0.01],
        };
        all.iter().copied().step_by(effort.choose(3, 1)).collect()
    }

    fn detector(self, setting: f64, noise: ForceNoise<f64>) -> Result<Detector, Failure> {
        Ok(match self {
            Self::Sum(allowance) => Box::new(DropDetector::with_sum(noise, Cusum::new(allowance, setting)?)?),
            Self::Ratio => Box::new(LikelihoodRatioDetector::<f64, 16>::new(noise, setting, RATE)?),
        })
    }
}

/// A point of the curve.
struct Score {
    family: String,
    set: &'static str,
    setting: f64,
    /// Median and 95 % of the delay \[ms\].
    delay: f64,
    late: f64,
    missed: f64,
    false_alarms_per_minute: f64,
}

/// False alarms a minute of a hold with the stated noise.
fn false_alarms(family: Family, setting: f64, noise: f64, minutes: f64) -> Result<f64, Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(99);
    let mut detector = family.detector(setting, ForceNoise::isotropic(noise)?)?;
    let mut alarms = 0_u32;
    for _ in 0..(minutes * 60.0 * RATE) as u64 {
        let force = sample(&mut random, 4.0, 1.6, noise, 0.0);
        alarms += u32::from(detector.update(&force, 1.0 / RATE) == SlipVerdict::Slipping);
    }
    // Where none was seen, the rate is below one in that time.
    Ok(f64::from(alarms.max(1)) / minutes)
}

fn score(
    family: Family,
    setting: f64,
    ramps: &[Ramp],
    (noise, set): (f64, &'static str),
    minutes: f64,
) -> Result<Score, Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let every = (10_000.0 / RATE).round() as usize;
    let (mut delays, mut missed) = (Vec::new(), 0_usize);
    for ramp in ramps {
        let mut detector = family.detector(setting, stated(noise, 0.0)?)?;
        let phase = random.random_range(0..every);
        let mut found = None;
        for (index, tangential) in ramp.tangential.iter().enumerate().skip(phase).step_by(every) {
            let time = index as f64 / 10_000.0;
            let force = sample(&mut random, ramp.normal, *tangential, noise, 0.0);
            let slipping = detector.update(&force, 1.0 / RATE) == SlipVerdict::Slipping;
            // What comes more than 5 ms before slip is a false alarm, counted elsewhere.
            if slipping && found.is_none() && time > ramp.slip - 5e-3 {
                found = Some(1e3 * (time - ramp.slip));
            }
        }
        missed += usize::from(found.is_none());
        delays.extend(found);
    }
    delays.sort_by(f64::total_cmp);
    Ok(Score {
        family: family.name(),
        set,
        setting,
        delay: quantile(&delays, 0.5),
        late: quantile(&delays, 0.95),
        missed: missed as f64 / ramps.len().max(1) as f64,
        false_alarms_per_minute: false_alarms(family, setting, noise, minutes)?,
    })
}

/// Of each family, the quickest that gives at most one false alarm a minute.
fn quickest(scores: &[Score]) -> Table {
    let mut short =
        Table::new(&["detector", "noise", "delay median ms", "delay 95 % ms", "missed", "false alarms/min"]);
    for (_, set) in NOISES {
        for family in [Family::Sum(0.5), Family::Sum(0.75), Family::Sum(1.0), Family::Ratio] {
            let best = scores
                .iter()
                .filter(|s| s.set == set && s.family == family.name() && s.false_alarms_per_minute <= 1.0)
                .min_by(|a, b| a.late.total_cmp(&b.late));
            if let Some(s) = best {
                short.row([
                    s.family.clone(),
                    set.to_owned(),
                    shown(s.delay),
                    shown(s.late),
                    format!("{:.1} %", 100.0 * s.missed),
                    shown(s.false_alarms_per_minute),
                ]);
            }
        }
    }
    short
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Slip detectors: delay against false alarms");
    let minutes = effort.choose(1.0, 30.0);
    page.say(&format!(
        "Up to {RAMPS} objects on LuGre friction, pulled until they slip (static coefficient 0.4 to 1, kinetic 0.6 to \
         0.85 of it, normal force 1 to 10 N, 20 to 300 g), read at 1 kHz. Delays count from a sliding speed \
         of 1 mm/s. False alarms are counted in a hold of {minutes} minutes; none counts as one. The report \
         `slip_report` has more of this: converters, rates, holds that drift, the threshold of a known friction \
         coefficient, and a real tribometer."
    ));
    let [plain, _] = ramps()?;
    let plain = &plain[..effort.choose(60, RAMPS).min(plain.len())];
    let mut scores = Vec::new();
    for noise in NOISES {
        for family in [Family::Sum(0.5), Family::Sum(0.75), Family::Sum(1.0), Family::Ratio] {
            for setting in family.settings(effort) {
                scores.push(score(family, setting, plain, noise, minutes)?);
            }
        }
    }
    for (index, (_, set)) in NOISES.iter().enumerate() {
        let mut series: Vec<Series> = Vec::new();
        for score in scores.iter().filter(|s| s.set == *set) {
            let index = series.iter().position(|s| s.name == score.family).unwrap_or_else(|| {
                series.push(Series { name: score.family.clone(), joined: true, ..Series::default() });
                series.len() - 1
            });
            series[index].points.push((score.false_alarms_per_minute, score.late));
        }
        page.diagram(
            &format!("detectors_{index}"),
            &Diagram {
                title: format!("Slip detectors, {set}: delay that 95 % keep, over false alarms"),
                x: "false alarms per minute",
                y: "95 % of the delays are below, ms",
                series,
                front: true,
            },
        )?;
    }
    let mut table = Table::new(&[
        "detector",
        "noise",
        "threshold or wanted rate",
        "delay median ms",
        "delay 95 % ms",
        "missed",
        "false alarms/min",
    ]);
    for s in &scores {
        table.row([
            s.family.clone(),
            s.set.to_owned(),
            format!("{}", s.setting),
            format!("{:.2}", s.delay),
            format!("{:.2}", s.late),
            format!("{:.4}", s.missed),
            shown(s.false_alarms_per_minute),
        ]);
    }
    page.table(&table);
    page.data("detectors", &table);
    let short = quickest(&scores);
    let said = format!(
        "The quickest setting of each detector with at most one false alarm a minute, 1 kHz.\n\n{}",
        short.markdown()
    );
    Ok(("Slip detectors".to_owned(), said))
}
