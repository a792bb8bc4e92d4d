//! Shapes that a file gives as formulas.

use fingertip::surfaces::{ActiveSurface, DynSurface, ImplicitSurface};
use fingertip::wrench::Line;
use fingertip_scene::Scene;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::{HEAD, NOISE, pushes};

fn scene_of(surface: &str, rest: &str) -> Result<Scene, String> {
    Scene::from_text(&format!("{HEAD}[surface]\n{surface}\n{rest}")).map_err(|problem| problem.to_string())
}

fn outside(formula: &str) -> String {
    format!("shape = \"formula\"\noutside = \"{formula}\"\nreach_m = 2.0")
}

/// The value of a formula at a place.
fn value(formula: &str, place: &Vector3<f64>) -> f64 {
    let scene = scene_of(&outside(formula), "").unwrap_or_else(|error| panic!("{formula}: {error}"));
    let DynSurface::Formula(implicit) = scene.surface() else { panic!() };
    implicit.inner().value(place)
}

#[test]
fn formulas_mean_what_mathematicians_mean() {
    type Meant = fn(f64, f64, f64) -> f64;
    let cases: [(&str, Meant); 13] = [
        ("x^2 + y^2 + z^2 - 1", |x, y, z| x * x + y * y + z * z - 1.0),
        ("x - y - z - 1/2/2", |x, y, z| x - y - z - 0.25),
        ("x*y/4*2 + 6/2*x/(z^2 + 1)", |x, y, z| x * y / 4.0 * 2.0 + 3.0 * x / (z * z + 1.0)),
        ("2*x^3 - 3*(y - 1)^2*z", |x, y, z| 2.0 * x.powi(3) - 3.0 * (y - 1.0).powi(2) * z),
        ("-(x^2) + (-y)^2 - -z", |x, y, z| -x * x + y * y + z),
        ("sqrt(x^2 + y^2 + 1) - 0.5 + z*0", |x, y, _| (x * x + y * y + 1.0).sqrt() - 0.5),
        ("max(x^2 + y^2 - 1, abs(z) - 0.5)", |x, y, z| (x * x + y * y - 1.0).max(z.abs() - 0.5)),
        ("min(x, min(y, z)) + 0.1*max(max(1, 0.5), (2 - 1))", |x, y, z| x.min(y).min(z) + 0.1),
        ("exp(x) - cos(pi*y)*sin(z)", |x, y, z| x.exp() - (core::f64::consts::PI * y).cos() * z.sin()),
        ("(x + 9)^-2 - (y + 9)^0.5 + z", |x, y, z| (x + 9.0).powi(-2) - (y + 9.0).sqrt() + z),
        ("x*1e-3 + y*2.5E2 + z", |x, y, z| x * 1e-3 + y * 250.0 + z),
        ("(2^3 + 1)*x - (1 - 2)*y + 6/4*z + 2*3", |x, y, z| 9.0 * x + y + 1.5 * z + 6.0),
        ("(x/2)^64 + y + z", |x, y, z| (x / 2.0).powi(64) + y + z),
    ];
    let mut random = Pcg64Mcg::seed_from_u64(61);
    for (formula, meant) in cases {
        for _ in 0..50 {
            let place = Vector3::from_fn(|_, _| random.random_range(0.1..1.0));
            let (found, expected) = (value(formula, &place), meant(place.x, place.y, place.z));
            assert!(
                (found - expected).abs() <= 1e-14 * (1.0 + expected.abs()),
                "{formula} at {place}: {found} {expected}"
            );
        }
    }
}

#[test]
fn a_formula_is_the_shape_that_it_describes() {
    let pairs = [
        (
            "shape = \"formula\"\noutside = \"(x/a)^2 + (y/b)^2 + (z/c)^2 - 1\"\nparameters = { a = 0.008, b = 0.010, c = 0.013 }\nreach_m = 0.014\nconvex = true",
            "shape = \"ellipsoid\"\nsemi_axes_m = [0.008, 0.010, 0.013]",
        ),
        (
            "shape = \"formula\"\noutside = \"(x/a)^4 + (y/b)^4 + (z/c)^4 - 1\"\nparameters = { a = 0.008, b = 0.010, c = 0.013 }\nreach_m = 0.02\nconvex = true",
            "shape = \"superquadric\"\nsemi_axes_m = [0.008, 0.010, 0.013]\nexponents = [0.5, 0.5]",
        ),
        (
            "shape = \"formula\"\noutside = \"min(x^2 + y^2 + z^2 - r^2, (x - d)^2 + y^2 + z^2 - r^2)\"\nparameters = { r = 0.008, d = 0.006 }\ncentre_m = [0.003, 0.0, 0.0]\nreach_m = 0.012",
            "shape = \"compound\"\nparts = [{ shape = \"sphere\", radius_m = 0.008 }, { shape = \"sphere\", radius_m = 0.008, centre_m = [0.006, 0.0, 0.0] }]",
        ),
    ];
    for (formula, known) in pairs {
        let models: &[&str] = if known.contains("compound") { &["point"] } else { &["point", "soft_finger"] };
        for model in models {
            let rest = format!(
                "[contact]\nmodel = \"{model}\"\n{NOISE}[pose]\ntranslation_m = [0.001, 0.002, 0.0]\nrotation_deg = [10.0, 20.0, 5.0]\n"
            );
            let (mut ours, mut theirs) =
                (scene_of(formula, &rest).unwrap().pipeline(), scene_of(known, &rest).unwrap().pipeline());
            let mut seen = 0;
            for push in pushes(8, 150) {
                let (found, expected) = (ours.sense(push, 1e-3), theirs.sense(push, 1e-3));
                let (Some(a), Some(b)) = (found.contact(), expected.contact()) else { continue };
                assert!(
                    (a.point - b.point).norm() < 1e-9 && (a.normal - b.normal).norm() < 1e-7,
                    "{formula}: {a:?} {b:?}"
                );
                seen += 1;
            }
            assert!(seen > 120, "{model} {seen}\n{formula}");
        }
    }
}

