//! Gauges on a tube, drawn flat.

use fingertip_calibration::design::TubeLayout;
use fingertip_calibration::page::{Anchor, Axis, Placed, Svg, TICK_SIZE, text_width};

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
    let axis = Axis::linear("distance behind the origin / mm", least * 1e3, most * 1e3);
    let rows = axis.placed_ticks(5, |value| TOP + scale * (value * 1e-3 - least));
    for (at, _) in &rows {
        svg.line("grid", (LEFT, *at), (LEFT + across, *at));
    }
    svg.ticks_up(LEFT - 5.0, &rows);
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
    svg.label("name", (2.0, 12.0), Anchor::Start, &axis.title());
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
    let mut placed = Placed::default();
    for (number, gauge) in (1..).zip(&layout.gauges) {
        let (x, y) = place(gauge.theta.to_degrees(), gauge.z);
        // On the side to which its head leans, so that the numbers of a stacked pair stand apart.
        let aside = if lies_left(gauge.q) { -1.0 } else { 1.0 };
        let (sin, cos) = gauge.q.sin_cos();
        let up = if cos < 0.0 { -1.0 } else { 1.0 };
        let label = number.to_string();
        let wide = 0.5 * text_width(&label, TICK_SIZE);
        // Where another's number stands, on its other side or at its other end.
        let ends = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let places = ends.map(|(end, side)| {
            (x + end * up * sin * half + side * aside * 8.0, y - end * up * cos * half + 2.0)
        });
        let free = places.into_iter().find(|(x, y)| placed.take([x - wide, x + wide, y - 8.0, y + 2.0]));
        if let Some(at) = free {
            svg.label("tick halo", at, Anchor::Middle, &label);
        }
    }
    svg.finish()
}

/// Whether a gauge leans to the left: between −90° and 0°, or the same turned by 180°.
fn lies_left(q: f64) -> bool {
    q.tan() < 0.0
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::gauge_layout::{Gauge, ThinWalledBeam};

    use super::{TubeLayout, draw};
    use fingertip_test_support::read_back::{paths, rulers, texts};

    #[test]
    fn gauges_stand_where_they_are_and_lean_as_they_do() {
        let places = [(-0.002, 0.0, 14.0), (0.0, 120.0, -40.0), (0.010, 240.0, 80.0), (0.012, 330.0, 200.0)];
        let gauge =
            |(z, theta, q): (f64, f64, f64)| Gauge { z, theta: theta.to_radians(), q: q.to_radians() };
        let layout = TubeLayout {
            beam: ThinWalledBeam { radius: 5e-3, thickness: 1e-4, youngs_modulus: 7e10, poisson_ratio: 0.3 },
            gauges: places.map(gauge).to_vec(),
            bridges: Vec::new(),
        };
        let svg = draw(&layout, 0.02);
        let (across, up) = rulers(&svg);
        // True to scale: an angle of 360° is 10π mm.
        let per_unit = (across.at(1.0) - across.at(0.0)) / 360.0 * core::f64::consts::TAU * 5.0;
        assert!((up.at(1.0) - up.at(0.0) - per_unit).abs() < 1e-3 * per_unit, "not to scale");
        let all = paths(&svg);
        let drawn: Vec<_> = all.iter().filter(|path| path.class.starts_with("curve thick")).collect();
        assert_eq!(drawn.len(), places.len());
        for (path, (z, theta, q)) in drawn.iter().zip(places) {
            let [tail, head] = path.pieces[0][..] else { panic!("no line") };
            let middle = (across.at(0.5 * (tail.0 + head.0)), up.at(0.5 * (tail.1 + head.1)));
            // At the edge of −30°, which is 330°.
            let turned = (middle.0 - theta).rem_euclid(360.0);
            assert!(turned.min(360.0 - turned) <= across.error(), "{middle:?} for {theta}");
            assert!((middle.1 - 1e3 * z).abs() <= up.error(), "{middle:?} for {z}");
            // From the axis, which points up to the tip, towards increasing angles, to the right.
            let leans = (head.0 - tail.0).atan2(tail.1 - head.1).to_degrees();
            assert!(((leans - q + 180.0).rem_euclid(360.0) - 180.0).abs() < 0.5, "{leans} for {q}");
            // A fifteenth of the circumference long.
            let long = (head.0 - tail.0).hypot(head.1 - tail.1) * per_unit;
            assert!((long / (core::f64::consts::TAU * 5.0 / 15.0) - 1.0).abs() < 0.01, "{long}");
        }
        let classes: Vec<&str> = drawn.iter().map(|path| path.class.as_str()).collect();
        assert_eq!(classes, ["curve thick a", "curve thick b", "curve thick a", "curve thick a"]);
        // The number stands at that end of its gauge which is nearer to the tip, on the side to which it leans.
        for (number, path) in (1..).zip(&drawn) {
            let [tail, head] = path.pieces[0][..] else { panic!("no line") };
            let end = if head.1 < tail.1 { head } else { tail };
            let side = if number == 2 { -8.0 } else { 8.0 };
            let label = texts(&svg).into_iter().find(|text| text.text == number.to_string()).unwrap();
            assert!(
                (label.at.0 - end.0 - side).abs() < 0.2 && (label.at.1 - end.1 - 2.0).abs() < 0.2,
                "{label:?}"
            );
        }
        let line = |class: &str| all.iter().find(|path| path.class == class).unwrap().pieces[0][0].1;
        assert!(up.at(line("axis")).abs() <= up.error() && (up.at(line("rim")) - 20.0).abs() <= up.error());
    }
}
