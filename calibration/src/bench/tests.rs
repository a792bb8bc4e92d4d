use core::f64::consts::{PI, TAU};

use fingertip_test_support::drawn::{self, Paper};
use fingertip_wrench::gauge_layout::{Gauge, ThinWalledBeam};
use proptest::prelude::*;

use super::{
    BridgeNode, Foil, Unrolled, direction, drawing, millimetres, placements, signed, template, wiring,
};
use crate::design::{Bridge, Excitation, Placement, TubeLayout};
use crate::sheet::{Sheet, pdf};

const CARE: Placement = Placement { angle: 0.008, position: 5e-5 };

fn layout(radius: f64, thickness: f64, gauges: Vec<Gauge<f64>>) -> TubeLayout {
    let beam = ThinWalledBeam { radius, thickness, youngs_modulus: 7e10, poisson_ratio: 0.33 };
    TubeLayout { beam, gauges, bridges: Vec::new() }
}

fn rosettes(radius: f64) -> TubeLayout {
    let gauge = |place: f64, q: f64| Gauge { z: 0.0, theta: place * TAU / 3.0, q };
    let gauges = (0..3_i32).flat_map(|i| [gauge(f64::from(i), 0.3), gauge(f64::from(i), -0.3)]).collect();
    layout(radius, 2e-4, gauges)
}

/// The corners of a rectangle of foil that is glued on the wall at a gauge, each by an angle and a height.
fn glued(gauge: &Gauge<f64>, [along, across]: [f64; 2], outer: f64) -> [(f64, f64); 4] {
    // The unit vectors of the foil in the wall's tangent plane: around, and to the tip.
    let (right, up) = (gauge.q.sin(), gauge.q.cos());
    [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)].map(|(a, b)| {
        let (a, b) = (0.5 * a * along, 0.5 * b * across);
        (gauge.theta + (a * right + b * up) / outer, gauge.z - (a * up - b * right))
    })
}

/// How far the gauges on paper are from those of the layout \[mm\]: measured by ruler from the line of 0° and from the lower
/// edge, which is the clamp. `strip` is the edge, `zero` the place of that line.
fn off(
    paper: &Paper,
    strip: &[[f64; 2]],
    zero: f64,
    layout: &TubeLayout,
    thickness: f64,
    clamped: f64,
) -> f64 {
    let outer = layout.beam.radius + 0.5 * layout.beam.thickness;
    let drawn = outer + 0.5 * thickness;
    let edge = |pick: fn(f64, f64) -> f64, of: usize, from: f64| strip.iter().map(|p| p[of]).fold(from, pick);
    let (left, right) = (edge(f64::min, 0, f64::INFINITY), edge(f64::max, 0, 0.0));
    let bottom = edge(f64::max, 1, 0.0);
    let long = TAU * drawn * 1e3;
    let mut worst = (right - left - long).abs();
    for gauge in &layout.gauges {
        let centre = left + (zero - left + gauge.theta * drawn * 1e3).rem_euclid(long);
        for size in [Foil::default().grid, Foil::default().carrier] {
            let expected = glued(gauge, size, outer).map(|(theta, z)| {
                [centre + (theta - gauge.theta) * drawn * 1e3, bottom + (z - clamped) * 1e3]
            });
            worst = worst.max(paper.nearest(&expected));
        }
    }
    worst
}

/// A drawing has room for eight rings: it says how many more there are, if there are any.
#[test]
fn rings_that_the_drawing_leaves_out_are_counted() {
    for (rings, left_out) in [(7, None), (8, None), (9, Some("and 1 more")), (11, Some("and 3 more"))] {
        let gauges = (0..rings).map(|ring| Gauge { z: f64::from(ring) * 1e-3, theta: 1.0, q: 0.1 }).collect();
        let unrolled = Unrolled::new(&layout(1e-2, 2e-4, gauges), 20e-3, &Foil::default(), 0.0).unwrap();
        let paper = drawn::svg(&drawing(&unrolled, None).to_svg());
        let told: Vec<_> = paper.texts.iter().filter(|text| text.contains("more rings")).collect();
        match left_out {
            None => assert!(told.is_empty(), "{rings}: {told:?}"),
            Some(count) => assert!(told.len() == 1 && told[0].starts_with(count), "{rings}: {told:?}"),
        }
    }
}

