//! What a hand does, and what is done to what it holds, as a list.

use nalgebra::{UnitQuaternion, Vector3};

use super::body::Inertial;
use crate::error::{ScriptProblem, SimulationError};
use crate::ramp::smooth;

/// One thing that happens. The hand moves along `10u³ − 15u⁴ + 6u⁵`, so that velocity and acceleration have no steps;
/// everything else follows `3u² − 2u³`.
///
/// ```
/// use fingertip_simulation::hand::HandSegment;
/// use nalgebra::Vector3;
///
/// let lift = HandSegment::Move { by: Vector3::z() * 0.1, duration: 0.8 };
/// assert_eq!(lift.duration(), 0.8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(tag = "do", rename_all = "snake_case"))]
#[non_exhaustive]
pub enum HandSegment {
    /// The fingers are open, or open, for `duration` \[s\].
    Open {
        /// How long \[s\].
        duration: f64,
    },
    /// The fingers close and hold.
    Hold {
        /// How long \[s\].
        duration: f64,
    },
    /// The hand moves.
    Move {
        /// By how much \[m\], in the world.
        by: Vector3<f64>,
        /// How long \[s\].
        duration: f64,
    },
    /// The hand turns about its origin.
    Turn {
        /// Axis times angle \[rad\], in the world.
        by: Vector3<f64>,
        /// How long \[s\].
        duration: f64,
    },
    /// Something is poured into the object, and stays where it is poured.
    Pour {
        /// How much \[kg\].
        mass: f64,
        /// Where, in the frame of the object \[m\].
        at: Vector3<f64>,
        /// How long \[s\].
        duration: f64,
    },
    /// Something pushes the object, and lets go again.
    Push {
        /// With what force \[N\], in the world.
        force: Vector3<f64>,
        /// Where, in the frame of the object \[m\].
        at: Vector3<f64>,
        /// How long the force takes to rise, and to fall \[s\].
        ramp: f64,
        /// How long it stays \[s\].
        hold: f64,
    },
    /// Another hand takes over the weight of the object, and keeps it where it is from then on.
    HandOver {
        /// How long \[s\].
        duration: f64,
    },
}

impl HandSegment {
    /// How long the segment takes \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        match *self {
            Self::Open { duration }
            | Self::Hold { duration }
            | Self::Move { duration, .. }
            | Self::Turn { duration, .. }
            | Self::Pour { duration, .. }
            | Self::HandOver { duration } => duration,
            Self::Push { ramp, hold, .. } => 2.0 * ramp + hold,
        }
    }

    fn problem(&self) -> Option<ScriptProblem> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let finite = |v: &Vector3<f64>| v.iter().all(|x| x.is_finite());
        let long = match self {
            Self::Push { ramp, hold, .. } => positive(*ramp) && *hold >= 0.0 && hold.is_finite(),
            other => positive(other.duration()),
        };
        if !long {
            return Some(ScriptProblem::BadDuration);
        }
        match self {
            Self::Move { by, .. } | Self::Turn { by, .. } if !finite(by) => Some(ScriptProblem::BadMotion),
            Self::Pour { mass, at, .. } if !(positive(*mass) && finite(at)) => Some(ScriptProblem::BadMass),
            Self::Push { force, at, .. } if !(finite(force) && finite(at)) => Some(ScriptProblem::BadPush),
            _ => None,
        }
    }
}

/// A list of [`HandSegment`]s, played one after the other.
///
/// ```
/// use fingertip_simulation::hand::HandScript;
///
/// let script = HandScript::default().open(0.3).hold(0.3).lift(0.03, 0.5).hold(0.2).put_down(0.03, 0.5).open(0.2);
/// assert!((script.duration() - 2.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct HandScript {
    /// What happens.
    pub segments: Vec<HandSegment>,
}

impl HandScript {
    /// Adds a segment.
    pub fn then(mut self, segment: HandSegment) -> Self {
        self.segments.push(segment);
        self
    }

    /// The fingers open, for a time \[s\].
    pub fn open(self, duration: f64) -> Self {
        self.then(HandSegment::Open { duration })
    }

    /// The fingers close and hold, for a time \[s\].
    pub fn hold(self, duration: f64) -> Self {
        self.then(HandSegment::Hold { duration })
    }

    /// The hand goes up \[m\] within a time \[s\].
    pub fn lift(self, height: f64, duration: f64) -> Self {
        self.then(HandSegment::Move { by: Vector3::z() * height, duration })
    }

