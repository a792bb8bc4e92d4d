//! The columns of a recording as channels that are watched.

use fingertip::wrench::ChannelLimits;
use fingertip_recordings::health::{Depth, Health, HealthWatch, Kind, WatchedChannel};
use fingertip_recordings::{HeaderProblem, Layout, Row, SignalColumns, SignalUnit, WrenchColumns};
use fingertip_scene::Sensor;
use nalgebra::DMatrix;

use crate::calibrated::Calibration;
use crate::error::CliError;
use crate::gauge_rows::{GaugeRows, KnownTemperature};

const AXES: [(&str, &str); 6] =
    [("fx", "N"), ("fy", "N"), ("fz", "N"), ("tx", "N·m"), ("ty", "N·m"), ("tz", "N·m")];

/// The rows of a recording, watched.
pub(crate) struct WatchedRows {
    wrenches: Vec<WrenchColumns>,
    signals: Vec<SignalColumns>,
    calibrated: Option<(GaugeRows, Sensor<f64>)>,
    channels: Vec<WatchedChannel>,
    depth: Depth,
    rate: Option<f64>,
    /// Made when the first row comes.
    watch: Option<HealthWatch>,
    readings: Vec<f64>,
}

fn prefixed(sensor: &str, name: &str) -> String {
    if sensor.is_empty() { name.to_owned() } else { format!("{sensor} {name}") }
}

/// The components of a wrench.
pub(crate) fn of_wrench(sensor: &str) -> Vec<WatchedChannel> {
    let channel = |(axis, (name, unit)): (usize, (&str, &str))| {
        let kind = if axis < 3 { Kind::Force } else { Kind::Torque };
        WatchedChannel::new(&prefixed(sensor, name), unit, kind).of_sensor(sensor)
    };
    AXES.into_iter().enumerate().map(channel).collect()
}

fn of_signals(columns: &SignalColumns, layout: &Layout) -> Vec<WatchedChannel> {
    let channel = |(number, name): (usize, &str)| {
        let kind = if number < columns.count() { Kind::Signal } else { Kind::Dummy };
        WatchedChannel::new(name, columns.unit().name(), kind).of_sensor(columns.name())
    };
    layout.names_of_signals(columns).into_iter().enumerate().map(channel).collect()
}

/// A watch over the readings of so many gauges.
pub(crate) fn of_gauges(gauges: usize, unit: SignalUnit, range: Option<[f64; 2]>) -> HealthWatch {
    let limits = range.and_then(|[low, high]| ChannelLimits::new(low, high).ok());
    let channel = |number: usize| {
        let channel = WatchedChannel::new(&format!("gauge {number}"), unit.name(), Kind::Signal);
        limits.map_or_else(|| channel.clone(), |limits| channel.clone().within(limits))
    };
    HealthWatch::new((1..=gauges).map(channel).collect(), Depth::Brief)
}

/// The readings of a table (samples × gauges), which follow each other.
pub(crate) fn of_table(signals: &DMatrix<f64>, unit: SignalUnit, range: Option<[f64; 2]>) -> Health {
    let mut watch = of_gauges(signals.ncols(), unit, range);
    let mut readings = vec![0.0; signals.ncols()];
    for row in signals.row_iter() {
        readings.iter_mut().zip(row.iter()).for_each(|(slot, reading)| *slot = *reading);
        watch.add(None, &readings);
    }
    watch.finish()
}

/// With the names that the file gives them.
fn of_wrench_columns(columns: &WrenchColumns, layout: &Layout) -> Vec<WatchedChannel> {
    let named = |(channel, name): (WatchedChannel, &str)| WatchedChannel { name: name.to_owned(), ..channel };
    of_wrench(columns.name()).into_iter().zip(layout.names_of_wrench(columns)).map(named).collect()
}

impl WatchedRows {
    /// Of every sensor, or that of a name.
    pub(crate) fn of(layout: &Layout, sensor: Option<&str>, depth: Depth) -> Result<Self, HeaderProblem> {
        let (wrenches, signals): (Vec<WrenchColumns>, Vec<SignalColumns>) = match sensor {
            None => (layout.wrenches().to_vec(), layout.signals().to_vec()),
            Some(sensor) => match (layout.wrench(sensor), layout.signals_of(sensor)) {
                (Err(problem), Err(_)) => return Err(problem),
                (wrench, signals) => {
                    (wrench.into_iter().cloned().collect(), signals.into_iter().cloned().collect())
                }
            },
        };
        Ok(Self::of_columns(layout, wrenches, signals, depth))
    }

