//! The maps, read back from their drawings.

use core::f64::consts::PI;

use nalgebra::Vector3;

use super::{Map, MapPoint, Projection, draw, window};
use fingertip_test_support::read_back::{
    assert_readable, circles, paths, points as points_of, rulers, texts,
};

fn axes() -> [Vector3<f64>; 3] {
    [Vector3::x(), Vector3::y(), Vector3::z()]
}

fn contacts(projection: &Projection, points: &[Vector3<f64>]) -> Vec<MapPoint> {
    let point = |point: &Vector3<f64>| MapPoint {
        place: projection.project(point),
        point: *point,
        normal_force: 1.0,
    };
    points.iter().map(point).collect()
}

fn dots(map: &Map) -> Vec<(f64, f64)> {
    let dots = paths(&map.svg).into_iter().filter(|path| path.class.starts_with("dots"));
    dots.flat_map(|path| path.pieces.concat()).collect()
}

/// Points of the unit sphere at polar angles and azimuths, both in degrees, about +x; the azimuth turns from y,
/// which is to the right, towards z, which is up.
fn on_sphere(places: &[(f64, f64)]) -> Vec<Vector3<f64>> {
    let point = |(polar, azimuth): &(f64, f64)| {
        let (polar, azimuth) = (polar.to_radians(), azimuth.to_radians());
        Vector3::new(polar.cos(), polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin())
    };
    places.iter().map(point).collect()
}

/// The polar map of such points, with its rim in degrees.
fn polar(rim: Option<f64>, places: &[(f64, f64)]) -> Map {
    let projection = Projection::sphere(Vector3::zeros(), Vector3::x(), rim.map(f64::to_radians), &axes());
    draw("test", &projection, &contacts(&projection, &on_sphere(places)), &[])
}

#[test]
fn the_angles_of_a_polar_map_can_be_read_off_its_rings() {
    let places = [(0.0, 0.0), (20.0, 0.0), (40.0, 90.0), (70.0, 200.0), (100.0, 300.0)];
    let map = polar(Some(110.0), &places);
    assert_readable(&map.svg);
    let all = texts(&map.svg);
    let labels: Vec<_> = all.iter().filter(|text| text.text.ends_with('°')).collect();
    let rings = circles(&map.svg, "ring");
    assert_eq!(labels.iter().map(|text| text.text.as_str()).collect::<Vec<_>>(), ["30°", "60°", "90°"]);
    let (centre, _) = rings[0];
    // A ring at θ has the radius 2 sin(θ/2), times a scale that is the same for all.
    let scale = rings[2].1 / (2.0 * (PI / 4.0).sin());
    for ((ring, degrees), label) in rings.iter().zip([30.0_f64, 60.0, 90.0]).zip(&labels) {
        let expected = scale * 2.0 * (0.5 * degrees.to_radians()).sin();
        assert!(ring.0 == centre && (ring.1 - expected).abs() < 0.11, "{ring:?} for {expected}");
        // The label stands on its ring, between two spokes.
        let (x, y) = (label.at.0 - centre.0, centre.1 - (label.at.1 - 3.5));
        assert!((x.hypot(y) - ring.1).abs() < 0.2, "{label:?}");
        assert!((y.atan2(x).to_degrees() - 67.5).abs() < 0.5, "{label:?}");
    }
    let (_, rim) = circles(&map.svg, "rim")[0];
    assert!((rim - scale * 2.0 * 55_f64.to_radians().sin()).abs() < 0.2, "{rim}");
    // The rim is the edge of the disk: 300 across, in the middle of 340.
    assert!((rim - 150.0).abs() < 0.06 && (centre.0 - 170.0).abs() < 0.06, "{rim} {centre:?}");
    for ((x, y), (polar, azimuth)) in dots(&map).into_iter().zip(places) {
        let (u, v) = (x - centre.0, centre.1 - y);
        let radius = scale * 2.0 * (0.5 * f64::to_radians(polar)).sin();
        let (sin, cos) = f64::to_radians(azimuth).sin_cos();
        assert!((u - radius * cos).hypot(v - radius * sin) < 0.2, "{polar} {azimuth}: {u} {v}");
    }
    assert_eq!(dots(&map).len(), places.len());
    // Four spokes through the centre, an eighth of a turn apart.
    let spokes: Vec<_> = paths(&map.svg).into_iter().filter(|path| path.class == "grid").collect();
    assert_eq!(spokes.len(), 4);
    for (index, spoke) in spokes.iter().enumerate() {
        let [from, to] = spoke.pieces[0][..] else { panic!("no line") };
        let turned = (to.1 - from.1).atan2(to.0 - from.0).to_degrees();
        assert!((turned - 45.0 * index as f64).abs() < 0.1, "{turned}");
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        assert!((length - 300.0).abs() < 0.2, "{length}");
        assert!((from.0 + to.0 - 2.0 * centre.0).abs() < 0.2 && (from.1 + to.1 - 2.0 * centre.1).abs() < 0.2);
    }
    // y to the right and z up.
    let name = |name: &str| all.iter().find(|text| text.text == name).unwrap().at;
    assert!(name("y").0 > centre.0 + 100.0 && (name("y").1 - centre.1).abs() < 10.0);
    assert!(name("z").1 < centre.1 - 100.0 && (name("z").0 - centre.0).abs() < 10.0);
    assert!(map.remark.contains("rim of the active region, at 110.0°"), "{}", map.remark);
}

