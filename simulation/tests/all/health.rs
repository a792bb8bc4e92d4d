//! The health of simulated sensors: every injected fault is named, and sound ones are called sound.

use fingertip_recordings::health::{Depth, Health, HealthWatch, Kind, Level, WatchedChannel, What};
use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint};
use fingertip_wrench::ChannelLimits;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

type Rows = Vec<(f64, Vec<f64>)>;

/// A recording of the six gauges \[V\], at rest or with loads at random places.
fn recorded(seed: u64, loaded: bool) -> Rows {
    let mut random = Pcg64Mcg::seed_from_u64(1000 + seed);
    let mut script = Script::default().rest(3.0);
    for _ in 0..if loaded { 6 } else { 0 } {
        let at = SurfacePoint::degrees(random.random_range(0.0..100.0), random.random_range(0.0..360.0));
        let (force, to) = (random.random_range(0.5..15.0), random.random_range(0.0..60.0));
        let roll = SurfacePoint::degrees(to, random.random_range(0.0..360.0));
        script = script.press(at, force, 0.2).hold(0.3).roll(roll, 0.5).hold(0.1).release(0.15).rest(0.25);
    }
    let script = script.rest(if loaded { 0.5 } else { 7.0 });
    let sensor = SimulatedFingertip::new(&script, Options { seed, ..Options::default() }).expect("a script");
    sensor.map(|sample| (sample.time, sample.raw.iter().take(6).copied().collect())).collect()
}

/// Noise of a reading of the simulated gauges \[V\], as the first test below finds it.
const NOISE: f64 = 0.28e-3;

fn watched(rows: &Rows, depth: Depth) -> Health {
    let limits = ChannelLimits::new(0.01, 4.99).expect("a range");
    let channel =
        |number: usize| WatchedChannel::new(&format!("v{number}"), "V", Kind::Signal).within(limits);
    let mut watch = HealthWatch::new((1..=6).map(channel).collect(), depth);
    rows.iter().for_each(|(time, readings)| watch.add(Some(*time), readings));
    watch.finish()
}

#[test]
fn a_hundred_sound_recordings_are_called_sound() {
    let mut alarms = Vec::new();
    for seed in 0..100 {
        let health = watched(&recorded(seed, seed % 2 == 1), Depth::Full);
        assert!(health.rest.is_some(), "{seed}");
        alarms.extend(health.faults().map(|finding| format!("{seed}: {finding}")));
        if seed == 0 {
            let noise =
                health.channels.iter().map(|channel| channel.noise.as_ref().expect("rested").deviation);
            assert!(noise.into_iter().all(|noise| (noise / NOISE - 1.0).abs() < 0.1));
            assert!(
                health
                    .channels
                    .iter()
                    .all(|channel| (channel.step.expect("known") * 16.0 * 4096.0 / 5.0 - 1.0).abs() < 0.01)
            );
        }
    }
    assert!(alarms.is_empty(), "{alarms:#?}");
}

struct Fault {
    name: &'static str,
    size: &'static str,
    /// Whether loads are needed to see it.
    loaded: bool,
    what: What,
    level: Level,
    /// The channel that must be named; all of them are for none.
    channel: Option<&'static str>,
    inject: fn(&mut Rows, &mut Pcg64Mcg),
}

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

/// The reading of channel `v2` that so much of the recording is below.
fn quantile(rows: &Rows, share: f64) -> f64 {
    let mut values: Vec<f64> = rows.iter().map(|(_, readings)| readings[1]).collect();
    values.sort_by(f64::total_cmp);
    values[(share * (values.len() - 1) as f64) as usize]
}

fn each(rows: &mut Rows, mut change: impl FnMut(f64, &mut Vec<f64>)) {
    rows.iter_mut().for_each(|(time, readings)| change(*time, readings));
}

