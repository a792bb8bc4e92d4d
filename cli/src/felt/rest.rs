//! The zero of a sensor, from the seconds before it is touched.

use fingertip::wrench::{TareError, Wrench};
use fingertip_scene::RestWatch;
use nalgebra::Vector6;
use thiserror::Error;

/// The first seconds give no zero.
#[derive(Clone, Copy, Debug, Error)]
#[error("no zero from {seconds} s at rest: {source}; rest longer, or check the sensor")]
pub(crate) struct NoZero {
    seconds: f64,
    source: TareError,
}

/// The mean of the first seconds.
#[derive(Clone, Debug)]
pub(crate) struct Rest {
    /// How long, while it lasts \[s\].
    left: Option<f64>,
    first: Option<f64>,
    resting: RestWatch<f64, 6>,
    zero: Vector6<f64>,
}

impl Rest {
    /// Over so many seconds; `None` takes nothing off.
    pub(crate) fn new(seconds: Option<f64>) -> Self {
        Self { left: seconds, first: None, resting: RestWatch::default(), zero: Vector6::zeros() }
    }

    /// The wrench less the zero; `None` while it rests.
    pub(crate) fn take(&mut self, time: f64, wrench: &Wrench<f64>) -> Result<Option<Wrench<f64>>, NoZero> {
        let components = wrench.components();
        if let Some(seconds) = self.left {
            if time - *self.first.get_or_insert(time) < seconds {
                self.resting.add(&components, &components, wrench);
                return Ok(None);
            }
            self.left = None;
            let tare = self.resting.tare().map_err(|source| NoZero { seconds, source })?;
            self.zero = *tare.zero();
        }
        Ok(Some(Wrench::from_components(&(components - self.zero))))
    }

    /// Standard deviation of each component meanwhile.
    pub(crate) fn noise(&self) -> Option<Vector6<f64>> {
        self.resting.noise()
    }

    /// Whether the zero is still being taken.
    pub(crate) const fn is_resting(&self) -> bool {
        self.left.is_some()
    }

    /// The zero.
    pub(crate) const fn zero(&self) -> &Vector6<f64> {
        &self.zero
    }
}
