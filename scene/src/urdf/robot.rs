//! Links and the joints between them.

use alloc::collections::BTreeMap;

use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use roxmltree::{Document, Node};

use super::UrdfFault;
use super::xml::{child, numbers_or, text, wrong};

/// What holds a link.
struct Joint<'a> {
    name: &'a str,
    kind: &'a str,
    parent: &'a str,
    parent_from_child: Isometry3<f64>,
}

/// A robot: its links, and for each but the first the joint that holds it.
pub(super) struct Robot<'a, 'b> {
    links: Vec<(&'a str, Node<'a, 'b>)>,
    joints: BTreeMap<&'a str, Joint<'a>>,
}

/// A link above another, what takes coordinates of that other to its own, and the joint that was passed to it.
type Above<'a, 'j> = (&'a str, Isometry3<f64>, Option<&'j Joint<'a>>);

/// Most links that a message lists.
const LISTED: usize = 12;

/// The `<origin>` of an element: where its frame lies in that around it. Roll, pitch and yaw are turns about the fixed axes
/// x, y and z, one after another (the URDF's definition).
pub(super) fn origin(node: Node<'_, '_>) -> Result<Isometry3<f64>, UrdfFault> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let [x, y, z] = numbers_or(origin, "xyz", [0.0; 3])?;
    let [roll, pitch, yaw] = numbers_or(origin, "rpy", [0.0; 3])?;
    Ok(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw)))
}

impl<'a, 'b> Robot<'a, 'b> {
    pub(super) fn of(document: &'a Document<'b>) -> Result<Self, UrdfFault> {
        let root = document.root_element();
        if !root.has_tag_name("robot") {
            return Err(UrdfFault::NoRobot(root.tag_name().name().to_owned()));
        }
        let (mut links, mut joints) = (Vec::new(), BTreeMap::new());
        for node in root.children() {
            if node.has_tag_name("link") {
                links.push((text(node, "name")?, node));
            } else if node.has_tag_name("joint") {
                let end = |name: &str| match child(node, name) {
                    Some(end) => text(end, "link"),
                    None => {
                        Err(wrong(node, format!("the joint has no <{name}>; write <{name} link=\"...\"/>")))
                    }
                };
                let joint = Joint {
                    name: text(node, "name")?,
                    kind: text(node, "type")?,
                    parent: end("parent")?,
                    parent_from_child: origin(node)?,
                };
                let held = end("child")?;
                if let Some(other) = joints.insert(held, joint) {
                    let message = format!(
                        "link {held:?} is held by this joint and by {:?}; one may hold it",
                        other.name
                    );
                    return Err(wrong(node, message));
                }
            }
        }
        Ok(Self { links, joints })
    }

    pub(super) fn link(&self, name: &str) -> Result<Node<'a, 'b>, UrdfFault> {
        self.named(name).map(|(_, node)| node)
    }

    fn named(&self, name: &str) -> Result<(&'a str, Node<'a, 'b>), UrdfFault> {
        let found = self.links.iter().find(|(known, _)| *known == name).copied();
        found.ok_or_else(|| {
            let mut known: Vec<&str> = self.links.iter().take(LISTED).map(|(name, _)| *name).collect();
            if self.links.len() > LISTED {
                known.push("and more");
            }
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            UrdfFault::NoLink { name: name.to_owned(), known }
        })
    }

    /// The links above one; itself first.
    fn above(&self, link: &'a str) -> Result<Vec<Above<'a, '_>>, UrdfFault> {
        let mut chain = vec![(link, Isometry3::identity(), None)];
        let (mut at, mut pose) = (link, Isometry3::identity());
        while let Some(joint) = self.joints.get(at) {
            if chain.len() > self.joints.len() {
                return Err(UrdfFault::Circle(link.to_owned()));
            }
            pose = joint.parent_from_child * pose;
            at = joint.parent;
            chain.push((at, pose, Some(joint)));
        }
        Ok(chain)
    }

    /// What takes coordinates of `link` to those of `sensor`; only fixed joints may lie between them.
    pub(super) fn between(&self, link: &str, sensor: &str) -> Result<Isometry3<f64>, UrdfFault> {
        let (from, to) = (self.above(self.named(link)?.0)?, self.above(self.named(sensor)?.0)?);
        let meeting = from
            .iter()
            .enumerate()
            .find_map(|(i, (link, ..))| to.iter().position(|(other, ..)| other == link).map(|j| (i, j)));
        let ends = || (link.to_owned(), sensor.to_owned());
        let Some((i, j)) = meeting else {
            let (link, sensor) = ends();
            return Err(UrdfFault::Apart { link, sensor });
        };
        let passed = from.iter().take(i + 1).chain(to.iter().take(j + 1)).filter_map(|(.., joint)| *joint);
        if let Some(joint) = passed.into_iter().find(|joint| joint.kind != "fixed") {
            let ((link, sensor), joint, kind) = (ends(), joint.name.to_owned(), joint.kind.to_owned());
            return Err(UrdfFault::Moves { joint, kind, link, sensor });
        }
        match (from.get(i), to.get(j)) {
            (Some((_, common_from_link, _)), Some((_, common_from_sensor, _))) => {
                Ok(common_from_sensor.inverse() * common_from_link)
            }
            _ => Ok(Isometry3::identity()),
        }
    }
}
