//! How well a pipeline did on a simulated session.

use fingertip_contact::{ContactModel, PointContact};
use fingertip_surfaces::Sphere;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::fingertip::{SimulatedFingertip, SimulatedSample};
use crate::script::Segment;

/// Compares what a pipeline says of each sample with the truth.
///
/// Accuracy is judged while the script holds still after a press ([`Segment::Hold`]): of single
/// samples, and of the mean wrench of each hold, as one reads a static load. Slips are judged over the whole session.
///
/// ```
/// use fingertip_simulation::{Options, Script, SessionScore, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).hold(0.1);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let mut score = SessionScore::new(&fingertip);
/// // A pipeline that knows the truth is never wrong.
/// for sample in fingertip {
///     let point = sample.truth.contact.map(|contact| contact.point);
///     score.add(&sample, &sample.truth.wrench, point.as_ref(), false);
/// }
/// let report = score.report();
/// assert!(report.presses[0].force_error < 1e-12 && report.false_alarms.is_empty());
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SessionScore {
    sphere: Sphere<f64>,
    /// Within which a slip must be called \[s\].
    window: f64,
    /// Whether each phase is a hold.
    still: Vec<bool>,
    holds: Vec<Hold>,
    slips: Vec<SlipScore>,
    false_alarms: Vec<f64>,
}

/// One hold, being summed up.
#[derive(Clone, Copy, Debug)]
struct Hold {
    phase: usize,
    force: Vector3<f64>,
    point: Vector3<f64>,
    sum: Wrench<f64>,
    samples: u32,
    squared_force: f64,
    squared_position: f64,
    greatest_position: f64,
    resolved: u32,
}

/// How one press was measured.
///
/// ```
/// use fingertip_simulation::{Options, Script, SessionScore, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).hold(0.1);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let mut score = SessionScore::new(&fingertip);
/// // A pipeline whose forces are 1 % too large.
/// for sample in fingertip {
///     let point = sample.truth.contact.map(|contact| contact.point);
///     score.add(&sample, &(sample.truth.wrench * 1.01), point.as_ref(), false);
/// }
/// let press = score.report().presses[0];
/// assert!((press.force - 2.0).abs() < 1e-9 && (press.force_error - 0.01).abs() < 1e-9);
/// assert_eq!((press.samples, press.resolved), (100, 100));
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PressScore {
    /// Index of the phase of the hold.
    pub phase: usize,
    /// True contact point \[m\].
    pub point: Vector3<f64>,
    /// True magnitude of the force \[N\].
    pub force: f64,
    /// Error of the mean force vector, relative to the true force.
    pub force_error: f64,
    /// Distance of the contact point of the mean wrench from the true one \[m\]; `None` if that
    /// wrench gives no contact.
    pub position_error: Option<f64>,
    /// Root mean square of the relative force error of single samples.
    pub sample_force_error: f64,
    /// Root mean square of the position error of the samples that the pipeline resolved \[m\].
    pub sample_position_error: f64,
    /// Greatest of them \[m\].
    pub greatest_position_error: f64,
    /// How many samples the hold has.
    pub samples: u32,
    /// How many of them the pipeline found a contact for.
    pub resolved: u32,
}

/// Presses of about the same force together.
///
/// ```
/// use fingertip_simulation::{Options, Script, SessionScore, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).hold(0.1).squeeze(4.0, 0.1).hold(0.1);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let mut score = SessionScore::new(&fingertip);
/// for sample in fingertip {
///     let point = sample.truth.contact.map(|contact| contact.point);
///     score.add(&sample, &sample.truth.wrench, point.as_ref(), false);
/// }
/// let levels = score.report().levels();
/// assert_eq!(levels.iter().map(|level| (level.force.round(), level.presses)).collect::<Vec<_>>(), [(2.0, 1), (4.0, 1)]);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LevelScore {
    /// True force \[N\].
    pub force: f64,
    /// How many presses.
    pub presses: usize,
    /// Mean of the relative force errors of the presses.
    pub mean_force_error: f64,
    /// Mean of the position errors of the presses \[m\].
    pub mean_position_error: f64,
    /// Greatest position error of a press \[m\]; infinite if one was not found.
    pub greatest_position_error: f64,
    /// Root mean square position error of single samples \[m\].
    pub sample_position_error: f64,
    /// Share of the samples for which a contact was found.
    pub resolved: f64,
}

