//! What the view shows, as the samples leave it.

use alloc::collections::VecDeque;
use core::time::Duration;
use std::time::Instant;

use fingertip::contact::ConfidenceEllipse;
use fingertip::friction::SlipVerdict;
use fingertip::wrench::Wrench;

use crate::felt::{NoiseWatch, ellipse};
use crate::observe::{SceneTouch, Status};
use crate::sensor::Losses;
use crate::shape::Projection;

/// How long the view remembers a slip \[s\]: a slip of milliseconds would not be seen.
const SLIP_SHOWN: f64 = 0.5;
/// Contact points of the trail.
const TRAIL: usize = 400;

/// How the source is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Health {
    Waiting,
    Running,
    Resting,
    Lost(String),
    Ended,
}

/// What is shown.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) source: String,
    pub(super) health: Health,
    /// How contacts are drawn; nothing without a scene.
    pub(super) projection: Option<Projection>,
    pub(super) coefficient: Option<f64>,
    pub(super) watches_slip: bool,
    /// \[s\]
    pub(super) time: f64,
    pub(super) wrench: Option<Wrench<f64>>,
    pub(super) touch: Option<SceneTouch>,
    pub(super) ellipse: Option<ConfidenceEllipse<f64>>,
    pub(super) trail: VecDeque<(f64, f64)>,
    /// Greatest force and torque so far \[N, N·m\], for the bars.
    pub(super) greatest: [f64; 2],
    pub(super) slips: u64,
    last_slip: Option<f64>,
    slipping: bool,
    noise: NoiseWatch,
    pub(super) samples: u64,
    pub(super) faults: u64,
    pub(super) last_fault: Option<String>,
    pub(super) losses: Losses,
    pub(super) reconnections: u64,
    /// Samples a second, of the last whole stretch.
    pub(super) rate: f64,
    counted: Option<(Instant, u64)>,
}

impl State {
    pub(super) fn new(source: String) -> Self {
        Self {
            source,
            health: Health::Waiting,
            projection: None,
            coefficient: None,
            watches_slip: false,
            time: 0.0,
            wrench: None,
            touch: None,
            ellipse: None,
            trail: VecDeque::with_capacity(TRAIL),
            greatest: [1e-3, 1e-6],
            slips: 0,
            last_slip: None,
            slipping: false,
            noise: NoiseWatch::default(),
            samples: 0,
            faults: 0,
            last_fault: None,
            losses: Losses::default(),
            reconnections: 0,
            rate: 0.0,
            counted: None,
        }
    }

    /// Takes a sample: the wrench without its zero, and what the scene makes of it.
    pub(super) fn sample(
        &mut self,
        time: f64,
        wrench: &Wrench<f64>,
        touch: Option<SceneTouch>,
        now: Instant,
    ) {
        self.health = Health::Running;
        self.time = time;
        self.samples += 1;
        let (begun, before) = *self.counted.get_or_insert((now, self.samples));
        let stretch = now.saturating_duration_since(begun);
        if stretch >= Duration::from_secs(1) {
            self.rate = (self.samples - before) as f64 / stretch.as_secs_f64();
            self.counted = Some((now, self.samples));
        }
        self.noise.add(wrench);
        if wrench.is_finite() {
            let [force, torque] = &mut self.greatest;
            *force = force.max(wrench.force().amax());
            *torque = torque.max(wrench.torque().amax());
        }
        self.wrench = Some(*wrench);
        let slipping = touch.as_ref().and_then(|touch| touch.slip) == Some(SlipVerdict::Slipping);
        if slipping {
            // Calls in quick succession are one slip.
            let anew = self.last_slip.is_none_or(|last| time - last > 0.05);
            self.slips += u64::from(anew && !self.slipping);
            self.last_slip = Some(time);
        }
        self.slipping = slipping;
        self.touch = touch;
    }

    /// What is worked out once per picture.
    pub(super) fn refresh(&mut self) {
        self.ellipse = self.touch.as_ref().and_then(|touch| ellipse(touch, &self.noise));
        let contact = self.touch.as_ref().and_then(|touch| touch.resolution.contact());
        if let (Some(contact), Some(projection)) = (contact, &self.projection) {
            let place = projection.project(&contact.point);
            if self.trail.back() != Some(&place) && place.0.is_finite() && place.1.is_finite() {
                if self.trail.len() >= TRAIL {
                    self.trail.pop_front();
                }
                self.trail.push_back(place);
            }
        }
    }

    /// Whether there is a contact, or why not.
    pub(super) fn status(&self) -> &'static str {
        match (&self.touch, &self.wrench) {
            (Some(touch), _) => Status::of(&touch.resolution).meaning(),
            (None, Some(_)) => "no scene",
            (None, None) => "nothing yet",
        }
    }

    /// The detector's verdict, in which a slip of just now lasts long enough to be seen.
    pub(super) fn verdict(&self) -> Option<SlipVerdict> {
        let verdict = self.touch.as_ref().and_then(|touch| touch.slip)?;
        let recent = self.last_slip.is_some_and(|last| (0.0..SLIP_SHOWN).contains(&(self.time - last)));
        Some(if recent { SlipVerdict::Slipping } else { verdict })
    }

    /// Forgets the trail and the scale.
    pub(super) fn forget(&mut self) {
        self.trail.clear();
        self.greatest = [1e-3, 1e-6];
        self.slips = 0;
    }
}
