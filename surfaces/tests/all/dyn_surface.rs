//! Files: every shape comes back as it was written, and nonsense does not come back at all.
#![cfg(feature = "serde")]

use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;

const SHAPES: &[&str] = &[
    "shape = 'plane'\npoint_m = [0.0, 0.0, 0.1]\nnormal = [0.0, 0.0, 1.0]",
    "shape = 'disk'\nradius_m = 0.5",
    "shape = 'rectangle'\nfirst_half_edge_m = [0.5, 0.0, 0.0]\nsecond_half_edge_m = [0.0, 0.4, 0.0]",
    "shape = 'sphere'\ncentre_m = [0.0, 0.1, 0.0]\nradius_m = 0.5",
    "shape = 'spherical_cap'\nradius_m = 0.5\nactive_half_angle_deg = 120.0",
    "shape = 'ellipsoid'\nsemi_axes_m = [0.5, 0.4, 0.3]",
    "shape = 'cylinder'\nradius_m = 0.5\nhalf_length_m = 0.4",
    "shape = 'capped_cylinder'\nradius_m = 0.5\nhalf_length_m = 0.4",
    "shape = 'elliptic_cylinder'\nsemi_axes_m = [0.5, 0.4]\nends_m = { capped = 0.4 }",
    "shape = 'elliptic_cylinder'\nsemi_axes_m = [0.5, 0.4]\nends_m = 'unbounded'",
    "shape = 'capsule'\nhalf_length_m = 0.3\nradius_m = 0.2",
    "shape = 'cone'\nhalf_angle_deg = 60.0\ndepth_m = 0.5",
    "shape = 'frustum'\nheight_m = 0.5\nbase_radius_m = 0.4\ntop_radius_m = 0.2",
    "shape = 'torus'\nring_radius_m = 0.3\ntube_radius_m = 0.2",
    "shape = 'superquadric'\nsemi_axes_m = [0.5, 0.4, 0.3]\nexponents = [0.3, 0.8]",
    "shape = 'rounded_box'\nhalf_extents_m = [0.5, 0.4, 0.3]\nrounding_m = 0.1",
    "shape = 'paraboloid'\nradii_m = [0.5, 0.4]",
    "shape = 'revolution'\nprofile_m = [[0.0, 0.3], [0.3, 0.25], [0.5, 0.0]]",
    "shape = 'heightfield'\ncorner_m = [-0.5, -0.5]\nspacing_m = [0.5, 0.5]\ncolumns = 3\n\
     heights_m = [0.0, 0.1, 0.0, 0.1, 0.2, 0.1, 0.0, 0.1, 0.0]",
    "shape = 'mesh'\nvertices_m = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n\
     triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]",
    "shape = 'posed'\ntranslation_m = [0.0, 0.0, 0.1]\nrotation_deg = [0.0, 90.0, 0.0]\n\
     [surface]\nshape = 'sphere'\nradius_m = 0.5",
    "shape = 'trimmed'\n[surface]\nshape = 'sphere'\nradius_m = 0.5\n\
     [region]\npoint_m = [0.0, 0.0, 0.0]\ninward = [0.0, 0.0, 1.0]",
    "shape = 'compound'\n[[parts]]\nshape = 'capped_cylinder'\nradius_m = 0.2\nhalf_length_m = 0.4\n\
     [[parts]]\nshape = 'sphere'\ncentre_m = [0.0, 0.0, 0.4]\nradius_m = 0.3",
    "shape = 'compound'\n[[parts]]\nshape = 'sphere'\nradius_m = 0.3\n\
     [[parts]]\nshape = 'sphere'\ncentre_m = [0.0, 0.0, 0.4]\nradius_m = 0.2\n\
     [[parts]]\nshape = 'disk'\nradius_m = 0.1",
];

fn crossings(surface: &DynSurface<f64>) -> Vec<Crossing<f64>> {
    let line = Line { point: Vector3::new(0.05, 0.03, 0.0), direction: Vector3::new(0.48, 0.6, 0.64) };
    let mut found = Vec::new();
    surface.crossings(&line, |c| found.push(c));
    found
}

