//! Contact points on the fingertip drawn flat (as Fig. 5 of Bicchi & Dario 1987).

use core::f64::consts::PI;

use fingertip_calibration::page::{Anchor, Axis, Placed, Svg, TICK_SIZE, text_width};
use fingertip_scene::{MapKind, Projection};

use super::colours::Classes;
use crate::observe::MapPoint;

const WIDTH: f64 = 340.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 24.0;
/// Room under the map for its axis, and for the legend.
const AXIS: f64 = 36.0;
const LEGEND: f64 = 40.0;

/// A map, and what has to be said under it.
pub(crate) struct Map {
    pub(crate) svg: String,
    pub(crate) remark: String,
}

/// An outline on the map, as its corners.
type Outline = Vec<(f64, f64)>;

/// Draws contact points, coloured by normal force, and outlines over them.
pub(crate) fn draw(title: &str, projection: &Projection, points: &[MapPoint], outlines: &[Outline]) -> Map {
    let classes = Classes::of(points.iter().map(|point| point.normal_force));
    match projection.kind() {
        MapKind::Polar { rim } => polar(title, rim, projection.names(), points, outlines, &classes),
        MapKind::Flat => flat(title, None, projection.names(), points, outlines, &classes),
        MapKind::Unrolled { radius, half_length } => {
            flat(title, Some((radius, half_length)), projection.names(), points, outlines, &classes)
        }
    }
}

fn dots(svg: &mut Svg, points: &[MapPoint], classes: &Classes, place: impl Fn((f64, f64)) -> (f64, f64)) {
    for class in 0..Classes::COUNT {
        let inside = points.iter().filter(|point| classes.class(point.normal_force) == class);
        svg.dots(&format!("q{class}"), inside.map(|point| place(point.place)));
    }
}

/// The sphere in a disk of radius 2 (in radii of the sphere), or less where nothing lies further
/// out.
fn polar(
    title: &str,
    rim: Option<f64>,
    names: [&str; 2],
    points: &[MapPoint],
    outlines: &[Outline],
    classes: &Classes,
) -> Map {
    let chord = |polar: f64| 2.0 * (0.5 * polar).sin();
    let farthest = points.iter().map(|point| point.place.0.hypot(point.place.1)).fold(0.0, f64::max);
    let reach = farthest.max(rim.map_or(0.0, chord)).max(chord(PI / 6.0));
    // As far as the rim if nothing lies beyond it, otherwise to the next ring of the grid.
    let rings = [30.0, 60.0, 90.0, 120.0, 150.0, 180.0_f64].map(f64::to_radians);
    let beyond = |ring: &f64| chord(*ring) >= reach * 0.999_999;
    let outer = rim.filter(beyond).or_else(|| rings.into_iter().find(beyond)).unwrap_or(PI);
    // A ring that would run along the rim says nothing.
    let apart = |ring: &f64| rim.is_none_or(|rim| (ring - rim).abs() > 6_f64.to_radians());
    let rings: Vec<f64> = rings.into_iter().filter(|ring| *ring <= outer).filter(apart).collect();
    let disk = 0.5 * (WIDTH - 40.0);
    let scale = disk / chord(outer);
    let centre = (0.5 * WIDTH, TOP + disk);
    let height = TOP + 2.0 * disk + 16.0 + LEGEND;
    let mut svg = Svg::new(WIDTH, height, title);
    for ring in &rings {
        let ring = *ring;
        svg.circle("ring", centre, scale * chord(ring));
    }
    for spoke in 0..4 {
        let (sin, cos) = (f64::from(spoke) * 0.25 * PI).sin_cos();
        let (x, y) = (disk * cos, disk * sin);
        svg.line("grid", (centre.0 - x, centre.1 - y), (centre.0 + x, centre.1 + y));
    }
    if let Some(rim) = rim {
        svg.circle("rim", centre, scale * chord(rim));
    }
    let place = |(u, v): (f64, f64)| (centre.0 + scale * u, centre.1 - scale * v);
    svg.begin_turn(centre, disk, scale);
    dots(&mut svg, points, classes, place);
    for outline in outlines {
        svg.polygon("sure", outline.iter().copied().map(place));
    }
    svg.end_clip();
    svg.label("name", (2.0, 12.0), Anchor::Start, "angle from the pole");
    svg.label("name halo", (centre.0 + disk - 5.0, centre.1 - 5.0), Anchor::End, names[0]);
    svg.label("name halo", (centre.0 + 6.0, TOP + 14.0), Anchor::Start, names[1]);
    // Ring labels last, on a slant between two spokes, so that they stay readable; the names are not as long as that.
    let (sin, cos) = (0.375 * PI).sin_cos();
    let mut placed = Placed::default();
    let mut has_room = |(x, y): (f64, f64), half: f64| placed.take([x - half, x + half, y - 8.0, y + 2.0]);
    for ring in rings {
        let at = scale * chord(ring);
        let label = format!("{:.0}°", ring.to_degrees());
        let place = (centre.0 + at * cos, centre.1 - at * sin + 3.5);
        if has_room(place, 0.5 * text_width(&label, TICK_SIZE)) {
            svg.label("tick halo", place, Anchor::Middle, &label);
        }
    }
    classes.legend(&mut svg, (LEFT, height - LEGEND + 10.0), WIDTH - LEFT - RIGHT);
    let rim = rim.map_or_else(String::new, |rim| {
        format!(" The dashed circle is the rim of the active region, at {:.1}°.", rim.to_degrees())
    });
    Map {
        svg: svg.finish(),
        remark: format!("Equal-area projection, seen from outside along the pole.{rim}"),
    }
}

