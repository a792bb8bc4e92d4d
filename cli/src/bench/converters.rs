//! Which settings of each converter suit the bridges, and what is to be expected of it.

use fingertip_calibration::design::{Assessment, DesignError, LayoutFile};
use fingertip_drivers::converters::{BridgeDemand, BridgeSetting, UnsuitableConverter};
use fingertip_drivers::devices::devices;
use nalgebra::{DMatrix, Vector6};

use super::args::Parts;
use crate::table::{Table, number, short};

/// Boltzmann's constant \[J/K\] times room temperature \[K\].
const THERMAL: f64 = 1.380_649e-23 * 300.0;

/// What a converter tells of the loads.
struct Expected {
    setting: BridgeSetting,
    /// Counts of a bridge's strain of 1.
    counts: f64,
    /// Noise of a channel, of converter and bridge together \[strain\].
    noise: f64,
}

/// All converters with the bridges of a design straight at their inputs.
pub(super) struct Converters {
    /// Strain of each channel per nominal load.
    strains: DMatrix<f64>,
    /// The most that the loads strain a channel by, all at once.
    greatest: f64,
    /// Noise of each component of the load, for a channel's noise of 1 \[N, N·m\].
    gains: Vector6<f64>,
    /// Bridges, one for the dummy included where there must be one.
    bridges: usize,
    imbalance: f64,
    rate: f64,
    all: Vec<(&'static str, Result<Expected, UnsuitableConverter>)>,
}

impl Converters {
    pub(super) fn new(file: &LayoutFile, parts: &Parts) -> Result<Self, DesignError> {
        let layout = file.layout();
        let strains = layout.normalised(1.0, &file.loads)?;
        let blind = DesignError::Singular { reason: "the gauges are blind to some load" };
        let judged = Assessment::new(&strains, None).ok_or(blind)?;
        let greatest = strains.row_iter().map(|row| row.abs().sum()).fold(0.0, f64::max);
        let steady = !layout.bridges.is_empty()
            && layout.bridges.iter().all(|bridge| bridge.compensates_temperature());
        let bridges = layout.channels() + usize::from(!steady);
        // The output of a bridge over its supply is K/4 of its strain.
        let (supply, sensitivity) = (file.excitation.supply, file.excitation.gauge_factor / 4.0);
        let imbalance = parts.imbalance * 1e-3;
        let demand = BridgeDemand {
            bridges,
            supply,
            greatest_ratio: imbalance + sensitivity * greatest,
            rate: parts.sample_rate,
        };
        let expected = |setting: BridgeSetting| {
            // A bridge has the resistance of one of its arms (docs/theory/calibration.md#noise-of-a-converter).
            let thermal = 4.0 * THERMAL * parts.foil().resistance * 0.5 * setting.conversions;
            let volts = (setting.noise * setting.noise + thermal).sqrt();
            let counts = sensitivity * setting.counts_per_ratio();
            Expected { setting, counts, noise: volts / (supply * sensitivity) }
        };
        let all = devices().iter().filter_map(|device| Some((device.name, device.converter?)));
        let all = all.map(|(name, figures)| (name, figures.setting(&demand).map(expected))).collect();
        // The figure of a load is what it gives beyond what the others could imitate.
        let gains = file.loads.components().component_div(&judged.sensitivities);
        Ok(Self { strains, greatest, gains, bridges, imbalance, rate: parts.sample_rate, all })
    }

    fn suitable(&self) -> impl Iterator<Item = (&'static str, &Expected)> {
        self.all.iter().filter_map(|(name, found)| Some((*name, found.as_ref().ok()?)))
    }

    /// What holds for all of them.
    pub(super) fn lines(&self) -> Vec<String> {
        vec![
            format!(
                "{} bridges straight at the inputs, out of balance by {} mV/V at most; {} samples a second are wanted.",
                self.bridges,
                short(self.imbalance * 1e3),
                short(self.rate)
            ),
            "Gains hold that and all nominal loads at once, within 90 % of the range. Noise is that of the data sheet".to_owned(),
            "for inputs that are shorted, and that of the bridges' resistance; where it is not stated, it is rather too large.".to_owned(),
        ]
    }

    pub(super) fn tables(&self) -> Vec<Table> {
        vec![self.settings(), self.noise(), self.resolution(), self.full_loads()]
    }

    fn settings(&self) -> Table {
        let head = [
            "",
            "chips",
            "gain",
            "reference / V",
            "rate / Hz",
            "samples / Hz",
            "counts per µm/m",
            "counts at full load",
            "noise / counts",
            "noise / µm/m",
        ];
        let mut table = Table::new("Settings of the converter", head);
        for (name, Expected { setting, counts, noise }) in self.suitable() {
            let reference = match setting.divider {
                None => format!("{} inside", short(setting.reference)),
                Some(1.0) => format!("{} supply", short(setting.reference)),
                Some(parts) => format!("{} supply/{}", short(setting.reference), short(parts)),
            };
            table.row([
                name.to_owned(),
                setting.chips.to_string(),
                short(setting.gain),
                reference,
                number(setting.conversions),
                number(setting.samples),
                number(counts * 1e-6),
                format!("{:.0}", counts * self.greatest),
                number(counts * noise),
                number(noise * 1e6),
            ]);
        }
        table
    }

    fn noise(&self) -> Table {
        self.loads("Noise of the load", |expected| expected.noise)
    }

    fn resolution(&self) -> Table {
        self.loads("What one count is", |expected| expected.counts.recip())
    }

    /// Of each component of the load, for a strain in every channel.
    fn loads(&self, title: &str, strain: impl Fn(&Expected) -> f64) -> Table {
        let head = ["", "Fx / mN", "Fy / mN", "Fz / mN", "Tx / N·mm", "Ty / N·mm", "Tz / N·mm"];
        let mut table = Table::new(title, head);
        for (name, expected) in self.suitable() {
            let cells = self.gains.iter().map(|gain| number(gain * strain(expected) * 1e3));
            table.rows.push(core::iter::once(name.to_owned()).chain(cells).collect());
        }
        table
    }

    /// The strains from which the counts follow.
    fn full_loads(&self) -> Table {
        let head = ["channel", "Fx", "Fy", "Fz", "Tx", "Ty", "Tz", "all at once"];
        let mut table = Table::new("Strain at the nominal loads / µm/m", head);
        for (channel, row) in (1..).zip(self.strains.row_iter()) {
            let cells = row.iter().copied().chain([row.abs().sum()]);
            // No "−0.0".
            let cells = cells.map(|strain| format!("{:.1}", (strain * 1e7).round() / 10.0 + 0.0));
            table.rows.push(core::iter::once(channel.to_string()).chain(cells).collect());
        }
        table
    }

    /// Which converters do not suit, and why.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = vec![
            "Converters have the bridges straight at their inputs: --gain is for an amplifier before one of gain 1".to_owned(),
        ];
        let refused = self.all.iter().filter_map(|(name, found)| Some((name, found.as_ref().err()?)));
        notes.extend(refused.map(|(name, why)| format!("{name} does not suit: {why}")));
        let slow: Vec<&str> = self
            .suitable()
            .filter(|(_, expected)| expected.setting.samples < self.rate)
            .map(|(name, _)| name)
            .collect();
        if !slow.is_empty() {
            notes.push(format!("{} cannot give {} samples a second", slow.join(" and "), short(self.rate)));
        }
        notes
    }
}
