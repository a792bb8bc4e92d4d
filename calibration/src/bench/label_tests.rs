//! Whether what is drawn can be read: labels that stand at what they name, on nothing else and on the paper.

use core::f64::consts::TAU;

use fingertip_test_support::drawn::{self, Paper};
use fingertip_wrench::gauge_layout::{Gauge, ThinWalledBeam};

use super::{Foil, Unrolled, drawing, wiring};
use crate::design::{Bridge, Excitation, TubeLayout};
use crate::sheet::Sheet;

fn layout(radius: f64, bridges: Vec<Bridge>) -> TubeLayout {
    let beam = ThinWalledBeam { radius, thickness: 2e-4, youngs_modulus: 7e10, poisson_ratio: 0.33 };
    let gauge = |place: i32| Gauge { z: 0.0, theta: f64::from(place / 2) * TAU / 3.0, q: 0.3 };
    TubeLayout { beam, gauges: (0..6).map(gauge).collect(), bridges }
}

/// Wiring of each kind of bridge: alone, and as many as go over to a second sheet.
fn wired() -> Vec<(Vec<Bridge>, Vec<Paper>)> {
    let kinds = [
        vec![],
        vec![Bridge::full([0, 3], [1, 4])],
        vec![Bridge::half(2, 5), Bridge::quarter(1), Bridge::full([0, 1], [2, 3])],
        (0..8)
            .map(|k| if k % 2 == 0 { Bridge::half(k % 6, (k + 1) % 6) } else { Bridge::quarter(k % 6) })
            .collect(),
    ];
    let excitation = Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 1.0 };
    let drawn = |bridges: Vec<Bridge>| {
        let sheets = wiring(&layout(1e-2, bridges.clone()), &Foil::default(), &excitation);
        let papers = sheets.iter().map(|sheet: &Sheet| drawn::svg(&sheet.to_svg())).collect();
        let quarters = (0..6).map(Bridge::quarter).collect();
        (if bridges.is_empty() { quarters } else { bridges }, papers)
    };
    kinds.into_iter().map(drawn).collect()
}

/// How far a point is from a rectangle.
fn apart([left, top, right, bottom]: [f64; 4], [x, y]: [f64; 2]) -> f64 {
    (left - x).max(x - right).max(0.0).hypot((top - y).max(y - bottom).max(0.0))
}

/// Whether a line goes through a rectangle: in small steps.
fn crosses(room: [f64; 4], [from, to]: [[f64; 2]; 2]) -> bool {
    let steps = 1 + ((to[0] - from[0]).hypot(to[1] - from[1]) / 0.1) as usize;
    (0..=steps).any(|step| {
        let share = step as f64 / steps as f64;
        apart(room, [0, 1].map(|i| from[i] + (to[i] - from[i]) * share)) <= 0.0
    })
}

fn is_readable(paper: &Paper) {
    let [wide, high] = paper.size;
    for (place, (room, text)) in paper.rooms.iter().zip(&paper.texts).enumerate() {
        let [left, top, right, bottom] = *room;
        assert!(left > 5.0 && top > 5.0 && right < wide - 5.0 && bottom < high - 5.0, "{text}: {room:?}");
        for (other, said) in paper.rooms.iter().zip(&paper.texts).take(place) {
            let beside = left >= other[2] || other[0] >= right || top >= other[3] || other[1] >= bottom;
            assert!(beside, "{text} lies on {said}: {room:?} {other:?}");
        }
        for line in paper.lines.iter().filter(|line| line.points.len() == 2) {
            assert!(
                !crosses(*room, [line.points[0], line.points[1]]),
                "{line:?} goes through {text}: {room:?}"
            );
        }
    }
}

#[test]
fn labels_of_bridges_are_free_of_each_other_and_of_wires() {
    for (_, papers) in wired() {
        papers.iter().for_each(is_readable);
    }
}