    /// Of the signals of a sensor alone, or of its wrench alone, as far as that costs little.
    pub(crate) fn brief(layout: &Layout, sensor: &str, of_signals: bool) -> Result<Self, HeaderProblem> {
        let (mut wrenches, mut signals) = (Vec::new(), Vec::new());
        if of_signals {
            signals.push(layout.signals_of(sensor)?.clone());
        } else {
            wrenches.push(layout.wrench(sensor)?.clone());
        }
        Ok(Self::of_columns(layout, wrenches, signals, Depth::Brief))
    }

    fn of_columns(
        layout: &Layout,
        wrenches: Vec<WrenchColumns>,
        signals: Vec<SignalColumns>,
        depth: Depth,
    ) -> Self {
        let mut channels: Vec<WatchedChannel> =
            wrenches.iter().flat_map(|columns| of_wrench_columns(columns, layout)).collect();
        channels.extend(signals.iter().flat_map(|columns| of_signals(columns, layout)));
        let readings = Vec::with_capacity(channels.len() + AXES.len());
        Self { wrenches, signals, calibrated: None, channels, depth, rate: None, watch: None, readings }
    }

    /// The same with a calibration: its range, and the wrench that it makes of the gauges.
    pub(super) fn calibrated(
        mut self,
        layout: &Layout,
        sensor: Option<&str>,
        calibration: &Calibration<'_>,
        temperature: Option<KnownTemperature>,
        notes: &mut Vec<String>,
        header: impl Fn(HeaderProblem) -> CliError,
    ) -> Result<Self, CliError> {
        let rows = GaugeRows::of(layout, sensor, calibration.gauges(), temperature).map_err(header)?;
        let made = calibration.of(&rows.readings(), notes)?;
        let name = rows.sensor().to_owned();
        self.limit(&name, calibration.range());
        let axes = of_wrench(&name).into_iter().map(WatchedChannel::derived);
        self.channels.extend(axes);
        self.calibrated = Some((rows, made));
        Ok(self)
    }

    /// The range of the gauges of a sensor.
    pub(crate) fn limit(&mut self, sensor: &str, range: Option<[f64; 2]>) {
        let limits = range.and_then(|[low, high]| ChannelLimits::new(low, high).ok());
        for channel in &mut self.channels {
            if let Some(limits) = limits.filter(|_| channel.kind == Kind::Signal && channel.sensor == sensor)
            {
                channel.limits = limits;
            }
        }
    }

    /// The same without times, with so many samples a second.
    pub(super) fn with_rate(self, rate: f64) -> Self {
        Self { rate: Some(rate), ..self }
    }

    /// Takes a row. One without a time where the others have one is left out.
    pub(crate) fn add(&mut self, row: &Row<'_>) {
        if row.marks().bad_time {
            return;
        }
        self.readings.clear();
        for columns in &self.wrenches {
            self.readings.extend(row.unchecked_components(columns));
        }
        for columns in &self.signals {
            self.readings.extend(row.unchecked_signals(columns));
        }
        if let Some((rows, sensor)) = &mut self.calibrated {
            let step = row.time_step().unwrap_or(0.0);
            let wrench = rows.reading(row, |reading| sensor.wrench(reading, step).ok()).flatten();
            let components = wrench.map(|wrench| wrench.components());
            self.readings.extend((0..AXES.len()).map(|axis| {
                components.as_ref().and_then(|wrench| wrench.get(axis)).copied().unwrap_or(f64::NAN)
            }));
        }
        let watch = self.watch.get_or_insert_with(|| {
            let watch = HealthWatch::new(self.channels.clone(), self.depth);
            match self.rate {
                Some(rate) => watch.with_rate(rate),
                None => watch,
            }
        });
        watch.add(row.time(), &self.readings);
    }

    /// How many rows were taken.
    pub(crate) fn samples(&self) -> u64 {
        self.watch.as_ref().map_or(0, HealthWatch::samples)
    }

    /// What they show.
    pub(crate) fn finish(self) -> Health {
        self.watch.unwrap_or_else(|| HealthWatch::new(self.channels, self.depth)).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, of_wrench};

    #[test]
    fn a_wrench_is_three_forces_and_three_torques() {
        let told: Vec<_> = of_wrench("left")
            .into_iter()
            .map(|channel| (channel.name, channel.unit, channel.sensor, channel.kind))
            .collect();
        let of =
            |name: &str, unit: &str, kind| (format!("left {name}"), unit.to_owned(), "left".to_owned(), kind);
        let forces = ["fx", "fy", "fz"].map(|name| of(name, "N", Kind::Force));
        let torques = ["tx", "ty", "tz"].map(|name| of(name, "N·m", Kind::Torque));
        assert_eq!(told, [forces, torques].concat());
        assert_eq!(of_wrench("")[5].name, "tz");
    }
}