#[test]
fn every_shape_survives_a_file() {
    for text in SHAPES {
        let first: DynSurface<f64> = toml::from_str(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
        let written = toml::to_string(&first).unwrap();
        let second: DynSurface<f64> = toml::from_str(&written).unwrap_or_else(|e| panic!("{written}\n{e}"));
        let (a, b) = (crossings(&first), crossings(&second));
        assert!(!a.is_empty() && a.len() == b.len(), "{text}: {a:?} {b:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!((a.point - b.point).norm() < 1e-14 && a.active == b.active, "{text}");
        }
    }
}

#[test]
fn nonsense_is_refused_with_a_reason() {
    for (text, reason) in [
        ("shape = 'sphere'\nradius_m = -1.0", "the radius of a sphere must be a positive finite length"),
        ("shape = 'sphere'\nradius = 0.1", "unknown field `radius`"),
        ("shape = 'cube'\nradius_m = 0.1", "unknown variant `cube`"),
        ("shape = 'sphere'\nradius_m = 0.1\nactive_half_angle_deg = 190.0", "above 0 and at most 180"),
        ("shape = 'compound'\n[[parts]]\nshape = 'sphere'\nradius_m = 0.1", "two `parts` or more"),
        ("shape = 'compound'\nparts = []", "two `parts` or more"),
        ("shape = 'torus'\nring_radius_m = 0.1\ntube_radius_m = 0.2", "less than the ring radius"),
        (
            "shape = 'superquadric'\nsemi_axes_m = [1.0, 1.0, 1.0]\nexponents = [3.0, 1.0]",
            "between 0.05 and 2",
        ),
        ("shape = 'revolution'\nprofile_m = [[0.0, 0.3], [0.0, 0.2]]", "ascending in z"),
        (
            "shape = 'heightfield'\ncorner_m = [0.0, 0.0]\nspacing_m = [1.0, 1.0]\ncolumns = 2\nheights_m = [0.0, 0.0, 0.0]",
            "two full rows",
        ),
        (
            "shape = 'mesh'\nvertices_m = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]\ntriangles = [[0, 1, 2]]",
            "3 open edges",
        ),
    ] {
        let error = toml::from_str::<DynSurface<f64>>(text).unwrap_err().to_string();
        assert!(error.contains(reason), "{text}: {error}");
    }
}

#[test]
fn fixed_profiles_survive_a_file() {
    let tip = Revolution::from_profile([[0.0, 0.3], [0.3, 0.25], [0.5, 0.0]]).unwrap();
    let written = toml::to_string(&tip).unwrap();
    assert_eq!(toml::from_str::<Revolution<f64, [Knot<f64>; 3]>>(&written).unwrap(), tip);
    assert!(toml::from_str::<Revolution<f64, [Knot<f64>; 4]>>(&written).is_err());
}

/// Angles in files are in degrees.
#[test]
fn angles_are_degrees() {
    let read = |text: &str| toml::from_str::<DynSurface<f64>>(text).unwrap();
    let DynSurface::Cone(cone) = read("shape = 'cone'\nhalf_angle_deg = 60.0") else { panic!() };
    assert!((cone.half_angle() - core::f64::consts::FRAC_PI_3).abs() < 1e-15);
    let DynSurface::Sphere(cap) =
        read("shape = 'spherical_cap'\nradius_m = 0.5\nactive_half_angle_deg = 120.0")
    else {
        panic!()
    };
    assert!((cap.active_fraction() - 0.75).abs() < 1e-15);
    let turned = "shape = 'posed'\nrotation_deg = [0.0, 90.0, 0.0]\n[surface]\nshape = 'plane'";
    assert!((read(turned).normal(&Vector3::zeros()) - Vector3::x()).norm() < 1e-15);
    for (shape, key, degrees) in [
        (DynSurface::Cone(cone), "half_angle_deg = ", 60.0),
        (DynSurface::Sphere(cap), "active_half_angle_deg = ", 120.0),
        (read(turned), "rotation_deg = [0.0, ", 90.0),
    ] {
        let written = toml::to_string(&shape).unwrap();
        let (_, rest) = written.split_once(key).unwrap_or_else(|| panic!("{written}"));
        let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        assert!((number.parse::<f64>().unwrap() - degrees).abs() < 1e-13, "{written}");
    }
}
