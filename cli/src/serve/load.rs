//! What the simulated sensor feels: the true load of a scenario, and noise.

use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_simulation::{Options, Script, SimulatedFingertip, SurfacePoint, standard_session};
use nalgebra::Vector6;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

use super::args::{Scenario, SimulateArguments};
use crate::calibrate::files::text;
use crate::error::CliError;
use crate::standard::shown;

/// Torque noise per force noise \[m\]: what a small six-axis sensor has.
const NOISE_ARM: f64 = 5e-3;

/// The loads of a scenario, sample by sample, without an end.
#[derive(Clone, Debug)]
pub(super) struct Load {
    fresh: SimulatedFingertip,
    playing: SimulatedFingertip,
    noise: Normal<f64>,
    random: Pcg64Mcg,
    samples: u64,
}

impl Load {
    pub(super) fn new(arguments: &SimulateArguments) -> Result<Self, CliError> {
        let fault = |message: String| CliError::Simulate { message };
        let script = match &arguments.script {
            Some(path) => read(path)?,
            None => script(arguments.scenario),
        };
        if script.segments.is_empty() {
            return Err(fault("the script has no segments; add [[segments]]".to_owned()));
        }
        let options = Options { sample_rate: arguments.rate, seed: arguments.seed, ..Options::default() };
        let fresh = SimulatedFingertip::new(&script, options).map_err(|error| fault(error.to_string()))?;
        let noise = Normal::new(0.0, arguments.noise)
            .ok()
            .filter(|_| arguments.noise >= 0.0)
            .ok_or_else(|| fault(format!("--noise {} must be finite and not negative", arguments.noise)))?;
        let random = Pcg64Mcg::seed_from_u64(arguments.seed);
        Ok(Self { playing: fresh.clone(), fresh, noise, random, samples: 0 })
    }

    /// From the beginning.
    pub(super) fn restart(&mut self) {
        self.playing = self.fresh.clone();
    }

    /// How long the scenario takes \[s\].
    pub(super) fn duration(&self) -> f64 {
        self.fresh.duration()
    }

    /// How many samples were taken.
    pub(super) const fn samples(&self) -> u64 {
        self.samples
    }

    /// The next load; behind the end the scenario begins anew.
    pub(super) fn next(&mut self) -> Wrench<f64> {
        let sample = self.playing.next().or_else(|| {
            self.restart();
            self.playing.next()
        });
        self.samples += 1;
        let truth = sample.map_or_else(Wrench::zero, |sample| sample.truth.wrench);
        let noise = Vector6::from_fn(|axis, _| {
            self.noise.sample(&mut self.random) * if axis < 3 { 1.0 } else { NOISE_ARM }
        });
        Wrench::from_components(&(truth.components() + noise))
    }
}

fn read(path: &Path) -> Result<Script, CliError> {
    let text = text("script", path)?;
    toml::from_str(&text)
        .map_err(|error| CliError::Simulate { message: format!("script {}: {error}", shown(path)) })
}

fn script(scenario: Scenario) -> Script {
    let points = [(0.0, 0.0), (30.0, 0.0), (60.0, 120.0), (90.0, 240.0), (45.0, 330.0)];
    let start = Script::default().rest(1.0);
    match scenario {
        Scenario::Session => standard_session(),
        Scenario::Rest => start,
        Scenario::Press => points.into_iter().fold(start, |script, (from_top, azimuth)| {
            let at = SurfacePoint::degrees(from_top, azimuth);
            script.press(at, 2.0, 0.3).hold(1.0).release(0.2).rest(0.5)
        }),
        Scenario::Slip => [0.0_f64, 90.0, 180.0, 270.0].into_iter().fold(start, |script, heading| {
            let at = SurfacePoint::degrees(20.0, heading);
            let script = script.press(at, 4.0, 0.3).hold(0.3);
            script.drag(heading.to_radians(), (0.5, 0.35), 1.0, 0.4).hold(0.3).release(0.3).rest(0.5)
        }),
        Scenario::Roll => start
            .press(SurfacePoint::degrees(60.0, 0.0), 3.0, 0.3)
            .roll(SurfacePoint::degrees(60.0, 120.0), 1.5)
            .roll(SurfacePoint::degrees(60.0, 240.0), 1.5)
            .roll(SurfacePoint::degrees(10.0, 0.0), 1.5)
            .hold(0.3)
            .release(0.3),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::{Load, Scenario, SimulateArguments, script};
    use crate::args::{Arguments, Command};
    use fingertip_simulation::{Options, SimulatedFingertip};

    #[test]
    fn every_scenario_can_be_played_and_begins_with_a_rest() {
        for scenario in [Scenario::Session, Scenario::Press, Scenario::Slip, Scenario::Roll, Scenario::Rest] {
            let mut fingertip = SimulatedFingertip::new(&script(scenario), Options::default()).unwrap();
            assert!(fingertip.duration() >= 1.0);
            assert!(
                fingertip.by_ref().take(990).all(|sample| sample.truth.contact.is_none()),
                "{scenario:?}"
            );
            assert_eq!(fingertip.any(|sample| sample.truth.contact.is_some()), scenario != Scenario::Rest);
        }
    }

    fn load(more: &[&str]) -> Load {
        let start = ["fingertip", "simulate", "--serve", "ati", "--scenario", "press"];
        let arguments: Box<SimulateArguments> = match Arguments::parse_from(start.iter().chain(more)).command
        {
            Command::Simulate(arguments) => Box::new(arguments),
            _ => panic!("another command"),
        };
        Load::new(&arguments).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_load_is_the_truth_again_and_again() {
        let options = Options { sample_rate: 50.0, ..Options::default() };
        let truth: Vec<_> = SimulatedFingertip::new(&script(Scenario::Press), options).unwrap().collect();
        let mut load = load(&["--rate", "50", "--noise", "0"]);
        assert!((load.duration() - 11.0).abs() < 1e-9);
        for number in 0..2 * truth.len() + 10 {
            assert_eq!(load.samples(), number as u64);
            assert_eq!(load.next(), truth[number % truth.len()].truth.wrench);
        }
        load.restart();
        assert_eq!(load.next(), truth[0].truth.wrench);
    }

    #[test]
    fn noise_has_the_deviation_that_is_asked_for() {
        let mut load = load(&["--noise", "0.2"]);
        // The first second is a rest: noise and nothing else.
        let mut squares = [0.0; 6];
        for _ in 0..990 {
            let wrench = load.next().components();
            squares.iter_mut().zip(wrench.iter()).for_each(|(sum, component)| *sum += component * component);
        }
        for (axis, sum) in squares.into_iter().enumerate() {
            // Of 990 samples a deviation is known to 2.2 %.
            let expected = if axis < 3 { 0.2 } else { 0.001 };
            assert!(((sum / 990.0_f64).sqrt() / expected - 1.0).abs() < 0.1, "axis {axis}: {sum}");
        }
    }
}
