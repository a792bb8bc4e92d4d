//! The friction cone and the slip margin.

use fingertip::friction::{Coulomb, FrictionModel};
use fingertip::wrench::ContactForce;
use nalgebra::Vector3;

use super::svg::{Drawing, Point, Svg};
use crate::failure::Failure;

/// Millimetres a newton.
const NEWTON: f64 = 9.0;

/// Two contact forces, one within the cone and one beyond.
pub(super) fn margin() -> Result<Drawing, Failure> {
    let coefficient = 0.5;
    let limit = Coulomb::new(coefficient).map_err(|error| Failure::Command(error.to_string()))?;
    let mut svg = Svg::new([-30.0, -6.0], [42.0, 36.0], 9.0);
    // Tangential force to the right, normal force up.
    let reach = 3.6 * NEWTON;
    let edge = |side: f64| Point::new(side * coefficient, 1.0) * reach;
    svg.polygon("cone", &[Point::zeros(), edge(-1.0), edge(1.0)]);
    svg.line("axis", Point::new(-26.0, 0.0), Point::new(30.0, 0.0));
    svg.line("axis", Point::zeros(), Point::new(0.0, 34.0));
    svg.text("label", Point::new(1.0, 33.4), "start", "normal force");
    svg.text("label", Point::new(30.0, -2.8), "end", "tangential force");
    svg.text("label", Point::new(-9.5, 28.5), "middle", "holds");
    svg.text("label", Point::new(24.0, 24.0), "start", "slips");
    for (tangential, normal, class) in [(0.4, 2.4, "near"), (2.0, 2.0, "far")] {
        let force = ContactForce::new(normal, Vector3::new(tangential, 0.0, 0.0), 0.0);
        let margin = limit.slip_margin(&force).newtons;
        let tip = Point::new(tangential, normal) * NEWTON;
        svg.arrow("force", Point::zeros(), tip);
        // To the edge of the cone, at right angles.
        let outward = Point::new(1.0, -coefficient).normalize();
        svg.line(&format!("spread {class}"), tip, tip + outward * (margin * NEWTON));
        // Right of the axis, within the cone or beyond it.
        let beside = if margin > 0.0 { Point::new(-2.2, 2.2) } else { Point::new(2.0, 0.5) };
        svg.text("label", tip + beside, "start", &format!("{margin:+.2} N").replace('-', "−"));
    }
    Ok(svg.drawing(
        "The friction cone with a force within it, whose margin is positive, and one beyond it, whose margin is negative",
        "The slip margin, drawn thick, is the distance to the edge of the cone: positive while the contact holds. Here the \
         coefficient is 0.5.",
    ))
}
