//! The surface drawn flat, with the contact point and its uncertainty.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use fingertip::contact::Contact;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::Block;
use ratatui::widgets::canvas::{Canvas, Circle, Context, Line as Stroke, Points, Rectangle};

use super::state::State;
use crate::table::number;
use fingertip_scene::{MapKind, Projection};

/// Fewer rows show nothing.
pub(super) const LEAST_HEIGHT: u16 = 6;
/// Corners of the ellipse.
const CORNERS: u32 = 32;
/// Half the width of the map of a plane, if nothing is farther out \[mm\].
const PLANE: f64 = 10.0;

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let Some(projection) = &state.projection else { return };
    if area.height < LEAST_HEIGHT {
        return;
    }
    let contact = state.touch.as_ref().and_then(|touch| touch.resolution.contact());
    let [right, up] = projection.names();
    let block = Block::bordered()
        .title(format!("Contact ({right} right, {up} up)"))
        .title_bottom(Line::from(said(state, contact)));
    let inner = block.inner(area);
    // Dots of a cell: two by four, and as wide as high.
    let (wide, high) = (f64::from(inner.width.max(1)) * 2.0, f64::from(inner.height.max(1)) * 4.0);
    let (half_width, half_height) = extent(projection, state);
    let dot = (2.0 * half_width / wide).max(2.0 * half_height / high) * 1.05;
    let (x, y) = (dot * wide / 2.0, dot * high / 2.0);
    let canvas = Canvas::default()
        .block(block)
        .marker(Marker::Braille)
        .x_bounds([-x, x])
        .y_bounds([-y, y])
        .paint(|canvas| paint(canvas, projection, state, contact));
    frame.render_widget(canvas, area);
}

/// Where the contact is, or why there is none.
fn said(state: &State, contact: Option<&Contact<f64>>) -> String {
    let Some(contact) = contact else { return state.status().to_owned() };
    let [x, y, z] = (contact.point * 1e3).into();
    let within = state.ellipse.map_or_else(String::new, |ellipse| {
        let [longer, _] = ellipse.semi_axes;
        format!(" ±{} (95 %)", number(longer * 1e3))
    });
    format!("at {x:.1}, {y:.1}, {z:.1} mm{within}")
}

/// Half the width and height of what is to be seen, in units of the map.
fn extent(projection: &Projection, state: &State) -> (f64, f64) {
    let farthest = |pick: fn(&(f64, f64)) -> f64| {
        state.trail.iter().map(|place| pick(place).abs()).filter(|far| far.is_finite()).fold(0.0, f64::max)
    };
    match projection.kind() {
        MapKind::Polar { rim } => {
            let radius = edge(rim);
            (radius, radius)
        }
        MapKind::Unrolled { radius, half_length } => {
            (PI * radius, half_length.unwrap_or_else(|| farthest(|place| place.1).max(PI * radius / 2.0)))
        }
        MapKind::Flat => {
            let far = farthest(|place| place.0).max(farthest(|place| place.1)).max(PLANE);
            (far, far)
        }
    }
}

/// Radius of the active region on the map of a sphere.
fn edge(rim: Option<f64>) -> f64 {
    2.0 * (0.5 * rim.unwrap_or(PI)).sin()
}

