//! The readings of gauges in the rows of a recording.

use fingertip_recordings::{HeaderProblem, Layout, NumberColumn, Row, SignalColumns};
use fingertip_scene::{GAUGES, GaugeReading};

use crate::calibrated::Readings;

/// Where the temperature of the sensor is known from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum KnownTemperature {
    /// It is in the recording.
    Column(NumberColumn),
    /// The user has said it \[°C\].
    Constant(f64),
}

impl KnownTemperature {
    fn of(self, row: &Row<'_>) -> Option<f64> {
        match self {
            Self::Column(column) => row.number(&column),
            Self::Constant(celsius) => Some(celsius),
        }
    }
}

/// The columns of one sensor.
#[derive(Clone, Debug)]
pub(crate) struct GaugeRows {
    columns: SignalColumns,
    temperature: Option<KnownTemperature>,
}

impl GaugeRows {
    /// The sensor of a name, or the only one, which must have so many gauges.
    pub(crate) fn of(
        layout: &Layout,
        sensor: Option<&str>,
        gauges: usize,
        temperature: Option<KnownTemperature>,
    ) -> Result<Self, HeaderProblem> {
        let columns = match sensor {
            Some(sensor) => layout.signals_of(sensor),
            None => layout.only_signals(),
        };
        Ok(Self { columns: columns.and_then(|columns| columns.expecting(gauges))?.clone(), temperature })
    }

    /// Name of the sensor; empty if the recording gives none.
    pub(crate) fn sensor(&self) -> &str {
        self.columns.name()
    }

    /// What a calibration must know of them, as if there were no rest.
    pub(crate) fn readings(&self) -> Readings {
        Readings {
            unit: self.columns.unit(),
            has_dummy: self.columns.has_dummy(),
            has_rest: false,
            has_temperature: self.temperature.is_some(),
        }
    }

    /// What `take` makes of the reading in a row; `None` if the row is unusable.
    #[inline]
    pub(crate) fn reading<A>(
        &self,
        row: &Row<'_>,
        take: impl FnOnce(&GaugeReading<'_, f64>) -> A,
    ) -> Option<A> {
        let mut cells = [0.0; *GAUGES.end()];
        let gauges = cells.get_mut(..self.columns.count()).filter(|_| row.is_usable())?;
        for (gauge, value) in gauges.iter_mut().zip(row.unchecked_signals(&self.columns)) {
            *gauge = value;
        }
        let celsius = self.temperature.and_then(|temperature| temperature.of(row));
        Some(take(&GaugeReading { gauges, dummy: row.dummy(&self.columns), celsius }))
    }
}