/// Angles of the rings of a map, and the chord of its edge.
fn rings(rim: Option<f64>, farthest: f64) -> (Vec<String>, f64) {
    let map = polar(rim, &[(farthest, 10.0)]);
    let labels = texts(&map.svg).into_iter().map(|text| text.text).filter(|text| text.ends_with('°'));
    // The point tells the scale; the edge of the disk is 150 from its centre.
    let centre = (170.0, 174.0);
    let (x, y) = dots(&map)[0];
    let scale = (x - centre.0).hypot(y - centre.1) / (2.0 * (0.5 * farthest.to_radians()).sin());
    (labels.collect(), 150.0 / scale)
}

#[test]
fn a_polar_map_reaches_as_far_as_it_must() {
    let check = |rim, farthest: f64, expected: &[&str], edge: f64| {
        let (labels, found) = rings(rim, farthest);
        assert_eq!(labels, expected, "{rim:?}, {farthest}");
        let expected = 2.0 * (0.5 * edge.to_radians()).sin();
        assert!((found - expected).abs() < 0.005, "{rim:?}, {farthest}: {found} for {expected}");
    };
    // To the next ring without a rim, but at least to the first.
    check(None, 5.0, &["30°"], 30.0);
    check(None, 29.0, &["30°"], 30.0);
    check(None, 31.0, &["30°", "60°"], 60.0);
    // The last two rings of the whole sphere are nearer to each other than two labels.
    check(None, 170.0, &["30°", "60°", "90°", "120°", "150°"], 180.0);
    // To the rim if nothing lies beyond it, with no ring beside it.
    check(Some(100.0), 20.0, &["30°", "60°", "90°"], 100.0);
    check(Some(95.0), 20.0, &["30°", "60°"], 95.0);
    check(Some(85.0), 20.0, &["30°", "60°"], 85.0);
    check(Some(20.0), 10.0, &["30°"], 30.0);
    // To the next ring if something does.
    check(Some(70.0), 80.0, &["30°", "60°", "90°"], 90.0);
}

#[test]
fn a_plane_is_drawn_to_scale_in_millimetres() {
    let projection = Projection::plane(Vector3::zeros(), Vector3::z(), &axes());
    let points: Vec<_> =
        (0..50).map(|i| Vector3::new(0.01 * f64::from(i).sin(), 0.008 * f64::from(i).cos(), 0.0)).collect();
    let map = draw("test", &projection, &contacts(&projection, &points), &[]);
    assert_readable(&map.svg);
    assert_eq!(map.remark, "Seen from outside.");
    let (across, up) = rulers(&map.svg);
    assert!((across.at(1.0) - across.at(0.0) + up.at(1.0) - up.at(0.0)).abs() < 1e-3, "not to scale");
    assert_eq!(dots(&map).len(), points.len());
    for ((x, y), point) in dots(&map).into_iter().zip(&points) {
        let error = (across.at(x) - 1e3 * point.x, up.at(y) - 1e3 * point.y);
        assert!(error.0.abs() <= across.error() && error.1.abs() <= up.error(), "{error:?}");
    }
}

