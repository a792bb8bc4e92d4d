//! The picture as a whole, at any size.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use super::state::{Health, State};
use super::{forces, map, slip};
use crate::sensor::losses_said;
use crate::table::{count, short};

/// Below this the picture is one line.
const LEAST: (u16, u16) = (28, 8);
/// From this width on, the map stands beside the numbers.
const WIDE: u16 = 72;

pub(super) fn draw(frame: &mut Frame<'_>, state: &State, held: bool) {
    let area = frame.area();
    if area.width < LEAST.0 || area.height < LEAST.1 {
        frame.render_widget(Paragraph::new(in_a_word(state)), area);
        return;
    }
    // Addresses stand above all else, as long as they leave room for the rest.
    let served = u16::try_from(state.served.len()).unwrap_or(0).min(area.height.saturating_sub(LEAST.1) / 2);
    let [head, addresses, body, link, keys] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(served),
        Constraint::Min(0),
        Constraint::Length(1),
        Constraint::Length(1),
    ])
    .areas(area);
    let lines: Vec<Line<'_>> = state.served.iter().map(|address| Line::raw(address.as_str())).collect();
    frame.render_widget(Paragraph::new(lines).fg(Color::Cyan), addresses);
    frame.render_widget(Paragraph::new(title(state, held)), head);
    frame.render_widget(Paragraph::new(statistics(state)), link);
    let help = "q ends  space holds  t zero (1 s)  r forgets trail and scale";
    frame.render_widget(Paragraph::new(help).fg(Color::DarkGray), keys);
    parts(frame, body, state);
}

fn parts(frame: &mut Frame<'_>, body: Rect, state: &State) {
    let has_scene = state.projection.is_some();
    let slip_height = if has_scene { slip::HEIGHT } else { 0 };
    if body.width >= WIDE {
        let numbers = if has_scene { Constraint::Percentage(50) } else { Constraint::Percentage(100) };
        let [left, right] = Layout::horizontal([numbers, Constraint::Min(0)]).areas(body);
        let [bars, light] =
            Layout::vertical([Constraint::Min(forces::HEIGHT), Constraint::Length(slip_height)]).areas(left);
        forces::draw(frame, bars, state);
        slip::draw(frame, light, state);
        map::draw(frame, right, state);
    } else {
        let spare = body.height.saturating_sub(forces::HEIGHT + slip_height);
        // What is most wanted stays when there is no room: forces, then slip, then the map.
        let map_height = if has_scene && spare >= map::LEAST_HEIGHT { spare } else { 0 };
        let [bars, light, place] = Layout::vertical([
            Constraint::Length(forces::HEIGHT),
            Constraint::Length(slip_height),
            Constraint::Length(map_height),
        ])
        .areas(body);
        forces::draw(frame, bars, state);
        slip::draw(frame, light, state);
        map::draw(frame, place, state);
    }
}

fn in_a_word(state: &State) -> String {
    match (&state.health, &state.wrench) {
        (Health::Running | Health::Ended, Some(wrench)) => {
            format!("{} N {}", short(wrench.force().norm()), state.status())
        }
        (health, _) => words(health).0.to_owned(),
    }
}

fn words(health: &Health) -> (&str, Color) {
    match health {
        Health::Waiting => ("waiting for the first sample", Color::Yellow),
        Health::Running => ("live", Color::Green),
        Health::Resting => ("taking the zero: do not touch", Color::Yellow),
        Health::Lost(_) => ("lost, connecting anew", Color::Red),
        Health::Ended => ("the recording is over", Color::Cyan),
    }
}

fn title(state: &State, held: bool) -> Line<'_> {
    let (word, colour) = if held { ("held", Color::Yellow) } else { words(&state.health) };
    let mut spans = vec![
        Span::styled(format!(" {word} "), Style::new().fg(Color::Black).bg(colour)),
        Span::raw(format!(" {} ", state.source)).bold(),
    ];
    if let Health::Lost(why) = &state.health {
        spans.push(Span::raw(why.clone()).red());
    }
    Line::from(spans)
}

