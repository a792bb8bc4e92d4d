//! The solid, for every shape that a scene can choose.

use fingertip::surfaces::{ActiveSurface, SmoothSurface, nearest_crossing};
use fingertip::wrench::Line;
use fingertip_scene::{Scene, registry};
use fingertip_test_support::read_back::{Path, paths, texts};
use nalgebra::Vector3;

use super::net::{COLUMNS, Net, ROWS, across, facets};
use super::{SHOWN, Solid};
use crate::observe::MapPoint;

fn scene(surface: &str) -> Scene {
    let head = "version = 2\n[input]\nconvention = \"on_fingertip\"\n";
    Scene::from_text(&format!("{head}{surface}")).unwrap_or_else(|problem| panic!("{problem}: {surface}"))
}

fn contact(scene: &Scene, point: Vector3<f64>, normal_force: f64) -> MapPoint {
    MapPoint { place: scene.projection().project(&point), point, normal_force }
}

#[test]
fn every_shape_has_facets_that_lie_on_it_and_point_outwards() {
    // And shapes without ends.
    let endless = ["shape = \"cylinder\"\nradius_m = 0.01", "shape = \"cone\"\nhalf_angle_deg = 30.0"];
    let endless = endless.map(|shape| (shape.to_owned(), format!("[surface]\n{shape}\n")));
    let askew = Vector3::new(0.48, 0.6, 0.64);
    let known = registry::SHAPES.iter().map(|entry| (entry.name.to_owned(), entry.text()));
    for (name, text) in known.chain(endless) {
        let scene = scene(&text);
        let surface = scene.surface();
        let net = Net::of(surface, scene.projection(), &[]);
        let all: Vec<_> = facets(&net.points, COLUMNS).collect();
        assert!(all.len() > 60, "{name}: {} facets", all.len());
        for facet in all.iter().step_by(37) {
            for corner in facet {
                // The surface is at the corner, along its normal or, where that is of an edge, along another line.
                let ways = [surface.normal(corner), Vector3::x(), Vector3::y(), Vector3::z(), askew];
                let on = ways.into_iter().any(|direction| {
                    let met = nearest_crossing(surface, &Line { point: *corner, direction });
                    met.is_some_and(|met| met.along.abs() < 1e-7)
                });
                assert!(on, "{name}: {corner:?}");
            }
            // Facets of some size point to where their middle leaves the surface.
            let along = across(facet);
            if along.norm() > 1e-7 {
                let middle = facet.iter().sum::<Vector3<f64>>() / 4.0;
                let outward: Vector3<f64> = facet.iter().map(|corner| surface.normal(corner)).sum();
                assert!(along.dot(&outward) > 0.0, "{name}: {middle:?} points inwards");
            }
        }
    }
}

#[test]
fn the_facets_of_a_sphere_have_nearly_its_area() {
    let area = |text: &str| {
        let scene = scene(text);
        let net = Net::of(scene.surface(), scene.projection(), &[]);
        assert_eq!(net.points.len(), (ROWS + 1) * COLUMNS);
        (facets(&net.points, COLUMNS).map(|facet| 0.5 * across(&facet).norm()).sum::<f64>(), net.is_open())
    };
    let ball = "[surface]\nshape = \"sphere\"\nradius_m = 0.01\n";
    let whole = 4.0 * core::f64::consts::PI * 1e-4;
    let (found, is_open) = area(ball);
    assert!(!is_open && found < whole && found > 0.98 * whole, "{found} of {whole}");
    // A cap up to 55° from its pole, which is between two rows: its rim is met.
    let (found, is_open) = area(&format!("{ball}active_half_angle_deg = 55.0\n"));
    let cap = 0.5 * whole * (1.0 - 55_f64.to_radians().cos());
    assert!(is_open && found < cap && found > 0.98 * cap, "{found} of {cap}");
    // Of a torus its outside, from tangent to tangent of the middle: the tube is seen up to the angle α from outwards
    // with cos α = −r/R, which has the area 4π r (R α + r sin α).
    let (found, _) = area("[surface]\nshape = \"torus\"\nring_radius_m = 0.02\ntube_radius_m = 0.004\n");
    let alpha = (-0.2_f64).acos();
    let outer = 4.0 * core::f64::consts::PI * 0.004 * (0.02 * alpha + 0.004 * alpha.sin());
    assert!(found < outer && found > 0.9 * outer, "{found} of {outer}");
}