/// Around a place that was found, the outline within which it surely lies: on round maps and on flat ones.
#[test]
fn outlines_are_drawn_where_contacts_are() {
    let round = Projection::sphere(Vector3::zeros(), Vector3::x(), None, &axes());
    let flat = Projection::plane(Vector3::zeros(), Vector3::z(), &axes());
    let on_plane = [(0.0, 0.0), (9.0, 0.0), (9.0, 7.0)].map(|(x, y)| 1e-3 * Vector3::new(x, y, 0.0));
    for (projection, points) in
        [(round, on_sphere(&[(10.0, 0.0), (40.0, 90.0), (70.0, 200.0)])), (flat, on_plane.to_vec())]
    {
        let contacts = contacts(&projection, &points);
        let outline = contacts.iter().map(|contact| contact.place).collect();
        let map = draw("test", &projection, &contacts, &[outline]);
        assert_eq!(points_of(&map.svg, "sure"), dots(&map));
    }
}

/// Few contacts far away do not shrink the rest; how many there are is told.
#[test]
fn contacts_outside_the_window_are_counted() {
    let projection = Projection::plane(Vector3::zeros(), Vector3::z(), &axes());
    let near = |i: i32| Vector3::new(0.01 * f64::from(i).sin(), 0.008 * f64::from(i).cos(), 0.0);
    for (strays, remark) in [
        (0, "Seen from outside."),
        (1, "Seen from outside. One contact lies outside the window."),
        (2, "Seen from outside. 2 contacts lie outside the window."),
    ] {
        let far = (0..strays).map(|i| Vector3::new(0.5, 0.1 * f64::from(i), 0.0));
        let points: Vec<_> = (0..400).map(near).chain(far).collect();
        let map = draw("test", &projection, &contacts(&projection, &points), &[]);
        assert_eq!((map.remark.as_str(), dots(&map).len()), (remark, 400));
        let (across, _) = rulers(&map.svg);
        assert!(dots(&map).into_iter().all(|(x, _)| across.at(x).abs() < 10.1), "{strays}");
    }
}

#[test]
fn a_cylinder_is_unrolled_by_angle_and_height() {
    let half = Some(0.012);
    let projection = Projection::cylinder(Vector3::zeros(), Vector3::y(), 0.02, half, &axes());
    let place = |i: i32| (3.0 * f64::from(i) - 70.0, 0.01 * f64::from(i).sin());
    let points: Vec<_> = (0..50)
        .map(|i| {
            let (degrees, height) = place(i);
            let (sin, cos) = degrees.to_radians().sin_cos();
            Vector3::new(0.02 * sin, height, 0.02 * cos)
        })
        .collect();
    let map = draw("test", &projection, &contacts(&projection, &points), &[]);
    assert_readable(&map.svg);
    let (across, up) = rulers(&map.svg);
    assert_eq!(dots(&map).len(), points.len());
    for ((x, y), i) in dots(&map).into_iter().zip(0..) {
        let (degrees, height) = place(i);
        assert!((across.at(x) - degrees).abs() <= across.error(), "{degrees}");
        assert!((up.at(y) - 1e3 * height).abs() <= up.error(), "{height}");
    }
    let ends = paths(&map.svg).into_iter().filter(|path| path.class == "rim");
    let ends: Vec<f64> = ends.map(|path| up.at(path.pieces[0][0].1)).collect();
    assert_eq!(ends.len(), 2);
    assert!(
        ends.iter().all(|end| (end.abs() - 12.0).abs() < up.error()) && ends[0] * ends[1] < 0.0,
        "{ends:?}"
    );
    assert!(map.remark.contains("The cylinder unrolled") && map.remark.contains("dashed lines are the ends"));
}

#[test]
fn a_thread_is_not_to_scale_and_strays_are_counted() {
    let projection = Projection::plane(Vector3::zeros(), Vector3::z(), &axes());
    let thread = |stray: usize| -> Vec<Vector3<f64>> {
        let point = |i: usize| Vector3::new(1e-4 * i as f64, 1e-6 * (i % 7) as f64, 0.0);
        let far = |i: usize| Vector3::new(0.0, 10.0 + i as f64, 0.0);
        (0..400).map(point).chain((0..stray).map(far)).collect()
    };
    for (stray, said) in
        [(0, ""), (1, " One contact lies outside the window."), (2, " 2 contacts lie outside the window.")]
    {
        let map = draw("test", &projection, &contacts(&projection, &thread(stray)), &[]);
        assert_eq!(map.remark, format!("Seen from outside. Not to scale.{said}"));
        assert_eq!(dots(&map).len(), 400);
    }
}