proptest! {
    /// The template, measured back from SVG and PDF, agrees with the layout to 0.05 mm; it does to a micrometre.
    #[test]
    fn the_template_agrees_with_the_layout(
        radius in 2e-3_f64..60e-3,
        wall in 5e-5_f64..1e-3,
        places in prop::collection::vec((-2e-3_f64..15e-3, 0.0..TAU, -PI..PI), 6..12),
        paper in 0.0_f64..3e-4,
    ) {
        let gauges = places.into_iter().map(|(z, theta, q)| Gauge { z, theta, q }).collect();
        let (layout, foil, clamped) = (layout(radius, wall, gauges), Foil::default(), 20e-3);
        let unrolled = Unrolled::new(&layout, clamped, &foil, paper).unwrap();
        let sheet = template(&unrolled, CARE);
        let svg = drawn::svg(&sheet.to_svg());
        let strip = svg.named("strip").points.clone();
        let zero = svg.named("angle-0").points[0][0];
        let far = off(&svg, &strip, zero, &layout, paper, clamped);
        prop_assert!(far < 1e-3, "{} mm in the SVG", far);
        let page = drawn::pdf(&pdf(core::slice::from_ref(&sheet))).remove(0);
        prop_assert!(page.nearest(&strip) < 1e-3);
        let far = off(&page, &strip, zero, &layout, paper, clamped);
        prop_assert!(far < 2e-3, "{} mm on the page", far);
        // Nothing but the copies of what goes over an edge leaves the sheet.
        for line in svg.lines.iter().filter(|line| !line.name.is_empty()) {
            for [x, y] in &line.points {
                prop_assert!((0.0..=sheet.size()[0]).contains(x) && (0.0..=sheet.size()[1]).contains(y), "{:?}", line);
            }
        }
        for (number, gauge) in (1..).zip(&layout.gauges) {
            // The line along a gauge turns from upwards to the right by Q, but for what paper is longer around.
            let [tail, head] = svg.named(&format!("gauge-{number}-axis")).points[..] else { panic!() };
            let stretched = unrolled.drawn / unrolled.outer;
            let found = ((head[0] - tail[0]) / stretched).atan2(tail[1] - head[1]);
            let off = (found - gauge.q).rem_euclid(TAU);
            prop_assert!(off.min(TAU - off) < 1e-4, "{} {}", found, gauge.q);
            // How far it may be off, about its middle.
            let round = &svg.named(&format!("gauge-{number}-place")).points;
            let centre = [0.5 * (round[0][0] + round[2][0]), 0.5 * (round[1][1] + round[3][1])];
            prop_assert!((0.5 * (round[0][0] - round[2][0]) - 0.1).abs() < 1e-3, "two standard deviations");
            prop_assert!((centre[0] - 0.5 * (head[0] + tail[0])).hypot(centre[1] - 0.5 * (head[1] + tail[1])) < 1e-3);
        }
    }

    /// No gauge lies over the seam where there is a gap that is wide enough for it not to.
    #[test]
    fn the_seam_is_in_the_widest_gap(angles in prop::collection::vec(0.0..TAU, 6..10)) {
        let gauges = angles.iter().map(|theta| Gauge { z: 0.0, theta: *theta, q: 0.1 }).collect();
        let unrolled = Unrolled::new(&layout(1e-2, 1e-4, gauges), 0.02, &Foil::default(), 0.0).unwrap();
        prop_assert!((0.0..TAU).contains(&unrolled.seam));
        let apart = |a: f64, b: f64| { let d = (a - b).rem_euclid(TAU); d.min(TAU - d) };
        let nearest = |angle: f64| angles.iter().map(|theta| apart(*theta, angle)).fold(f64::INFINITY, f64::min);
        let here = nearest(unrolled.seam);
        for step in 0..360 {
            prop_assert!(nearest(f64::from(step).to_radians()) <= here + 1e-9);
        }
    }

    /// Carriers overlap where a point of the one lies on the other, tried on a fine grid.
    #[test]
    fn overlaps_are_those_of_points(theta in -0.6_f64..0.6, z in -6e-3_f64..6e-3, q in -PI..PI, p in -PI..PI) {
        let mut gauges = rosettes(12e-3).gauges;
        gauges[0] = Gauge { z: 5e-3, theta: 0.0, q: p };
        gauges[1] = Gauge { z: 5e-3 + z, theta, q };
        let layout = layout(12e-3, 2e-4, gauges);
        let unrolled = Unrolled::new(&layout, 0.03, &Foil::default(), 1e-4).unwrap();
        let outer = unrolled.outer;
        // A point of the one's carrier in the coordinates of the other, and whether it is inside by a margin.
        let inside = |margin: f64| {
            let [long, wide] = unrolled.foil.carrier;
            let local = |gauge: &Gauge<f64>, right: f64, up: f64| {
                (up * gauge.q.cos() + right * gauge.q.sin(), right * gauge.q.cos() - up * gauge.q.sin())
            };
            let (a, b) = (&layout.gauges[0], &layout.gauges[1]);
            (-40..=40).flat_map(|i| (-40..=40).map(move |j| (i, j))).any(|(i, j)| {
                let (along, across) = (f64::from(i) / 80.0 * long, f64::from(j) / 80.0 * wide);
                let right = outer * a.theta + along * a.q.sin() + across * a.q.cos();
                let down = a.z - along * a.q.cos() + across * a.q.sin();
                let (u, v) = local(b, right - outer * b.theta, b.z - down);
                u.abs() <= 0.5 * long + margin && v.abs() <= 0.5 * wide + margin
            })
        };
        let over = unrolled.overlapping().contains(&(0, 1)) || unrolled.stacked().contains(&(0, 1));
        // Finer than the grid nothing is claimed.
        if inside(0.0) {
            prop_assert!(over);
        } else if !inside(1.2e-4) {
            prop_assert!(!over);
        }
    }
}