/// Whether one slip was found.
///
/// ```
/// use fingertip_simulation::{Options, Script, SessionScore, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::TOP, 2.0, 0.1).drag(0.0, (0.5, 0.35), 0.1, 0.05);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let mut score = SessionScore::new(&fingertip);
/// // Whoever calls each slip 3 ms late.
/// let onset = fingertip.slip_onsets()[0];
/// for sample in fingertip {
///     let called = (sample.time - onset - 3e-3).abs() < 0.5e-3;
///     score.add(&sample, &sample.truth.wrench, None, called);
/// }
/// let slip = score.report().slips[0];
/// assert!((slip.delay.ok_or("it was called")? - 3e-3).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SlipScore {
    /// When it began \[s\].
    pub onset: f64,
    /// When it was called after that \[s\]; `None` if it was missed.
    pub delay: Option<f64>,
}

/// The result.
///
/// ```
/// use fingertip_simulation::{Options, Script, SessionScore, SimulatedFingertip, SurfacePoint};
///
/// let script = Script::default().rest(0.1);
/// let fingertip = SimulatedFingertip::new(&script, Options::default())?;
/// let mut score = SessionScore::new(&fingertip);
/// // A detector that calls a slip where nothing touches.
/// for sample in fingertip {
///     score.add(&sample, &sample.truth.wrench, None, sample.time == 0.05);
/// }
/// let report = score.report();
/// assert!(report.presses.is_empty() && report.slips.is_empty());
/// assert_eq!(report.false_alarms, [0.05]);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SessionReport {
    /// Every press.
    pub presses: Vec<PressScore>,
    /// Every slip of the script.
    pub slips: Vec<SlipScore>,
    /// When slip was called though nothing slipped \[s\].
    pub false_alarms: Vec<f64>,
}

impl SessionScore {
    /// For the session of a fingertip. A slip counts as found if it is called within 20 ms.
    #[must_use]
    pub fn new(fingertip: &SimulatedFingertip) -> Self {
        Self {
            sphere: fingertip.sphere(),
            window: 20e-3,
            still: fingertip
                .phases()
                .iter()
                .map(|phase| matches!(phase.segment, Segment::Hold { .. }))
                .collect(),
            holds: Vec::new(),
            slips: fingertip
                .slip_onsets()
                .iter()
                .map(|onset| SlipScore { onset: *onset, delay: None })
                .collect(),
            false_alarms: Vec::new(),
        }
    }

    /// Takes what the pipeline says of a sample: the wrench, the contact point if there is one, and
    /// whether slip was called.
    pub fn add(
        &mut self,
        sample: &SimulatedSample,
        wrench: &Wrench<f64>,
        point: Option<&Vector3<f64>>,
        slip_called: bool,
    ) {
        if slip_called {
            self.judge_call(sample);
        }
        if !self.still.get(sample.truth.phase).copied().unwrap_or(false) {
            return;
        }
        let Some(contact) = &sample.truth.contact else { return };
        if contact.contact_force().tangential_magnitude() > 1e-9 * contact.force.norm() {
            // A hold after a drag is no press.
            return;
        }
        if self.holds.last().is_none_or(|hold| hold.phase != sample.truth.phase) {
            self.holds.push(Hold {
                phase: sample.truth.phase,
                force: contact.force,
                point: contact.point,
                sum: Wrench::zero(),
                samples: 0,
                squared_force: 0.0,
                squared_position: 0.0,
                greatest_position: 0.0,
                resolved: 0,
            });
        }
        let Some(hold) = self.holds.last_mut() else { return };
        hold.sum = hold.sum + *wrench;
        hold.samples += 1;
        hold.squared_force += (wrench.force() - contact.force).norm_squared() / contact.force.norm_squared();
        if let Some(point) = point {
            let error = (point - contact.point).norm();
            hold.resolved += 1;
            hold.squared_position += error * error;
            hold.greatest_position = greatest(hold.greatest_position, error);
        }
    }

