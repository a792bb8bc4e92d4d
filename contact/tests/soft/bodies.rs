//! Bodies with edges, bodies of facets, and shapes made of shapes.

use fingertip_contact::{ContactModel, Search, SoftContact, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::testing::cube_of_triangles;
use fingertip_surfaces::{
    ActiveSurface, CappedCylinder, Capsule, Compound, Cone, Cylinder, CylinderEnds, DynSurface,
    EllipticCylinder, Frustum, Heightfield, Mesh, Offset, Paraboloid, Revolution, Sphere,
};
use fingertip_test_support::Worst;
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use crate::common;
use crate::wrenches::{Case, Random};

fn all<T: Real, S: SoftFingerSurface<T>>(surface: &S, wrench: &Wrench<T>) -> Vec<SoftContact<T>> {
    let mut found = Vec::new();
    let search = surface.soft_contacts(wrench, None, |contact| found.push(contact));
    // Of a surface that may not be convex, such as one of revolution, nothing more is known.
    assert!(matches!(search, Search::Complete | Search::Uncertified), "{search:?} {wrench:?}");
    found
}

/// `|m − c × f − τ n|` in units of `|f| size + |m|`.
fn residual(contact: &SoftContact<f64>, wrench: &Wrench<f64>, size: f64) -> f64 {
    let rest = wrench.torque() - contact.point.cross(&wrench.force()) - contact.normal * contact.spin_torque;
    rest.norm() / (wrench.force().norm() * size + wrench.torque().norm())
}

/// A wrench of any kind, with a spin torque.
fn any_wrench(random: &mut Random, size: f64) -> Wrench<f64> {
    let arm = size * random.log_uniform(1e-3, 1e2);
    Wrench::on_fingertip(random.direction(), random.direction() * arm)
}

/// On a convex body every wrench with `f·m ≠ 0` has exactly one contact, and the equations hold.
fn exactly_one<S: SoftFingerSurface<f64>>(name: &str, body: &S, size: f64, count: usize) {
    let mut random = Random::new(61);
    let mut worst = Worst::new();
    for _ in 0..count {
        let wrench = any_wrench(&mut random, size);
        let found = all(body, &wrench);
        assert_eq!(found.len(), 1, "{name} {wrench:?} {found:?}");
        assert!(wrench.force().dot(&found[0].normal) < 0.0, "{name} {wrench:?} {found:?}");
        worst.see(residual(&found[0], &wrench, size));
    }
    let worst = worst.get();
    println!("{name:16} exactly one contact for {count} wrenches, residual {worst:.1e}");
    assert!(worst < 1e-12, "{name} {worst:e}");
}

/// The contact that a wrench was made from is among those found.
fn comes_back<S: SoftFingerSurface<f64>>(name: &str, body: &S, size: f64, spin: f64, tolerance: f64) {
    let mut random = Random::new(62);
    let mut worst = Worst::new();
    for _ in 0..3000 {
        let case = Case::random(&mut random, body, size, [1e-6, spin], 1.0);
        if case.incidence < 0.1 {
            continue;
        }
        let found = all(body, &case.wrench);
        let off = found.iter().map(|c| (c.point - case.point).norm() / size).fold(f64::INFINITY, f64::min);
        assert!(off < tolerance, "{name}: {off:e} {case:?} {found:?}");
        worst.see(off);
        let contact = SoftFinger::new(0.0).unwrap().without_friction_limit().resolve_near(
            &case.wrench,
            body,
            Some(&case.point),
        );
        assert!((contact.contact().unwrap().point - case.point).norm() < tolerance * size);
    }
    let worst = worst.get();
    println!("{name:16} comes back to {worst:.1e} of its size");
}

fn capped() -> CappedCylinder<f64> {
    CappedCylinder::new(Vector3::new(0.001, 0.0, -0.002), Vector3::new(0.2, 0.1, 1.0), 0.007, 0.011).unwrap()
}

fn frustum(base: f64, top: f64) -> Frustum<f64> {
    Frustum::new(Vector3::new(0.001, 0.0, -0.008), Vector3::new(0.1, 0.1, 1.0), base, top, 0.016).unwrap()
}

#[test]
fn closed_cylinders_and_frusta() {
    exactly_one("capped cylinder", &capped(), 0.013, 20_000);
    comes_back("capped cylinder", &capped(), 0.013, 3.0, 1e-11);
    for (base, top) in [(0.009, 0.005), (0.004, 0.010), (0.009, 0.0), (0.0, 0.008), (0.007, 0.0069999)] {
        let body = frustum(base, top);
        exactly_one(&format!("frustum {base} {top}"), &body, 0.014, 20_000);
        comes_back("frustum", &body, 0.012, 3.0, 1e-10);
    }
}

#[test]
fn closed_elliptic_cylinders() {
    let closed = |a, b, half| EllipticCylinder::new([a, b], CylinderEnds::Capped(half)).unwrap();
    for (a, b, half) in [(0.007, 0.012, 0.009), (0.012, 0.002, 0.004), (0.005, 0.006, 0.020)] {
        exactly_one(&format!("elliptic {a} {b}"), &closed(a, b, half), 0.013, 20_000);
        comes_back("elliptic cylinder", &closed(a, b, half), 0.013, 3.0, 1e-10);
    }
    // With equal axes it is the closed circular cylinder, edges and all.
    let (elliptic, round) = (
        closed(0.010, 0.010, 0.004),
        CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.010, 0.004).unwrap(),
    );
    let (mut random, mut on_rims) = (Random::new(64), 0);
    for _ in 0..3000 {
        let wrench = any_wrench(&mut random, 0.01);
        let (a, b) = (all(&elliptic, &wrench)[0], all(&round, &wrench)[0]);
        assert!((a.point - b.point).norm() < 1e-10 && (a.normal - b.normal).norm() < 1e-8, "{a:?} {b:?}");
        on_rims += usize::from(a.normal.z.abs() > 1e-9 && a.normal.z.abs() < 1.0 - 1e-9);
    }
    assert!(on_rims > 100, "{on_rims}");
}

