//! Noise of many kinds on a contact force: for the tests and the slip report.

use core::f64::consts::TAU;

use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::{Rng, RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// The stated deviation \[N\]; all kinds are told in it.
pub(crate) const STATED: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// So many times the stated.
    White(f64),
    /// Of first order, with this correlation of neighbouring samples, and so many times the stated.
    Correlated(f64, f64),
    /// A hum of so many deviations and so many hertz beside the stated noise, on the tangential force or both, with
    /// harmonics or without.
    Hum { size: f64, hertz: f64, both: bool, harmonics: bool },
    /// A converter of so many bits over 60 N, beside noise of so many times the stated.
    Steps(i32, f64),
    /// Loads that drift to and fro by a fifth, each at its own pace.
    Drift,
}

pub(crate) const KINDS: [(&str, Kind); 15] = [
    ("white, as stated", Kind::White(1.0)),
    ("white, 3 times", Kind::White(3.0)),
    ("white, 5 times", Kind::White(5.0)),
    ("correlated by 0.5", Kind::Correlated(0.5, 1.0)),
    ("correlated by 0.9", Kind::Correlated(0.9, 1.0)),
    ("correlated by 0.95", Kind::Correlated(0.95, 1.0)),
    ("correlated by 0.9, 3 times", Kind::Correlated(0.9, 3.0)),
    ("hum of 1 at 50 Hz", Kind::Hum { size: 1.0, hertz: 50.0, both: false, harmonics: false }),
    ("hum of 2 at 60 Hz", Kind::Hum { size: 2.0, hertz: 60.0, both: false, harmonics: false }),
    ("hum of 3 at 50 Hz, harmonics", Kind::Hum { size: 3.0, hertz: 50.0, both: false, harmonics: true }),
    ("hum of 10 at 50 Hz, both forces", Kind::Hum { size: 10.0, hertz: 50.0, both: true, harmonics: false }),
    ("hum of 10 at 60 Hz, harmonics", Kind::Hum { size: 10.0, hertz: 60.0, both: true, harmonics: true }),
    ("12 bits over 60 N, a fifth of the noise", Kind::Steps(12, 0.2)),
    ("16 bits over 60 N", Kind::Steps(16, 1.0)),
    ("drifting loads", Kind::Drift),
];

pub(crate) struct Noise {
    kind: Kind,
    rate: f64,
    random: Pcg64Mcg,
    memory: [f64; 2],
    phases: [f64; 4],
    samples: u64,
}

impl Noise {
    pub(crate) fn new(kind: Kind, rate: f64, seed: u64) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let phases = [(); 4].map(|()| random.random_range(0.0..TAU));
        Self { kind, rate, random, memory: [0.0; 2], phases, samples: 0 }
    }

    /// The contact force of the next sample, of which these are the true parts.
    pub(crate) fn on(&mut self, normal: f64, tangential: f64) -> ContactForce<f64> {
        let draws = [draw(&mut self.random), draw(&mut self.random)];
        let time = self.samples as f64 / self.rate;
        self.samples += 1;
        let (normal, tangential) = match self.kind {
            Kind::White(times) => {
                (normal + times * STATED * draws[0], tangential + times * STATED * draws[1])
            }
            Kind::Correlated(share, times) => {
                let fresh = (1.0 - share * share).sqrt();
                for (memory, draw) in self.memory.iter_mut().zip(draws) {
                    *memory = share * *memory + fresh * draw;
                }
                let scale = times * STATED;
                (normal + scale * self.memory[0], tangential + scale * self.memory[1])
            }
            Kind::Hum { size, hertz, both, harmonics } => {
                let wave = |order: f64, phase: f64| (TAU * order * hertz * time + phase).sin();
                let mut hum = wave(1.0, self.phases[0]);
                if harmonics {
                    for (order, share, phase) in
                        [(2.0, 0.4, self.phases[1]), (3.0, 0.3, self.phases[2]), (5.0, 0.15, self.phases[3])]
                    {
                        hum += share * wave(order, phase);
                    }
                }
                let on_normal = if both { size * hum } else { 0.0 };
                (normal + STATED * (draws[0] + on_normal), tangential + STATED * (draws[1] + size * hum))
            }
            Kind::Steps(bits, times) => {
                let step = 60.0 / f64::from(2_i32.pow(bits.unsigned_abs()));
                let moved = tangential * (1.0 + 0.1 * (TAU * 0.05 * time).sin());
                let stepped = |x: f64| (x / step).round() * step;
                (stepped(normal + times * STATED * draws[0]), stepped(moved + times * STATED * draws[1]))
            }
            Kind::Drift => (
                normal * (1.0 + 0.2 * (TAU * 0.3 * time).sin()) + STATED * draws[0],
                tangential * (1.0 + 0.2 * (TAU * 0.21 * time).cos()) + STATED * draws[1],
            ),
        };
        ContactForce::new(normal, Vector3::new(0.6 * tangential, -0.8 * tangential, 0.0), 0.0)
    }

    pub(crate) fn random(&mut self) -> &mut impl Rng {
        &mut self.random
    }
}

fn draw(random: &mut impl Rng) -> f64 {
    StandardNormal.sample(random)
}
