//! Meshes in Collada files (.dae): the triangles of their scene, as robots' descriptions have them.
//!
//! `mesh-loader`, which reads such files too, indexes them unchecked and draws a geometry once that is there twice. Read are
//! `<triangles>`, `<polylist>` and `<polygons>` of the scene's nodes with their transforms, in the unit that the file
//! states. What it says of the upward axis is left out of account, as RViz and MoveIt do.

use std::collections::HashMap;

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};
use roxmltree::{Document, Node};

use super::UrdfFault;
use super::xml::{child, wrong};

/// Vertices \[m\], and triangles as indices of them.
type Parts = (Vec<Vector3<f64>>, Vec<[u32; 3]>);
/// Elements by their names.
type Named<'a, 'b> = HashMap<&'a str, Node<'a, 'b>>;

/// More vertices or corners than this are no fingertip, but a scene that repeats its nodes.
const MOST: usize = 1 << 22;
/// Nodes that stand for nodes, one in the other: more is a circle.
const DEEPEST: usize = 64;
/// Nodes in all: they can stand for each other so that each level has twice as many.
const MOST_NODES: usize = 1 << 16;

/// The mesh of a file.
pub(super) fn read(document: &Document<'_>) -> Result<Parts, UrdfFault> {
    let root = document.root_element();
    if !root.has_tag_name("COLLADA") {
        let message = format!("the outermost element is <{}>, not <COLLADA>", root.tag_name().name());
        return Err(wrong(root, message));
    }
    let unit = child(root, "asset").and_then(|asset| child(asset, "unit"));
    let metres = match unit.and_then(|unit| Some((unit, unit.attribute("meter")?))) {
        Some((node, said)) => {
            said.trim().parse().ok().filter(|metres: &f64| *metres > 0.0 && metres.is_finite()).ok_or_else(
                || wrong(node, format!("`meter` of <unit> is {said:?}, which must be a positive number")),
            )?
        }
        None => 1.0,
    };
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect();
    let mut mesh = Collected { ids, parts: Parts::default(), nodes: 0 };
    let whole = Matrix4::new_scaling(metres);
    let shown = child(root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
    match shown {
        Some(shown) => mesh.add_nodes(mesh.meant(shown)?, &whole, 0)?,
        // A library of geometries and nothing that places them.
        None => {
            let mut meshes = document.descendants().filter(|node| node.has_tag_name("geometry"));
            meshes.try_for_each(|geometry| mesh.add_geometry(geometry, &whole))?;
        }
    }
    if mesh.parts.1.is_empty() {
        return Err(wrong(root, "it has no triangles or polygons".to_owned()));
    }
    Ok(mesh.parts)
}

struct Collected<'a, 'b> {
    ids: Named<'a, 'b>,
    parts: Parts,
    nodes: usize,
}

impl<'a, 'b> Collected<'a, 'b> {
    /// The element that `url` names.
    fn meant(&self, node: Node<'a, 'b>) -> Result<Node<'a, 'b>, UrdfFault> {
        self.named(node, "url")
    }

    fn named(&self, node: Node<'a, 'b>, key: &str) -> Result<Node<'a, 'b>, UrdfFault> {
        let element = node.tag_name().name();
        let said = node.attribute(key).unwrap_or_default();
        let found = said.strip_prefix('#').and_then(|id| self.ids.get(id));
        found.copied().ok_or_else(|| {
            wrong(node, format!("`{key}` of <{element}> is {said:?}, which names nothing here"))
        })
    }

    /// What hangs on a visual scene or a node.
    fn add_nodes(
        &mut self,
        parent: Node<'a, 'b>,
        place: &Matrix4<f64>,
        depth: usize,
    ) -> Result<(), UrdfFault> {
        self.nodes += 1;
        if depth > DEEPEST || self.nodes > MOST_NODES {
            let message =
                format!("nodes lie more than {DEEPEST} deep in each other, in a circle, or are too many");
            return Err(wrong(parent, message));
        }
        for node in parent.children().filter(Node::is_element) {
            match node.tag_name().name() {
                "node" => self.add_nodes(node, &(place * transform(node)?), depth + 1)?,
                "instance_node" => {
                    let meant = self.meant(node)?;
                    self.add_nodes(meant, &(place * transform(meant)?), depth + 1)?;
                }
                "instance_geometry" => self.add_geometry(self.meant(node)?, place)?,
                "instance_controller" => {
                    let message =
                        "a mesh that bends (<instance_controller>) is no collision shape; export it rigid";
                    return Err(wrong(node, message.to_owned()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn add_geometry(&mut self, geometry: Node<'a, 'b>, place: &Matrix4<f64>) -> Result<(), UrdfFault> {
        let Some(mesh) = child(geometry, "mesh") else { return Ok(()) };
        for primitive in mesh.children().filter(Node::is_element) {
            match primitive.tag_name().name() {
                "triangles" | "polylist" | "polygons" => self.add_polygons(primitive, place)?,
                "tristrips" | "trifans" => {
                    let message = format!(
                        "<{}> is not read; have the mesh exported as triangles",
                        primitive.tag_name().name()
                    );
                    return Err(wrong(primitive, message));
                }
                // Lines have no inside.
                _ => {}
            }
        }
        Ok(())
    }

    fn add_polygons(&mut self, primitive: Node<'a, 'b>, place: &Matrix4<f64>) -> Result<(), UrdfFault> {
        let inputs = || primitive.children().filter(|node| node.has_tag_name("input"));
        let offset = |input: Node<'_, '_>| whole_number(input, "offset", 0);
        let mut stride = 1;
        for input in inputs() {
            stride = stride.max(offset(input)? + 1);
        }
        let vertex = inputs().find(|input| input.attribute("semantic") == Some("VERTEX"));
        let vertex = vertex.ok_or_else(|| wrong(primitive, "its <input>s name no VERTEX".to_owned()))?;
        let (own, points) = (offset(vertex)?, self.points(vertex)?);
        let first = self.parts.0.len();
        let corners = corners(primitive, stride, own)?;
        let counted: usize = corners.iter().map(Vec::len).sum();
        if is_too_much([first, points.len()], [self.parts.1.len(), counted]) {
            return Err(wrong(
                primitive,
                format!("it makes more than {MOST} vertices or corners of triangles"),
            ));
        }
        if let Some(none) = corners.iter().flatten().find(|corner| **corner >= points.len()) {
            return Err(wrong(primitive, format!("it names the vertex {none} of {}", points.len())));
        }
        let mirrored = place.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let placed = points.iter().map(|point| place.transform_point(&Point3::from(*point)).coords);
        self.parts.0.extend(placed);
        // Fits: there are at most `MOST`.
        let index = |corner: usize| u32::try_from(first + corner).unwrap_or(u32::MAX);
        for polygon in corners {
            for [a, b, c] in fan(&polygon, &points).ok_or_else(|| {
                let message = "a polygon of it is not convex; have the mesh exported as triangles";
                wrong(primitive, message.to_owned())
            })? {
                let [b, c] = if mirrored { [c, b] } else { [b, c] };
                self.parts.1.push([a, b, c].map(index));
            }
        }
        Ok(())
    }

    /// The positions of the vertices that an `<input>` names.
    fn points(&self, input: Node<'a, 'b>) -> Result<Vec<Vector3<f64>>, UrdfFault> {
        let vertices = self.named(input, "source")?;
        let position = vertices.children().find(|node| node.attribute("semantic") == Some("POSITION"));
        let position = position.ok_or_else(|| wrong(vertices, "it names no POSITION".to_owned()))?;
        let source = self.named(position, "source")?;
        let accessor = child(source, "technique_common").and_then(|common| child(common, "accessor"));
        let (stride, skipped, count) = match accessor {
            Some(accessor) => (
                whole_number(accessor, "stride", 1)?,
                whole_number(accessor, "offset", 0)?,
                whole_number(accessor, "count", usize::MAX)?,
            ),
            None => (3, 0, usize::MAX),
        };
        if stride < 3 {
            return Err(wrong(
                source,
                format!("positions have three coordinates, and its `stride` is {stride}"),
            ));
        }
        let array = child(source, "float_array");
        let array = array.ok_or_else(|| wrong(source, "it has no <float_array>".to_owned()))?;
        let numbers = numbers(array)?;
        let rows = numbers.get(skipped..).unwrap_or_default().chunks(stride).take(count);
        Ok(rows.filter_map(|row| row.first_chunk::<3>()).map(|[x, y, z]| Vector3::new(*x, *y, *z)).collect())
    }
}

/// The corners of each polygon, as indices of vertices.
fn corners(primitive: Node<'_, '_>, stride: usize, own: usize) -> Result<Vec<Vec<usize>>, UrdfFault> {
    let lists = primitive.children().filter(|node| node.has_tag_name("p"));
    let vertices_of =
        |list: &[usize]| list.chunks(stride).filter_map(|corner| corner.get(own).copied()).collect();
    if primitive.has_tag_name("polygons") {
        if let Some(hole) = primitive.children().find(|node| node.has_tag_name("ph")) {
            return Err(wrong(hole, "a polygon with a hole (<ph>) is not read; export triangles".to_owned()));
        }
        return lists.map(|node| Ok(vertices_of(&indices(node)?))).collect();
    }
    let mut all: Vec<usize> = Vec::new();
    for node in lists {
        let indices = indices(node)?;
        all.extend::<Vec<usize>>(vertices_of(&indices));
    }
    if primitive.has_tag_name("triangles") {
        return Ok(all.chunks_exact(3).map(<[usize]>::to_vec).collect());
    }
    let counts = child(primitive, "vcount");
    let counts =
        counts.ok_or_else(|| wrong(primitive, "a <polylist> has a <vcount>; write one".to_owned()))?;
    let mut rest = all.as_slice();
    let mut polygons = Vec::new();
    for count in indices(counts)? {
        let (polygon, behind) = rest
            .split_at_checked(count)
            .ok_or_else(|| wrong(counts, "<vcount> asks for more corners than <p> has".to_owned()))?;
        polygons.push(polygon.to_vec());
        rest = behind;
    }
    Ok(polygons)
}

/// Whether so many vertices with so many more, or the corners of so many triangles with so many more, are no fingertip's.
fn is_too_much([vertices, more]: [usize; 2], [triangles, corners]: [usize; 2]) -> bool {
    vertices + more > MOST || 3 * triangles + corners > MOST
}

/// The triangles of a convex polygon, from its first corner; none of one with fewer than three, `None` where one of the
/// triangles is turned against the others.
fn fan(polygon: &[usize], points: &[Vector3<f64>]) -> Option<Vec<[usize; 3]>> {
    let Some((first, others)) = polygon.split_first() else { return Some(Vec::new()) };
    let triangles: Vec<[usize; 3]> = others.array_windows().map(|[b, c]| [*first, *b, *c]).collect();
    let at = |corner: usize| points.get(corner).copied().unwrap_or_default();
    let area = |[a, b, c]: &[usize; 3]| (at(*b) - at(*a)).cross(&(at(*c) - at(*a)));
    let whole: Vector3<f64> = triangles.iter().map(area).sum();
    triangles.iter().all(|triangle| area(triangle).dot(&whole) >= 0.0).then_some(triangles)
}

/// Where a node lies in its parent: its transforms, the first outermost.
fn transform(node: Node<'_, '_>) -> Result<Matrix4<f64>, UrdfFault> {
    let mut whole = Matrix4::identity();
    for step in node.children().filter(Node::is_element) {
        let three = || exactly::<3>(step).map(Vector3::from);
        whole *= match step.tag_name().name() {
            "matrix" => Matrix4::from_row_slice(&exactly::<16>(step)?),
            "translate" => Matrix4::new_translation(&three()?),
            "scale" => Matrix4::new_nonuniform_scaling(&three()?),
            "rotate" => {
                let [x, y, z, degrees] = exactly(step)?;
                let axis = Unit::try_new(Vector3::new(x, y, z), 1e-12)
                    .ok_or_else(|| wrong(step, "the axis of a <rotate> has no direction".to_owned()))?;
                Rotation3::from_axis_angle(&axis, degrees.to_radians()).to_homogeneous()
            }
            name @ ("lookat" | "skew") => {
                return Err(wrong(step, format!("<{name}> is not read; export a <matrix>")));
            }
            _ => continue,
        };
    }
    Ok(whole)
}

fn exactly<const N: usize>(node: Node<'_, '_>) -> Result<[f64; N], UrdfFault> {
    numbers(node)?.try_into().map_err(|numbers: Vec<f64>| {
        let element = node.tag_name().name();
        wrong(node, format!("<{element}> has {} numbers; {N} belong there", numbers.len()))
    })
}

/// The numbers that stand in an element.
fn numbers(node: Node<'_, '_>) -> Result<Vec<f64>, UrdfFault> {
    list(node, |number: &f64| number.is_finite())
}

/// The indices or counts that stand in an element.
fn indices(node: Node<'_, '_>) -> Result<Vec<usize>, UrdfFault> {
    list(node, |_| true)
}

fn list<N: core::str::FromStr>(node: Node<'_, '_>, belongs: fn(&N) -> bool) -> Result<Vec<N>, UrdfFault> {
    let words = node.text().unwrap_or_default().split_ascii_whitespace();
    words
        .map(|word| {
            word.parse().ok().filter(belongs).ok_or_else(|| {
                wrong(
                    node,
                    format!("{word:?} in <{}> is no number that belongs there", node.tag_name().name()),
                )
            })
        })
        .collect()
}

/// A count of an element, or what stands for it where the key is missing.
fn whole_number(node: Node<'_, '_>, key: &str, otherwise: usize) -> Result<usize, UrdfFault> {
    let Some(said) = node.attribute(key) else { return Ok(otherwise) };
    said.trim().parse().ok().filter(|number| *number < MOST).ok_or_else(|| {
        let element = node.tag_name().name();
        wrong(node, format!("`{key}` of <{element}> is {said:?}, which must be a count, and no large one"))
    })
}

#[cfg(test)]
mod tests {
    use super::{MOST, is_too_much};

    /// As many as are said, in one part or in several, and one more.
    #[test]
    fn a_mesh_may_have_four_million_vertices_and_corners() {
        assert_eq!(MOST, 4_194_304);
        for (before, more) in [(0, MOST), (MOST - 7, 7), (MOST, 0)] {
            assert!(!is_too_much([before, more], [0, 0]));
            assert!(is_too_much([before, more + 1], [0, 0]) && is_too_much([before + 1, more], [0, 0]));
        }
        for triangles in [0, 1, 1_398_101] {
            let corners = MOST - 3 * triangles;
            assert!(!is_too_much([MOST, 0], [triangles, corners]));
            assert!(is_too_much([0, 0], [triangles, corners + 1]));
            assert!(is_too_much([0, 0], [triangles + 1, corners.saturating_sub(2)]));
        }
    }
}
