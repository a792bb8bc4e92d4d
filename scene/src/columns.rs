//! `[input.columns]` and `[input.units]`: recordings of others, whose columns have names of their own.

use alloc::collections::BTreeMap;

use fingertip::wrench::units::{ForceUnit, TorqueUnit};
use fingertip_recordings::{RenamedColumn, acceleration_unit, turning_unit};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;

/// What each column is called in the recording: by `time`, `fx` to `tz`, `v1` and so on, `dummy`, `temperature_C`, `ax` to `az`
/// and `wx` to `wz` of an inertial unit. A
/// minus before the name turns the sign round.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct ColumnsSection(BTreeMap<String, Column>);

/// A column by its name, or by its number, counted from 1: for recordings without a header.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
enum Column {
    Name(String),
    Number(i64),
}

/// The units of columns that `[input.columns]` names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct UnitsSection {
    time: String,
    force: String,
    torque: String,
    signal: String,
    acceleration: String,
    angular_velocity: String,
}

impl Default for UnitsSection {
    fn default() -> Self {
        let [time, force, torque, signal, acceleration, angular_velocity] =
            ["s", "N", "Nm", "V", "m/s2", "rad/s"].map(str::to_owned);
        Self { time, force, torque, signal, acceleration, angular_velocity }
    }
}

impl ColumnsSection {
    /// What the reader of recordings is to take each column for.
    pub(crate) fn renamed(&self, units: &UnitsSection) -> Result<Vec<RenamedColumn>, SceneProblem> {
        let known = [
            ("time", &units.time, matches!(units.time.as_str(), "s" | "ms" | "us" | "ns")),
            ("force", &units.force, ForceUnit::from_name(&units.force).is_some()),
            ("torque", &units.torque, TorqueUnit::from_name(&units.torque).is_some()),
            ("acceleration", &units.acceleration, acceleration_unit(&units.acceleration).is_some()),
            ("angular_velocity", &units.angular_velocity, turning_unit(&units.angular_velocity).is_some()),
            ("signal", &units.signal, matches!(units.signal.as_str(), "V" | "mV" | "uV" | "counts")),
        ];
        if let Some((key, unit, _)) = known.into_iter().find(|(.., known)| !known) {
            return Err(SceneProblem::Unit { key, unit: unit.clone() });
        }
        let named = |(key, column): (&String, &Column)| {
            let name = match column {
                Column::Name(name) => name.clone(),
                Column::Number(number) => number.to_string(),
            };
            let to = match key.as_str() {
                "time" => format!("t ({})", units.time),
                "fx" | "fy" | "fz" => format!("{key} ({})", units.force),
                "tx" | "ty" | "tz" => format!("{key} ({})", units.torque),
                "ax" | "ay" | "az" => format!("{key} ({})", units.acceleration),
                "wx" | "wy" | "wz" => format!("{key} ({})", units.angular_velocity),
                "temperature_C" => key.clone(),
                "dummy" => format!("{key} ({})", units.signal),
                other => match other.strip_prefix('v').map(str::parse::<u32>) {
                    Some(Ok(1..)) => format!("{key} ({})", units.signal),
                    _ => return Err(SceneProblem::Column(key.clone())),
                },
            };
            let (negative, from) = name.strip_prefix('-').map_or((false, name.as_str()), |name| (true, name));
            if negative && key == "time" {
                return Err(SceneProblem::Column(format!("-{from}")));
            }
            Ok(RenamedColumn { from: from.trim().to_owned(), to, negative })
        };
        self.0.iter().map(named).collect()
    }
}
