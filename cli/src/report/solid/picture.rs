//! The picture that stands where no script runs: an isometric one.

use fingertip_calibration::page::{Anchor, Svg};
use fingertip_scene::Projection;
use nalgebra::Vector3;

use super::Solid;
use super::net::{COLUMNS, Facet, across, facets};

const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 300.0;
/// Drawing units from the middle to the edge.
const HALF: f64 = 0.5 * HEIGHT - 6.0;
/// Shades of the style sheet, `s0` to `s7`, from dark to light.
const SHADES: f64 = 8.0;
/// Pieces of an axis, so that the surface hides what is behind it.
const PIECES: usize = 12;
/// Most contacts of the picture.
const DOTS: usize = 400;

/// From where it is seen, in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) centre: Vector3<f64>,
    /// Of what is drawn beside the axes.
    pub(super) radius: f64,
    /// From the middle of the drawing to its edge.
    pub(super) reach: f64,
    /// Unit vectors to the right, up, and towards the viewer.
    pub(super) frame: [Vector3<f64>; 3],
}

impl View {
    /// Isometric: all three directions of the map are equally foreshortened. From the side on which the contacts are.
    pub(super) fn of(
        projection: &Projection,
        centre: Vector3<f64>,
        reach: f64,
        radius: f64,
        contacts: &[Vector3<f64>],
    ) -> Self {
        let directions = projection.directions();
        let middle: Vector3<f64> = contacts.iter().map(|point| point - centre).sum();
        let towards: Vector3<f64> = directions
            .iter()
            .map(|direction| if middle.dot(direction) < 0.0 { -direction } else { *direction })
            .sum();
        let towards = towards.try_normalize(0.0).unwrap_or_else(Vector3::z);
        let [.., out] = directions;
        let up = (out - towards * out.dot(&towards)).try_normalize(0.0).unwrap_or_else(Vector3::y);
        Self { centre, radius, reach, frame: [up.cross(&towards), up, towards] }
    }

    /// To the right, up, and towards the viewer.
    pub(super) fn seen(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let from_centre = point - self.centre;
        Vector3::from(self.frame.map(|axis| axis.dot(&from_centre)))
    }

    fn place(&self, point: &Vector3<f64>) -> (f64, f64) {
        let seen = self.seen(point);
        let scale = HALF / self.reach;
        (0.5 * WIDTH + scale * seen.x, 0.5 * HEIGHT - scale * seen.y)
    }

    /// How light a facet is, lit from the left above the viewer; the inside is darker.
    fn shade(&self, facet: &Facet) -> Option<usize> {
        let normal = across(facet).try_normalize(0.0)?;
        let [x, y, z] = self.frame.map(|axis| axis.dot(&normal));
        let light = -0.35 * x + 0.45 * y + 0.82 * z;
        let share = if z < 0.0 { 0.35 * light.abs() } else { light.max(0.0) };
        Some((SHADES * share).clamp(0.0, SHADES - 1.0) as usize)
    }
}

/// What is drawn, the farthest first.
enum Item {
    Facet(Facet, usize),
    Piece(&'static str, [Vector3<f64>; 2]),
}

pub(super) fn draw(solid: &Solid) -> String {
    let view = &solid.view;
    let mut svg = Svg::new(WIDTH, HEIGHT, "The surface with contacts and the axes of the sensor");
    let faces_viewer = |facet: &Facet| across(facet).dot(&view.frame[2]) > 0.0;
    let depth = |points: &[Vector3<f64>]| {
        points.iter().map(|point| view.seen(point).z).sum::<f64>() / points.len() as f64
    };
    // Every other column is enough for what cannot be turned.
    let columns = solid.net.iter().enumerate().filter(|(place, _)| (place % COLUMNS).is_multiple_of(2));
    let net: Vec<_> = columns.map(|(_, point)| *point).collect();
    let mut items: Vec<(f64, Item)> = facets(&net, COLUMNS / 2)
        // The inside of a closed surface is not seen.
        .filter(|facet| solid.is_open || faces_viewer(facet))
        .filter_map(|facet| Some((depth(&facet), Item::Facet(facet, view.shade(&facet)?))))
        .collect();
    for (class, tip) in ["curve wide a", "curve wide b", "curve wide c"].into_iter().zip(&solid.axes) {
        items.extend((0..PIECES).map(|piece| {
            let at = |end: usize| tip * (end as f64 / PIECES as f64);
            let ends = [at(piece), at(piece + 1)];
            (depth(&ends), Item::Piece(class, ends))
        }));
    }
    items.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    for (_, item) in &items {
        match item {
            Item::Facet(facet, shade) => {
                svg.polygon(&format!("s{shade}"), facet.iter().map(|corner| view.place(corner)));
            }
            Item::Piece(class, [from, to]) => svg.line(class, view.place(from), view.place(to)),
        }
    }
    let count: usize = solid.contacts.iter().map(Vec::len).sum();
    for (class, contacts) in solid.contacts.iter().enumerate() {
        // Those on the side of the viewer.
        let seen = contacts.iter().step_by(count.div_ceil(DOTS).max(1));
        let seen = seen.filter(|point| solid.is_open || view.seen(point).z > 0.0);
        svg.dots(&format!("q{class}"), seen.map(|point| view.place(point)));
    }
    for (name, tip) in ["x", "y", "z"].into_iter().zip(&solid.axes) {
        let (x, y) = view.place(&(tip * 1.06));
        svg.label("halo", (x, y + 4.0), Anchor::Middle, name);
    }
    svg.finish()
}
