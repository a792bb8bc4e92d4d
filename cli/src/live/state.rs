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
use fingertip_scene::Projection;

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
    /// Where else it can be seen.
    pub(super) served: Vec<String>,
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
    /// What is wrong with the sensor, as far as it was seen.
    pub(super) seen: Vec<String>,
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
            served: Vec::new(),
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
            seen: Vec::new(),
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

    /// Where the contact of the last sample lies with 95 %.
    pub(super) fn ellipse_now(&self) -> Option<ConfidenceEllipse<f64>> {
        self.touch.as_ref().and_then(|touch| ellipse(touch, &self.noise))
    }

    /// What is worked out once per picture.
    pub(super) fn refresh(&mut self) {
        self.ellipse = self.ellipse_now();
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

#[cfg(test)]
mod tests {
    use core::time::Duration;
    use std::path::Path;
    use std::time::Instant;

    use fingertip::contact::{NoContact, Resolution};
    use fingertip::friction::SlipVerdict;
    use fingertip::wrench::Wrench;
    use nalgebra::Vector3;

    use super::{SceneTouch, State, TRAIL};
    use crate::felt::SceneFeel;
    use crate::scene::load_or_simulated;

    fn touch(slip: Option<SlipVerdict>) -> Option<SceneTouch> {
        let resolution = Resolution::NoContact(NoContact::NotFinite);
        Some(SceneTouch { wrench: Wrench::zero(), resolution, force: None, grip: None, slip, tracked: () })
    }

    fn load(force: [f64; 3], torque: [f64; 3]) -> Wrench<f64> {
        Wrench::on_fingertip(force.into(), torque.into())
    }

    #[test]
    fn the_rate_is_that_of_the_last_second_that_is_over() {
        let mut state = State::new(String::new());
        let begun = Instant::now();
        let at = |milliseconds: u64, state: &mut State| {
            let now = begun + Duration::from_millis(milliseconds);
            state.sample(0.0, &Wrench::zero(), None, now);
            state.rate
        };
        // 250 samples a second, then 100: told at the end of each second, or of what came to be more.
        (0..1000).step_by(4).for_each(|ms| assert_eq!(at(ms, &mut state), 0.0));
        assert_eq!(at(1000, &mut state), 250.0);
        (1010..2000).step_by(10).for_each(|ms| assert_eq!(at(ms, &mut state), 250.0));
        assert_eq!(at(2000, &mut state), 100.0);
        assert_eq!(at(4000, &mut state), 0.5);
        assert_eq!(state.samples, 250 + 1 + 99 + 1 + 1);
    }

    #[test]
    fn the_scale_is_that_of_the_greatest_component_until_it_is_forgotten() {
        let mut state = State::new(String::new());
        let mut take = |wrench: Wrench<f64>| {
            state.sample(0.0, &wrench, None, Instant::now());
            state.greatest
        };
        assert_eq!(take(Wrench::zero()), [1e-3, 1e-6]);
        assert_eq!(take(load([1.0, -3.0, 2.0], [0.0, 0.01, -0.02])), [3.0, 0.02]);
        assert_eq!(take(load([1.0, 1.0, 1.0], [0.05, 0.0, 0.0])), [3.0, 0.05]);
        assert_eq!(take(load([f64::INFINITY, 0.0, 0.0], [9.0, 0.0, 0.0])), [3.0, 0.05]);
        state.trail.push_back((1.0, 2.0));
        state.slips = 3;
        state.forget();
        assert_eq!((state.greatest, state.slips, state.trail.len()), ([1e-3, 1e-6], 0, 0));
    }

    #[test]
    fn calls_in_quick_succession_are_one_slip_which_is_shown_for_half_a_second() {
        let mut state = State::new(String::new());
        let mut take = |time: f64, verdict: Option<SlipVerdict>| {
            state.sample(time, &Wrench::zero(), touch(verdict), Instant::now());
            (state.slips, state.verdict())
        };
        let (slipping, holding) = (Some(SlipVerdict::Slipping), Some(SlipVerdict::Holding));
        assert_eq!(take(1.0, holding), (0, holding));
        assert_eq!(take(1.01, slipping), (1, slipping));
        // Called without a break for longer than a slip is remembered, it is still one.
        assert_eq!(take(1.10, slipping), (1, slipping));
        assert_eq!(take(1.11, holding), (1, slipping));
        assert_eq!(take(1.14, slipping), (1, slipping));
        assert_eq!(take(1.16, holding), (1, slipping));
        assert_eq!(take(1.25, slipping), (2, slipping));
        assert_eq!(take(1.74, holding), (2, slipping));
        assert_eq!(take(1.76, holding), (2, holding));
        // A recording that begins anew is not behind its last slip.
        assert_eq!(take(0.0, holding), (2, holding));
        assert_eq!(take(2.0, None), (2, None));
    }

    #[test]
    fn the_trail_has_the_last_places_and_no_place_twice() {
        let scene = load_or_simulated(Path::new("sim")).unwrap();
        let mut state = State::new(String::new());
        let projection = *scene.projection();
        state.projection = Some(projection);
        let mut feel = SceneFeel::new(&scene, true);
        let mut places = Vec::new();
        for step in 0..TRAIL + 10 {
            let angle = 1e-3 * step as f64;
            let normal = Vector3::new(angle.cos(), angle.sin(), 0.0);
            let wrench = Wrench::from_force_at(&(normal * 0.013), -normal * 2.0);
            let touch = feel.feel(step as f64, &wrench).unwrap();
            let point = touch.as_ref().and_then(|touch| touch.resolution.contact()).unwrap().point;
            assert!((point - normal * 0.013).norm() < 1e-12);
            state.sample(step as f64, &wrench, touch, Instant::now());
            state.refresh();
            state.refresh();
            places.push(projection.project(&point));
        }
        assert_eq!(state.trail.iter().copied().collect::<Vec<_>>(), places[10..]);
        assert_eq!(state.status(), "contact");
        // Twenty samples tell the noise, and that the ellipse.
        assert!(state.ellipse.is_some());
        assert_eq!(State::new(String::new()).status(), "nothing yet");
    }
}
