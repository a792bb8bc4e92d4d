//! Recordings of wrenches.

use fingertip::wrench::{TareAccumulator, TareError, Wrench};
use fingertip_drivers::recording::{HeaderProblem, Layout, Row, WrenchColumns};
use nalgebra::Vector6;

use crate::observe::Status;

/// The wrench of one sensor, tared.
pub(super) struct Wrenches {
    columns: WrenchColumns,
    resting: TareAccumulator<f64, 6>,
    zero: Vector6<f64>,
}

impl Wrenches {
    pub(super) fn new(layout: &Layout, sensor: Option<&str>) -> Result<Self, HeaderProblem> {
        let columns = match sensor {
            Some(sensor) => layout.wrench(sensor),
            None => layout.only_wrench(),
        }?;
        Ok(Self { columns: columns.clone(), resting: TareAccumulator::default(), zero: Vector6::zeros() })
    }

    pub(super) fn sensor(&self) -> &str {
        self.columns.name()
    }

    /// The wrench as recorded, less the tare, or why there is none.
    #[inline]
    pub(super) fn read(&self, row: &Row<'_>) -> Result<Wrench<f64>, Status> {
        let recorded = row.wrench(&self.columns).ok_or(Status::UnusableRow)?;
        Ok(Wrench::from_components(&(recorded.components() - self.zero)))
    }

    /// Takes a row of the rest; `false` if it is unusable.
    pub(super) fn rest(&mut self, row: &Row<'_>) -> bool {
        row.wrench(&self.columns).is_some_and(|wrench| self.resting.add(&wrench.components()))
    }

    /// The mean of the rest is the zero from now on.
    pub(super) fn end_rest(&mut self) -> Result<(), TareError> {
        self.zero = *self.resting.finish()?.zero();
        Ok(())
    }
}