/// All faults; each is put on channel `v2` unless it is of all.
fn faults() -> Vec<Fault> {
    let fault = |name, size, loaded, what, level, inject: fn(&mut Rows, &mut Pcg64Mcg)| Fault {
        name,
        size,
        loaded,
        what,
        level,
        channel: Some("v2"),
        inject,
    };
    let of_all = |fault: Fault| Fault { channel: None, ..fault };
    vec![
        fault("dead", "2.5 V all the time", false, What::Dead, Level::Bad, |rows, _| {
            each(rows, |_, r| r[1] = 2.5)
        }),
        fault("dead, amplifier alive", "noise alone", true, What::Unmoved, Level::Suspect, |rows, random| {
            each(rows, |_, r| r[1] = 2.5 + NOISE * normal(random));
        }),
        fault("stuck", "0.3 s", false, What::Stuck, Level::Bad, |rows, _| {
            let held = rows[4000].1[1];
            each(rows, |t, r| {
                if (4.0..4.3).contains(&t) {
                    r[1] = held
                }
            });
        }),
        fault("stuck", "to the end", true, What::Stuck, Level::Bad, |rows, _| {
            let held = quantile(rows, 0.5);
            each(rows, |t, r| {
                if t > 4.0 {
                    r[1] = held
                }
            });
        }),
        fault(
            "stuck, two values",
            "5 s between neighbours",
            false,
            What::Stuck,
            Level::Bad,
            |rows, random| {
                let held = quantile(rows, 0.5);
                each(rows, |t, r| {
                    if t > 5.0 {
                        r[1] = held + 5.0 / 65_536.0 * f64::from(random.random_range(0..2))
                    }
                });
            },
        ),
        fault("clipped above", "2 % of the readings", true, What::Clipped, Level::Bad, |rows, _| {
            let limit = quantile(rows, 0.98);
            each(rows, |_, r| r[1] = r[1].min(limit));
        }),
        fault("clipped below", "2 % of the readings", true, What::Clipped, Level::Bad, |rows, _| {
            let limit = quantile(rows, 0.02);
            each(rows, |_, r| r[1] = r[1].max(limit));
        }),
        fault("saturated", "10 readings", false, What::Saturated, Level::Bad, |rows, _| {
            each(rows, |t, r| {
                if (5.0..5.0095).contains(&t) {
                    r[1] = 5.0
                }
            });
        }),
        fault("noisy", "4 times the noise", false, What::Noisy, Level::Suspect, |rows, random| {
            each(rows, |_, r| r[1] += 4.0 * NOISE * normal(random));
        }),
        fault("mains", "50 Hz of 0.7 times the noise", false, What::Hum, Level::Suspect, |rows, _| {
            each(rows, |t, r| r[1] += NOISE * (core::f64::consts::TAU * 50.0 * t).sin());
        }),
        fault("drift", "10 times the noise in 10 s", false, What::Drift, Level::Suspect, |rows, _| {
            each(rows, |t, r| r[1] += NOISE * t);
        }),
        fault("settling", "15 times the noise, 2 s", false, What::Settling, Level::Suspect, |rows, _| {
            each(rows, |t, r| r[1] += 15.0 * NOISE * (-t / 2.0).exp());
        }),
        fault("zero step", "12 times the noise", false, What::ZeroStep, Level::Suspect, |rows, _| {
            each(rows, |t, r| {
                if t > 6.0 {
                    r[1] -= 12.0 * NOISE
                }
            });
        }),
        of_all(fault("tare", "all to zero at 6 s", false, What::Tare, Level::Suspect, |rows, _| {
            let zero = rows[6001].1.clone();
            each(rows, |t, r| {
                if t > 6.0 {
                    r.iter_mut().zip(&zero).for_each(|(r, zero)| *r -= zero)
                }
            });
        })),
        fault("cross-talk", "15 % of the next channel", false, What::CrossTalk, Level::Suspect, |rows, _| {
            each(rows, |_, r| r[1] += 0.15 * r[4]);
        }),
        fault("identical", "v2 reads v5", false, What::Identical, Level::Bad, |rows, _| {
            each(rows, |_, r| r[1] = r[4])
        }),
        of_all(fault(
            "common noise",
            "of half the noise",
            false,
            What::CommonNoise,
            Level::Note,
            |rows, random| {
                each(rows, |_, r| {
                    let common = 0.5 * NOISE * normal(random);
                    r.iter_mut().for_each(|r| *r += common);
                });
            },
        )),
        of_all(fault("gaps", "3 times 5 samples", false, What::Gaps, Level::Suspect, |rows, _| {
            for at in [8000, 5000, 2000] {
                rows.drain(at..at + 5);
            }
        })),
        of_all(fault("repeats", "7 samples", false, What::Repeats, Level::Suspect, |rows, _| {
            (1..8).for_each(|i| rows.insert(i * 1000, rows[i * 1000].clone()));
        })),
        of_all(fault("held", "every third twice", false, What::Held, Level::Suspect, |rows, _| {
            (1..rows.len()).step_by(3).for_each(|i| rows[i].1 = rows[i - 1].1.clone());
        })),
        of_all(fault("jitter", "a third of the step", false, What::Jitter, Level::Note, |rows, random| {
            rows.iter_mut().for_each(|(t, _)| *t += 1e-3 * random.random_range(-0.45..0.45));
        })),
        fault("not finite", "3 readings", false, What::NotFinite, Level::Bad, |rows, _| {
            [100, 2000, 2001].into_iter().for_each(|i| rows[i].1[1] = f64::NAN);
        }),
        fault("coarse", "a step of 5 times the noise", false, What::Coarse, Level::Note, |rows, _| {
            let middle = quantile(rows, 0.5);
            // Between two steps, so that they show.
            each(rows, |_, r| r[1] = middle + ((r[1] - middle) / (5.0 * NOISE) + 0.5).round() * 5.0 * NOISE);
        }),
    ]
}

