//! The simulated fingertip, in this process: its volts through tare, dummy gauge and solver.

use core::convert::Infallible;

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaussianElimination, WrenchSolver,
};
use fingertip_drivers::middleware::Paced;
use fingertip_drivers::{Sample, Source};
use fingertip_simulation::{Options, SimulatedFingertip, standard_session};
use nalgebra::{SVector, Vector6};

use super::{Address, Feed, Losses, Next, Reading, SensorError, Volts};

/// A session that is played again and again, its time going on.
pub(super) struct Rounds {
    fingertip: SimulatedFingertip,
    fresh: SimulatedFingertip,
    /// Length of the rounds before \[s\].
    before: f64,
}

impl Rounds {
    pub(super) fn new(fresh: SimulatedFingertip) -> Self {
        Self { fingertip: fresh.clone(), fresh, before: 0.0 }
    }
}

impl Source<f64, SVector<f64, 7>> for Rounds {
    type Error = Infallible;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Volts>>, Infallible> {
        let next = self.fingertip.next().or_else(|| {
            self.before += self.fresh.duration();
            self.fingertip = self.fresh.clone();
            self.fingertip.next()
        });
        Ok(next.map(|sample| Sample { time: Some(self.before + sample.time), value: sample.raw }))
    }
}

struct Simulated {
    source: Paced<Rounds>,
    solver: GaussianElimination<f64>,
    zero: DummyGauge<f64, 6>,
}

/// So many samples of the rest give the zero: at a high rate all of it would take longer than anybody waits.
const REST: usize = 20_000;

/// The fingertip of an address.
pub(super) fn fresh(address: &Address) -> Result<SimulatedFingertip, SensorError> {
    let options = Options {
        seed: address.whole("seed")?.unwrap_or(1),
        sample_rate: address.positive("rate_Hz")?.unwrap_or(1000.0),
        ..Options::default()
    };
    Ok(SimulatedFingertip::new(&standard_session(), options)?)
}

pub(super) fn open(address: &Address) -> Result<Box<dyn Feed>, SensorError> {
    let fresh = fresh(address)?;
    let solver = GaussianElimination::new(fresh.calibrated_matrix())?;
    // The session begins with a rest: it gives the zero, as on a bench before the work begins.
    let mut rest = DummyGaugeAccumulator::default();
    for sample in fresh.clone().take(REST).take_while(|sample| sample.truth.phase == 0) {
        rest.add(&sample.reading());
    }
    let zero = rest.finish()?;
    let source = Paced::new(Rounds::new(fresh), 1.0);
    Ok(Box::new(Simulated { source, solver, zero }))
}

impl Feed for Simulated {
    fn next(&mut self) -> Result<Next, SensorError> {
        let Ok(sample) = self.source.next_sample();
        let Some(Sample { time, value: volts }) = sample else { return Ok(Next::End) };
        let [v1, v2, v3, v4, v5, v6, dummy] = volts.into();
        let reading = GaugesAndDummy { gauges: Vector6::new(v1, v2, v3, v4, v5, v6), dummy };
        let wrench = self.solver.solve(&self.zero.compensate(&reading));
        Ok(Next::Reading(Reading { time, wrench, volts: Some(volts) }))
    }

    fn losses(&self) -> Losses {
        Losses { lost: Some(0), ..Losses::default() }
    }
}

#[cfg(test)]
mod tests {
    use fingertip_drivers::Source;
    use fingertip_simulation::{Options, Script, SimulatedFingertip};

    use super::super::address;
    use super::{Rounds, fresh};

    #[test]
    fn a_session_begins_anew_and_its_time_goes_on() {
        let options = Options { sample_rate: 100.0, ..Options::default() };
        let session = SimulatedFingertip::new(&Script::default().rest(0.5), options).unwrap();
        let round: Vec<_> = session.clone().collect();
        let mut rounds = Rounds::new(session);
        for number in 0..3 * round.len() {
            let Ok(Some(sample)) = rounds.next_sample() else { panic!("no sample") };
            let expected = number as f64 * 0.01;
            assert!((sample.time.unwrap() - expected).abs() < 1e-9, "{:?} for {expected}", sample.time);
            assert_eq!(sample.value, round[number % round.len()].raw);
        }
    }

    #[test]
    fn an_address_sets_the_rate_and_the_seed() {
        let options = |text: &str| *fresh(&address(text).unwrap()).unwrap().options();
        assert_eq!((options("sim").sample_rate, options("sim").seed), (1000.0, 1));
        assert_eq!((options("sim?rate_Hz=250").sample_rate, options("sim?seed=9").seed), (250.0, 9));
    }
}