/// The limit of a rounded edge: a capsule-like torus of a thin tube has its contact near the rim's.
#[test]
fn a_rim_is_a_torus_of_no_thickness() {
    let cylinder = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.010, 0.004).unwrap();
    let mut random = Random::new(63);
    let mut on_rims = 0;
    for _ in 0..3000 {
        let wrench = any_wrench(&mut random, 0.01);
        let contact = all(&cylinder, &wrench)[0];
        let radius = contact.point.xy().norm();
        if (radius - 0.010).abs() > 1e-12 || (contact.point.z.abs() - 0.004).abs() > 1e-12 {
            continue;
        }
        on_rims += 1;
        let rounding = 1e-7;
        let centre = Vector3::z() * 0.004_f64.copysign(contact.point.z);
        let rounded = fingertip_surfaces::Torus::new(0.010, rounding).unwrap();
        let about = Wrench::on_fingertip(wrench.force(), wrench.torque_about(&centre));
        let found = all(&rounded, &about);
        let near = found.iter().map(|c| (c.point + centre - contact.point).norm());
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-3 * 0.01, "{wrench:?} {contact:?} {found:?}");
    }
    assert!(on_rims > 100, "{on_rims}");
}

/// A ball of triangles, from an octahedron whose faces are cut into `n²`.
fn ball(radius: f64, n: u32) -> Mesh<f64> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..8_u8 {
        let sign = |bit: u8| if face >> bit & 1 == 1 { -1.0 } else { 1.0 };
        let corners = [Vector3::x() * sign(0), Vector3::y() * sign(1), Vector3::z() * sign(2)];
        let at = |i: u32, j: u32| {
            let [a, b, c] = corners;
            let v = a * f64::from(i) + b * f64::from(j) + c * f64::from(n - i - j);
            v.normalize() * radius
        };
        let mut add = |mut points: [Vector3<f64>; 3]| {
            if (points[1] - points[0]).cross(&(points[2] - points[0])).dot(&points[0]) < 0.0 {
                points.swap(1, 2);
            }
            let first = vertices.len() as u32;
            vertices.extend(points);
            triangles.push([first, first + 1, first + 2]);
        };
        for i in 0..n {
            for j in 0..n - i {
                add([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    // The same corner, computed for two faces, must be the same number.
    let snapped: Vec<Vector3<f64>> =
        vertices.iter().map(|v| v.map(|x| (x * 1e12).round() / 1e12 + 0.0)).collect();
    Mesh::new(&snapped, &triangles).unwrap()
}

fn cube(half: f64) -> Mesh<f64> {
    let (vertices, triangles) = cube_of_triangles(half);
    Mesh::new(&vertices, &triangles).unwrap()
}

#[test]
fn a_convex_mesh_has_one_contact() {
    exactly_one("cube", &cube(0.01), 0.01, 20_000);
    exactly_one("ball of facets", &ball(0.01, 8), 0.01, 2000);
    comes_back("cube", &cube(0.01), 0.01, 0.5, 1e-12);
}

/// A contact on a vertex has a normal on which nothing is higher.
#[test]
fn vertices_hold_what_facets_cannot() {
    let (body, mut random, mut on_vertices) = (cube(0.01), Random::new(64), 0);
    for _ in 0..5000 {
        let wrench = any_wrench(&mut random, 0.01);
        let contact = all(&body, &wrench)[0];
        let height = body.vertices().map(|v| v.dot(&contact.normal)).fold(f64::NEG_INFINITY, f64::max);
        assert!((contact.point.dot(&contact.normal) - height).abs() < 1e-15, "{contact:?}");
        on_vertices += usize::from(contact.point.abs().min() > 0.01 - 1e-15);
    }
    assert!(on_vertices > 500, "{on_vertices}");
}

/// Finer facets come nearer to the sphere, in proportion to their size.
#[test]
fn facets_approach_the_sphere() {
    let sphere = Sphere::centred(0.01).unwrap();
    let mut before = f64::INFINITY;
    for n in [4, 8, 16, 32] {
        let (mesh, mut random, mut sum) = (ball(0.01, n), Random::new(65), 0.0);
        let count = 200;
        for _ in 0..count {
            let case = Case::random(&mut random, &sphere, 0.01, [0.05, 1.0], 1.0);
            let found = all(&mesh, &case.wrench);
            assert_eq!(found.len(), 1);
            sum += ((found[0].point - case.point).norm() / 0.01).powi(2);
        }
        let error = (sum / f64::from(count)).sqrt();
        println!("ball of {:5} facets: contact off by {:.4} R", mesh.triangle_count(), error);
        assert!(error < before * 0.7, "{n} {error} {before}");
        before = error;
    }
    assert!(before < 0.06);
}

fn dome(n: usize) -> Heightfield<f64> {
    let step = 0.016 / (n - 1) as f64;
    let mut heights = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let (x, y) = (-0.008 + step * i as f64, -0.008 + step * j as f64);
            heights.push(-(x * x / 0.010 + y * y / 0.015) / 2.0);
        }
    }
    Heightfield::new([-0.008; 2], [step; 2], n, heights).unwrap()
}

#[test]
fn heightfields_approach_the_paraboloid() {
    let smooth = Paraboloid::new([0.010, 0.015]).unwrap();
    let mut before = f64::INFINITY;
    for n in [9, 17, 33, 65] {
        let (field, mut random, mut sum, mut count) = (dome(n), Random::new(66), 0.0, 0);
        while count < 200 {
            let case = Case::random(&mut random, &smooth, 0.008, [0.01, 0.5], 1.0);
            if case.point.xy().amax() > 0.006 || case.incidence < 0.3 {
                continue;
            }
            count += 1;
            let found = all(&field, &case.wrench);
            let off = found.iter().map(|c| (c.point - case.point).norm()).fold(f64::INFINITY, f64::min);
            assert!(off < 0.008, "{case:?} {found:?}");
            for contact in &found {
                assert!(residual(contact, &case.wrench, 0.008) < 1e-11, "{contact:?}");
            }
            sum += (off / 0.01).powi(2);
        }
        let error = (sum / f64::from(count)).sqrt();
        println!("dome of {n} × {n} heights: contact off by {error:.4} R");
        assert!(error < before * 0.75, "{n} {error} {before}");
        before = error;
    }
    comes_back("heightfield", &dome(17), 0.006, 0.3, 1e-10);
}

#[test]
fn unions_keep_what_is_outside() {
    let finger = Compound::new(capped(), Sphere::new(Vector3::new(0.003, 0.001, 0.010), 0.009).unwrap());
    comes_back("compound", &finger, 0.015, 1.0, 1e-10);
    let hidden = finger.parts().1.centre() - Vector3::z() * 0.009;
    assert!(finger.contains(&hidden));
    let mut random = Random::new(67);
    for _ in 0..2000 {
        for contact in all(&finger, &any_wrench(&mut random, 0.015)) {
            assert!(!finger.contains(&(contact.point + contact.normal * 1e-9)), "{contact:?}");
        }
    }
}

#[test]
fn parallel_surfaces() {
    let sphere = common::sphere::<f64>();
    let grown = Sphere::new(sphere.centre(), sphere.radius() + 0.002).unwrap();
    let skin = Offset::new(sphere, 0.002).unwrap();
    let mut random = Random::new(68);
    for _ in 0..1000 {
        let case = Case::random(&mut random, &grown, 0.015, [1e-12, 1e2], 1.0);
        let (ours, exact) = (all(&skin, &case.wrench), all(&grown, &case.wrench));
        assert!((ours[0].point - exact[0].point).norm() < 1e-15 * 64.0, "{case:?} {ours:?} {exact:?}");
    }
    comes_back(
        "grown ellipsoid",
        &Offset::new(common::ellipsoid::<f64>(), 0.002).unwrap(),
        0.017,
        10.0,
        1e-12,
    );
    comes_back(
        "shrunk ellipsoid",
        &Offset::new(common::ellipsoid::<f64>(), -0.001).unwrap(),
        0.017,
        10.0,
        1e-12,
    );
}

#[test]
fn surfaces_of_revolution() {
    // Any points of a sphere give that sphere.
    let profile = [0.0_f64, 0.004, 0.009, 0.014, 0.019, 0.024, 0.026]
        .map(|z| [z, (0.013_f64.powi(2) - (z - 0.013).powi(2)).max(0.0).sqrt()]);
    let (round, sphere) =
        (Revolution::from_profile(profile).unwrap(), Sphere::new(Vector3::z() * 0.013, 0.013).unwrap());
    let mut random = Random::new(69);
    for _ in 0..2000 {
        let case = Case::random(&mut random, &sphere, 0.03, [1e-12, 1e2], 1.0);
        let (ours, exact) = (all(&round, &case.wrench), all(&sphere, &case.wrench));
        assert_eq!(ours.len(), 1);
        assert!((ours[0].point - exact[0].point).norm() < 1e-14, "{case:?} {ours:?} {exact:?}");
    }
    let tip = Revolution::from_profile([
        [0.000, 0.0080],
        [0.004, 0.0080],
        [0.008, 0.0074],
        [0.012, 0.0052],
        [0.014, 0.0],
    ])
    .unwrap();
    comes_back("gel tip", &tip, 0.014, 3.0, 1e-11);
    let waisted =
        Revolution::from_profile([[0.0, 0.006], [0.005, 0.004], [0.010, 0.0065], [0.016, 0.0]]).unwrap();
    comes_back("waisted tip", &waisted, 0.014, 1.0, 1e-10);
    // The ends of the profile are part of it.
    let tube = Revolution::from_profile([0.0, 0.006, 0.012].map(|z| [z, 0.008])).unwrap();
    for (height, active) in [(-1e-9, false), (0.0, true), (0.012, true), (0.012 + 1e-9, false)] {
        let wrench = Wrench::from_force_at(&Vector3::new(0.0, 0.0, height), Vector3::new(-2.0, 0.0, 0.0));
        let found = all(&tube, &wrench);
        assert!(found.iter().all(|contact| contact.active == active), "{height} {found:?}");
        assert_eq!(found.iter().any(|contact| contact.active), active, "{height} {found:?}");
    }
}

/// Chosen at run time, a shape answers as its own type does.
#[test]
fn a_shape_chosen_at_run_time() {
    let mut random = Random::new(70);
    let union = DynSurface::union(vec![capped().into(), common::sphere::<f64>().into()]).unwrap();
    let plain = Compound::new(capped(), common::sphere::<f64>());
    for _ in 0..500 {
        let wrench = any_wrench(&mut random, 0.015);
        assert_eq!(
            all(&DynSurface::from(common::ellipsoid::<f64>()), &wrench),
            all(&common::ellipsoid(), &wrench)
        );
        assert_eq!(all(&union, &wrench), all(&plain, &wrench));
        assert_eq!(all(&DynSurface::from(cube(0.01)), &wrench), all(&cube(0.01), &wrench));
        let torus = common::torus::<f64>();
        assert_eq!(all(&DynSurface::from(torus), &wrench), all(&torus, &wrench));
    }
}

/// A pure force that misses one part and meets the other has a contact; one that misses both grazes.
#[test]
fn a_contact_of_either_part_settles_what_the_other_cannot() {
    let ball = |x: f64| Sphere::new(Vector3::new(x, 0.0, 0.0), 0.005).unwrap();
    let down = |x: f64| Wrench::from_force_at(&Vector3::new(x, 0.001, 0.0), Vector3::new(0.0, 0.0, -1.0));
    for (met, missed) in [(0.02, -0.02), (-0.02, 0.02)] {
        let mut found = Vec::new();
        let search =
            Compound::new(ball(-0.02), ball(0.02)).soft_contacts(&down(met), None, |c| found.push(c));
        assert!(matches!(search, Search::Complete), "{search:?}");
        let [contact] = found.as_slice() else { panic!("{found:?}") };
        assert!((contact.point.x - met).abs() < 1e-15 && contact.point.z > 0.0, "{contact:?}");
        let alone = ball(missed).soft_contacts(&down(met), None, |c| panic!("{c:?}"));
        assert!(matches!(alone, Search::Grazing(_)), "{alone:?}");
    }
    let search = Compound::new(ball(-0.02), ball(0.02)).soft_contacts(&down(0.0), None, |c| panic!("{c:?}"));
    assert!(matches!(search, Search::Grazing(_)), "{search:?}");
}

/// A pure force that misses a convex mesh touches it nowhere, no corner either.
#[test]
fn a_pure_force_that_misses_a_mesh_has_no_contact() {
    let (mut random, mut missed) = (Random::new(71), 0);
    for body in [cube(0.01), ball(0.01, 6)] {
        for turn in 0..6000 {
            let point = random.direction() * 0.025;
            // Along an axis, so that f·m is zero to the last bit.
            let along = Vector3::ith(turn % 3, random.sign());
            let mut meets = false;
            body.crossings(&Line { point, direction: along }, |_| meets = true);
            if !meets {
                missed += 1;
                let force = along * random.log_uniform(0.1, 10.0);
                let wrench = Wrench::on_fingertip(force, point.cross(&force));
                assert_eq!(all(&body, &wrench), [], "{wrench:?}");
            }
        }
    }
    assert!(missed > 1000, "{missed}");
}

/// Beyond its end a capsule is the ball there, and grazed where that is.
#[test]
fn a_capsule_is_grazed_at_the_end_that_is_passed() {
    let (half, radius) = (0.01, 0.005);
    let capsule = Capsule::new(Vector3::zeros(), Vector3::z(), radius, half).unwrap();
    for end in [1.0, -1.0] {
        let ball = Sphere::new(Vector3::z() * (end * half), radius).unwrap();
        let passing = Vector3::new(0.0, 1e-4, end * (half + 1.1 * radius));
        let wrench = Wrench::from_force_at(&passing, Vector3::new(-1.0, 0.0, 0.0));
        let pair = |search: &Search<f64>| match search {
            Search::Grazing(pair) => *pair,
            other => panic!("{other:?}"),
        };
        let found = pair(&capsule.soft_contacts(&wrench, None, |c| panic!("{c:?}")));
        let expected = pair(&ball.soft_contacts(&wrench, None, |c| panic!("{c:?}")));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).amax() < 1e-15, "{found} {expected}");
            assert!(found.z * end >= half);
        }
    }
}

