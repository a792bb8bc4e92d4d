//! Collision meshes in Collada files, beside the same triangles in a file that says no more than these.

use std::fs;

use fingertip::surfaces::{ActiveSurface, DynSurface};
use fingertip::wrench::Line;
use fingertip_scene::Scene;
use nalgebra::{Matrix4, Rotation3, Vector3};

use crate::HEAD;
use crate::front::Folder;

const ROBOT: &str = "<robot name=\"hand\"><link name=\"tip\"><collision><geometry><mesh filename=\"tip.MESH\"/></geometry>\
                     </collision></link></robot>";
const CORNERS: [[f64; 3]; 5] = [
    [0.01, 0.012, 0.0],
    [-0.01, 0.01, 0.001],
    [-0.009, -0.01, 0.0],
    [0.01, -0.01, 0.0],
    [0.001, 0.002, 0.015],
];
/// A pyramid: four sides and two halves of its base, outward.
const TRIANGLES: [[usize; 3]; 6] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];

fn surface(folder: &Folder, ending: &str, mesh: &str) -> Result<DynSurface<f64>, String> {
    fs::write(folder.path().join(format!("tip.{ending}")), mesh).unwrap();
    fs::write(folder.path().join("hand.urdf"), ROBOT.replace("MESH", ending)).unwrap();
    let text = format!("{HEAD}[surface]\nurdf = \"hand.urdf\"\nlink = \"tip\"\n");
    let scene = Scene::parse(&text, "urdf", folder.path()).map_err(|fault| fault.problem.to_string())?;
    Ok(scene.surface().clone())
}

/// The pyramid moved, as an OBJ file.
fn obj(places: &[Matrix4<f64>]) -> String {
    let mut text = String::new();
    for (number, place) in places.iter().enumerate() {
        for corner in CORNERS {
            let at = place.transform_point(&corner.into());
            text += &format!("v {:?} {:?} {:?}\n", at.x, at.y, at.z);
        }
        for triangle in TRIANGLES {
            // A mirror turns triangles inside out.
            let turned = if place.determinant() < 0.0 { [0, 2, 1] } else { [0, 1, 2] };
            let [a, b, c] = turned.map(|corner| triangle[corner] + 1 + 5 * number);
            text += &format!("f {a} {b} {c}\n");
        }
    }
    text
}

fn numbers(of: impl IntoIterator<Item = f64>) -> String {
    of.into_iter().map(|number| format!("{number:?} ")).collect()
}

/// Columns of a vertex and of a normal for each corner, as exporters write them.
fn indices(of: &[usize]) -> String {
    of.iter().map(|corner| format!("{corner} 0 ")).collect()
}

const INPUTS: &str = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>\
                      <input semantic=\"NORMAL\" source=\"#n\" offset=\"1\"/>";

fn triangles() -> String {
    format!("<triangles count=\"6\">{INPUTS}<p>{}</p></triangles>", indices(TRIANGLES.as_flattened()))
}

/// The corners in rows of so many numbers, behind some that belong to none; with or without what says so.
fn positions(stride: usize, skipped: usize, is_said: bool) -> String {
    let rows = CORNERS.into_iter().flat_map(|corner| corner.into_iter().chain([77.0; 9]).take(stride));
    let all = numbers([55.0; 9].into_iter().take(skipped).chain(rows));
    let said = format!("<accessor source=\"#f\" count=\"5\" stride=\"{stride}\" offset=\"{skipped}\"/>");
    let said = if is_said { format!("<technique_common>{said}</technique_common>") } else { String::new() };
    format!("<float_array id=\"f\" count=\"{}\">{all}</float_array>{said}", skipped + 5 * stride)
}

fn dae(asset: &str, primitives: &str, scene: &str) -> String {
    let shown = if scene.is_empty() { "" } else { "<scene><instance_visual_scene url=\"#all\"/></scene>" };
    format!(
        "\u{feff}<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">
         <asset>{asset}<up_axis>Y_UP</up_axis></asset>
         <library_geometries><geometry id=\"g\"><mesh>
         <source id=\"p\">{}</source>
         <source id=\"n\"><float_array id=\"m\" count=\"3\">0 0 1</float_array></source>
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>
         {primitives}</mesh></geometry></library_geometries>
         <library_visual_scenes><visual_scene id=\"all\">{scene}</visual_scene></library_visual_scenes>{shown}</COLLADA>",
        positions(4, 0, true),
    )
}

const GEOMETRY: &str = "<instance_geometry url=\"#g\"/>";