fn paint(canvas: &mut Context<'_>, projection: &Projection, state: &State, contact: Option<&Contact<f64>>) {
    match projection.kind() {
        MapKind::Polar { rim } => {
            let equator = 2.0 * (0.5 * FRAC_PI_2).sin();
            canvas.draw(&Circle { x: 0.0, y: 0.0, radius: edge(rim), color: Color::Gray });
            if edge(rim) > equator {
                canvas.draw(&Circle { x: 0.0, y: 0.0, radius: equator, color: Color::DarkGray });
            }
        }
        MapKind::Unrolled { radius, half_length } => {
            let half = half_length.unwrap_or_else(|| extent(projection, state).1);
            canvas.draw(&Rectangle {
                x: -PI * radius,
                y: -half,
                width: TAU * radius,
                height: 2.0 * half,
                color: Color::Gray,
            });
        }
        MapKind::Flat => {
            let (far, _) = extent(projection, state);
            let cross = [(-far, 0.0, far, 0.0), (0.0, -far, 0.0, far)];
            for (x1, y1, x2, y2) in cross {
                canvas.draw(&Stroke { x1, y1, x2, y2, color: Color::DarkGray });
            }
        }
    }
    let trail: Vec<(f64, f64)> = state.trail.iter().copied().collect();
    canvas.draw(&Points { coords: &trail, color: Color::Blue });
    let Some(contact) = contact else { return };
    canvas.layer();
    if let Some(ellipse) = state.ellipse {
        let [a, b] = ellipse.semi_axes;
        let [along, across] = ellipse.directions;
        let corner = |index: u32| {
            let angle = TAU * f64::from(index) / f64::from(CORNERS);
            projection.project(&(contact.point + along * (a * angle.cos()) + across * (b * angle.sin())))
        };
        for index in 0..CORNERS {
            let ((x1, y1), (x2, y2)) = (corner(index), corner(index + 1));
            if [x1, y1, x2, y2].iter().all(|number| number.is_finite()) {
                canvas.draw(&Stroke { x1, y1, x2, y2, color: Color::Cyan });
            }
        }
    }
    let (x, y) = projection.project(&contact.point);
    if [x, y].iter().all(|number| number.is_finite()) {
        canvas.print(x, y, Line::from("●").fg(Color::White).bold());
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use nalgebra::Vector3;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use ratatui::style::Color;

    use super::super::state::State;
    use super::{LEAST_HEIGHT, Projection, draw, edge, extent};

    #[test]
    fn the_map_is_as_large_as_what_it_shows() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let zero = Vector3::zeros();
        let mut state = State::new(String::new());
        let plane = Projection::plane(zero, Vector3::z(), &axes);
        // Ten millimetres, unless something lies farther out.
        assert_eq!(extent(&plane, &state), (10.0, 10.0));
        state.trail.extend([(3.0, -12.0), (f64::NAN, f64::INFINITY), (-11.0, 0.0)]);
        assert_eq!(extent(&plane, &state), (12.0, 12.0));
        // The whole way round, and the active length, or a quarter of the way round, or what is farther.
        let tube = |half| Projection::cylinder(zero, Vector3::y(), 0.004, half, &axes);
        assert_eq!(extent(&tube(Some(0.007)), &state), (4.0 * PI, 7.0));
        assert_eq!(extent(&tube(None), &state), (4.0 * PI, 12.0));
        state.trail.clear();
        assert_eq!(extent(&tube(None), &state), (4.0 * PI, 2.0 * PI));
        // 2 sin(θ/2): the whole sphere is 2, half of it √2.
        let sphere = |rim| extent(&Projection::sphere(zero, Vector3::z(), rim, &axes), &state);
        assert_eq!(sphere(None), (2.0, 2.0));
        assert!((edge(Some(PI / 2.0)) - 2.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(sphere(Some(1.0)), (edge(Some(1.0)), edge(Some(1.0))));
    }

    /// How many cells of a map have marks of a colour, and the columns that they reach from and to.
    fn marks(state: &State, colour: Color) -> (usize, [u16; 2]) {
        let mut terminal = Terminal::new(TestBackend::new(60, 30)).unwrap();
        terminal.draw(|frame| draw(frame, frame.area(), state)).unwrap();
        let buffer = terminal.backend().buffer();
        let inside = (1..29).flat_map(|row| (1..59).map(move |column| (column, row)));
        let marked: Vec<u16> = inside
            .filter(|place| buffer[*place].symbol() != " " && buffer[*place].fg == colour)
            .map(|(column, _)| column)
            .collect();
        (marked.len(), [marked.iter().min(), marked.iter().max()].map(|column| column.copied().unwrap_or(0)))
    }

    fn shown(projection: Projection) -> State {
        let mut state = State::new(String::new());
        state.projection = Some(projection);
        state
    }

    /// The edge is gray, and the equator darker, where it is not the edge itself.
    #[test]
    fn a_sphere_has_its_edge_and_its_equator() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let sphere = |rim| shown(Projection::sphere(Vector3::zeros(), Vector3::z(), rim, &axes));
        for (rim, has_equator) in
            [(None, true), (Some(2.0), true), (Some(PI / 2.0), false), (Some(1.0), false)]
        {
            let state = sphere(rim);
            let (edge, [left, right]) = marks(&state, Color::Gray);
            assert!(edge > 40 && right - left > 45, "{rim:?}: {edge} from {left} to {right}");
            let (equator, [from, to]) = marks(&state, Color::DarkGray);
            assert_eq!(equator > 30, has_equator, "{rim:?}: {equator}");
            assert!(if has_equator { from > left && to < right } else { equator == 0 }, "{rim:?}");
        }
    }

    #[test]
    fn other_maps_have_their_frame_and_their_trail() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let zero = Vector3::zeros();
        let mut plane = shown(Projection::plane(zero, Vector3::z(), &axes));
        // A cross through the middle, and what was touched.
        assert!(marks(&plane, Color::DarkGray).0 > 60 && marks(&plane, Color::Blue).0 == 0);
        plane.trail.extend([(-5.0, 5.0), (5.0, -5.0)]);
        let (dots, [left, right]) = marks(&plane, Color::Blue);
        assert!(dots == 2 && left < 29 && right > 30, "{dots} {left} {right}");
        let tube = |half| shown(Projection::cylinder(zero, Vector3::y(), 0.004, half, &axes));
        let (frame, [left, right]) = marks(&tube(Some(0.007)), Color::Gray);
        assert!(frame > 100 && right - left > 50, "{frame} from {left} to {right}");
        assert!(marks(&tube(None), Color::Gray).0 > 100);
        // Where there is no room nothing is drawn.
        for (height, drawn) in [(LEAST_HEIGHT, true), (LEAST_HEIGHT - 1, false)] {
            let mut terminal = Terminal::new(TestBackend::new(60, height)).unwrap();
            terminal.draw(|frame| draw(frame, frame.area(), &plane)).unwrap();
            let empty = terminal.backend().buffer().content().iter().all(|cell| cell.symbol() == " ");
            assert_eq!(!empty, drawn, "{height}");
        }
    }
}
