//! The sensor's frame, the surface's frame, and how one turns.

use super::svg::{Drawing, Point, Svg};

fn axes(svg: &mut Svg, at: Point, right: Point, names: [&str; 2], class: &str) {
    let up = Point::new(-right.y, right.x);
    for (direction, name) in [(right, names[0]), (up, names[1])] {
        svg.arrow(class, at, at + direction * 11.0);
        svg.text("label", at + direction * 13.0 + Point::new(0.0, -0.6), "middle", name);
    }
}

/// A capsule on a sensor.
pub(super) fn frames() -> Drawing {
    let mut svg = Svg::new([-34.0, -10.0], [46.0, 49.5], 7.0);
    let corners = [[-12.0, -9.0], [12.0, -9.0], [12.0, 0.0], [-12.0, 0.0]].map(Point::from);
    svg.polygon("sensor", &corners);
    svg.text("label", Point::new(0.0, -5.8), "middle", "force/torque sensor");
    // A capsule of 8 mm radius and 15 mm of half length about its own origin, 25 mm up.
    let origin = Point::new(0.0, 25.0);
    let mut outline = Vec::new();
    for step in 0..=24 {
        let angle = core::f64::consts::PI * f64::from(step) / 24.0;
        outline.push(origin + Point::new(8.0 * angle.cos(), 15.0 + 8.0 * angle.sin()));
    }
    for step in 0..=24 {
        let angle = core::f64::consts::PI * (1.0 + f64::from(step) / 24.0);
        outline.push(origin + Point::new(8.0 * angle.cos(), -15.0 + 8.0 * angle.sin()));
    }
    svg.polygon("body", &outline);
    axes(&mut svg, Point::zeros(), Point::new(1.0, 0.0), ["x", "z"], "sensor-axis");
    axes(&mut svg, origin, Point::new(1.0, 0.0), ["x", "z"], "surface-axis");
    svg.arrow("measure", Point::new(-14.0, 0.0), Point::new(-14.0, 25.0));
    svg.text("label", Point::new(-15.0, 12.0), "end", "translation_m");
    svg.text("label", Point::new(-15.0, 9.4), "end", "[0, 0, 0.025]");
    svg.text("label", Point::new(16.5, 1.6), "start", "sensor frame:");
    svg.text("label", Point::new(16.5, -1.0), "start", "all that comes out");
    svg.text("label", Point::new(16.5, 27.0), "start", "surface frame:");
    svg.text("label", Point::new(16.5, 24.4), "start", "keys of [surface]");
    svg.drawing(
        "A capsule above a sensor; the surface frame sits 25 mm above the sensor frame",
        "The keys of <code>[surface]</code> count in the surface's own frame, <code>[pose]</code> says where that is in the \
         sensor's frame, and everything that comes out is in the sensor's frame.",
    )
}

/// A frame that is turned by 30 degrees.
pub(super) fn turned() -> Drawing {
    let mut svg = Svg::new([-14.0, -5.5], [40.0, 16.0], 9.0);
    let angle = 30.0_f64.to_radians();
    axes(&mut svg, Point::zeros(), Point::new(1.0, 0.0), ["x", "y"], "sensor-axis");
    axes(&mut svg, Point::zeros(), Point::new(angle.cos(), angle.sin()), ["x′", "y′"], "surface-axis");
    let arc: Vec<Point> = (0..=12)
        .map(|step| {
            let turn = angle * f64::from(step) / 12.0;
            Point::new(7.0 * turn.cos(), 7.0 * turn.sin())
        })
        .collect();
    svg.curve("measure", &arc);
    svg.text("label", Point::new(8.0, 1.6), "start", "30°");
    svg.dot("normal", Point::zeros());
    svg.text("label", Point::new(-1.2, -3.4), "middle", "z towards you");
    svg.text("label", Point::new(17.0, 13.0), "start", "rotation_deg = [0, 0, 30]");
    svg.text("label", Point::new(17.0, 10.2), "start", "p = R p′ + t");
    svg.drawing(
        "Axes x and y, and the same turned counterclockwise by 30 degrees about z",
        "A rotation vector is axis times angle, counterclockwise seen against the axis (the right-hand rule).",
    )
}
