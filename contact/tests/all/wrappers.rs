//! The contact on a shape inside a wrapper is the contact on the shape, to the last bit: what is found the
//! short way alone is found the short way inside, and mended at flat angles as well.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, RigidTransform, Wrench};
use nalgebra::{Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

/// A wrench of a force through a place near the surface, with a spin torque of its own.
fn any_wrench(random: &mut Pcg64Mcg, spin: f64) -> Wrench<f64> {
    let mut any = |reach: f64| Vector3::from_fn(|_, _| random.random_range(-reach..reach));
    let (place, force) = (any(0.012), any(2.0));
    let at: Wrench<f64> = Wrench::from_force_at(&place, force);
    Wrench::on_fingertip(at.force(), at.torque() + any(1.0) * spin)
}

/// How many of the contacts differ, of point contacts and of soft fingers.
fn differ<S: SoftFingerSurface<f64>, W: SoftFingerSurface<f64>>(shape: &S, wrapper: &W) -> [u32; 2] {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let (point, soft) = (PointContact::new(0.1).unwrap(), SoftFinger::new(0.1).unwrap());
    let [mut points, mut softs, mut found] = [0, 0, 0];
    for _ in 0..2000 {
        let wrench = any_wrench(&mut random, 0.0);
        let inner = point.resolve(&wrench, shape);
        found += u32::from(inner.contact().is_some());
        points += u32::from(inner != point.resolve(&wrench, wrapper));
        let wrench = any_wrench(&mut random, 1e-3);
        softs += u32::from(soft.resolve(&wrench, shape) != soft.resolve(&wrench, wrapper));
    }
    assert!(found > 300, "{found}");
    [points, softs]
}

fn check<S: SoftFingerSurface<f64> + Clone + Into<DynSurface<f64>>>(shape: S) {
    assert_eq!(differ(&shape, &&shape), [0, 0]);
    assert_eq!(differ(&shape, &Trimmed::new(shape.clone(), |_: &Vector3<f64>| true)), [0, 0]);
    let identity = RigidTransform::from_parts(Rotation3::identity(), Vector3::zeros());
    // A soft finger takes normals of a posed shape at their word: see `SoftFingerSurface::patch`.
    let [points, _] = differ(&shape, &Posed::new(shape.clone(), identity));
    assert_eq!(points, 0);
    let named: DynSurface<f64> = shape.clone().into();
    assert_eq!(differ(&shape, &named), [0, 0]);
}

#[test]
fn a_wrapper_changes_no_bit_of_a_contact() {
    let sphere = Sphere::new(v(0.001, 0.0, 0.002), 0.01).unwrap();
    check(sphere);
    assert_eq!(differ(&sphere, &SphericalCap::new(sphere, v(0.0, 0.0, 1.0), -1.0).unwrap()), [0, 0]);
    check(Ellipsoid::new(v(0.012, 0.008, 0.01)).unwrap());
    check(Cylinder::new(v(0.0, 0.0, 0.0), v(1.0, 2.0, 3.0), 0.009).unwrap());
    check(CappedCylinder::new(v(0.0, 0.0, 0.0), v(1.0, 2.0, 3.0), 0.009, 0.008).unwrap());
    check(Capsule::new(v(0.0, 0.0, 0.0), v(1.0, 2.0, 3.0), 0.008, 0.006).unwrap());
    check(Plane::new(v(0.0, 0.0, 0.003), v(1.0, -2.0, 3.0)).unwrap());
}

/// A sphere that forgets what the one inside knows.
struct Forgets(Sphere<f64>);

impl ActiveSurface<f64> for Forgets {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        self.0.crossings(line, visit);
    }
}

#[test]
fn a_surface_with_crossings_alone_has_the_same_contacts_but_for_rounding() {
    let sphere = Sphere::new(v(0.001, 0.0, 0.002), 0.01).unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let model = PointContact::new(0.1).unwrap();
    let [mut other_bits, mut missed] = [0, 0];
    for _ in 0..2000 {
        let wrench = any_wrench(&mut random, 0.0);
        match (model.resolve(&wrench, &sphere), model.resolve(&wrench, &Forgets(sphere))) {
            (Resolution::Contact(a), Resolution::Contact(b)) => {
                let allowed = 1e-16 / a.incidence().max(1e-3);
                assert!((a.point - b.point).norm() <= allowed, "{a:?} {b:?}");
                other_bits += u32::from(a != b);
            }
            (Resolution::NoContact(NoContact::Misses { closest: Some(_) }), b) => {
                assert_eq!(b, Resolution::NoContact(NoContact::Misses { closest: None }));
                missed += 1;
            }
            (Resolution::NoContact(a), Resolution::NoContact(b)) => assert_eq!(a, b),
            other => panic!("{other:?}"),
        }
    }
    // That it took another way shows.
    assert!(other_bits > 100 && missed > 100, "{other_bits} {missed}");
}

#[test]
fn a_gap_that_is_not_known_is_not_accepted_and_said() {
    let sphere = Sphere::centred(0.01).unwrap();
    let wrench = Wrench::from_force_at(&v(0.010_001, 0.0, 0.0), v(0.0, 0.0, -1.0));
    let tolerant = PointContact::new(0.1).unwrap().with_greatest_gap(1e-5).unwrap();
    assert!(tolerant.resolve(&wrench, &sphere).contact().is_some());
    let unknown = tolerant.resolve(&wrench, &Forgets(sphere)).into_result().unwrap_err();
    assert_eq!(unknown, NoContact::Misses { closest: None });
    assert_eq!(
        unknown.to_string(),
        "the line of action misses the surface; by how much the surface does not tell"
    );
    let known = PointContact::new(0.1).unwrap().resolve(&wrench, &sphere).into_result().unwrap_err();
    assert!(known.to_string().starts_with("the line of action misses the surface by 0.00000"), "{known}");
}

/// A posed shape that is chosen at run time answers to the bit as by its type, at every angle.
#[test]
fn a_pose_chosen_at_run_time() {
    fn same<S: SoftFingerSurface<f32> + Copy + Into<DynSurface<f32>>>(shape: S) {
        let mut random = Pcg64Mcg::seed_from_u64(31);
        let mut vector = |size: f32| Vector3::<f32>::from_fn(|_, _| random.random_range(-size..size));
        let (mut met, mut flat) = (0, 0);
        for _ in 0..2000 {
            let turn = Rotation3::from_scaled_axis(vector(3.0));
            let pose = RigidTransform::<f32>::from_parts(turn, vector(0.5));
            let typed = Posed::new(shape, pose);
            let chosen = DynSurface::Posed(Box::new(Posed::new(shape.into(), pose)));
            let wrench = Wrench::from_force_at(&pose.transform_point(&vector(0.7)), vector(2.0));
            let model = PointContact::new(0.0).unwrap();
            let [by_type, at_run_time] = [model.resolve(&wrench, &typed), model.resolve(&wrench, &chosen)];
            if let Resolution::Contact(contact) = by_type {
                assert_eq!(by_type, at_run_time);
                met += 1;
                flat += usize::from((0.3..0.6).contains(&contact.incidence()));
            }
        }
        assert!(met > 200 && flat > 20, "{met} {flat}");
    }
    let (along, across) = (Vector3::new(0.9, 0.0, 0.0), Vector3::new(0.0, 0.6, 0.6));
    same(Rectangle::new(Vector3::new(0.0, 0.0, 0.1), along, across).unwrap());
    same(Ellipsoid::new(Vector3::new(1.0, 0.7, 0.4)).unwrap());
    same(Paraboloid::new([1.0, 0.6]).unwrap());
}