/// Every crossing of lines through both, entries first, in the order of their places.
fn agree(found: &DynSurface<f64>, expected: &DynSurface<f64>, case: &str) {
    let mut met = 0;
    for k in 0..400 {
        let (turn, off) = (f64::from(k) * 0.7, f64::from(k % 20) - 10.0);
        let direction = Vector3::new(turn.cos(), turn.sin(), (turn * 0.37).sin()).normalize();
        let line = Line { point: Vector3::new(off, -off, off * 0.5) * 1e-3, direction };
        let crossings = |surface: &DynSurface<f64>| {
            let mut all = Vec::new();
            surface.crossings(&line, |crossing| all.push((crossing.point, crossing.normal)));
            all.sort_by(|a, b| a.0.dot(&direction).total_cmp(&b.0.dot(&direction)));
            all
        };
        let (ours, theirs) = (crossings(found), crossings(expected));
        assert_eq!(ours.len(), theirs.len(), "{case}, line {k}");
        for ((point, normal), (at, outward)) in ours.iter().zip(&theirs) {
            assert!((point - at).norm() < 1e-12 && (normal - outward).norm() < 1e-9, "{case}, line {k}");
            met += 1;
        }
    }
    assert!(met > 100, "{case}: {met} crossings");
}

#[test]
fn every_way_to_write_a_mesh_is_the_same_mesh() {
    let folder = Folder::new("collada");
    let here = Matrix4::identity();
    let polylist = format!(
        "<polylist count=\"5\">{INPUTS}<vcount>3 3 3 3 4</vcount><p>{} {}</p></polylist>",
        indices(TRIANGLES[..4].as_flattened()),
        indices(&[0, 3, 2, 1])
    );
    let polygon = |of: &[usize]| format!("<p>{}</p>", indices(of));
    let polygons = format!(
        "<polygons count=\"5\">{INPUTS}{}{}</polygons><lines><p>0 1</p></lines>",
        TRIANGLES[..4].iter().map(|triangle| polygon(triangle)).collect::<String>(),
        polygon(&[0, 3, 2, 1])
    );
    let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.5).to_homogeneous();
    let moved = Matrix4::new_translation(&Vector3::new(0.001, 0.002, -0.003));
    let mirrored = Matrix4::new_nonuniform_scaling(&Vector3::new(1.0, -1.0, 2.0));
    let far = Matrix4::new_translation(&Vector3::new(0.03, 0.0, 0.0));
    let degrees = 0.5_f64.to_degrees();
    let steps = format!("<translate>0.001 0.002 -0.003</translate><rotate>0 2 0 {degrees:?}</rotate>");
    let rows = numbers((moved * turned).transpose().iter().copied());
    let twice = format!(
        "<node id=\"one\">{GEOMETRY}</node><node><translate>0.03 0 0</translate><instance_node url=\"#one\"/></node>"
    );
    for (case, asset, primitives, scene, places) in [
        ("triangles", "", triangles(), format!("<node>{GEOMETRY}</node>"), vec![here]),
        ("no scene", "", triangles(), String::new(), vec![here]),
        ("polylist", "", polylist, format!("<node>{GEOMETRY}</node>"), vec![here]),
        ("polygons", "", polygons, format!("<node>{GEOMETRY}</node>"), vec![here]),
        (
            "half size",
            "<unit name=\"half\" meter=\"0.5\"/>",
            triangles(),
            format!("<node>{GEOMETRY}</node>"),
            vec![Matrix4::new_scaling(0.5)],
        ),
        ("steps", "", triangles(), format!("<node>{steps}{GEOMETRY}</node>"), vec![moved * turned]),
        (
            "matrix",
            "",
            triangles(),
            format!("<node><matrix>{rows}</matrix>{GEOMETRY}</node>"),
            vec![moved * turned],
        ),
        (
            "nested",
            "",
            triangles(),
            format!(
                "<node><translate>0.001 0.002 -0.003</translate><node><rotate>0 1 0 {degrees:?}</rotate>{GEOMETRY}</node></node>"
            ),
            vec![moved * turned],
        ),
        (
            "mirrored",
            "",
            triangles(),
            format!("<node><scale>1 -1 2</scale>{GEOMETRY}</node>"),
            vec![mirrored],
        ),
        ("twice", "", triangles(), twice, vec![here, far]),
    ] {
        let found = surface(&folder, "dae", &dae(asset, &primitives, &scene))
            .unwrap_or_else(|why| panic!("{case}: {why}"));
        agree(&found, &surface(&folder, "obj", &obj(&places)).unwrap(), case);
    }
}

#[test]
fn coordinates_stand_in_rows_of_any_width() {
    let folder = Folder::new("collada-rows");
    let text = dae("", &triangles(), &format!("<node>{GEOMETRY}</node>"));
    let expected = surface(&folder, "obj", &obj(&[Matrix4::identity()])).unwrap();
    for (stride, skipped, is_said) in [(3, 0, true), (3, 2, true), (5, 7, true), (3, 0, false)] {
        let text = text.replace(&positions(4, 0, true), &positions(stride, skipped, is_said));
        agree(&surface(&folder, "dae", &text).unwrap(), &expected, &format!("{stride} {skipped} {is_said}"));
    }
}