#[test]
fn stacked_gauges_are_no_overlap_and_neighbours_over_the_edge_are() {
    let mut layout = rosettes(7e-3);
    let of = |layout: &TubeLayout| Unrolled::new(layout, 0.02, &Foil::default(), 1e-4).unwrap();
    let unrolled = of(&layout);
    assert_eq!((unrolled.stacked(), unrolled.overlapping()), (vec![(0, 1), (2, 3), (4, 5)], vec![]));
    // Once around is the same place; a little further is not.
    layout.gauges[1].theta = TAU;
    assert_eq!(of(&layout).stacked().len(), 3);
    layout.gauges[1].theta = TAU + 0.1;
    let unrolled = of(&layout);
    assert_eq!((unrolled.stacked().len(), unrolled.overlapping()), (2, vec![(0, 1)]));
    // One on either side of the seam: gauges everywhere leave no gap without any.
    layout.gauges =
        (0..12_i32).map(|i| Gauge { z: 0.0, theta: f64::from(i) * TAU / 12.0, q: PI / 2.0 }).collect();
    let unrolled = of(&layout);
    assert_eq!(unrolled.overlapping().len(), 12, "each with the next, the last with the first");
    // Wherever the seam is among them, and whichever of two comes first.
    for turned in 0..12 {
        let mut other = layout.clone();
        other.gauges.rotate_left(turned);
        assert_eq!(of(&other).overlapping().len(), 12, "{turned}");
        other.gauges.reverse();
        assert_eq!(of(&other).overlapping().len(), 12, "{turned}");
    }
    let svg = drawn::svg(&template(&unrolled, CARE).to_svg());
    // What goes over an edge stands at the other, too.
    let strip = &svg.named("strip").points;
    let long = strip[1][0] - strip[0][0];
    for (number, outline) in (1..).zip(&unrolled.outlines) {
        let carrier = &svg.named(&format!("gauge-{number}-carrier")).points;
        for turns in [-1.0, 1.0] {
            let copy: Vec<[f64; 2]> = carrier.iter().map(|[x, y]| [x + turns * long, *y]).collect();
            let reaches = copy.iter().any(|[x, _]| (strip[0][0]..strip[1][0]).contains(x));
            assert_eq!(svg.nearest(&copy) < 1e-3, reaches, "{outline:?}");
        }
    }
}

