//! The collision shapes of a link, as shapes of a scene.

use std::path::{Path, PathBuf};

use fingertip::surfaces::Mesh;
use nalgebra::Isometry3;
use roxmltree::Node;
use toml::{Table, Value};

use super::collada;
use super::robot::origin;
use super::xml::{child, numbers, numbers_or, parse, positive, text, wrong};
use super::{UrdfFault, numbers as list, read_text, table};
use crate::named::Folder;

/// The shapes of a link and where they lie in its frame; `robot` is the file that describes it. The files of its meshes are
/// noted in `folder`.
pub(super) fn of_link(
    node: Node<'_, '_>,
    link: &str,
    robot: &Path,
    folder: &Folder<'_>,
) -> Result<Vec<(Isometry3<f64>, Table)>, UrdfFault> {
    let collisions = node.children().filter(|child| child.has_tag_name("collision"));
    collisions.map(|collision| Ok((origin(collision)?, shape(collision, link, robot, folder)?))).collect()
}

fn shape(collision: Node<'_, '_>, link: &str, robot: &Path, folder: &Folder<'_>) -> Result<Table, UrdfFault> {
    const KNOWN: &str = "box, sphere, cylinder, capsule or mesh";
    let geometry = child(collision, "geometry").and_then(|geometry| geometry.first_element_child());
    let geometry = geometry.ok_or_else(|| {
        wrong(collision, format!("a <collision> of link {link:?} has no <geometry>; write a {KNOWN}"))
    })?;
    Ok(match geometry.tag_name().name() {
        "sphere" => table([("shape", "sphere".into()), ("radius_m", positive(geometry, "radius")?.into())]),
        "cylinder" | "capsule" => {
            let (radius, length) = (positive(geometry, "radius")?, positive(geometry, "length")?);
            let name = if geometry.has_tag_name("capsule") { "capsule" } else { "capped_cylinder" };
            table([
                ("shape", name.into()),
                ("radius_m", radius.into()),
                ("half_length_m", (0.5 * length).into()),
            ])
        }
        "box" => {
            let size: [f64; 3] = numbers(geometry, "size")?;
            if !size.iter().all(|edge| *edge > 0.0) {
                return Err(wrong(geometry, "`size` of <box> must be three positive numbers".to_owned()));
            }
            // Sharp edges.
            table([
                ("shape", "rounded_box".into()),
                ("half_extents_m", list(&size.map(|edge| 0.5 * edge))),
                ("rounding_m", 0.0.into()),
            ])
        }
        "mesh" => mesh(geometry, link, robot, folder)?,
        other => {
            let message = format!("a <collision> of link {link:?} is a <{other}>, which is no {KNOWN}");
            return Err(wrong(geometry, message));
        }
    })
}

fn mesh(node: Node<'_, '_>, link: &str, robot: &Path, folder: &Folder<'_>) -> Result<Table, UrdfFault> {
    let path = found(text(node, "filename")?, link, robot)?;
    folder.note(&path);
    let is = |ending: &str| path.extension().is_some_and(|name| name.eq_ignore_ascii_case(ending));
    if !["stl", "obj", "dae"].into_iter().any(is) {
        return Err(UrdfFault::MeshFormat { link: link.to_owned(), path });
    }
    let scale = numbers_or(node, "scale", [1.0; 3])?;
    if !scale.iter().all(|factor| *factor > 0.0) {
        let message = "`scale` of <mesh> must be three positive numbers; mirror the file itself".to_owned();
        return Err(wrong(node, message));
    }
    let (vertices, triangles) = if is("dae") {
        let read = || collada::read(&parse(&read_text(&path)?)?);
        let fault =
            |fault| UrdfFault::Collada { link: link.to_owned(), path: path.clone(), fault: Box::new(fault) };
        read().map_err(fault)?
    } else {
        Mesh::<f64>::parts_from_file(&path, 1.0).map_err(|source| UrdfFault::Mesh {
            link: link.to_owned(),
            path,
            source,
        })?
    };
    let [x, y, z] = scale;
    let vertices = vertices.iter().map(|v| list(&[v.x * x, v.y * y, v.z * z])).collect();
    let corners = |triangle: &[u32; 3]| Value::Array(triangle.iter().map(|i| i64::from(*i).into()).collect());
    Ok(table([
        ("shape", "mesh".into()),
        ("vertices_m", Value::Array(vertices)),
        ("triangles", Value::Array(triangles.iter().map(corners).collect())),
    ]))
}

/// The file that a description means: beside itself, at an address of files, or in a package, whose folder is beside the
/// description or around it.
fn found(uri: &str, link: &str, robot: &Path) -> Result<PathBuf, UrdfFault> {
    let folder = robot.parent().unwrap_or(Path::new(""));
    let mut tried = Vec::new();
    if let Some(within) = uri.strip_prefix("package://").or_else(|| uri.strip_prefix("model://")) {
        let (_, inner) = within.split_once('/').unwrap_or(("", within));
        let around = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        for folder in around.ancestors() {
            // The package itself, or the folder of packages.
            tried.push(folder.join(within));
            tried.push(folder.join(inner));
        }
    } else {
        tried.push(folder.join(uri.strip_prefix("file://").unwrap_or(uri)));
    }
    if let Some(path) = tried.iter().find(|path| path.is_file()) {
        return Ok(path.clone());
    }
    let named: Vec<String> = tried.iter().take(3).map(|path| path.display().to_string()).collect();
    let more = if tried.len() > named.len() { " and in the folders around" } else { "" };
    let tried = format!("{}{more}", named.join(", "));
    Err(UrdfFault::NoMesh { link: link.to_owned(), uri: uri.to_owned(), tried })
}