/// A force through the tip of a cone that pulls has no contact, and that is certain.
#[test]
fn a_pull_at_the_tip_of_a_cone_is_no_contact() {
    let cone = Cone::new(Vector3::zeros(), -Vector3::z(), 0.5).unwrap();
    for force in [Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.2, -0.1, 2.0)] {
        let wrench = Wrench::on_fingertip(force, Vector3::zeros());
        let mut found = Vec::new();
        let search = cone.soft_contacts(&wrench, None, |contact| found.push(contact));
        assert!(matches!(search, Search::Complete) && found.is_empty(), "{force} {found:?}");
    }
}

/// At flat angles on a surface that tells only its level function, single precision solves the equations but for
/// rounding of what it answers: the spin torque is what the force leaves of the torque.
#[test]
fn the_spin_torque_is_mended_with_the_place() {
    let (single, double) = (common::pillow::<f32>(), common::pillow::<f64>());
    let mut random = Random::new(91);
    let (mut worst, mut flat) = (Worst::new(), 0);
    for _ in 0..4000 {
        let (point, normal) = random.place(&double, 0.012);
        let aside = random.direction().cross(&normal).normalize();
        let force = (aside - normal * random.log_uniform(0.02, 0.3)).normalize();
        let spin = random.sign() * random.log_uniform(1e-4, 0.3) * 0.01;
        let (force, torque) = (force.cast::<f32>(), (point.cross(&force) + normal * spin).cast::<f32>());
        for contact in all(&single, &Wrench::on_fingertip(force, torque)) {
            let (c, n) = (contact.point.cast::<f64>(), contact.normal.cast::<f64>());
            let left = torque.cast::<f64>() - c.cross(&force.cast());
            let size = c.norm() + torque.cast::<f64>().norm();
            worst.see((n.dot(&left) - f64::from(contact.spin_torque)).abs() / size);
            // The normal of the place, but for rounding of the place and of the normal: it bends by 4 radii of 10 mm.
            worst.see((n - double.normal(&c)).norm() / 4.0);
            flat += usize::from(n.dot(&force.cast()) > -0.1);
        }
    }
    let worst = worst.get() / f64::from(f32::EPSILON);
    println!("spin torques at flat angles: {worst:.2} units of rounding");
    assert!(worst < 4.0 && flat > 1000, "{worst} {flat}");
}

/// The ends of a cylinder that ends are part of it.
#[test]
fn the_end_of_a_cylinder_is_part_of_it() {
    let cylinder =
        Cylinder::new(Vector3::zeros(), Vector3::z(), 0.01).unwrap().with_half_length(0.02).unwrap();
    for (height, active) in [(0.02, true), (-0.02, true), (0.020_000_1, false), (-0.020_000_1, false)] {
        let wrench = Wrench::from_force_at(&Vector3::new(0.0, 0.0, height), Vector3::new(-2.0, 0.0, 0.0));
        let found = all(&cylinder, &wrench);
        assert_eq!(found.iter().map(|contact| contact.active).collect::<Vec<_>>(), [active], "{height}");
    }
}
