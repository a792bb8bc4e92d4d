//! What the columns of a header are taken for.

use fingertip_recordings::{ColumnMeaning, ColumnName, Layout, SignalUnit};

use super::Column;

/// Every column, in its order.
pub(super) fn of(layout: &Layout) -> Vec<Column> {
    let ignored: Vec<&str> = layout.ignored().collect();
    let mut columns = Vec::new();
    for name in layout.columns() {
        let meaning = meaning(name, ignored.contains(&name.as_str()));
        columns.push(Column { name: name.clone(), meaning });
    }
    columns
}

fn meaning(name: &str, is_ignored: bool) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let ColumnName { sensor, meaning } = ColumnName::parse(name);
    let of = if sensor.is_empty() { String::new() } else { format!(" of sensor {sensor}") };
    let axis = |axis: usize| AXES.get(axis).copied().unwrap_or_default();
    let in_unit = |size: f64, si: &str| if size == 1.0 { si.to_owned() } else { format!("{size} {si}") };
    let signal = |unit: SignalUnit, size: f64| match unit {
        SignalUnit::Unstated => "no unit stated".to_owned(),
        _ => in_unit(size, unit.name()),
    };
    match meaning {
        ColumnMeaning::Time(Some(size)) => format!("time [{}]", in_unit(size, "s")),
        ColumnMeaning::Force(k, Some(unit)) if !is_ignored => {
            format!("force {}{of} [{}]", axis(k), in_unit(unit.in_newtons(), "N"))
        }
        ColumnMeaning::Torque(k, Some(unit)) if !is_ignored => {
            format!("torque {}{of} [{}]", axis(k), in_unit(unit.in_newton_metres(), "N·m"))
        }
        ColumnMeaning::Signal(number, unit, size) if !is_ignored => {
            format!("signal {number}{of} [{}]", signal(unit, size))
        }
        ColumnMeaning::Dummy(unit, size) if !is_ignored => {
            format!("dummy gauge{of} [{}]", signal(unit, size))
        }
        ColumnMeaning::Acceleration(k, Some(unit)) => {
            format!("acceleration {}{of} [{}], where a payload asks for it", axis(k), in_unit(unit, "m/s²"))
        }
        ColumnMeaning::AngularVelocity(k, Some(unit)) => {
            format!(
                "angular velocity {}{of} [{}], where a payload asks for it",
                axis(k),
                in_unit(unit, "rad/s")
            )
        }
        _ if name.starts_with("contact_") && !is_ignored => "contact".to_owned(),
        _ => match name {
            "temperature_C" => "temperature [°C], where a calibration asks for it".to_owned(),
            "qx" | "qy" | "qz" | "qw" => "orientation, where a payload asks for it".to_owned(),
            _ => "not used".to_owned(),
        },
    }
}
