//! Scores the slip detectors on simulated ramps.
//!
//! `cargo run --release -p fingertip-benches --bin slip_report [-- FOLDER]`
//!
//! Prints the tables as Markdown, and writes `slip.csv` (one row per ramp and detector) and
//! `slip.html` (tables and the receiver operating curve) into the folder, by default
//! `target/slip_report`.

mod cost;

use core::error::Error;
use core::fmt::Write as _;
use std::path::PathBuf;

use fingertip_friction::{
    Bristle, Cusum, Drive, DropDetector, ForceNoise, LikelihoodRatioDetector, LuGre, NormalForceGate,
    RatioThreshold, SlipDetector, SlipVerdict, Stribeck,
};
use fingertip_wrench::ContactForce;
use nalgebra::{Vector1, Vector3};
use plotters::prelude::{
    BLACK, ChartBuilder, Circle, Color, EmptyElement, IntoDrawingArea, IntoFont, IntoLogRange, LineSeries,
    RED, SVGBackend, Text, WHITE,
};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

type Failure = Box<dyn Error>;

/// Steps of the mechanics per second.
const MECHANICS: f64 = 50_000.0;
const RAMPS: usize = 1000;
const STRIBECK_SPEED: f64 = 1e-3;

/// One object pulled until it slips: the truth at 10 kHz.
struct Ramp {
    normal: f64,
    static_coefficient: f64,
    tangential: Vec<f64>,
    /// When it passed the Stribeck speed \[s\].
    slip: f64,
    /// The noise, and the step of the converter, with which it is read.
    noise: f64,
    step: f64,
}

fn ramp(rng: &mut Pcg64Mcg, plain: bool) -> Result<Ramp, Failure> {
    let normal = rng.random_range(1.0..10.0);
    let static_coefficient = rng.random_range(0.4..1.0);
    let kinetic = static_coefficient * rng.random_range(0.6..0.85);
    // The parameters of Canudas de Wit et al. 1995, per newton of normal force.
    let curve = Stribeck::new(kinetic, static_coefficient, STRIBECK_SPEED)?;
    let mut friction = Bristle::<f64, _, 1>::new(LuGre::new(1e5, 1e5_f64.sqrt(), 0.4, curve)?);
    friction.set_load(normal);
    let mass = rng.random_range(0.02..0.3);
    let rate = normal * static_coefficient / rng.random_range(0.3..1.0);
    let (mut velocity, mut slip, mut index) = (Vector1::new(0.0), f64::NAN, 0_u32);
    let mut tangential = Vec::new();
    let h = 1.0 / MECHANICS;
    loop {
        let time = f64::from(index) * h;
        let drive = Drive { mass: Vector1::new(mass), force: Vector1::new(rate * time), stiffness: 0.0 };
        let end = friction.step_body(&velocity, &drive, h);
        velocity = end.velocity;
        if index.is_multiple_of(5) {
            tangential.push(end.friction[0]);
        }
        if slip.is_nan() && velocity[0] > STRIBECK_SPEED {
            slip = time;
        }
        if time > slip + 0.1 {
            break;
        }
        if time > 3.0 {
            return Err("a ramp did not slip".into());
        }
        index += 1;
    }
    let (noise, step) = if plain {
        (0.02, 0.0)
    } else {
        // 60 N of span at 12 or 16 bits, or no converter.
        let step = [0.0, 60.0 / 65536.0, 60.0 / 4096.0][rng.random_range(0..3)];
        (5e-3 * 10_f64.powf(rng.random_range(0.0..1.0)), step)
    };
    Ok(Ramp { normal, static_coefficient, tangential, slip, noise, step })
}

fn read(rng: &mut Pcg64Mcg, value: f64, noise: f64, step: f64) -> f64 {
    let draw: f64 = StandardNormal.sample(rng);
    let value = value + noise * draw;
    if step > 0.0 { (value / step).round() * step } else { value }
}

fn sample(rng: &mut Pcg64Mcg, normal: f64, tangential: f64, noise: f64, step: f64) -> ContactForce<f64> {
    ContactForce {
        normal: read(rng, normal, noise, step),
        tangential: Vector3::new(read(rng, tangential, noise, step), 0.0, 0.0),
        spin: 0.0,
    }
}

/// What a user would state: the noise with that of the converter's steps.
fn stated(noise: f64, step: f64) -> Result<ForceNoise<f64>, Failure> {
    Ok(ForceNoise::isotropic((noise * noise + step * step / 12.0).sqrt())?)
}

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
            Self::Threshold => Box::new(RatioThreshold::new(NormalForceGate::from_noise(&noise), mu, 0.9)?),
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

