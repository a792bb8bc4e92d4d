//! Heightfields against a search that looks everywhere.

use fingertip_contact::{ContactModel, Search, SoftContact, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::Heightfield;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::wrenches::Random;

const COLUMNS: usize = 6;
const ROWS: usize = 5;

fn field(random: &mut Random) -> Heightfield<f64> {
    let heights = (0..COLUMNS * ROWS).map(|_| 0.02 + random.uniform(-0.0007, 0.0007)).collect();
    Heightfield::new([-0.003, 0.011], [0.002, 0.003], COLUMNS, heights).unwrap()
}

/// Where a function of [0, 1] changes its sign, by looking at 200 places.
fn changes(f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut found = Vec::new();
    for k in 0..200 {
        let (mut low, mut high) = (f64::from(k) / 200.0, f64::from(k + 1) / 200.0);
        let sign = f(low) < 0.0;
        if sign != (f(high) < 0.0) {
            for _ in 0..60 {
                let middle = (low + high) / 2.0;
                *if sign == (f(middle) < 0.0) { &mut low } else { &mut high } = middle;
            }
            found.push(low);
        }
    }
    found
}

/// All contacts: in every cell, where the torque that is left of a point is along the normal; and on every node
/// within, if the node is the highest of its surroundings in the direction of the torque that is left.
fn everywhere(field: &Heightfield<f64>, wrench: &Wrench<f64>) -> Vec<Vector3<f64>> {
    let (f, m) = (wrench.force(), wrench.torque());
    let left = |c: &Vector3<f64>| m - c.cross(&f);
    let mut found = Vec::new();
    for j in 0..ROWS - 1 {
        for i in 0..COLUMNS - 1 {
            let [a, b, d, e] =
                [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| field.node(i, j));
            let at = |s: f64, t: f64| {
                a * ((1.0 - s) * (1.0 - t)) + b * (s * (1.0 - t)) + d * ((1.0 - s) * t) + e * (s * t)
            };
            let by_s = |t: f64| (b - a) * (1.0 - t) + (e - d) * t;
            let by_t = |s: f64| (d - a) * (1.0 - s) + (e - b) * s;
            // Along a straight line of the patch its moment is the same everywhere.
            for t in changes(|t| left(&at(0.3, t)).dot(&by_s(t))) {
                for s in changes(|s| left(&at(s, 0.6)).dot(&by_t(s))) {
                    if by_s(t).cross(&by_t(s)).dot(&f) < 0.0 {
                        found.push(at(s, t));
                    }
                }
            }
            if i > 0 && j > 0 {
                let normal = left(&a) * -f.dot(&m).signum();
                let around = [(i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)].map(|(i, j)| field.node(i, j));
                if normal.z > 0.0 && around.iter().all(|other| normal.dot(&(other - a)) < 0.0) {
                    found.push(a);
                }
            }
        }
    }
    found
}

fn all(field: &Heightfield<f64>, wrench: &Wrench<f64>) -> Vec<SoftContact<f64>> {
    let mut found = Vec::new();
    let search = field.soft_contacts(wrench, None, |contact| found.push(contact));
    assert!(matches!(search, Search::Complete));
    found
}

#[test]
fn every_contact_is_found_and_no_other() {
    let mut random = Random::new(181);
    let (mut on_nodes, mut in_cells, mut several, mut none) = (0, 0, 0, 0);
    for _ in 0..1200 {
        let field = field(&mut random);
        let through = Vector3::new(random.uniform(-0.005, 0.009), random.uniform(0.009, 0.025), 0.02);
        let mut force = random.direction();
        force.z = -force.z.abs() - 0.3;
        let spin = random.sign() * random.log_uniform(1e-7, 0.03);
        let torque = through.cross(&force) + (random.direction() + Vector3::z() * 2.0) * spin;
        let wrench = Wrench::on_fingertip(force, torque);
        let (ours, theirs) = (all(&field, &wrench), everywhere(&field, &wrench));
        for contact in &ours {
            let rest = torque - contact.point.cross(&force) - contact.normal * contact.spin_torque;
            assert!(rest.norm() < 1e-15 * (1.0 + torque.norm() * 50.0), "{contact:?} {}", rest.norm());
            assert!((contact.normal.norm() - 1.0).abs() < 1e-14 && force.dot(&contact.normal) < 0.0);
            assert!(contact.active);
            let near = |point: &Vector3<f64>| (contact.point - point).norm() < 1e-9;
            assert_eq!(
                theirs.iter().filter(|point| near(point)).count(),
                1,
                "{contact:?} {theirs:?} {wrench:?}"
            );
        }
        assert_eq!(ours.len(), theirs.len(), "{ours:?} {theirs:?} {wrench:?}");
        let is_node = |c: &SoftContact<f64>| {
            (0..COLUMNS * ROWS).any(|k| (field.node(k % COLUMNS, k / COLUMNS) - c.point).norm() < 1e-12)
        };
        let nodes = ours.iter().filter(|contact| is_node(contact)).count();
        on_nodes += nodes;
        in_cells += ours.len() - nodes;
        several += usize::from(ours.len() > 1);
        none += usize::from(ours.is_empty());
    }
    println!("{in_cells} contacts in cells, {on_nodes} on nodes; several {several} times, none {none} times");
    assert!(in_cells > 300 && on_nodes > 100 && several > 100 && none > 20);
}

/// A force that presses straight on a node or on an edge of the grid touches there.
#[test]
fn nodes_and_edges_are_of_the_surface() {
    // A dome, whose middle is a node, over numbers that binary fractions have.
    let at = |k: usize| 0.25 * k as f64 - 0.5;
    let heights = (0..25).map(|k| 1.0 - at(k % 5).powi(2) - 0.5 * at(k / 5).powi(2)).collect();
    let field = Heightfield::new([-0.5; 2], [0.25; 2], 5, heights).unwrap();
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    for i in 1..32 {
        for j in 1..32 {
            let (x, y) = (-0.5 + f64::from(i) / 32.0, -0.5 + f64::from(j) / 32.0);
            let wrench = Wrench::from_force_at(&Vector3::new(x, y, 0.0), Vector3::new(0.0, 0.0, -2.0));
            let found = model.resolve(&wrench, &field);
            let contact = found.contact().unwrap_or_else(|| panic!("{x} {y} {found:?}"));
            assert!(
                (contact.point.xy() - nalgebra::Vector2::new(x, y)).norm() < 1e-15,
                "{x} {y} {contact:?}"
            );
        }
    }
}