/// The table: fault, size, found or not, and what else was said of the same recordings.
#[test]
fn every_fault_is_named() {
    const SEEDS: u64 = 5;
    let mut missed = Vec::new();
    for fault in faults() {
        let mut found = 0;
        let mut beside = Vec::new();
        for seed in 200..200 + SEEDS {
            let mut random = Pcg64Mcg::seed_from_u64(seed);
            let mut rows = recorded(seed, fault.loaded);
            (fault.inject)(&mut rows, &mut random);
            let health = watched(&rows, Depth::Full);
            let is_it = |finding: &&fingertip_recordings::health::Finding| {
                let named =
                    fault.channel.is_none_or(|channel| finding.channels.iter().any(|name| name == channel));
                finding.what == fault.what && finding.level == fault.level && named
            };
            found += u64::from(health.findings.iter().any(|finding| is_it(&finding)));
            beside.extend(health.faults().filter(|finding| !is_it(finding)).map(ToString::to_string));
        }
        beside.dedup();
        println!("| {} | {} | {found} of {SEEDS} |", fault.name, fault.size);
        if found < SEEDS {
            missed.push(format!(
                "{} ({}): {found} of {SEEDS}; said instead: {beside:?}",
                fault.name, fault.size
            ));
        }
        // A fault of one channel is not blamed on another.
        if fault.channel.is_some() && fault.what != What::Identical {
            let other = beside.iter().find(|said| !said.contains("v2"));
            assert!(other.is_none(), "{}: {other:?}", fault.name);
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn the_brief_look_sees_what_costs_little() {
    for fault in faults().into_iter().filter(|fault| {
        !matches!(fault.what, What::Hum | What::CrossTalk | What::Identical | What::CommonNoise)
    }) {
        let mut rows = recorded(300, fault.loaded);
        (fault.inject)(&mut rows, &mut Pcg64Mcg::seed_from_u64(300));
        let health = watched(&rows, Depth::Brief);
        assert!(
            health.findings.iter().any(|finding| finding.what == fault.what),
            "{}: {:?}",
            fault.name,
            health.findings
        );
    }
}