fn quantile(sorted: &[f64], share: f64) -> f64 {
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

/// Markdown tables and headings as HTML.
fn html(markdown: &str, plot: &str) -> String {
    let mut body = String::new();
    let mut inside = false;
    for line in markdown.lines() {
        if line.starts_with("|---") {
            continue;
        }
        if let Some(cells) = line.strip_prefix("| ") {
            let tag = if inside { "td" } else { "th" };
            if !inside {
                body += "<div style='overflow-x:auto'><table>";
            }
            inside = true;
            body += "<tr>";
            for cell in cells.trim_end_matches('|').split('|') {
                body += &format!("<{tag}>{}</{tag}>", cell.trim().replace('<', "&lt;"));
            }
            body += "</tr>\n";
            continue;
        }
        if inside {
            body += "</table></div>\n";
            inside = false;
        }
        if let Some(title) = line.strip_prefix("## ") {
            body += &format!("<h2>{title}</h2>\n");
        } else if let Some(title) = line.strip_prefix("# ") {
            body += &format!("<h1>{title}</h1>\n");
        } else if !line.is_empty() {
            body += &format!("<p>{line}</p>\n");
        }
    }
    if inside {
        body += "</table></div>\n";
    }
    format!(
        "<!doctype html><html lang='en'><meta charset='utf-8'>\
         <meta name='viewport' content='width=device-width'><title>Slip detectors</title>\
         <style>body{{font-family:sans-serif;margin:1em;max-width:60em}}table{{border-collapse:collapse}}\
         td,th{{border:1px solid #999;padding:.2em .5em;text-align:right}}svg{{max-width:100%;height:auto}}</style>\
         {body}<h2>Missed slips against false alarms</h2>{plot}</html>"
    )
}

/// Missed share over false alarms a minute, one point per threshold.
fn plot(points: &[(f64, f64, f64)]) -> Result<String, Failure> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (640, 420)).into_drawing_area();
        area.fill(&WHITE)?;
        let top = points.iter().map(|p| p.1).fold(1e-3, f64::max) * 1.1;
        let mut chart = ChartBuilder::on(&area)
            .caption("faint slips, 1 kHz; numbers are the threshold h", ("sans-serif", 16))
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(56)
            .build_cartesian_2d((0.02_f64..2000.0).log_scale(), 0.0..top)?;
        chart
            .configure_mesh()
            .x_desc("false alarms per minute (at most 0.03 where none was seen)")
            .y_desc("share of slips missed")
            .draw()?;
        let place = |p: &(f64, f64, f64)| (p.0.max(0.03), p.1);
        chart.draw_series(LineSeries::new(points.iter().map(place), RED))?;
        chart.draw_series(points.iter().map(|p| Circle::new(place(p), 3, RED.filled())))?;
        let label = ("sans-serif", 12).into_font().color(&BLACK);
        chart.draw_series(
            points
                .iter()
                .map(|p| EmptyElement::at(place(p)) + Text::new(format!("{}", p.2), (6, -14), label.clone())),
        )?;
        area.present()?;
    }
    Ok(svg)
}

fn main() -> Result<(), Failure> {
    if std::env::args().nth(1).as_deref() == Some("--cost") {
        println!("{}", cost::table()?);
        return Ok(());
    }
    let folder =
        std::env::args_os().nth(1).map_or_else(|| PathBuf::from("target/slip_report"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let mut rows = String::from(
        "set,rate_Hz,detector,ramp,normal_N,static_coefficient,noise_N,step_N,slip_s,delay_s,lead_s,early\n",
    );
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let plain: Vec<Ramp> = (0..RAMPS).map(|_| ramp(&mut rng, true)).collect::<Result<_, _>>()?;
    let mixed: Vec<Ramp> = (0..RAMPS).map(|_| ramp(&mut rng, false)).collect::<Result<_, _>>()?;
    let kinds = [
        Kind::Threshold,
        Kind::Drop,
        Kind::CumulativeSum { allowance: 0.75, threshold: None },
        Kind::CumulativeSum { allowance: 1.0, threshold: None },
        Kind::LikelihoodRatio,
    ];
    let mut text = String::from("# Slip detectors, scored\n\n");
    writeln!(
        text,
        "{RAMPS} ramps of LuGre friction (parameters of 1995 per newton of normal force), static coefficient \
         0.4-1, kinetic 0.6-0.85 of it, normal force 1-10 N, mass 20-300 g. Delays count from the Stribeck \
         speed of 1 mm/s; early is an alarm more than 5 ms (or two samples) before it. False alarms are \
         counted in holds with 20 mN of noise: constant, drifting, with steps of the normal force. Lead is \
         the time by which a warning came before slip."
    )?;
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
        text += &table(title, &scores)?;
    }

    // The receiver operating curve, on slips faint enough to be missed.
    let faint: Vec<Ramp> = plain.into_iter().map(|ramp| Ramp { noise: 0.08, ..ramp }).collect();
    let mut curve = Vec::new();
    let mut scores = Vec::new();
    for h in [1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0] {
        let kind = Kind::CumulativeSum { allowance: 0.75, threshold: Some(h) };
        let s = score(kind, &faint, 1000.0, 30.0, &mut rows, "faint")?;
        curve.push((s.false_alarms_per_minute, s.missed as f64 / RAMPS as f64, h));
        scores.push(s);
    }
    text += &table("Receiver operating curve: noise 80 mN (faint slips), 1 kHz", &scores)?;
    println!("{text}");
    std::fs::write(folder.join("slip.csv"), rows)?;
    std::fs::write(folder.join("slip.html"), html(&text, &plot(&curve)?))?;
    println!("Wrote {}", folder.join("slip.html").display());
    Ok(())
}