#[test]
fn of_an_endless_shape_the_part_around_the_contacts_is_shown() {
    let scene = scene("[surface]\nshape = \"plane\"\npoint_m = [0.0, 0.0, 0.01]\n");
    // On a circle of 20 mm; one far away does not count.
    let mut contacts: Vec<MapPoint> = (0..200)
        .map(|i| {
            let (sin, cos) = (core::f64::consts::TAU * f64::from(i) / 200.0).sin_cos();
            contact(&scene, Vector3::new(0.1 + 0.02 * cos, 0.02 * sin, 0.01), 1.0)
        })
        .collect();
    contacts.push(contact(&scene, Vector3::new(50.0, 0.0, 0.01), 1.0));
    let solid = Solid::of(scene.surface(), scene.projection(), &contacts).unwrap();
    let reach = solid.net.iter().flatten().map(|point| (point - Vector3::new(100.0, 0.0, 10.0)).norm());
    let reach = reach.fold(0.0, f64::max);
    assert!((reach - 30.0).abs() < 1.5, "{reach} mm");
    assert_eq!(solid.contacts.concat().len(), 200);
}

#[test]
fn the_numbers_of_the_page_are_those_of_the_surface_and_few() {
    let scene = scene("[surface]\nshape = \"sphere\"\nradius_m = 0.013\n");
    let contacts: Vec<MapPoint> = (0..1500)
        .map(|i| {
            let (sin, cos) = (0.01 * f64::from(i)).sin_cos();
            contact(&scene, Vector3::new(0.013 * sin, 0.0, 0.013 * cos), 0.01 * f64::from(i + 1))
        })
        .collect();
    let solid = Solid::of(scene.surface(), scene.projection(), &contacts).unwrap();
    let text = solid.attributes();
    let attribute = |name: &str| {
        let start = text.find(&format!("data-{name}=\"")).unwrap() + name.len() + 7;
        &text[start..start + text[start..].find('"').unwrap()]
    };
    let radius = |point: &str| {
        let numbers: Vec<f64> = point.split(',').map(|number| number.parse().unwrap()).collect();
        Vector3::from_column_slice(&numbers).norm()
    };
    let net: Vec<&str> = attribute("net").split(';').collect();
    assert_eq!(net.len(), (ROWS + 1) * COLUMNS);
    assert!(net.iter().all(|point| (radius(point) - 13.0).abs() < 0.02));
    let shown: Vec<&str> = attribute("contacts").split(['|', ';']).collect();
    assert!(shown.len() > SHOWN / 2 && shown.len() <= SHOWN);
    assert!(shown.iter().all(|point| (radius(point) - 13.0).abs() < 0.02));
    assert_eq!(attribute("contacts").matches('|').count(), 6);
    let length = super::SCRIPT.len() + super::picture::draw(&solid).len() + text.len();
    assert!(length < 60_000, "{length} bytes");
    assert!(!text.contains("NaN") && !text.contains("inf"));
}

