//! The pictures of the book, drawn by what the library computes.

mod frames;
mod margin;
mod sides;
mod svg;

use fingertip::contact::{Contact, ContactModel, PointContact};
use fingertip::surfaces::Sphere;
use fingertip::wrench::Wrench;
use nalgebra::Vector3;

use crate::failure::Failure;
use crate::pages::{self, Made};
use svg::Point;

/// Radius of the ball that all pictures have \[m\].
const RADIUS: f64 = 13e-3;

/// All pictures: as parts of the book's pages, and those of the theory, whose chapters are read outside the book too, as images.
pub(crate) fn pictures() -> Result<Vec<Made>, Failure> {
    let sheet = pages::sources().join("../style.css");
    let sheet = std::fs::read_to_string(&sheet).map_err(Failure::file(&sheet))?;
    let (line, margin) = (sides::line_of_action()?, margin::margin()?);
    let (frames, grazing) = (frames::frames(), sides::grazing()?);
    Ok(vec![
        Made { path: "theory/pictures/line-of-action.svg", text: line.image(&sheet) },
        Made { path: "theory/pictures/frames.svg", text: frames.image(&sheet) },
        Made { path: "theory/pictures/margin.svg", text: margin.image(&sheet) },
        Made { path: "theory/pictures/grazing.svg", text: grazing.image(&sheet) },
        Made { path: "pictures/line-of-action.svg", text: line.figure() },
        Made { path: "pictures/both-sides.svg", text: sides::both_sides()?.figure() },
        Made { path: "pictures/frames.svg", text: frames.figure() },
        Made { path: "pictures/turned.svg", text: frames::turned().figure() },
        Made { path: "pictures/margin.svg", text: margin.figure() },
        Made { path: "pictures/grazing.svg", text: grazing.figure() },
    ])
}

/// The contact of a wrench on the ball.
fn contact(wrench: &Wrench<f64>) -> Result<Contact<f64>, Failure> {
    let told = |error: &dyn core::fmt::Display| Failure::Command(error.to_string());
    let ball = Sphere::centred(RADIUS).map_err(|error| told(&error))?;
    let model = PointContact::new(0.01).map_err(|error| told(&error))?;
    model.resolve(wrench, &ball).into_result().map_err(|reason| told(&reason))
}

/// Where a point of the plane of x and z is drawn \[mm\].
fn drawn(point: &Vector3<f64>) -> Point {
    Point::new(point.x, point.z) * 1e3
}
