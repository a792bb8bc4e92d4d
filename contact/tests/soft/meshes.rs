//! Soft fingers on meshes: the tree leaves nothing out, and no dent is touched from within.

use fingertip_contact::{SoftContact, SoftFingerSurface};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{ActiveSurface, Mesh};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::Random;

/// A ball of the radius 1 that is dented, stretched and moved: a function of each vertex.
fn bent<T: Real>(
    rings: u32,
    sectors: u32,
    sliver: Option<f64>,
    bend: impl Fn(Vector3<f64>) -> Vector3<f64>,
) -> Mesh<T> {
    let (vertices, triangles) = ball_of_triangles::<f64>(rings, sectors, sliver);
    let vertices: Vec<_> = vertices.iter().map(|v| bend(*v).map(T::literal)).collect();
    Mesh::new(&vertices, &triangles).unwrap()
}

/// A ball, a needle, a wavy ball, a dented disk, and one with slivers, far from the origin.
fn meshes<T: Real>(n: u32) -> [Mesh<T>; 5] {
    let wave = |v: Vector3<f64>| v * (0.01 + 0.002 * (9.0 * v.x).sin() * (7.0 * v.y).cos());
    let dish = |v: Vector3<f64>| Vector3::new(0.02 * v.x, 0.015 * v.y, 0.006 * v.z + 0.008 * v.x * v.x);
    let away = Vector3::new(0.03, -0.02, 0.05);
    [
        bent(n, n + 3, None, |v| v * 0.013),
        bent(n, n + 3, None, |v| v.component_mul(&Vector3::new(0.001, 0.002, 0.02))),
        bent(n, 2 * n, None, wave),
        bent(n, 2 * n, None, dish),
        bent(n, n + 3, Some(1e-6), move |v| v * 0.01 + away),
    ]
}

/// Every contact, by looking at all triangles and all vertices, and how far rounding may move it in a facet that
/// the force meets at a flat angle.
fn by_trying_all<T: Real>(mesh: &Mesh<T>, wrench: &Wrench<T>) -> Vec<(Vector3<T>, T)> {
    let (centre, scale) = mesh.frame();
    let (force, torque) = (wrench.force(), wrench.torque_about(&centre) * scale);
    let at = |k: u32| *mesh.stored(k).unwrap();
    let about = |a: u32, b: u32| {
        let moment = torque.dot(&(at(b) - at(a))) + force.dot(&at(a).cross(&at(b)));
        if moment.is_zero() { if a < b { T::LEAST_NORMAL } else { -T::LEAST_NORMAL } } else { moment }
    };
    let mut found = Vec::new();
    let mut neighbours = vec![Vec::new(); mesh.vertices().count()];
    for (k, [a, b, c]) in mesh.triangles().iter().copied().enumerate() {
        let [bc, ca, ab] = [about(b, c), about(c, a), about(a, b)];
        if bc < T::zero() && ca < T::zero() && ab < T::zero() && force.dot(&mesh.normal_of(k)) < T::zero() {
            let point = (at(a) * bc + at(b) * ca + at(c) * ab) / (bc + ca + ab);
            let incidence = force.dot(&mesh.normal_of(k)) / force.norm();
            let arm = T::one() + torque.amax() / force.norm();
            found.push((point, T::EPSILON * T::literal(64.0) * arm / (incidence * incidence)));
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours[from as usize].push(to);
        }
    }
    let power = force.dot(&wrench.torque());
    // For all that its numbers say.
    let pure = power.abs() <= force.amax() * wrench.torque().amax() * T::EPSILON * T::literal(8.0);
    for (k, around) in (0..).zip(&neighbours) {
        let is_lower = |other: &u32| (about(k, *other) > T::zero()) != (power < T::zero());
        if !pure && around.iter().all(is_lower) {
            found.push((at(k), T::zero()));
        }
    }
    found.iter().map(|(point, room)| (point / scale + centre, *room / scale)).collect()
}

fn all<T: Real>(mesh: &Mesh<T>, wrench: &Wrench<T>) -> Vec<SoftContact<T>> {
    let mut found = Vec::new();
    let _ = mesh.soft_contacts(wrench, None, |contact| found.push(contact));
    found
}

/// Wrenches of every kind about a mesh: spins from next to nothing to all, lines that pass by, pure forces,
/// next to pure torques, and such as act at a vertex.
fn any_wrench<T: Real>(random: &mut Random, mesh: &Mesh<T>, kind: u32) -> Wrench<T> {
    let vertices: Vec<_> = mesh.vertices().map(|v| v.map(Real::to_f64)).collect();
    let at = vertices[(random.uniform(0.0, 1.0) * vertices.len() as f64) as usize];
    let size = 10_f64.powi(if kind % 5 == 4 { 12 } else { 0 });
    let force = random.direction() * random.log_uniform(0.01, 10.0) / size;
    let past = at + random.direction() * random.log_uniform(1e-5, 0.05);
    let spin = random.direction() * 0.01 * force.norm();
    let wrench = match kind % 9 {
        0 => (force, at.cross(&force)),
        1 => (force, at.cross(&force) + spin * random.log_uniform(1e-9, 1e-3)),
        2 => (force, past.cross(&force)),
        3 => (force, past.cross(&force) + spin * random.log_uniform(1e-6, 1e6)),
        4 => {
            (Vector3::ith(kind as usize % 3, force.x), past.cross(&Vector3::ith(kind as usize % 3, force.x)))
        }
        5 => (force * 1e-9, spin),
        _ => (force, past.cross(&force) + spin * random.log_uniform(0.01, 3.0)),
    };
    Wrench::on_fingertip(wrench.0.map(T::literal), wrench.1.map(T::literal))
}