#[test]
fn contacts_are_seen_from_their_side() {
    let scene = scene("[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = [0.008, 0.01, 0.013]\n");
    for towards in [Vector3::new(1.0, 1.0, 1.0), Vector3::new(-1.0, 2.0, 1.0), Vector3::new(1.0, -0.5, -3.0)]
    {
        let line = Line { point: Vector3::zeros(), direction: towards.normalize() };
        let mut met = Vec::new();
        scene
            .surface()
            .crossings(&line, |crossing| met.extend((crossing.along > 0.0).then_some(crossing.point)));
        let solid = Solid::of(scene.surface(), scene.projection(), &[contact(&scene, met[0], 1.0)]).unwrap();
        let [right, up, near] = solid.view.frame;
        assert!((right.cross(&up) - near).norm() < 1e-12, "not right-handed");
        assert!(solid.view.seen(&(met[0] * 1e3)).z > 0.0, "behind, seen from {near:?}");
        // All axes come out of the surface and end within the picture.
        let extent = scene.surface().extent();
        assert!(solid.axes.iter().all(|tip| tip.norm() > 8.0 && tip.norm() < 2e3 * extent.radius));
    }
}

/// Where the squares of its extent are nothing, there is no picture, rather than one of NaN.
#[test]
fn what_is_smaller_than_numbers_is_not_drawn() {
    let is_drawn = |radius: &str| {
        let scene = scene(&format!("[surface]\nshape = \"sphere\"\nradius_m = {radius}\n"));
        let net = Net::of(scene.surface(), scene.projection(), &[]);
        assert!(net.points.iter().all(Option::is_some), "{radius}");
        Solid::of(scene.surface(), scene.projection(), &[]).is_some()
    };
    assert!(is_drawn("1e-150") && !is_drawn("1e-165") && !is_drawn("1e-300"));
}

/// What is drawn of a ball whose active part reaches so far from its pole \[°\]: its facets, in two heaps by the side
/// that they turn to the viewer, and how many dots. Of fifty contacts halfway down to the equator ten are behind.
fn picture(reach: Option<f64>) -> ([Vec<Path>; 2], usize) {
    let rim = reach.map_or_else(String::new, |reach| format!("active_half_angle_deg = {reach:?}\n"));
    let scene =
        scene(&format!("[surface]\nshape = \"sphere\"\nradius_m = 0.013\npole = [0.0, 0.0, 1.0]\n{rim}"));
    let contacts: Vec<MapPoint> = (0..50)
        .map(|i| {
            // Most of them on one side, from which they are seen.
            let turn = if i < 40 { 0.3 + 0.02 * f64::from(i) } else { 3.5 + 0.02 * f64::from(i) };
            contact(&scene, Vector3::new(turn.cos(), turn.sin(), 1.0) * 0.0092, f64::from(i + 1))
        })
        .collect();
    let solid = Solid::of(scene.surface(), scene.projection(), &contacts).unwrap();
    assert_eq!(solid.is_open, reach.is_some());
    let all = paths(&super::picture::draw(&solid));
    let dots =
        all.iter().filter(|path| path.class.starts_with("dots")).map(|path| path.pieces.concat().len());
    let dots = dots.sum();
    let facets = all.into_iter().filter(|path| path.class.len() == 2 && path.class.starts_with('s'));
    // By Gauss's area formula, with y downwards: their corners run against the clock, seen from outside.
    let faces = |facet: &Path| {
        let corners = &facet.pieces[0];
        let next = corners.iter().cycle().skip(1);
        let area: f64 = corners.iter().zip(next).map(|((a, b), (c, d))| a * d - b * c).sum();
        area < 0.0
    };
    let (front, back) = facets.partition(faces);
    ([front, back], dots)
}

#[test]
fn what_a_closed_surface_hides_is_not_drawn() {
    let lightest = |facets: &[Path]| facets.iter().map(|facet| facet.class.clone()).max().unwrap_or_default();
    let ([front, back], dots) = picture(None);
    let half = ROWS * COLUMNS / 4;
    // At the edge rounding may turn a facet that is hardly seen.
    assert!(front.len() + 20 > half && back.len() < 5, "{} and {} of {half}", front.len(), back.len());
    assert_eq!((dots, lightest(&front)), (40, "s7".to_owned()));
    // Of an open one all is drawn, and the inside is dark.
    let ([front, back], dots) = picture(Some(100.0));
    assert!(front.len() > 100 && back.len() > 20, "{} and {}", front.len(), back.len());
    let dark = lightest(&back);
    assert!(dots == 50 && lightest(&front) == "s7" && ("s0".."s3").contains(&dark.as_str()), "{dots} {dark}");
}