/// Scales of 100 mm both ways, with a mark each millimetre, and the paper as large as it must be.
#[test]
fn the_printer_can_be_checked() {
    for radius in [3e-3, 10e-3, 22e-3, 40e-3, 90e-3] {
        let sheet = template(&Unrolled::new(&rosettes(radius), 0.02, &Foil::default(), 1e-4).unwrap(), CARE);
        let svg = drawn::svg(&sheet.to_svg());
        for (name, across) in [("scale-across", 0), ("scale-down", 1)] {
            let line = &svg.named(name).points;
            assert!((line[1][across] - line[0][across] - 100.0).abs() < 1e-9);
            assert_eq!(line[1][1 - across], line[0][1 - across]);
            let marks = svg.lines.iter().filter(|mark| {
                let [from, to] = mark.points[..] else { return false };
                let on = (from[1 - across] - line[0][1 - across]).abs() < 1e-9;
                let step = from[across] - line[0][across];
                on && from[across] == to[across]
                    && (-1e-9..100.1).contains(&step)
                    && (step - step.round()).abs() < 1e-3
            });
            assert!(marks.count() >= 101, "{name}");
        }
        let points = svg.lines.iter().flat_map(|line| &line.points);
        let reach = points.fold([0.0_f64; 2], |[x, y], point| [x.max(point[0]), y.max(point[1])]);
        assert!(reach[0] <= sheet.size()[0] && reach[1] <= sheet.size()[1], "{radius}: {reach:?}");
        for (text, [left, top, right, bottom]) in svg.texts.iter().zip(&svg.rooms) {
            // Some printers leave 10 mm white.
            let across = *left >= 10.0 && *right <= sheet.size()[0] - 10.0;
            let down = *top >= 5.0 && *bottom <= sheet.size()[1] - 10.0;
            assert!(
                across && down,
                "{radius}: {text:?} on {:?} at {left} {top} {right} {bottom}",
                sheet.size()
            );
        }
        assert!(
            svg.texts
                .iter()
                .any(|text| text.contains(&format!("Ø {} mm", millimetres(2.0 * radius + 2e-4, 2))))
        );
    }
}

#[test]
fn the_table_says_where_gauges_go() {
    let mut layout = rosettes(10e-3);
    layout.gauges[3] = Gauge { z: 2.5e-3, theta: TAU - 1e-12, q: 3.0 };
    let unrolled = Unrolled::new(&layout, 20e-3, &Foil::default(), 0.0).unwrap();
    let sheets = placements(&unrolled, CARE);
    let page = drawn::pdf(&pdf(&sheets)).remove(0);
    let texts = page.texts.join("|");
    // 3 rad are 171.89°, which is the direction −8.11°; dashes are minus signs in the letters of Windows.
    let edge = millimetres(unrolled.place(TAU - 1e-12), 2);
    assert!(texts.contains(&format!("|4|2.50|17.50|0.00|{edge}|\u{96}8.11|")), "{texts}");
    assert!(texts.contains("|1|0.00|20.00|0.00|"), "{texts}");
    assert!(texts.contains("off by 0.10 mm along and around, and by 0.9°"), "{texts}");
}