    /// The hand goes down \[m\] within a time \[s\].
    pub fn put_down(self, height: f64, duration: f64) -> Self {
        self.lift(-height, duration)
    }

    /// The hand turns by axis times angle \[rad\] within a time \[s\].
    pub fn turn(self, by: Vector3<f64>, duration: f64) -> Self {
        self.then(HandSegment::Turn { by, duration })
    }

    /// A mass \[kg\] is poured in at a place of the object \[m\] within a time \[s\].
    pub fn pour(self, mass: f64, at: Vector3<f64>, duration: f64) -> Self {
        self.then(HandSegment::Pour { mass, at, duration })
    }

    /// A force \[N\] at a place of the object \[m\], which rises and falls within a `ramp` and stays for `hold` \[s\].
    pub fn push(self, force: Vector3<f64>, at: Vector3<f64>, ramp: f64, hold: f64) -> Self {
        self.then(HandSegment::Push { force, at, ramp, hold })
    }

    /// Another hand takes the object within a time \[s\].
    pub fn hand_over(self, duration: f64) -> Self {
        self.then(HandSegment::HandOver { duration })
    }

    /// How long it takes \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(HandSegment::duration).sum()
    }
}

/// How the hand is and moves, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HandMotion {
    /// Its origin \[m\].
    pub(super) origin: Vector3<f64>,
    /// Its attitude.
    pub(super) attitude: UnitQuaternion<f64>,
    /// The velocity of its origin \[m/s\].
    pub(super) velocity: Vector3<f64>,
    /// The acceleration of its origin \[m/s²\].
    pub(super) acceleration: Vector3<f64>,
    /// Its angular velocity \[rad/s\].
    pub(super) turning: Vector3<f64>,
}

/// What the script has at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    pub(super) motion: HandMotion,
    /// What the object is made of.
    pub(super) object: Inertial,
    /// A force in the world and its place on the object.
    pub(super) push: Option<(Vector3<f64>, Vector3<f64>)>,
    /// What share of the weight another hand bears.
    pub(super) taken: f64,
    /// Whether the fingers are to be open.
    pub(super) open: bool,
    pub(super) phase: usize,
}

/// A segment with what was before it.
#[derive(Clone, Copy, Debug)]
struct Phase {
    segment: HandSegment,
    start: f64,
    before: Instant,
}

/// The phases of a script.
#[derive(Clone, Debug)]
pub(super) struct HandTimeline {
    phases: Vec<Phase>,
    after: Instant,
    end: f64,
}

impl HandTimeline {
    pub(super) fn new(script: &HandScript, object: Inertial) -> Result<Self, SimulationError> {
        let motion = HandMotion {
            origin: Vector3::zeros(),
            attitude: UnitQuaternion::identity(),
            velocity: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            turning: Vector3::zeros(),
        };
        let mut before = Instant { motion, object, push: None, taken: 0.0, open: true, phase: 0 };
        let mut end = 0.0;
        let mut phases = Vec::with_capacity(script.segments.len());
        for (index, segment) in script.segments.iter().enumerate() {
            if let Some(problem) = segment.problem() {
                return Err(SimulationError::Script { segment: index + 1, problem });
            }
            before.phase = index;
            let phase = Phase { segment: *segment, start: end, before };
            end += segment.duration();
            before = Instant { push: None, ..phase.at(segment.duration()) };
            phases.push(phase);
        }
        Ok(Self { phases, after: before, end })
    }

    pub(super) const fn end(&self) -> f64 {
        self.end
    }

    pub(super) fn phases(&self) -> impl Iterator<Item = (HandSegment, f64)> {
        self.phases.iter().map(|phase| (phase.segment, phase.start))
    }

    pub(super) fn at(&self, time: f64) -> Instant {
        let next = self.phases.partition_point(|phase| phase.start <= time);
        match next.checked_sub(1).and_then(|index| self.phases.get(index)) {
            Some(phase) if time < self.end => phase.at(time - phase.start),
            _ => self.after,
        }
    }
}

/// `10u³ − 15u⁴ + 6u⁵` with its first two derivatives by `u`.
fn quintic(u: f64) -> [f64; 3] {
    let rest = 1.0 - u;
    [u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * rest * rest, 60.0 * u * rest * (1.0 - 2.0 * u)]
}