/// A plane, or a cylinder of given radius and active half length, in millimetres.
fn flat(
    title: &str,
    unrolled: Option<(f64, Option<f64>)>,
    names: [&str; 2],
    points: &[MapPoint],
    outlines: &[Outline],
    classes: &Classes,
) -> Map {
    let half_length = unrolled.and_then(|(_, half_length)| half_length);
    let (left, right) = window(points.iter().map(|point| point.place.0), None);
    let (low, high) = window(points.iter().map(|point| point.place.1), half_length);
    let width = WIDTH - LEFT - RIGHT;
    // True to scale as long as the map is neither a thread nor a tower.
    let true_height = width * (high - low) / (right - left);
    let map_height = true_height.clamp(0.4 * width, 1.1 * width);
    let to_scale = (true_height - map_height).abs() < 0.01 * map_height;
    let height = TOP + map_height + AXIS + LEGEND;

    let x = match unrolled {
        Some((radius, _)) => {
            let degrees = (1.0 / radius).to_degrees();
            Axis::degrees("angle around the axis / °", left * degrees, right * degrees)
        }
        None => Axis::linear(&format!("{} / mm", names[0]), left, right),
    };
    let up = if unrolled.is_some() { "height along the axis" } else { names[1] };
    let y = Axis::linear(&format!("{up} / mm"), low, high);
    let place = |(u, v): (f64, f64)| {
        (LEFT + width * (u - left) / (right - left), TOP + map_height * (high - v) / (high - low))
    };

    let mut svg = Svg::new(WIDTH, height, title);
    let bottom = TOP + map_height;
    let rows = y.placed_ticks(6, |value| TOP + map_height * (1.0 - y.place(value)));
    for (at, _) in &rows {
        svg.line("grid", (LEFT, *at), (LEFT + width, *at));
    }
    svg.ticks_up(LEFT - 5.0, &rows);
    let columns = x.placed_ticks(6, |value| LEFT + width * x.place(value));
    for (at, _) in &columns {
        svg.line("grid", (*at, TOP), (*at, bottom));
    }
    svg.ticks_across(bottom + 15.0, &columns);
    svg.label("name", (2.0, 12.0), Anchor::Start, &y.title());
    svg.label("name", (LEFT + width, bottom + 30.0), Anchor::End, &x.title());
    svg.begin_plot((LEFT, TOP), (width, map_height), &x, &y);
    for edge in half_length.iter().flat_map(|half| [-half, *half]) {
        svg.line("rim", place((left, edge)), place((right, edge)));
    }
    let inside =
        |point: &&MapPoint| (left..=right).contains(&point.place.0) && (low..=high).contains(&point.place.1);
    let shown: Vec<MapPoint> = points.iter().filter(inside).copied().collect();
    dots(&mut svg, &shown, classes, place);
    for outline in outlines {
        svg.polygon("sure", outline.iter().copied().map(place));
    }
    svg.end_clip();
    classes.legend(&mut svg, (LEFT, height - LEGEND + 10.0), width);

    let mut remark = String::from(if unrolled.is_some() {
        "The cylinder unrolled, seen from outside."
    } else {
        "Seen from outside."
    });
    if !to_scale {
        remark.push_str(" Not to scale.");
    }
    if half_length.is_some() {
        remark.push_str(" The dashed lines are the ends of the active region.");
    }
    match points.len() - shown.len() {
        0 => {}
        1 => remark.push_str(" One contact lies outside the window."),
        missing => remark.push_str(&format!(" {missing} contacts lie outside the window.")),
    }
    Map { svg: svg.finish(), remark }
}

/// What the map shows of one coordinate: all but one in two hundred at either end, with room; the
/// ends of the active region, if they are not far away. One stray contact does not shrink the rest.
fn window(values: impl Iterator<Item = f64>, edge: Option<f64>) -> (f64, f64) {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let skipped = sorted.len() / 200;
    let (mut low, mut high) = match (sorted.get(skipped), sorted.iter().rev().nth(skipped)) {
        (Some(low), Some(high)) => (*low, *high),
        _ => (-1.0, 1.0),
    };
    if let Some(edge) = edge
        && edge < 3.0 * low.abs().max(high.abs())
    {
        low = low.min(-edge);
        high = high.max(edge);
    }
    let room = 0.06 * (high - low).max(1e-3 * high.abs().max(low.abs())).max(1e-6);
    (low - room, high + room)
}

#[cfg(test)]
mod tests;
