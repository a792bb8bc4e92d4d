//! Surface, contact, force and the limit of friction for RViz: `visualization_msgs/msg/MarkerArray`.

use core::f64::consts::TAU;

use fingertip_recordings::mcap::{CdrWriter, Header};
use nalgebra::Vector3;

use crate::{About, Sample};

/// Length of the arrow of a newton \[m\].
const NEWTON: f64 = 0.004;
const CORNERS: u32 = 24;

/// Kinds and actions of `visualization_msgs/msg/Marker`.
const ARROW: i32 = 0;
const SPHERE: i32 = 2;
const LINE_STRIP: i32 = 4;
const TRIANGLES: i32 = 11;
const ADD: i32 = 0;
const DELETE: i32 = 2;

/// One marker; what it has none of is empty.
struct Marker<'a> {
    id: i32,
    kind: i32,
    action: i32,
    at: Vector3<f64>,
    scale: [f64; 3],
    colour: [f32; 4],
    points: &'a [Vector3<f64>],
}

impl Marker<'_> {
    fn write(&self, header: &Header, to: &mut CdrWriter) {
        header.write(to);
        to.string("fingertip");
        [self.id, self.kind, self.action].into_iter().for_each(|number| to.i32(number));
        to.f64s(self.at.iter().copied().chain([0.0, 0.0, 0.0, 1.0]));
        to.f64s(self.scale);
        self.colour.into_iter().for_each(|part| to.f32(part));
        // For ever, and fixed to its frame.
        to.i32(0);
        to.u32(0);
        to.u8(1);
        to.u32(u32::try_from(self.points.len()).unwrap_or(0));
        self.points.iter().for_each(|point| to.f64s(point.iter().copied()));
        // No colours of points, no texture (name, image with header, format and bytes, places).
        to.u32(0);
        to.string("");
        Header::default().write(to);
        to.string("");
        [0, 0].into_iter().for_each(|count| to.u32(count));
        // No text, no mesh (name, file with name and bytes, materials).
        to.string("");
        to.string("");
        to.string("");
        to.u32(0);
        to.u8(0);
    }
}

/// What is to be seen of a sample, with the surface if that is due.
pub(super) fn markers(sample: &Sample, about: &About, header: &Header, with_surface: bool) -> Vec<u8> {
    let mut to = CdrWriter::default();
    let corners: Vec<Vector3<f64>> =
        if with_surface { about.surface.triangles().flatten().collect() } else { Vec::new() };
    let none = Vector3::zeros();
    let contact = sample.contact();
    let action = if contact.is_some() { ADD } else { DELETE };
    let used = sample.felt.and_then(|felt| felt.margin).map_or(0.0, |margin| margin.utilisation);
    let colour = match used {
        used if used >= 1.0 => [0.78, 0.12, 0.27, 1.0],
        used if used > 0.8 => [0.78, 0.32, 0.05, 1.0],
        _ => [0.0, 0.5, 0.37, 1.0],
    };
    let arrow = contact.map_or([none; 2], |contact| [contact.point - contact.force * NEWTON, contact.point]);
    let rim = contact.zip(about.coefficient).map_or_else(Vec::new, |(contact, coefficient)| {
        let length = NEWTON * contact.normal_force;
        let helper = if contact.normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let right = contact.normal.cross(&helper).try_normalize(0.0).unwrap_or_else(Vector3::x);
        let up = contact.normal.cross(&right);
        let far = contact.point + contact.normal * length;
        let corner = |place: u32| {
            let (sin, cos) = (TAU * f64::from(place) / f64::from(CORNERS)).sin_cos();
            far + (right * cos + up * sin) * (coefficient * length)
        };
        (0..=CORNERS).map(corner).collect()
    });
    let rim_action = if rim.is_empty() { DELETE } else { ADD };
    let at = contact.map_or(none, |contact| contact.point);
    let dark = [0.1, 0.11, 0.13, 1.0];
    let list = [
        Marker { id: 1, kind: SPHERE, action, at, scale: [1e-3; 3], colour, points: &[] },
        Marker {
            id: 2,
            kind: ARROW,
            action,
            at: none,
            scale: [6e-4, 1.5e-3, 2e-3],
            colour: dark,
            points: &arrow,
        },
        Marker {
            id: 3,
            kind: LINE_STRIP,
            action: rim_action,
            at: none,
            scale: [3e-4, 0.0, 0.0],
            colour,
            points: &rim,
        },
        Marker {
            id: 0,
            kind: TRIANGLES,
            action: ADD,
            at: none,
            scale: [1.0; 3],
            colour: [0.72, 0.75, 0.79, 0.8],
            points: &corners,
        },
    ];
    let count = if corners.is_empty() { 3 } else { 4 };
    to.u32(u32::try_from(count).unwrap_or(0));
    list.iter().take(count).for_each(|marker| marker.write(header, &mut to));
    to.into_message()
}