#[test]
fn formulas_that_cannot_be_are_refused_by_name() {
    for (formula, expected) in [
        ("-x^2 + 1", "-x^2"),
        ("1 - (y + -(x + 1)^2)", "-(x+1)^2"),
        ("x^2 + q - 1", "`q`"),
        ("x^2.5 - 1", "exponent"),
        ("x^65 - 1", "exponent"),
        ("1 - -y^3", "for -y^3,"),
        ("x^y - 1", "exponent"),
        ("x^2 + + ", "cannot be read"),
        ("(x^2 - 1", "cannot be read"),
        ("", "cannot be read"),
        ("tan(x)", "tan"),
    ] {
        let error = scene_of(&outside(formula), "").unwrap_err();
        assert!(error.contains(expected) && !error.contains('\n'), "{formula}: {error}");
    }
    let error = scene_of(&format!("{}\nparameters = {{ a = 1.0 }}", outside("x^2 - 1")), "").unwrap_err();
    assert!(error.contains("`a`"), "{error}");
    let error = scene_of("shape = \"formula\"\noutside = \"x^2 - 1\"\nreach_m = -1.0", "").unwrap_err();
    assert!(error.contains("radius"), "{error}");
    assert!(scene_of("shape = \"formula\"\noutside = \"x^2 - 1\"", "").unwrap_err().contains("reach_m"));
}

/// A root that is zero on the surface tells no steepness: it must be stated, and must not be too small.
#[test]
fn how_steep_a_formula_is_can_be_stated() {
    let drum = |more: &str| {
        let outside = "sqrt((x/0.008)^2 + (y/0.01)^2)^2 + (z/0.012)^2 - 1";
        format!("shape = \"formula\"\noutside = \"{outside}\"\nreach_m = 0.013\nconvex = true\n{more}")
    };
    let error = scene_of(&drum(""), "").unwrap_err();
    assert!(error.contains("of an implicit surface") && error.contains("steepest_per_m"), "{error}");
    let error = scene_of(&drum("steepest_per_m = 100.0"), "").unwrap_err();
    assert!(error.contains("nowhere exceeded"), "{error}");
    for bad in ["-1.0", "0.0", "nan", "inf"] {
        assert!(scene_of(&drum(&format!("steepest_per_m = {bad}")), "").is_err(), "{bad}");
    }
    let stated = scene_of(&drum("steepest_per_m = 420.0"), "").unwrap();
    let known = scene_of("shape = \"ellipsoid\"\nsemi_axes_m = [0.008, 0.010, 0.012]", "").unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(63);
    let mut vector = || Vector3::from_fn(|_, _| random.random_range(-0.01..0.01));
    for _ in 0..200 {
        let line = Line { point: vector(), direction: vector().normalize() };
        let crossings = |scene: &Scene| {
            let mut places = Vec::new();
            scene.surface().crossings(&line, |crossing| places.push(crossing.along));
            places.sort_by(f64::total_cmp);
            places
        };
        let (found, expected) = (crossings(&stated), crossings(&known));
        assert_eq!(found.len(), expected.len());
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }
}

/// Whatever stands in a formula, it is refused or it is a shape.
#[test]
fn nothing_breaks_the_reader_of_formulas() {
    let pieces = [
        "x", "y", "z", "a", "1", "0.5", "1e3", "+", "-", "*", "/", "^", "(", ")", ",", "min", "max", "sqrt",
        "abs", " ", "{", "}", "2", "pi", "é", ".", "e",
    ];
    let mut random = Pcg64Mcg::seed_from_u64(62);
    let (mut refused, mut taken) = (0, 0);
    for _ in 0..4000 {
        let text: String =
            (0..random.random_range(1..12)).map(|_| pieces[random.random_range(0..pieces.len())]).collect();
        match scene_of(&outside(&text), "") {
            Ok(scene) => {
                taken += 1;
                let normal = scene.surface().normal(&Vector3::new(0.1, 0.2, 0.3));
                assert!(normal.iter().all(|x| x.is_finite()), "{text}");
            }
            Err(message) => {
                refused += 1;
                assert!(message.len() > 10, "{text}: {message}");
            }
        }
    }
    assert!(refused > 1000 && taken > 20, "{refused} {taken}");
}