/// What the drawing says is what it shows, measured with its own scale.
#[test]
fn dimensions_are_those_that_are_drawn() {
    let mut layout = rosettes(10e-3);
    layout.gauges[2].z = 6e-3;
    let unrolled = Unrolled::new(&layout, 20e-3, &Foil::default(), 1e-4).unwrap();
    for tip in [None, Some(13e-3)] {
        let sheet = drawing(&unrolled, tip);
        let svg = drawn::svg(&sheet.to_svg());
        let of = |name: &str| svg.named(name).points.clone();
        let side = of("side");
        let scale = (side[2][1] - side[1][1]) / 20.2;
        let known = [20.0, 10.0, 5.0, 4.0, 3.0, 2.0, 1.0];
        assert!(known.iter().any(|s| (s - scale).abs() < 1e-6), "{scale}");
        assert!(svg.texts.contains(&format!("From the side, {scale:.0}:1")));
        for expected in ["Ø 20.20", "20.00 (origin)", "14.00", "1.50", "1.20", "4.00", "2.50"] {
            assert!(svg.texts.iter().any(|text| text == expected), "{expected} in {:?}", svg.texts);
        }
        // The dimension of 14 mm from the clamp: a line that long.
        let is_long = |line: &&drawn::Line| {
            let [from, to] = line.points[..] else { return false };
            from[1] == to[1] && ((to[0] - from[0]).abs() - 14.0 * scale).abs() < 1e-3
        };
        assert!(svg.lines.iter().any(|line| is_long(&line)));
        let radius = |name: &str| 0.5 * (of(name)[0][0] - of(name)[2][0]);
        assert!((radius("outside") / radius("inside") - 10.1 / 9.9).abs() < 1e-3);
        assert_eq!(svg.lines.iter().any(|line| line.name == "tip"), tip.is_some());
        if tip.is_some() {
            // About the origin, which lies 20 mm from the clamp.
            let round = of("tip");
            assert!((0.5 * (round[0][0] + round[2][0]) - side[0][0] - 20.0 * scale).abs() < 1e-3);
            assert!((radius("tip") - 13.0 * scale).abs() < 1e-3);
        }
        let (grid, carrier) = (of("grid"), of("carrier"));
        assert!(((grid[2][1] - grid[1][1]) / (carrier[2][1] - carrier[1][1]) - 1.5 / 4.0).abs() < 1e-3);
        let reach = svg.lines.iter().flat_map(|line| &line.points);
        assert!(reach.into_iter().all(|[x, y]| (5.0..205.0).contains(x) && (5.0..292.0).contains(y)));
        // From the tip Y is on the right and Z above: gauges at 0° and 120°.
        let centre = [0.5 * (of("outside")[0][0] + of("outside")[2][0]), of("outside")[0][1]];
        let marks = svg.lines.iter().filter_map(|line| match line.points[..] {
            [from, to] => {
                let far = |p: [f64; 2]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
                ((far(from) - radius("outside")).abs() < 1e-3 && (far(to) - far(from) - 3.0).abs() < 1e-3)
                    .then(|| (centre[1] - to[1]).atan2(to[0] - centre[0]).to_degrees().rem_euclid(360.0))
            }
            _ => None,
        });
        let mut marks: Vec<i64> = marks.map(|angle| angle.round() as i64).collect();
        marks.sort_unstable();
        assert_eq!(marks, [0, 120, 240]);
        assert!(svg.texts.iter().any(|text| text == "1, 2: 0.0°"), "{:?}", svg.texts);
    }
}

/// The bridge that is drawn, as a circuit of resistors between nodes, gives what the bridge is said to give.
#[test]
fn drawn_bridges_are_the_circuits_that_are_meant() {
    proptest!(|(strains in prop::array::uniform4(-2e-3_f64..2e-3), present in 1_u8..16)| {
        let arm = |i: usize| (present >> i & 1 == 1).then_some(i);
        let bridge = Bridge { arm0: arm(0), arm1: arm(1), arm2: arm(2), arm3: arm(3) };
        let resistance = |i: usize| 350.0 * (1.0 + if arm(i).is_some() { 2.0 * strains[i] } else { 0.0 });
        // The potential of an output that draws no current: of two arms in a row between supply and ground.
        let potential = |node: BridgeNode| {
            let ends = |other: BridgeNode| {
                let mut arms = (0..4).filter(|i| BridgeNode::ARMS[*i].contains(&node) && BridgeNode::ARMS[*i].contains(&other));
                let found = arms.next().unwrap();
                assert!(arms.next().is_none());
                resistance(found)
            };
            let (above, below) = (ends(BridgeNode::Supply), ends(BridgeNode::Ground));
            below / (above + below)
        };
        let output = potential(BridgeNode::Plus) - potential(BridgeNode::Minus);
        prop_assert!((output - bridge.exact_ratio(strains, 2.0)).abs() < 1e-15);
    });
}