/// What the tree leads to is what is found by trying all, to the last bit but for dents.
fn finds_all<T: Real>(n: u32, count: u32) {
    let mut random = Random::new(811);
    for (which, mesh) in meshes::<T>(n).iter().enumerate() {
        let (mut several, mut dents, mut some) = (0, 0, 0);
        for kind in 0..count {
            let wrench = any_wrench(&mut random, mesh, kind);
            let expected = by_trying_all(mesh, &wrench);
            let found: Vec<_> = all(mesh, &wrench).iter().map(|contact| contact.point).collect();
            let known =
                |point: &Vector3<T>| expected.iter().any(|(other, room)| (point - other).amax() <= *room);
            assert!(found.iter().all(known), "{which} {kind} {wrench:?} {found:?} {expected:?}");
            if which != 2 && which != 3 {
                assert_eq!(found.len(), expected.len(), "{which} {kind} {wrench:?} {expected:?}");
            }
            dents += expected.len() - found.len();
            some += usize::from(!found.is_empty());
            several += usize::from(found.len() > 1);
        }
        println!("mesh {which}: {some} of {count} with contacts, {several} with several, {dents} dents");
    }
}

#[test]
fn the_tree_leaves_nothing_out() {
    finds_all::<f64>(12, 450);
    finds_all::<f32>(12, 450);
    finds_all::<f64>(40, 45);
    finds_all::<f32>(40, 45);
}

/// A finger touches a mesh from outside: next to a contact, along its normal, a line to far away leaves the mesh as
/// often as it enters. At a dent, which is the highest vertex of its surroundings from within, it does not.
#[test]
fn no_dent_is_touched_from_within() {
    let [_, _, wavy, dish, _] = meshes::<f64>(12);
    let (mut random, mut dents) = (Random::new(812), 0);
    for kind in 0..400 {
        let mesh = if kind % 2 == 0 { &wavy } else { &dish };
        let wrench = any_wrench(&mut random, mesh, 6);
        let direction = random.direction();
        let is_inside = |point: Vector3<f64>| {
            let mut ahead = 0;
            mesh.crossings(&Line { point, direction }, |crossing| {
                ahead += usize::from((crossing.point - point).dot(&direction) > 0.0);
            });
            ahead % 2 == 1
        };
        let found = all(mesh, &wrench);
        for contact in &found {
            assert!(!is_inside(contact.point + contact.normal * 1e-8), "{wrench:?} {contact:?}");
        }
        for (point, _) in by_trying_all(mesh, &wrench) {
            if found.iter().all(|contact| (contact.point - point).norm() > 1e-9) {
                let rest = wrench.torque() - point.cross(&wrench.force());
                let upward = -rest.normalize() * wrench.force().dot(&wrench.torque()).signum();
                assert!(is_inside(point + upward * 1e-8), "{wrench:?} {point:?}");
                dents += 1;
            }
        }
    }
    assert!(dents > 20, "{dents}");
}

/// A mesh asked by itself, without the scaling of a model, knows no unit of force as far as numbers reach: what is
/// touched, from outside and at dents, is the same to the last bit where the wrench is times a power of two.
fn knows_no_unit_of_force<T: Real>(powers: [i32; 4]) {
    let [_, _, wavy, dish, _] = meshes::<T>(12);
    let mut random = Random::new(813);
    for kind in 0..200 {
        let mesh = if kind % 2 == 0 { &wavy } else { &dish };
        let wrench = any_wrench(&mut random, mesh, 6);
        let found = all(mesh, &wrench);
        for power in powers {
            let unit = T::literal(2_f64.powi(power));
            let scaled = all(mesh, &(wrench * unit));
            assert_eq!(scaled.len(), found.len(), "{power} {wrench:?} {found:?} {scaled:?}");
            for (ours, theirs) in found.iter().zip(&scaled) {
                assert_eq!((ours.point, ours.normal), (theirs.point, theirs.normal), "{power} {wrench:?}");
                assert_eq!(ours.spin_torque * unit, theirs.spin_torque, "{power} {wrench:?}");
            }
        }
    }
}

#[test]
fn dents_and_contacts_are_the_same_in_every_unit_of_force() {
    knows_no_unit_of_force::<f64>([400, 200, -200, -400]);
    knows_no_unit_of_force::<f32>([45, 20, -20, -40]);
}
