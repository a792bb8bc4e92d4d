//! Surface, contact, force and the limit of friction for RViz: `visualization_msgs/msg/MarkerArray`.

use fingertip_recordings::mcap::{CdrWriter, Header};
use nalgebra::Vector3;

use crate::drawn::{Colour, FORCE, NEWTON, SURFACE, colour, rim};
use crate::{About, Sample};

/// Corners of a ring.
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
    colour: Colour,
    points: &'a [Vector3<f64>],
}

impl Marker<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "single precision is what the message holds")]
    fn write(&self, header: &Header, to: &mut CdrWriter) {
        header.write(to);
        to.string("fingertip");
        [self.id, self.kind, self.action].into_iter().for_each(|number| to.i32(number));
        to.f64s(self.at.iter().copied().chain([0.0, 0.0, 0.0, 1.0]));
        to.f64s(self.scale);
        self.colour.into_iter().for_each(|part| to.f32(part as f32));
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
    let colour = colour(sample);
    let arrow = contact.map_or([none; 2], |contact| [contact.point - contact.force * NEWTON, contact.point]);
    let mut rim = contact
        .zip(about.coefficient)
        .map_or_else(Vec::new, |(contact, coefficient)| rim(contact, coefficient, CORNERS));
    // Back to where it began.
    rim.extend(rim.first().copied());
    let rim_action = if rim.is_empty() { DELETE } else { ADD };
    let at = contact.map_or(none, |contact| contact.point);
    let list = [
        Marker { id: 1, kind: SPHERE, action, at, scale: [1e-3; 3], colour, points: &[] },
        Marker {
            id: 2,
            kind: ARROW,
            action,
            at: none,
            scale: [6e-4, 1.5e-3, 2e-3],
            colour: FORCE,
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
            colour: SURFACE,
            points: &corners,
        },
    ];
    let count = if corners.is_empty() { 3 } else { 4 };
    to.u32(u32::try_from(count).unwrap_or(0));
    list.iter().take(count).for_each(|marker| marker.write(header, &mut to));
    to.into_message()
}