#[test]
fn wiring_names_gauges_and_resistors() {
    let mut layout = rosettes(10e-3);
    let excitation = Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 1.0 };
    let texts = |sheets: &[Sheet]| -> Vec<Vec<String>> {
        sheets.iter().map(|sheet| drawn::svg(&sheet.to_svg()).texts).collect()
    };
    let quarters = wiring(&layout, &Foil::default(), &excitation);
    let said = texts(&quarters);
    assert_eq!(said.len(), 1);
    let count = |word: &str| said[0].iter().filter(|text| *text == word).count();
    assert_eq!((count("R"), count("+ supply"), count("out −"), count("gauge 6")), (18, 6, 6, 1));
    // 5 V over 350 ohm.
    assert!(said[0].iter().any(|text| text.contains("takes 14.3 mA, all of them 86 mA")), "{said:?}");
    assert!(said[0].iter().any(|text| text.starts_with("6 bridges feel temperature")), "{said:?}");
    layout.bridges = vec![Bridge::full([0, 3], [1, 4]); 7];
    layout.bridges[6] = Bridge::quarter(5);
    let said = texts(&wiring(&layout, &Foil::default(), &excitation));
    assert_eq!(said.len(), 2);
    assert_eq!(said[0].iter().filter(|text| *text == "R").count(), 0);
    assert_eq!(said[1].iter().filter(|text| *text == "R").count(), 3);
    assert!(said[1].iter().any(|text| text == "channel 7") && said[1].iter().any(|text| text == "gauge 6"));
    assert!(said[0].iter().any(|text| text.starts_with("One bridge feels temperature")));
    layout.bridges.truncate(6);
    let said = texts(&wiring(&layout, &Foil::default(), &excitation));
    assert!(said[0].iter().any(|text| text.ends_with("temperature cancels.")));
    // Each arm is drawn between the two nodes that it joins.
    let svg = drawn::svg(&wiring(&layout, &Foil::default(), &excitation)[0].to_svg());
    let middle = |arm: usize| {
        let corners = &svg.named(&format!("channel-1-arm-{arm}")).points;
        [0, 1].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 4.0)
    };
    let [upper_left, lower_left, lower_right, upper_right] = [0, 1, 2, 3].map(middle);
    assert!(upper_left[0] < upper_right[0] && upper_left[1] < lower_left[1]);
    assert!(lower_left[0] < lower_right[0] && upper_right[1] < lower_right[1]);
}

#[test]
fn what_cannot_be_is_refused() {
    let (layout, foil) = (rosettes(1e-2), Foil::default());
    assert!(Unrolled::new(&layout, 0.02, &foil, 0.0).is_ok());
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(Unrolled::new(&layout, 0.02, &foil, bad).is_err());
        assert!(Unrolled::new(&layout, bad, &foil, 0.0).is_err());
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for foil in [
            Foil { resistance: bad, ..foil },
            Foil { grid: [bad, 1e-3], ..foil },
            Foil { carrier: [4e-3, bad], ..foil },
        ] {
            assert!(foil.validate().is_err() && Unrolled::new(&layout, 0.02, &foil, 0.0).is_err());
        }
    }
    assert!(Foil { grid: [4.1e-3, 1e-3], ..foil }.validate().is_err());
    assert!(Foil { grid: foil.carrier, ..foil }.validate().is_ok());
    let mut few = layout;
    few.gauges.truncate(5);
    assert!(Unrolled::new(&few, 0.02, &foil, 0.0).is_err());
}

#[test]
fn numbers_are_written_as_they_are_read() {
    assert_eq!(
        (millimetres(-1e-9, 2), millimetres(-1.5e-3, 2), signed(0.0, 0)),
        ("0.00".into(), "−1.50".into(), "0".into())
    );
    assert_eq!(signed(-0.05, 1), "−0.1");
    assert!(
        (direction(PI) - 0.0).abs() < 1e-12 && (direction(2.0) - 2.0_f64.to_degrees() + 180.0).abs() < 1e-12
    );
}
