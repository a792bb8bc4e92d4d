//! Fingertips as links of robots: their collision shapes, in the frame of the sensor.

use std::fs;
use std::path::Path;

use fingertip::surfaces::{ActiveSurface, DynSurface};
use fingertip::wrench::{Line, Wrench};
use fingertip_scene::{Scalar, Scene};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::HEAD;
use crate::front::Folder;

/// A hand whose fingertip has the shapes that are given, on a sensor two fixed joints below it and one beside.
fn robot(collisions: &str) -> String {
    format!(
        r#"<?xml version="1.0"?>
<robot name="hand">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="palm"/>
  <link name="proximal"/>
  <link name="middle"/>
  <link name="sensor"><visual><geometry><sphere radius="1"/></geometry></visual></link>
  <link name="tip">{collisions}</link>
  <link name="loose"/>
  <joint name="base" type="revolute"><parent link="palm"/><child link="proximal"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint>
  <joint name="to_middle" type="fixed"><origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/><parent link="proximal"/><child link="middle"/></joint>
  <joint name="to_tip" type="fixed"><origin xyz="0 0 0.02" rpy="0 1.5707963267948966 0"/><parent link="middle"/><child link="tip"/></joint>
  <joint name="to_sensor" type="fixed"><origin rpy="0 0 0.5"/><parent link="proximal"/><child link="sensor"/></joint>
</robot>"#
    )
}

fn collision(geometry: &str, origin: &str) -> String {
    format!("<collision>{origin}<geometry>{geometry}</geometry></collision>")
}

fn read(folder: &Path, robot: &str, more: &str) -> Result<Scene, String> {
    fs::write(folder.join("hand.urdf"), robot).unwrap();
    let text = format!("{HEAD}[surface]\nurdf = \"hand.urdf\"\n{more}\n");
    Scene::parse(&text, "urdf", folder).map_err(|fault| fault.problem.to_string())
}

/// Where a line along −z through (x, y) first enters.
fn top(surface: &DynSurface<f64>, x: f64, y: f64) -> f64 {
    let mut highest = f64::NEG_INFINITY;
    let line = Line { point: Vector3::new(x, y, 0.0), direction: -Vector3::z() };
    surface.crossings(&line, |crossing| highest = highest.max(crossing.point.z));
    highest
}