/// Seen from (1, 1, 1): z is up, x to the left and y to the right, both downwards.
#[test]
fn the_picture_is_isometric_and_lit_from_the_left_above() {
    let scene = scene("[surface]\nshape = \"sphere\"\nradius_m = 0.013\npole = [0.0, 0.0, 1.0]\n");
    let drawn = |count: u32| {
        let point = |i: u32| {
            let (sin, cos) = (0.01 * f64::from(i)).sin_cos();
            Vector3::new(0.006 + 0.001 * cos, 0.006 + 0.001 * sin, 0.006)
        };
        let contacts: Vec<MapPoint> = (0..count).map(|i| contact(&scene, point(i), 1.0)).collect();
        super::picture::draw(&Solid::of(scene.surface(), scene.projection(), &contacts).unwrap())
    };
    let svg = drawn(1);
    let all = paths(&svg);
    let middle = (170.0, 150.0);
    for (axis, name, (right, up)) in
        [("a", "x", (-1.0, -1.0)), ("b", "y", (1.0, -1.0)), ("c", "z", (0.0, 1.0))]
    {
        let class = format!("curve wide {axis}");
        let pieces: Vec<_> =
            all.iter().filter(|path| path.class == class).map(|path| &path.pieces[0]).collect();
        // The ends of the pieces are those of twelve parts of one line from the middle of the ball.
        let mut far: Vec<f64> =
            pieces.iter().flat_map(|piece| piece.iter()).map(|(x, y)| (x - 170.0).hypot(y - 150.0)).collect();
        far.sort_by(f64::total_cmp);
        let whole = far[23];
        assert!(pieces.len() == 12 && whole > 80.0, "{name}: {whole}");
        for (k, far) in far.iter().enumerate() {
            let expected = whole * k.div_ceil(2) as f64 / 12.0;
            assert!((far - expected).abs() < 0.2, "{name}: {far} for {expected}");
        }
        // Its name is just behind its tip; the baseline is 4 lower than its middle.
        let label = texts(&svg).into_iter().find(|text| text.text == name).unwrap().at;
        let (x, y) = (label.0 - middle.0, middle.1 - (label.1 - 4.0));
        assert!((x.hypot(y) - 1.06 * whole).abs() < 0.3, "{name}: {x} {y}");
        let slant = 30_f64.to_radians();
        let (across, height) = if right == 0.0 { (0.0, 1.0) } else { (slant.cos(), slant.sin()) };
        assert!((x / x.hypot(y) - right * across).abs() < 0.01, "{name}: {x} {y}");
        assert!((y / x.hypot(y) - up * height).abs() < 0.01, "{name}: {x} {y}");
    }
    // Where facets of a shade are, on the average.
    let place = |shade: &str| {
        let corners = all.iter().filter(|path| path.class == shade).flat_map(|path| path.pieces.concat());
        let corners: Vec<_> = corners.collect();
        let sum = corners.iter().fold((0.0, 0.0), |sum, corner| (sum.0 + corner.0, sum.1 + corner.1));
        (sum.0 / corners.len() as f64 - middle.0, middle.1 - sum.1 / corners.len() as f64)
    };
    let (light, dark) = (place("s7"), place("s2"));
    assert!(light.0 < -10.0 && light.1 > 10.0 && dark.0 > 5.0 && dark.1 < -5.0, "{light:?} {dark:?}");
    // As many dots as can be told apart, at most.
    let dots = |count: u32| drawn(count).matches("h0").count();
    assert_eq!((dots(400), dots(401), dots(700)), (400, 201, 350));
}
