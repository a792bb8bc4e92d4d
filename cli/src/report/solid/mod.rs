//! The fingertip as a solid that turns, with the contacts on it: drawn by a script of its own, and where none runs, or
//! on paper, by a picture in its place.

mod net;
mod picture;

use core::fmt::Write;

use fingertip::surfaces::DynSurface;
use fingertip_scene::Projection;
use nalgebra::Vector3;

use super::Figure;
use super::colours::Classes;
use crate::observe::{MapPoint, Observations};
use net::{COLUMNS, Net};
use picture::View;

/// The script. It is given all in attributes of the element around it.
const SCRIPT: &str = include_str!("solid.js");
/// Most contacts that are shown.
const SHOWN: usize = 700;
const MILLIMETRES: f64 = 1e3;

/// What is drawn, in millimetres.
struct Solid {
    net: Vec<Option<Vector3<f64>>>,
    is_open: bool,
    /// By the class of their normal force.
    contacts: Vec<Vec<Vector3<f64>>>,
    /// Tips of the sensor's axes.
    axes: [Vector3<f64>; 3],
    view: View,
}

/// How the solid is turned, for its caption.
const TURNING: &str =
    "Drag it or use the arrow keys to turn, the wheel or + and − to zoom; a double click resets.";

/// The surface with its contacts; `None` where nothing of it can be seen.
pub(super) fn figure(surface: &DynSurface<f64>, observations: &Observations) -> Option<Figure> {
    let shown = "The active surface with contacts, coloured by normal force as on the map, and the axes of the sensor.";
    drawn(surface, observations.projection(), observations.map.kept(), shown)
}

/// The surface alone, as an element of a page whose script gives it what is to be drawn with it; nothing where there is
/// nothing to be seen.
#[cfg(feature = "web")]
pub(super) fn element(surface: &DynSurface<f64>, projection: &Projection) -> String {
    drawn(surface, projection, &[], "").map_or_else(String::new, |figure| figure.svg)
}

/// The surface as a net of points \[m\], with how many stand in a row.
#[cfg(any(feature = "foxglove", feature = "ros2"))]
pub(super) fn net(surface: &DynSurface<f64>, projection: &Projection) -> (Vec<Option<Vector3<f64>>>, usize) {
    (Net::of(surface, projection, &[]).points, COLUMNS)
}

/// The surface alone, where its region and the sensor's axes are what one wants to see.
pub(super) fn of_scene(surface: &DynSurface<f64>, projection: &Projection) -> Option<Figure> {
    drawn(surface, projection, &[], "The active surface and the axes of the sensor.")
}

fn drawn(
    surface: &DynSurface<f64>,
    projection: &Projection,
    contacts: &[MapPoint],
    shown: &str,
) -> Option<Figure> {
    let solid = Solid::of(surface, projection, contacts)?;
    let picture = picture::draw(&solid);
    Some(Figure {
        title: "The fingertip from all sides".to_owned(),
        svg: format!("<div class=\"solid\" {}>{picture}<script>{SCRIPT}</script></div>", solid.attributes()),
        keys: [("a", "x"), ("b", "y"), ("c", "z")].map(|(class, name)| (class, name.to_owned())).to_vec(),
        caption: format!("{shown} {TURNING}"),
        on_white: false,
    })
}

impl Solid {
    fn of(surface: &DynSurface<f64>, projection: &Projection, contacts: &[MapPoint]) -> Option<Self> {
        let touched: Vec<Vector3<f64>> = contacts.iter().map(|contact| contact.point).collect();
        let net = Net::of(surface, projection, &touched);
        let classes = Classes::of(contacts.iter().map(|contact| contact.normal_force));
        let step = contacts.len().div_ceil(SHOWN).max(1);
        let mut coloured = vec![Vec::new(); Classes::COUNT];
        for contact in contacts.iter().step_by(step).filter(|contact| net.shown.holds(&contact.point)) {
            if let Some(class) = coloured.get_mut(classes.class(contact.normal_force)) {
                class.push(contact.point * MILLIMETRES);
            }
        }
        let is_open = net.is_open();
        let points: Vec<_> = net.points.iter().map(|point| point.map(|point| point * MILLIMETRES)).collect();
        let mut all = points.iter().flatten().chain(coloured.iter().flatten()).peekable();
        let first = **all.peek()?;
        let (low, high) =
            all.clone().fold((first, first), |(low, high), point| (low.inf(point), high.sup(point)));
        let centre = (low + high) * 0.5;
        let radius = all.clone().map(|point| (point - centre).norm()).fold(0.0, f64::max);
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        // Long enough to come out of the surface.
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()]
            .map(|axis| axis * (high.dot(&axis) + 0.35 * radius).max(0.5 * radius));
        let reach = axes.iter().map(|tip| (tip - centre).norm()).fold(radius, f64::max);
        let view = View::of(projection, centre, reach.min(2.5 * radius), radius, &coloured.concat());
        Some(Self { net: points, is_open, contacts: coloured, axes, view })
    }

    /// All numbers for the script: to a thousandth of the size.
    fn attributes(&self) -> String {
        let decimals = (3.0 - self.view.radius.log10()).ceil().clamp(1.0, 9.0) as usize;
        let number = |value: f64, text: &mut String| {
            // Writing to a String cannot fail.
            let _ = write!(text, "{value:.decimals$}");
        };
        let triple = |point: &Vector3<f64>, text: &mut String| {
            for (place, value) in point.iter().enumerate() {
                text.push_str(if place > 0 { "," } else { "" });
                number(*value, text);
            }
        };
        let list = |points: &mut dyn Iterator<Item = Option<Vector3<f64>>>| {
            let mut text = String::new();
            for (place, point) in points.enumerate() {
                text.push_str(if place > 0 { ";" } else { "" });
                if let Some(point) = point {
                    triple(&point, &mut text);
                }
            }
            text
        };
        let contacts: Vec<String> =
            self.contacts.iter().map(|class| list(&mut class.iter().copied().map(Some))).collect();
        let mut reach = String::new();
        number(self.view.reach, &mut reach);
        format!(
            "data-columns=\"{COLUMNS}\" data-net=\"{}\" data-contacts=\"{}\" data-axes=\"{}\" data-centre=\"{}\" \
             data-reach=\"{reach}\" data-view=\"{}\"",
            list(&mut self.net.iter().copied()),
            contacts.join("|"),
            list(&mut self.axes.iter().copied().map(Some)),
            list(&mut core::iter::once(Some(self.view.centre))),
            self.view.frame.map(|axis| format!("{:.4},{:.4},{:.4}", axis.x, axis.y, axis.z)).join(";"),
        )
    }
}

#[cfg(test)]
mod tests;