#[test]
fn every_geometry_is_its_shape() {
    let folder = Folder::new("urdf-shapes");
    for (geometry, heights) in [
        (r#"<sphere radius="0.01"/>"#, [(0.0, 0.0, 0.01), (0.006, 0.0, 0.008)]),
        (r#"<cylinder radius="0.01" length="0.05"/>"#, [(0.0, 0.0, 0.025), (0.006, 0.006, 0.025)]),
        (r#"<capsule radius="0.01" length="0.05"/>"#, [(0.0, 0.0, 0.035), (0.006, 0.0, 0.033)]),
        (r#"<box size="0.02 0.04 0.06"/>"#, [(0.0, 0.0, 0.03), (0.009, -0.019, 0.03)]),
    ] {
        let scene = read(folder.path(), &robot(&collision(geometry, "")), "link = \"tip\"").unwrap();
        for (x, y, height) in heights {
            let found = top(scene.surface(), x, y);
            assert!((found - height).abs() < 1e-12, "{geometry}: {found} for {height}");
        }
        // Where nothing moves it, it is found as quickly as any such shape.
        assert!(!matches!(scene.surface(), DynSurface::Posed(_)), "{geometry}");
        // It can be exported, and as JSON it stands for itself.
        scene.to_rust(Scalar::F64, None).unwrap();
        let json: toml::Value = serde_json::from_str(&scene.to_json().unwrap()).unwrap();
        let again = Scene::from_text(&toml::to_string(&json).unwrap()).unwrap();
        assert_eq!(again.surface(), scene.surface());
    }
}

/// Against the same chain of joints, worked out here: the link's frame in that of the sensor.
#[test]
fn fixed_joints_lead_from_the_link_to_the_sensor() {
    let folder = Folder::new("urdf-joints");
    let origin = r#"<origin xyz="0.001 0.002 0.003" rpy="0.3 0 0"/>"#;
    let text = robot(&collision(r#"<cylinder radius="0.005" length="0.03"/>"#, origin));
    let pose = |xyz: [f64; 3], rpy: [f64; 3]| {
        let [roll, pitch, yaw] = rpy;
        // Turns about the fixed axes x, y, z, one after another.
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw)
            * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), pitch)
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), roll);
        Isometry3::from_parts(Translation3::from(Vector3::from(xyz)), turn)
    };
    let proximal_from_tip = pose([0.01, 0.02, 0.03], [0.1, 0.2, 0.3])
        * pose([0.0, 0.0, 0.02], [0.0, core::f64::consts::FRAC_PI_2, 0.0]);
    let sensor_from_proximal = pose([0.0; 3], [0.0, 0.0, 0.5]).inverse();
    let tip_from_shape = pose([0.001, 0.002, 0.003], [0.3, 0.0, 0.0]);
    for (sensor, sensor_from_tip) in [
        ("", Isometry3::identity()),
        ("sensor_link = \"tip\"", Isometry3::identity()),
        ("sensor_link = \"proximal\"", proximal_from_tip),
        ("sensor_link = \"sensor\"", sensor_from_proximal * proximal_from_tip),
    ] {
        let scene = read(folder.path(), &text, &format!("link = \"tip\"\n{sensor}")).unwrap();
        let sensor_from_shape = sensor_from_tip * tip_from_shape;
        // A push on the side of the cylinder, 4 mm up its axis.
        let at = sensor_from_shape * nalgebra::Point3::new(0.0, 0.005, 0.004);
        let inward = sensor_from_shape * -Vector3::y();
        let felt = *scene.pipeline().sense(Wrench::from_force_at(&at.coords, inward), 1e-3);
        let contact = felt.contact().unwrap_or_else(|| panic!("{sensor}: {:?}", felt.touch.resolution));
        assert!(
            (contact.point - at.coords).norm() < 1e-12 && (contact.normal + inward).norm() < 1e-12,
            "{sensor}"
        );
    }
}

#[test]
fn several_shapes_are_one_surface_and_meshes_are_found_in_packages() {
    let folder = Folder::new("urdf-mesh");
    let meshes = folder.path().join("meshes");
    fs::create_dir_all(&meshes).unwrap();
    let pyramid = "v 1 0 0\nv -1 1 0\nv -1 -1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    fs::write(meshes.join("tip.obj"), pyramid).unwrap();
    for uri in ["meshes/tip.obj", "package://some_hand/meshes/tip.obj"] {
        let mesh = format!(r#"<mesh filename="{uri}" scale="0.01 0.01 0.02"/>"#);
        let two =
            collision(&mesh, "") + &collision(r#"<sphere radius="0.004"/>"#, r#"<origin xyz="0.02 0 0"/>"#);
        let scene = read(folder.path(), &robot(&two), "link = \"tip\"").unwrap();
        assert!((top(scene.surface(), 0.0, 0.0) - 0.02).abs() < 1e-9);
        assert!((top(scene.surface(), 0.02, 0.0) - 0.004).abs() < 1e-12);
        assert!(scene.pipeline_in::<f32>().is_ok());
    }
}

#[test]
fn what_cannot_be_is_named() {
    let folder = Folder::new("urdf-wrong");
    let ball = robot(&collision(r#"<sphere radius="0.01"/>"#, ""));
    let tip = "link = \"tip\"";
    let with = |geometry: &str| robot(&collision(geometry, ""));
    for (robot, more, words) in [
        (
            ball.as_str(),
            "link = \"thumb\"",
            "no link \"thumb\"; its links are palm, proximal, middle, sensor, tip, loose",
        ),
        (
            &ball,
            "link = \"tip\"\nsensor_link = \"palm\"",
            "joint \"base\" between the links \"tip\" and \"palm\" is revolute",
        ),
        (
            &ball,
            "link = \"tip\"\nsensor_link = \"loose\"",
            "no joints connect the links \"tip\" and \"loose\"",
        ),
        (&ball, "link = \"palm\"", "link \"palm\" has no <collision>"),
        (&ball, "", "missing field `link`"),
        (&ball, "link = \"tip\"\nlnik = 1", "unknown field `lnik`"),
        ("<sdf/>", tip, "<sdf>, not <robot>"),
        ("<robot>", tip, "no XML"),
        (
            &with(r#"<sphere radius="-1"/>"#),
            tip,
            "line 8: `radius` of <sphere> is -1, which must be positive",
        ),
        (&with(r#"<sphere radius="0"/>"#), tip, "`radius` of <sphere> is 0, which must be positive"),
        (&with(r#"<sphere/>"#), tip, "<sphere> has no `radius`"),
        (&with(r#"<sphere radius="a"/>"#), tip, "must be a number"),
        (&with(r#"<box size="1 2"/>"#), tip, "must be three numbers"),
        (&with(r#"<box size="1 0 1"/>"#), tip, "three positive numbers"),
        (&with(r#"<torus/>"#), tip, "is a <torus>, which is no box"),
        (&with(""), tip, "has no <geometry>"),
        (&with(r#"<mesh filename="tip.dae"/>"#), tip, "is not there"),
        (&with(r#"<mesh filename="hand.urdf"/>"#), tip, "is neither .stl nor .obj nor .dae"),
        (&ball.replace("child link=\"sensor\"", "child link=\"tip\""), tip, "one may hold it"),
        (&ball.replace("parent link=\"palm\"", "parent link=\"tip\""), tip, "lead round in a circle"),
    ] {
        let error = read(folder.path(), robot, more).unwrap_err();
        assert!(error.contains(words), "{error}\n(expected: {words})");
    }
    let missing = Scene::from_text(&format!("{HEAD}[surface]\nurdf = \"nowhere.urdf\"\nlink = \"tip\"\n"));
    assert!(missing.unwrap_err().to_string().contains("robot nowhere.urdf: it cannot be read"));
}

#[test]
fn of_many_links_twelve_are_named() {
    let folder = Folder::new("urdf-links");
    let named = |count: usize| {
        let links: String = (0..count).map(|k| format!("<link name=\"l{k}\"/>")).collect();
        let error = read(folder.path(), &format!("<robot name=\"r\">{links}</robot>"), "link = \"tip\"");
        let error = error.unwrap_err();
        error.split("its links are ").nth(1).unwrap_or_else(|| panic!("{error}")).to_owned()
    };
    let twelve = (0..12).map(|k| format!("l{k}")).collect::<Vec<_>>().join(", ");
    assert_eq!(named(0), "none");
    assert_eq!(named(2), "l0, l1");
    assert_eq!(named(12), twelve);
    assert_eq!(named(13), format!("{twelve}, and more"));
}

/// Beside the description where the address says so; in the folders around it, too, where it is of a package.
#[test]
fn a_mesh_that_is_not_there_is_told_with_the_places_that_were_tried() {
    let folder = Folder::new("urdf-sought");
    let tried = |uri: &str| {
        let mesh = collision(&format!(r#"<mesh filename="{uri}"/>"#), "");
        read(folder.path(), &robot(&mesh), "link = \"tip\"").unwrap_err()
    };
    let here = folder.path().join("tip.stl").display().to_string();
    for uri in ["tip.stl", "file://tip.stl"] {
        let error = tried(uri);
        assert!(error.contains(&here) && !error.contains("in the folders around"), "{error}");
    }
    let error = tried("package://hand/tip.stl");
    assert!(error.contains("hand/tip.stl") && error.contains(" and in the folders around"), "{error}");
}