#[test]
fn labels_of_dimensions_are_free_of_each_other_and_of_lines() {
    for (radius, clamped, paper) in [(4e-3, 12e-3, 0.0), (10e-3, 20e-3, 1e-4), (25e-3, 45e-3, 5e-5)] {
        let unrolled = Unrolled::new(&layout(radius, vec![]), clamped, &Foil::default(), paper).unwrap();
        for tip in [None, Some(1.3 * radius)] {
            is_readable(&drawn::svg(&drawing(&unrolled, tip).to_svg()));
        }
    }
}

/// The nearest label of those that are asked for.
fn nearest(paper: &Paper, at: [f64; 2], asked: impl Fn(&str) -> bool) -> (&str, [f64; 4]) {
    let labels = paper.texts.iter().zip(&paper.rooms).filter(|(text, _)| asked(text));
    let (text, room) = labels.min_by(|a, b| apart(*a.1, at).total_cmp(&apart(*b.1, at))).unwrap();
    (text, *room)
}

/// Each arm has its gauge outside of the bridge and its number inside, each node its name beside it, and in the middle
/// of them stands the number of the channel.
#[test]
fn labels_of_bridges_stand_at_what_they_name() {
    let middle = |points: &[[f64; 2]]| {
        [0, 1].map(|i| points.iter().map(|point| point[i]).sum::<f64>() / points.len() as f64)
    };
    for (bridges, papers) in wired() {
        for (channel, bridge) in bridges.iter().enumerate() {
            let paper = &papers[channel / 6];
            let arms = [0, 1, 2, 3]
                .map(|arm| middle(&paper.named(&format!("channel-{}-arm-{arm}", channel + 1)).points));
            let centre = middle(&arms);
            let title = format!("channel {}", channel + 1);
            let (_, room) = nearest(paper, centre, |text| text == title);
            assert!(apart(room, centre) < 0.5 && (0.5 * (room[0] + room[2]) - centre[0]).abs() < 0.5);
            for (number, (at, arm)) in arms.iter().zip(bridge.arms()).enumerate() {
                let out = |room: [f64; 4]| {
                    (0.5 * (room[0] + room[2]) - centre[0]).abs() - (at[0] - centre[0]).abs()
                };
                let (name, room) = nearest(paper, *at, |text| text == "R" || text.starts_with("gauge "));
                assert_eq!(name, arm.map_or("R".to_owned(), |gauge| format!("gauge {}", gauge + 1)));
                assert!(out(room) > 1.0 && apart(room, *at) < 5.0, "{title}: {name} {room:?} {at:?}");
                let (name, room) = nearest(paper, *at, |text| text.len() == 1 && text != "R");
                assert_eq!(name, number.to_string());
                assert!(out(room) < -1.0 && apart(room, *at) < 5.0, "{title}: {name} {room:?} {at:?}");
            }
            // The nodes are where four wires of a bridge meet: as far from the middle as the arms' middles together.
            let [dx, dy] = [0, 1].map(|i| 2.0 * (arms[0][i] - centre[i]).abs());
            for (node, name) in
                [([0.0, -dy], "+ supply"), ([0.0, dy], "ground"), ([-dx, 0.0], "out −"), ([dx, 0.0], "out +")]
            {
                let at = [centre[0] + node[0], centre[1] + node[1]];
                let dot = |line: &drawn::Line| {
                    line.points.len() == 4 && (0..2).all(|i| (middle(&line.points)[i] - at[i]).abs() < 1e-3)
                };
                assert!(paper.lines.iter().any(dot), "{title}: no dot at {at:?}");
                let (found, room) = nearest(paper, at, |_| true);
                assert_eq!(found, name);
                assert!((0.6..3.0).contains(&apart(room, at)), "{title}: {name} {room:?} {at:?}");
                // Outside of the bridge: farther along the way from its middle than the node.
                let beyond = (0.5 * (room[0] + room[2]) - at[0]) * node[0]
                    + (0.5 * (room[1] + room[3]) - at[1]) * node[1];
                assert!(beyond > 0.0, "{title}: {name} {room:?} {at:?}");
            }
        }
    }
}
