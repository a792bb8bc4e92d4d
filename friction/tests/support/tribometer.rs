//! The recording of a reciprocating tribometer, and what the estimators and the detector of
//! incipient slip make of it: for the tests and the slip report.

use fingertip_friction::{ForceNoise, IncipientSlip, NormalForceGate, SlipVerdict, StaticFriction};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

type Failure = Box<dyn core::error::Error>;

/// Samples (time, normal force, position in mm, friction) and strokes (see the recording's own
/// description of its columns).
pub(crate) struct Recording {
    pub(crate) samples: Vec<Vec<f64>>,
    pub(crate) strokes: Vec<Vec<f64>>,
}

/// The columns of a file of numbers; `None` where it is absent, which is said.
fn read(name: &str) -> Option<Vec<Vec<f64>>> {
    let text = fingertip_test_support::recording_text(&format!("friction_tribometer/{name}"))?;
    let parsed: Option<_> =
        text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().ok()).collect()).collect();
    assert!(parsed.is_some(), "{name} holds what is no number");
    parsed
}

pub(crate) fn force(normal: f64, friction: f64) -> ContactForce<f64> {
    ContactForce::new(normal, Vector3::new(friction, 0.0, 0.0), 0.0)
}

/// When the detector of incipient slip warned \[s\], and how often it then called gross slip.
pub(crate) struct Onsets {
    pub(crate) times: Vec<f64>,
    pub(crate) slips: usize,
}

impl Recording {
    pub(crate) fn open() -> Option<Self> {
        Some(Self { samples: read("reciprocating.csv")?, strokes: read("strokes.csv")? })
    }

    pub(crate) fn between(&self, start: f64, end: f64) -> impl DoubleEndedIterator<Item = &Vec<f64>> {
        self.samples.iter().filter(move |row| row[0] >= start && row[0] <= end)
    }

    /// The peak of the friction ratio of each stroke over that of its row, less one.
    pub(crate) fn peak_errors(&self) -> Result<Vec<f64>, Failure> {
        // The recording's own noise, rounded up.
        let noise = ForceNoise { normal: 1e-3, tangential: 2e-4 };
        let peak = |stroke: &Vec<f64>| -> Result<f64, Failure> {
            // A window over the whole stroke, since the peak comes up to half a second after onset.
            let mut friction = StaticFriction::<f64, 256>::new(noise, 0.05, 0.01)?;
            for row in self.between(stroke[0], stroke[1]) {
                // The stroke starts with the friction of the last one: only force along it counts.
                if row[3] * stroke[2] < 0.0 {
                    friction.observe(&force(row[1], row[3]));
                }
            }
            Ok(friction.onset().ok_or("no peak")?.coefficient / stroke[3] - 1.0)
        };
        self.strokes.iter().map(peak).collect()
    }

    pub(crate) fn onsets(&self) -> Result<Onsets, Failure> {
        let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.05)?);
        let mut detector = IncipientSlip::new(gate, 4e-6)?.with_warning_share(0.65)?;
        let mut found = Onsets { times: Vec::new(), slips: 0 };
        let mut last = SlipVerdict::Holding;
        for row in &self.samples {
            let verdict = detector.update(&force(row[1], row[3]), &Vector3::new(row[2] * 1e-3, 0.0, 0.0));
            if verdict == SlipVerdict::Warning && last != SlipVerdict::Warning {
                found.times.push(row[0]);
            }
            found.slips += usize::from(verdict == SlipVerdict::Slipping && last == SlipVerdict::Warning);
            last = verdict;
        }
        Ok(found)
    }

    /// How far the fingertip had slipped \[mm\] at a sample, were the stiffness of the stroke
    /// `share` of the one in its row.
    pub(crate) fn slipped(stroke: &[f64], first: &[f64], row: &[f64], share: f64) -> f64 {
        let force = (row[3] - first[3]) * -stroke[2];
        stroke[2] * (row[2] - first[2]) - force / (stroke[7] * share)
    }

    /// When the fingertip had slipped by 5 µm for good \[s\]: how the labels are made, from the
    /// motion and the force of the recording itself.
    pub(crate) fn slipped_for_good(&self, stroke: &[f64], share: f64) -> Option<f64> {
        let first = self.between(stroke[0], stroke[4]).next()?;
        let slipped = self
            .between(stroke[0], stroke[4])
            .rev()
            .take_while(|row| Self::slipped(stroke, first, row, share) > 5e-3);
        slipped.last().map(|row| row[0])
    }
}