fn statistics(state: &State) -> Line<'_> {
    let mut spans = vec![Span::raw(format!(
        "{} samples/s, {} s, {}",
        short(state.rate.round()),
        short(state.time),
        losses_said(&state.losses)
    ))];
    if state.losses.lost.is_some_and(|lost| lost > 0) {
        spans = spans.into_iter().map(Stylize::yellow).collect();
    }
    if state.reconnections > 0 {
        spans.push(Span::raw(format!(", connected anew {} times", count(state.reconnections))).yellow());
    }
    if state.faults > 0 {
        let last = state.last_fault.as_deref().unwrap_or_default();
        spans.push(Span::raw(format!(", {} bad ({last})", count(state.faults))).red());
    }
    if let Some(first) = state.seen.first() {
        spans.push(Span::raw(format!(", sensor: {first}")).red());
    }
    Line::from(spans)
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Instant;

    use fingertip::wrench::Wrench;
    use nalgebra::{Vector3, Vector6};
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use ratatui::style::Color;

    use super::{Health, State, draw};
    use crate::felt::SceneFeel;
    use crate::scene::load_or_simulated;

    const SIZES: [(u16, u16); 12] = [
        (0, 0),
        (1, 1),
        (3, 40),
        (200, 1),
        (20, 5),
        (28, 8),
        (30, 12),
        (40, 30),
        (71, 24),
        (72, 10),
        (80, 24),
        (200, 60),
    ];

    /// The picture as text.
    fn picture(state: &State, (width, height): (u16, u16)) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(frame, state, false)).unwrap();
        let buffer = terminal.backend().buffer();
        let mut text = String::new();
        for row in 0..height {
            for column in 0..width {
                text.push_str(buffer[(column, row)].symbol());
            }
            text.push('\n');
        }
        text
    }

    fn pressed(force: Vector3<f64>, samples: u32) -> State {
        let scene = load_or_simulated(Path::new("sim")).unwrap();
        let mut state = State::new("test".to_owned());
        state.projection = Some(*scene.projection());
        state.coefficient = scene.limit().map(fingertip_scene::Limit::coefficient);
        state.watches_slip = true;
        let mut feel = SceneFeel::new(&scene, true);
        for sample in 0..samples {
            let time = f64::from(sample) * 1e-3;
            // A point at 45° from the top, and something like noise.
            let point = Vector3::new(0.0092, 0.0092, 0.0) * (1.0 + 1e-4 * f64::from(sample % 3));
            let wrench: Wrench<f64> = Wrench::from_force_at(&point, force);
            let touch = feel.feel(time, &wrench).unwrap();
            state.sample(time, &wrench, touch, Instant::now());
        }
        state.refresh();
        state
    }

    #[test]
    fn every_state_can_be_drawn_at_every_size() {
        let mut states = vec![State::new("x".repeat(300))];
        let force = Vector3::new(-1.5, -1.2, 0.3);
        states.push(pressed(force, 100));
        states.push(pressed(-force, 100));
        states.push(pressed(Vector3::repeat(f64::NAN), 100));
        states.push(pressed(force * 1e300, 100));
        states.push(pressed(force * 1e-300, 100));
        let mut lost = pressed(force, 3);
        lost.health = Health::Lost("unplugged".to_owned());
        lost.faults = 12_345;
        states.push(lost);
        for state in &states {
            for size in SIZES {
                picture(state, size);
            }
        }
    }

    #[test]
    fn a_press_shows_as_numbers_bars_and_a_point() {
        let state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        let text = picture(&state, (80, 24));
        for expected in ["live", "fx", "-1.50 N", "contact", "holding", "µ 0.4", "fn 1.9", "q ends", "mm ±"]
        {
            assert!(text.contains(expected), "{expected} is missing:\n{text}");
        }
        assert!(text.contains('●') && text.contains('█'), "{text}");
        assert!(picture(&state, (20, 5)).contains("1.94 N contact"));
        // Without a scene there is no map, and it is said how to get one.
        let mut plain = State::new("test".to_owned());
        plain.sample(0.0, &Wrench::on_fingertip(Vector3::x(), Vector3::zeros()), None, Instant::now());
        let text = picture(&plain, (80, 24));
        assert!(text.contains("--scene") && !text.contains('●'), "{text}");
    }

    /// A map of a few rows would show nothing but its frame.
    #[test]
    fn a_map_that_is_too_low_is_left_out() {
        let state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        // Three rows of a picture are not of its body.
        for width in [72, 200] {
            assert!(!picture(&state, (width, 8)).contains("Contact ("), "{width}");
            assert!(picture(&state, (width, 9)).contains("Contact ("), "{width}");
        }
    }

    #[test]
    fn addresses_are_shown_where_there_is_room() {
        let mut state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        state.served = vec!["Watch: http://a".to_owned(), "Command: http://b".to_owned()];
        let text = picture(&state, (80, 24));
        assert!(
            text.contains("Watch: http://a")
                && text.contains("Command: http://b")
                && text.contains("holding")
        );
        assert!(!picture(&state, (80, 8)).contains("http"));
    }

    #[test]
    fn what_is_no_contact_says_why() {
        let text = picture(&pressed(Vector3::new(-0.05, -0.01, 0.0), 10), (80, 24));
        assert!(text.contains("force below the threshold") && !text.contains('●'), "{text}");
    }

    /// Compares with a picture that somebody has looked at; with `FINGERTIP_ACCEPT=1`, writes it.
    fn assert_accepted(name: &str, picture: &str) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/accepted").join(name);
        if std::env::var_os("FINGERTIP_ACCEPT").is_some() {
            std::fs::write(&path, picture).unwrap();
        }
        let accepted = std::fs::read_to_string(&path).unwrap();
        assert!(picture == accepted, "{name} has become\n{picture}");
    }

    #[test]
    fn the_pictures_are_those_that_were_accepted() {
        let mut state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        state.rate = 1000.4;
        assert_accepted("live_wide.txt", &picture(&state, (80, 24)));
        assert_accepted("live_narrow.txt", &picture(&state, (40, 30)));
        assert_accepted("live_low.txt", &picture(&state, (72, 10)));
        // Without room for the map: forces, then slip.
        assert_accepted("live_small.txt", &picture(&state, (40, 20)));
        let mut lost = pressed(Vector3::new(-0.5, -0.1, 0.3), 3);
        lost.health = Health::Lost("unplugged".to_owned());
        (lost.faults, lost.last_fault, lost.reconnections) = (12_345, Some("cut".to_owned()), 2);
        lost.losses.lost = Some(3);
        assert_accepted("live_lost.txt", &picture(&lost, (100, 24)));
    }

    /// A scene of a surface, pressed here and there with something like noise of so many newtons.
    fn wandering(surface: &str, noise: f64, place: impl Fn(f64) -> (Vector3<f64>, Vector3<f64>)) -> State {
        let text = format!("version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\n{surface}\n");
        let scene = fingertip_scene::Scene::from_text(&text).unwrap();
        let mut state = State::new("test".to_owned());
        state.projection = Some(*scene.projection());
        let mut feel = SceneFeel::new(&scene, true);
        for sample in 0..120_u32 {
            let (point, force) = place(0.05 * f64::from(sample));
            let noise = noise * (11.0 * f64::from(sample)).sin();
            let wrench: Wrench<f64> = Wrench::from_force_at(&point, force);
            let noisy = Wrench::from_components(
                &(wrench.components() + Vector6::new(0.0, 0.0, 0.0, noise, -noise, noise)),
            );
            let time = f64::from(sample) * 1e-2;
            let touch = feel.feel(time, &noisy).unwrap();
            state.sample(time, &noisy, touch, Instant::now());
            state.refresh();
        }
        state
    }

    #[test]
    fn the_maps_of_other_surfaces_are_those_that_were_accepted() {
        let plane =
            |t: f64| (Vector3::new(0.008 * t.cos(), 0.013 * t.sin(), 0.0), Vector3::new(0.1, 0.0, -2.0));
        assert_accepted("live_plane.txt", &picture(&wandering("shape = \"plane\"", 0.002, plane), (80, 24)));
        let tube = |t: f64| {
            let (sin, cos) = (2.0 * t.sin()).sin_cos();
            (Vector3::new(0.01 * sin, 0.004 * t.cos(), 0.01 * cos), Vector3::new(-2.0 * sin, 0.2, -2.0 * cos))
        };
        let shape = "shape = \"cylinder\"\nradius_m = 0.01\naxis = [0.0, 1.0, 0.0]";
        assert_accepted("live_tube.txt", &picture(&wandering(shape, 1e-4, tube), (80, 24)));
        let half = format!("{shape}\nhalf_length_m = 0.006");
        assert_accepted("live_half_tube.txt", &picture(&wandering(&half, 3e-3, tube), (80, 24)));
        let cap = "shape = \"sphere\"\nradius_m = 0.01\nactive_half_angle_deg = 80.0";
        let top =
            |t: f64| (Vector3::new(0.003 * t.cos(), 0.003 * t.sin(), 0.0095), Vector3::new(0.0, 0.0, -1.0));
        assert_accepted("live_cap.txt", &picture(&wandering(cap, 1e-3, top), (80, 24)));
    }

    #[test]
    fn what_is_wrong_with_the_sensor_is_shown() {
        let mut state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        state.seen = vec!["fx is dead".to_owned(), "fy is dead".to_owned()];
        assert!(picture(&state, (100, 24)).contains(", sensor: fx is dead"));
    }

    #[test]
    fn a_small_window_has_one_line() {
        let mut state = pressed(Vector3::new(-1.5, -1.2, 0.3), 100);
        let first = |state: &State, size| picture(state, size).lines().next().unwrap().trim_end().to_owned();
        assert_eq!(first(&state, (27, 8)), "1.94 N contact");
        assert_eq!(first(&state, (28, 7)), "1.94 N contact");
        assert!(first(&state, (28, 8)).starts_with(" live "));
        state.health = Health::Resting;
        assert_eq!(first(&state, (50, 3)), "taking the zero: do not touch");
    }

    /// The colours of a row's letters, each once.
    fn colours(state: &State, held: bool, row: u16) -> Vec<Color> {
        let mut terminal = Terminal::new(TestBackend::new(120, 24)).unwrap();
        terminal.draw(|frame| draw(frame, state, held)).unwrap();
        let buffer = terminal.backend().buffer();
        let letters = (0..120).map(|column| &buffer[(column, row)]).filter(|cell| cell.symbol() != " ");
        let mut found: Vec<Color> =
            letters.map(|cell| if row == 0 && cell.bg != Color::Reset { cell.bg } else { cell.fg }).collect();
        found.dedup();
        found
    }

    #[test]
    fn what_is_to_be_minded_has_a_colour() {
        let mut state = State::new("test".to_owned());
        for (health, colour) in [
            (Health::Waiting, Color::Yellow),
            (Health::Running, Color::Green),
            (Health::Resting, Color::Yellow),
            (Health::Ended, Color::Cyan),
        ] {
            state.health = health;
            assert_eq!(colours(&state, false, 0), [colour, Color::Reset], "{:?}", state.health);
            assert_eq!(colours(&state, true, 0), [Color::Yellow, Color::Reset]);
        }
        state.health = Health::Lost("unplugged".to_owned());
        assert_eq!(colours(&state, false, 0), [Color::Red, Color::Reset, Color::Red]);
        // The line of the link: plain, as long as nothing is missing.
        assert_eq!(colours(&state, false, 22), [Color::Reset]);
        state.losses.lost = Some(0);
        assert_eq!(colours(&state, false, 22), [Color::Reset]);
        (state.losses.lost, state.reconnections, state.faults) = (Some(1), 1, 1);
        assert_eq!(colours(&state, false, 22), [Color::Yellow, Color::Red]);
        assert_eq!(colours(&state, false, 23), [Color::DarkGray]);
    }

    #[test]
    fn one_line_says_how_it_is() {
        let mut state = State::new("test".to_owned());
        let line = |state: &State| picture(state, (50, 1)).trim_end().to_owned();
        assert_eq!(line(&state), "waiting for the first sample");
        state.sample(0.0, &Wrench::on_fingertip(Vector3::y() * 3.0, Vector3::zeros()), None, Instant::now());
        assert_eq!(line(&state), "3 N no scene");
        state.health = Health::Ended;
        assert_eq!(line(&state), "3 N no scene");
        state.health = Health::Lost(String::new());
        assert_eq!(line(&state), "lost, connecting anew");
    }
}