/// A chain of nodes of which each stands for the next, and the last shows the mesh: 64 are read.
#[test]
fn nodes_are_followed_as_deep_as_is_said() {
    let folder = Folder::new("collada-deep");
    let chain = |length: usize| {
        let next = |k: usize| format!("<node id=\"l{k}\"><instance_node url=\"#l{}\"/></node>", k + 1);
        let links: String = (2..length).map(next).collect();
        let library = format!("{links}<node id=\"l{length}\">{GEOMETRY}</node>");
        let text = dae("", &triangles(), "<node><instance_node url=\"#l2\"/></node>");
        let library = format!("<library_nodes>{library}</library_nodes><library_visual_scenes>");
        surface(&folder, "dae", &text.replace("<library_visual_scenes>", &library))
    };
    let expected = surface(&folder, "obj", &obj(&[Matrix4::identity()])).unwrap();
    agree(&chain(64).unwrap(), &expected, "64 deep");
    let error = chain(65).unwrap_err();
    assert!(error.contains("nodes lie more than 64 deep in each other"), "{error}");
}

#[test]
fn what_is_no_mesh_is_named() {
    let folder = Folder::new("collada-wrong");
    let shown = format!("<node>{GEOMETRY}</node>");
    let good = dae("", &triangles(), &shown);
    // Each level stands for the next twice.
    let levels: String = (0..40)
        .map(|k| {
            let next = format!("<instance_node url=\"#l{}\"/>", k + 1);
            format!("<node id=\"l{k}\">{next}{next}</node>")
        })
        .collect();
    let flat = format!("<polygons>{INPUTS}<p>{}</p></polygons>", indices(&[0, 2, 1, 3]));
    for (text, says) in [
        ("<sdf/>".to_owned(), "the outermost element is <sdf>, not <COLLADA>"),
        ("<COLLADA>".to_owned(), "it is no XML"),
        ("<COLLADA/>".to_owned(), "it has no triangles or polygons"),
        (dae("", "", &shown), "it has no triangles or polygons"),
        (
            dae("<unit meter=\"0\"/>", &triangles(), &shown),
            "`meter` of <unit> is \"0\", which must be a positive number",
        ),
        (
            dae("", &triangles(), "<node><instance_geometry url=\"#h\"/></node>"),
            "`url` of <instance_geometry> is \"#h\", which names nothing here",
        ),
        (
            dae("", &triangles(), "<node><rotate>0 0 0 1</rotate></node>"),
            "the axis of a <rotate> has no direction",
        ),
        (
            dae("", &triangles(), "<node><matrix>1 2 3</matrix></node>"),
            "<matrix> has 3 numbers; 16 belong there",
        ),
        (
            dae("", &triangles(), "<node><translate>1 2 nan</translate></node>"),
            "\"nan\" in <translate> is no number that belongs there",
        ),
        (dae("", &triangles(), "<node><skew>1</skew></node>"), "<skew> is not read"),
        (dae("", &triangles(), "<node><instance_controller url=\"#g\"/></node>"), "export it rigid"),
        (dae("", "<trifans/>", &shown), "<trifans> is not read; have the mesh exported as triangles"),
        (dae("", &triangles(), "<node id=\"a\"><instance_node url=\"#a\"/></node>"), "in a circle"),
        (dae("", &triangles(), &format!("{levels}<node id=\"l40\"/>")), "or are too many"),
        (dae("", &flat, &shown), "a polygon of it is not convex"),
        (good.replace("<p>0 0", "<p>5 0"), "it names the vertex 5 of 5"),
        (good.replace("<p>0 0", "<p>-1 0"), "\"-1\" in <p> is no number that belongs there"),
        (good.replace("count=\"5\" stride", "count=\"4\" stride"), "it names the vertex 4 of 4"),
        (good.replace("stride=\"4\"", "stride=\"2\""), "its `stride` is 2"),
        (
            good.replace("stride=\"4\"", "stride=\"99999999999\""),
            "`stride` of <accessor> is \"99999999999\", which must be a count",
        ),
        (good.replace("semantic=\"VERTEX\"", "semantic=\"OTHER\""), "its <input>s name no VERTEX"),
        (good.replace("semantic=\"POSITION\"", "semantic=\"OTHER\""), "it names no POSITION"),
        (dae("", &format!("<polylist>{INPUTS}<p>0 0</p></polylist>"), &shown), "a <polylist> has a <vcount>"),
        (
            dae("", &format!("<polylist>{INPUTS}<vcount>3</vcount><p>0 0</p></polylist>"), &shown),
            "<vcount> asks for more corners than <p> has",
        ),
        (dae("", "<polygons><ph/></polygons>", &shown), "its <input>s name no VERTEX"),
        (
            dae("", &format!("<polygons>{INPUTS}<ph/></polygons>"), &shown),
            "a polygon with a hole (<ph>) is not read",
        ),
    ] {
        let error = surface(&folder, "dae", &text).unwrap_err();
        assert!(error.contains(says), "{error} for {says}");
        assert!(error.contains("tip.dae of link \"tip\": "), "{error}");
    }
}
