//! Recordings of wrenches.

use fingertip::wrench::{TareError, Wrench};
use fingertip_recordings::{HeaderProblem, Layout, Row, WrenchColumns};
use fingertip_scene::{Doubt, RestWatch};
use nalgebra::Vector6;

use super::recorded::Recorded;
use crate::observe::Status;

/// The wrench of one sensor, tared.
pub(super) struct Wrenches {
    columns: WrenchColumns,
    watch: RestWatch<f64, 6>,
    zero: Vector6<f64>,
}

impl Wrenches {
    pub(super) fn new(layout: &Layout, sensor: Option<&str>) -> Result<Self, HeaderProblem> {
        let columns = match sensor {
            Some(sensor) => layout.wrench(sensor),
            None => layout.only_wrench(),
        }?;
        Ok(Self { columns: columns.clone(), watch: RestWatch::default(), zero: Vector6::zeros() })
    }
}

impl Recorded for Wrenches {
    fn sensor(&self) -> &str {
        self.columns.name()
    }

    /// The wrench as recorded, less the tare.
    fn read(&mut self, row: &Row<'_>, _: f64) -> Result<Wrench<f64>, Status> {
        let recorded = row.wrench(&self.columns).ok_or(Status::UnusableRow)?;
        Ok(Wrench::from_components(&(recorded.components() - self.zero)))
    }

    fn rest(&mut self, row: &Row<'_>) -> Status {
        let Some(wrench) = row.wrench(&self.columns) else { return Status::UnusableRow };
        let components = wrench.components();
        if self.watch.add(&components, &components, &wrench) { Status::Rest } else { Status::UnusableRow }
    }

    fn end_rest(&mut self) -> Result<(), TareError> {
        self.zero = *self.watch.tare()?.zero();
        Ok(())
    }

    fn noise(&self) -> Option<Vector6<f64>> {
        self.watch.noise()
    }

    fn doubt(&self) -> Option<Doubt> {
        let names = ["fx", "fy", "fz", "tx", "ty", "tz"];
        self.watch.doubt(|component| names.get(component).copied().unwrap_or("a component").to_owned())
    }
}
