//! Where the line of a force meets the ball, and on which side it presses.

use fingertip::wrench::Wrench;
use nalgebra::Vector3;

use super::svg::{Drawing, Point, Svg};
use super::{contact, drawn};
use crate::failure::Failure;

/// Millimetres a newton.
const LENGTH: f64 = 7.0;

fn ball(svg: &mut Svg, shift: Point) {
    svg.circle("body", shift, 13.0);
    svg.circle("axis", shift, 0.6);
}

/// One ball with a force, its line, its contact and its normal.
fn touched(svg: &mut Svg, shift: Point, wrench: &Wrench<f64>) -> Result<(), Failure> {
    let contact = contact(wrench)?;
    let force = drawn(&(wrench.force() * 1e-3)) * LENGTH;
    let at = drawn(&contact.point) + shift;
    let along = force.normalize();
    svg.line("faint", at, at + along * 30.0);
    svg.arrow("force", at - force, at);
    svg.arrow("normal", at, at + drawn(&contact.normal) * 8e-3);
    svg.dot("contact", at);
    Ok(())
}

/// From six numbers to a place.
pub(super) fn line_of_action() -> Result<Drawing, Failure> {
    let at = Vector3::new(5.0, 0.0, 12.0) * 1e-3;
    let force = Vector3::new(-1.6, 0.0, -1.2);
    let wrench = Wrench::from_force_at(&at, force);
    let mut svg = Svg::new([-30.0, -15.0], [38.0, 24.0], 9.0);
    ball(&mut svg, Point::zeros());
    touched(&mut svg, Point::zeros(), &wrench)?;
    let foot = wrench.force().cross(&wrench.torque()) / wrench.force().norm_squared();
    svg.line("measure", Point::zeros(), drawn(&foot));
    svg.text("label", drawn(&foot) * 0.5 + Point::new(1.2, 0.4), "start", "|m| / |f|");
    svg.text("label force", Point::new(17.6, 20.0), "start", "force f");
    svg.text("label force", Point::new(17.6, 17.4), "start", "on the fingertip");
    svg.text("label contact", Point::new(8.6, 12.4), "start", "contact");
    svg.text("label normal", Point::new(7.4, 20.4), "end", "outward normal");
    svg.text("label", Point::new(1.4, -0.6), "start", "sensor");
    Ok(svg.drawing(
        "A ball with a force that points into it, the line of the force, and the contact where the line enters",
        "Force and torque tell the line along which the force acts: it passes the sensor at the distance |m|/|f|. Where it \
         enters the fingertip is the contact.",
    ))
}

/// The same wrench taken right and taken wrong.
pub(super) fn both_sides() -> Result<Drawing, Failure> {
    let at = Vector3::new(5.0, 0.0, 12.0) * 1e-3;
    let load = Wrench::from_force_at(&at, Vector3::new(-1.6, 0.0, -1.2));
    let opposite = Wrench::from_reaction(load.force(), load.torque());
    let mut svg = Svg::new([-24.0, -24.0], [76.0, 28.0], 7.0);
    for (shift, wrench, title) in
        [(Point::zeros(), load, "taken as it is"), (Point::new(52.0, 0.0), opposite, "taken as its opposite")]
    {
        ball(&mut svg, shift);
        touched(&mut svg, shift, &wrench)?;
        svg.text("title", shift + Point::new(0.0, 24.5), "middle", title);
    }
    Ok(svg.drawing(
        "Two balls: one is pressed from above right, the other, by the opposite force on the same line, from below left",
        "The same numbers with the other sign: the line is the same, and the contact is where the opposite force would press, \
         on the far side.",
    ))
}

/// A force that grazes the ball.
pub(super) fn grazing() -> Result<Drawing, Failure> {
    let mut svg = Svg::new([-30.0, -17.0], [34.0, 26.0], 9.0);
    ball(&mut svg, Point::zeros());
    for (lever, class) in [(0.0, "near"), (0.006, "near"), (0.0115, "far"), (0.0128, "far")] {
        // A push downwards, this far from the middle, and the same half a millimetre aside.
        let push = |x: f64| Wrench::from_force_at(&Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.0));
        let (one, other) = (contact(&push(lever - 2e-4))?, contact(&push(lever + 1.9e-4))?);
        svg.line("faint", Point::new(lever * 1e3, 24.0), Point::new(lever * 1e3, drawn(&one.point).y));
        svg.line(&format!("spread {class}"), drawn(&one.point), drawn(&other.point));
        let apart = (one.point - other.point).norm() * 1e3;
        // Within the ball, where no line crosses it; the first is left of all lines.
        let aside = if lever > 0.0 { Point::new(-1.0, -1.6) } else { Point::new(-1.2, 1.6) };
        svg.text("label", drawn(&other.point) + aside, "end", &format!("{apart:.2} mm"));
    }
    Ok(svg.drawing(
        "A ball that is pressed from above at four distances from its middle; the spread of contacts grows towards the rim",
        "The same uncertainty of the line, 0.4 mm, moves the contact the more the flatter the line meets the surface.",
    ))
}