    /// A call within the window finds the slip; one while it still slides says nothing new; any
    /// other is false.
    fn judge_call(&mut self, sample: &SimulatedSample) {
        let since = |slip: &SlipScore| sample.time - slip.onset;
        let window = self.window;
        let current = self.slips.iter_mut().find(|slip| since(slip) >= 0.0 && since(slip) <= window);
        match current {
            Some(slip) if slip.delay.is_none() => slip.delay = Some(since(slip)),
            Some(_) => {}
            None if sample.truth.slipping => {}
            None => self.false_alarms.push(sample.time),
        }
    }

    /// The result.
    #[must_use]
    pub fn report(&self) -> SessionReport {
        SessionReport {
            presses: self.holds.iter().map(|hold| hold.score(&self.sphere)).collect(),
            slips: self.slips.clone(),
            false_alarms: self.false_alarms.clone(),
        }
    }
}

impl Hold {
    fn score(&self, sphere: &Sphere<f64>) -> PressScore {
        let samples = f64::from(self.samples);
        let mean = self.sum * (1.0 / samples);
        let force = self.force.norm();
        let found = PointContact::new(0.0).ok().map(|model| model.resolve_near(&mean, sphere, None));
        let found = found.and_then(|resolution| resolution.contact().map(|contact| contact.point));
        let resolved = f64::from(self.resolved.max(1));
        PressScore {
            phase: self.phase,
            point: self.point,
            force,
            force_error: (mean.force() - self.force).norm() / force,
            position_error: found.map(|point| (point - self.point).norm()),
            sample_force_error: (self.squared_force / samples).sqrt(),
            sample_position_error: (self.squared_position / resolved).sqrt(),
            greatest_position_error: self.greatest_position,
            samples: self.samples,
            resolved: self.resolved,
        }
    }
}

/// The greater of two; NaN if one of them is, which `f64::max` would pass over.
fn greatest(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other { one } else { other }
}

impl SessionReport {
    /// The presses by their force, from the least.
    #[must_use]
    pub fn levels(&self) -> Vec<LevelScore> {
        let mut forces: Vec<f64> = self.presses.iter().map(|press| press.force).collect();
        forces.sort_by(f64::total_cmp);
        forces.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * b.abs());
        forces.into_iter().map(|force| self.level(force)).collect()
    }

    fn level(&self, force: f64) -> LevelScore {
        let presses: Vec<&PressScore> =
            self.presses.iter().filter(|press| (press.force - force).abs() <= 1e-6 * force).collect();
        #[allow(clippy::cast_precision_loss, reason = "a few presses")]
        let count = presses.len() as f64;
        let position = |press: &PressScore| press.position_error.unwrap_or(f64::INFINITY);
        let (samples, resolved) = presses
            .iter()
            .fold((0.0, 0.0), |(s, r), press| (s + f64::from(press.samples), r + f64::from(press.resolved)));
        let squares: f64 =
            presses.iter().map(|press| press.sample_position_error.powi(2) * f64::from(press.resolved)).sum();
        LevelScore {
            force,
            presses: presses.len(),
            mean_force_error: presses.iter().map(|press| press.force_error).sum::<f64>() / count,
            mean_position_error: presses.iter().map(|press| position(press)).sum::<f64>() / count,
            greatest_position_error: presses.iter().map(|press| position(press)).fold(0.0, greatest),
            sample_position_error: (squares / f64::max(resolved, 1.0)).sqrt(),
            resolved: resolved / samples,
        }
    }

    /// How many slips were found in time.
    #[must_use]
    pub fn slips_found(&self) -> usize {
        self.slips.iter().filter(|slip| slip.delay.is_some()).count()
    }
}