impl Phase {
    fn at(&self, since: f64) -> Instant {
        let mut now = self.before;
        let duration = self.segment.duration();
        let u = (since / duration).clamp(0.0, 1.0);
        now.open = false;
        match self.segment {
            HandSegment::Open { .. } => now.open = true,
            HandSegment::Hold { .. } => {}
            HandSegment::Move { by, .. } => {
                let [way, speed, pace] = quintic(u);
                now.motion.origin += by * way;
                now.motion.velocity = by * (speed / duration);
                now.motion.acceleration = by * (pace / (duration * duration));
            }
            HandSegment::Turn { by, .. } => {
                let [way, speed, _] = quintic(u);
                now.motion.attitude = UnitQuaternion::from_scaled_axis(by * way) * now.motion.attitude;
                now.motion.turning = by * (speed / duration);
            }
            HandSegment::Pour { mass, at, .. } => {
                now.object = now.object.with_point_mass(mass * smooth(u), at);
            }
            HandSegment::Push { force, at, ramp, hold } => {
                let share = smooth(since / ramp).min(smooth((2.0 * ramp + hold - since) / ramp));
                now.push = Some((force * share, at));
            }
            HandSegment::HandOver { .. } => now.taken += (1.0 - now.taken) * smooth(u),
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hand_moves_as_its_velocity_and_acceleration_say() {
        let script = HandScript::default()
            .open(0.2)
            .lift(0.05, 0.4)
            .turn(Vector3::new(0.1, 0.4, -0.2), 0.5)
            .pour(0.1, Vector3::z() * 0.02, 0.3)
            .push(Vector3::x() * 2.0, Vector3::zeros(), 0.1, 0.2)
            .hand_over(0.2)
            .open(0.1);
        let timeline = HandTimeline::new(&script, Inertial::cylinder(0.03, 0.05, 0.2)).unwrap();
        let step = 1e-5;
        let mut time = step;
        while time < timeline.end() - step {
            let [before, now, after] = [-step, 0.0, step].map(|by| timeline.at(time + by));
            let speed = (after.motion.origin - before.motion.origin) / (2.0 * step);
            assert!((speed - now.motion.velocity).norm() < 1e-6, "{time}");
            let pace = (after.motion.velocity - before.motion.velocity) / (2.0 * step);
            assert!((pace - now.motion.acceleration).norm() < 1e-3, "{time}");
            let turned = (after.motion.attitude * before.motion.attitude.inverse()).scaled_axis();
            assert!((turned / (2.0 * step) - now.motion.turning).norm() < 1e-5, "{time}");
            assert!((after.object.mass - now.object.mass).abs() < 1e-4);
            time += 7e-4;
        }
        let end = timeline.at(timeline.end());
        assert!((end.motion.origin.z - 0.05).abs() < 1e-15 && (end.object.mass - 0.3).abs() < 1e-15);
        assert!(end.taken == 1.0 && end.open && end.push.is_none());
        // What another hand has taken it keeps: taken over again it is as before.
        let script = HandScript::default().open(0.1).hand_over(0.2).hold(0.1).hand_over(0.2).open(0.1);
        let twice = HandTimeline::new(&script, Inertial::cylinder(0.03, 0.05, 0.2)).unwrap();
        assert!((0..100).all(|i| twice.at(0.3 + 0.004 * f64::from(i)).taken == 1.0));
        assert!((twice.at(0.2).taken - 0.5).abs() < 1e-12 && twice.at(0.05).taken == 0.0);
        let pushed = timeline.at(1.4 + 0.2).push.unwrap().0;
        assert_eq!(pushed, Vector3::x() * 2.0);
    }

    #[test]
    fn a_script_that_cannot_be_is_refused_with_the_number_of_its_segment() {
        let object = Inertial::cylinder(0.03, 0.05, 0.2);
        let refused = |script: HandScript| HandTimeline::new(&script, object).unwrap_err().to_string();
        let good = HandScript::default().open(0.1);
        assert!(refused(good.clone().hold(0.0)).starts_with("segment 2 of the script: a duration"));
        assert!(refused(good.clone().pour(-1.0, Vector3::zeros(), 0.1)).contains("mass"));
        assert!(refused(good.clone().lift(f64::NAN, 0.1)).contains("motion"));
        let push = good.push(Vector3::x() * f64::INFINITY, Vector3::zeros(), 0.1, 0.0);
        assert!(refused(push).contains("push"));
    }
}
