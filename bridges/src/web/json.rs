//! What is sent, in JSON. A number that is none is `null`.

use fingertip::friction::SlipVerdict;
use serde::Serialize;
use serde_json::json;

use crate::{About, Felt, Health, Sample, Status};

/// What a connection is told first.
pub(super) fn hello(about: &About, commands: bool) -> String {
    let About { source, frame, has_scene, watches_slip, coefficient, .. } = about;
    json!({"hello": {
        "version": env!("CARGO_PKG_VERSION"), "source": source, "frame": frame, "has_scene": has_scene,
        "watches_slip": watches_slip, "coefficient": coefficient, "commands": commands,
    }})
    .to_string()
}

/// How the source is.
pub(super) fn status(status: &Status) -> String {
    let Status { health, zero, lost, faults, reconnections, seen } = status;
    let why = if let Health::Lost(why) = health { Some(why) } else { None };
    json!({"status": {
        "health": health.word(), "why": why, "lost": lost, "faults": faults, "reconnections": reconnections, "seen": seen,
        "zero": {"taken": zero.taken, "failed": zero.failed, "why": zero.why, "value": zero.value},
    }})
    .to_string()
}

/// Samples that came together, and how many were missed before them.
pub(super) fn samples(samples: &[Sample], missed: u64) -> String {
    // Written as it goes: at a kilohertz a tree of values would cost more than all else.
    let mut text = String::from("{\"samples\":[");
    for (place, sample) in samples.iter().enumerate() {
        if place > 0 {
            text.push(',');
        }
        // Numbers and words alone: there is nothing that JSON cannot hold.
        text.push_str(&serde_json::to_string(&Shown::of(sample)).unwrap_or_default());
    }
    text.push_str(&format!("],\"missed\":{missed}}}"));
    text
}

#[derive(Serialize)]
struct Shown {
    n: u64,
    t: f64,
    stamp: f64,
    wrench: [f64; 6],
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    felt: Option<ShownFelt>,
}

#[derive(Serialize)]
struct ShownFelt {
    status: &'static str,
    load: [f64; 6],
    #[serde(skip_serializing_if = "Option::is_none")]
    contact: Option<ShownContact>,
    #[serde(skip_serializing_if = "Option::is_none")]
    margin: Option<ShownMargin>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slip: Option<&'static str>,
}

#[derive(Serialize)]
struct ShownMargin {
    newtons: f64,
    utilisation: f64,
}

#[derive(Serialize)]
struct ShownContact {
    point: [f64; 3],
    normal: [f64; 3],
    force: [f64; 3],
    normal_force: f64,
    tangential_force: [f64; 3],
    spin_torque: f64,
    ellipse: Option<ShownEllipse>,
}

#[derive(Serialize)]
struct ShownEllipse {
    semi_axes: [f64; 2],
    directions: [[f64; 3]; 2],
}

impl Shown {
    fn of(sample: &Sample) -> Self {
        let Sample { number, time, stamp, wrench, felt } = sample;
        let felt = felt.as_ref().map(ShownFelt::of);
        Self { n: *number, t: *time, stamp: stamp.as_secs_f64(), wrench: wrench.components().into(), felt }
    }
}

impl ShownFelt {
    fn of(felt: &Felt) -> Self {
        let contact = felt.contact.as_ref().map(|contact| ShownContact {
            point: contact.point.into(),
            normal: contact.normal.into(),
            force: contact.force.into(),
            normal_force: contact.normal_force,
            tangential_force: contact.tangential_force.into(),
            spin_torque: contact.spin_torque,
            ellipse: contact.ellipse.map(|ellipse| ShownEllipse {
                semi_axes: ellipse.semi_axes,
                directions: ellipse.directions.map(Into::into),
            }),
        });
        let margin = felt
            .margin
            .map(|margin| ShownMargin { newtons: margin.newtons, utilisation: margin.utilisation });
        Self {
            status: felt.status,
            load: felt.load.components().into(),
            contact,
            margin,
            slip: felt.slip.map(SlipVerdict::word),
        }
    }
}

#[cfg(test)]
mod tests {
    use fingertip::friction::{SlipMargin, SlipVerdict};
    use fingertip::wrench::Wrench;
    use nalgebra::{Vector3, Vector6};
    use serde_json::Value;

    use super::samples;
    use crate::{Felt, Pressed, Sample};

    #[test]
    fn numbers_are_read_as_they_were_and_what_is_none_is_null() {
        let wrench = Wrench::from_components(&Vector6::new(0.1, -1e-300, 1e300, f64::NAN, 1.0 / 3.0, -0.0));
        let (x, zero) = (Vector3::x(), Vector3::zeros());
        let contact = Pressed {
            point: x * 0.013,
            normal: x,
            force: -x,
            normal_force: 1.0,
            tangential_force: zero,
            spin_torque: 0.25,
            ellipse: None,
        };
        let felt = Felt {
            status: "contact",
            load: wrench,
            contact: Some(contact),
            margin: Some(SlipMargin { newtons: -0.5, utilisation: f64::MAX }),
            slip: Some(SlipVerdict::Slipping),
        };
        let text = samples(&[Sample::new(0.1, wrench, Some(felt)), Sample::new(0.2, wrench, None)], 7);
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["missed"], 7);
        let [first, second] = [&value["samples"][0], &value["samples"][1]];
        for (place, component) in wrench.components().iter().enumerate() {
            let read = &first["wrench"][place];
            assert_eq!(
                read.as_f64().map(f64::to_bits),
                Some(*component).filter(|c| c.is_finite()).map(f64::to_bits)
            );
        }
        assert_eq!(first["contact"]["point"][0], 0.013);
        assert_eq!(
            (first["slip"].as_str(), first["margin"]["utilisation"].as_f64()),
            (Some("slipping"), Some(f64::MAX))
        );
        assert!(second.get("contact").is_none() && second.get("status").is_none() && second["t"] == 0.2);
        assert_eq!(samples(&[], 0), "{\"samples\":[],\"missed\":0}");
    }
}