#[test]
fn a_window_leaves_out_one_in_two_hundred_at_either_end() {
    // 1000 numbers: five are left out at either end, and 6 % are added.
    let many = (0..1000).map(f64::from).chain([f64::NAN, f64::INFINITY]);
    let (low, high) = window(many, None);
    let room = 0.06 * (994.0 - 5.0);
    assert!((low - (5.0 - room)).abs() < 1e-9 && (high - (994.0 + room)).abs() < 1e-9, "{low} {high}");
    // Nothing is left out of a few; nothing at all is a window of its own.
    assert_eq!(window([1.0, 2.0].into_iter(), None), (0.94, 2.06));
    assert_eq!(window(core::iter::empty(), None), (-1.12, 1.12));
    // One number: room by its size, and at least something.
    let (low, high) = window([5.0].into_iter(), None);
    assert!((low - (5.0 - 3e-4)).abs() < 1e-12 && (high - (5.0 + 3e-4)).abs() < 1e-12, "{low} {high}");
    assert_eq!(window([0.0].into_iter(), None), (-0.06e-6, 0.06e-6));
    // The ends of the active region, unless they are three times as far.
    assert_eq!(window([-1.0, 1.0].into_iter(), Some(2.5)), (-2.8, 2.8));
    assert_eq!(window([-1.0, 1.0].into_iter(), Some(3.5)), (-1.12, 1.12));
}

/// An end of the active region within three times the farthest contact is shown, on whichever side that contact is; one
/// between contacts takes nothing away.
#[test]
fn a_window_shows_ends_that_are_not_far_away() {
    for sign in [1.0, -1.0] {
        let sorted = |a: f64, b: f64| if sign > 0.0 { (a, b) } else { (-b, -a) };
        for (edge, expected) in [(29.9, (-29.9, 29.9)), (30.1, sorted(-10.0, 1.0)), (5.0, sorted(-10.0, 5.0))]
        {
            let (low, high) = window([-10.0 * sign, sign].into_iter(), Some(edge));
            let room = 0.06 * (expected.1 - expected.0);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
            assert!(near(low, expected.0 - room) && near(high, expected.1 + room), "{edge}: {low} {high}");
        }
    }
}

/// However long a capsule is, and wherever it was touched, no label lies over another one, and none leaves the drawing.
#[test]
fn labels_of_a_capsule_do_not_overlap() {
    for (radius, half_length) in
        [(0.005, 0.0005), (0.005, 0.004), (0.005, 0.02), (0.0004, 0.03), (0.02, 0.001)]
    {
        let text = format!(
            "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"capsule\"\nradius_m = {radius}\n\
             half_length_m = {half_length}\n"
        );
        let scene = fingertip_scene::Scene::from_text(&text).unwrap();
        let projection = scene.projection();
        let on_capsule = |polar: f64, azimuth: f64, along: f64| {
            let [cap] = on_sphere(&[(polar, azimuth)])[..] else { panic!() };
            // The axis of a capsule is z.
            let end = half_length * along.clamp(-1.0, 1.0);
            Vector3::new(radius * cap.y, radius * cap.z, radius * cap.x + end)
        };
        for reach in [1.0, 40.0, 95.0, 179.0] {
            let points: Vec<Vector3<f64>> = (0..200)
                .map(|k| {
                    let share = f64::from(k) / 199.0;
                    on_capsule(
                        share * reach,
                        137.5 * f64::from(k),
                        if share * reach > 90.0 { -1.0 } else { 1.0 },
                    )
                })
                .collect();
            let mut contacts = contacts(projection, &points);
            contacts.iter_mut().zip(1..).for_each(|(contact, k)| contact.normal_force = 0.01 * f64::from(k));
            let map = draw("test", projection, &contacts, &[]);
            assert_readable(&map.svg);
        }
    }
}
