//! Gauges on a tube, drawn flat.

use fingertip_calibration::design::TubeLayout;

use super::axis::Axis;
use super::svg::{Anchor, Svg};

const WIDTH: f64 = 520.0;
const LEFT: f64 = 48.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 24.0;
/// Length of a gauge in the drawing over the circumference: a fifteenth, near that of the smallest foil
/// gauges on a fingertip's tube.
const GAUGE: f64 = 1.0 / 15.0;

/// The wall unrolled: the angle to the right, the tip upwards, both to one scale. `clamped_at` is where
/// the tube is held, behind the origin \[m\].
pub(crate) fn draw(layout: &TubeLayout, clamped_at: f64) -> String {
    let circumference = core::f64::consts::TAU * layout.beam.radius;
    let margin = GAUGE * circumference;
    let most = layout.gauges.iter().map(|gauge| gauge.z).fold(clamped_at, f64::max);
    let least = layout.gauges.iter().map(|gauge| gauge.z).fold(0.0, f64::min) - 1.5 * margin;
    let across = WIDTH - LEFT - RIGHT;
    let scale = across / circumference;
    let down = scale * (most - least);
    let height = TOP + down + 40.0;
    let mut svg = Svg::new(WIDTH, height, "gauges on the unrolled tube");
    // From the edge at −30°, so that a gauge at 0° is whole.
    let first = -30.0;
    let place = |degrees: f64, z: f64| {
        let turned = (degrees - first).rem_euclid(360.0);
        (LEFT + across * turned / 360.0, TOP + scale * (z - least))
    };
    let axis = Axis::linear("", least * 1e3, most * 1e3);
    for tick in axis.ticks(5) {
        let at = TOP + scale * (tick.value * 1e-3 - least);
        svg.line("grid", (LEFT, at), (LEFT + across, at));
        svg.label("tick", (LEFT - 5.0, at + 3.5), Anchor::End, &tick.label);
    }
    for step in 0..6 {
        let degrees = f64::from(step) * 60.0;
        let (x, _) = place(degrees, 0.0);
        svg.line("grid", (x, TOP), (x, TOP + down));
        svg.label("tick", (x, TOP + down + 15.0), Anchor::Middle, &format!("{degrees:.0}°"));
    }
    let origin = TOP - scale * least;
    svg.line("axis", (LEFT, origin), (LEFT + across, origin));
    let clamp = TOP + scale * (clamped_at - least);
    svg.line("rim", (LEFT, clamp), (LEFT + across, clamp));
    svg.label("name", (2.0, 12.0), Anchor::Start, "distance behind the origin / mm");
    svg.label("name", (LEFT + across, TOP + down + 32.0), Anchor::End, "angle around the tube");

    let half = 0.5 * margin * scale;
    svg.begin_clip((LEFT, TOP), (across, down));
    for gauge in &layout.gauges {
        let (x, y) = place(gauge.theta.to_degrees(), gauge.z);
        let (sin, cos) = gauge.q.sin_cos();
        // From the axis (up, to the tip) towards increasing angle (right).
        let (dx, dy) = (half * sin, -half * cos);
        let class = if lies_left(gauge.q) { "curve thick b" } else { "curve thick a" };
        svg.line(class, (x - dx, y - dy), (x + dx, y + dy));
    }
    svg.end_clip();
    for (number, gauge) in (1..).zip(&layout.gauges) {
        let (x, y) = place(gauge.theta.to_degrees(), gauge.z);
        // On the side to which its head leans, so that the numbers of a stacked pair stand apart.
        let aside = if lies_left(gauge.q) { -1.0 } else { 1.0 };
        let (sin, cos) = gauge.q.sin_cos();
        let up = if cos < 0.0 { -1.0 } else { 1.0 };
        let at = (x + up * sin * half + aside * 8.0, y - up * cos * half + 2.0);
        svg.label("tick halo", at, Anchor::Middle, &number.to_string());
    }
    svg.finish()
}

/// Whether a gauge leans to the left: between −90° and 0°, or the same turned by 180°.
fn lies_left(q: f64) -> bool {
    q.tan() < 0.0
}
