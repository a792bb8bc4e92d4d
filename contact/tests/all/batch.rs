//! Batches answer as one at a time.

use fingertip_contact::batch::{BatchSurface, Contacts, Lines, SoftContacts, Wrenches};
use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn agrees<T: Real, S: ActiveSurface<T> + BatchSurface<T>>(surface: &S, exact_misses: bool) {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let count = 5003;
    let mut columns: [Vec<T>; 6] = Default::default();
    for k in 0..count {
        let strength = 10_f64.powf(random.random_range(-7.0..7.0));
        let force = Vector3::<f64>::from_fn(|_, _| random.random_range(-1.0..1.0)) * strength;
        // In the first, no line misses.
        let reach = if k < 1500 { 0.2 } else { 1.2 };
        let at = Vector3::<f64>::from_fn(|_, _| random.random_range(-reach..reach));
        let mut parts = [force, at.cross(&force)].map(|v| v.data.0[0]).concat();
        if k >= 1500 && k % 100 == 0 {
            parts[k / 100 % 6] = [f64::NAN, f64::INFINITY][k / 100 % 2];
        }
        if k >= 1500 && k % 100 == 1 {
            parts[..3].fill(0.0);
        }
        for (column, part) in columns.iter_mut().zip(parts) {
            column.push(T::literal(part));
        }
    }
    let mut out = [(); 7].map(|()| vec![T::zero(); count]);
    let [px, py, pz, nx, ny, nz, gap] = &mut out;
    let [fx, fy, fz, tx, ty, tz] = columns.each_ref().map(|column| &column[..]);
    surface.contacts(
        Wrenches { force: [fx, fy, fz], torque: [tx, ty, tz] },
        Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap },
    );
    alone_or_together(surface, [fx, fy, fz, tx, ty, tz], &out);
    let model = PointContact::new(T::zero()).unwrap();
    let (mut met, mut missed, mut nothing) = (0, 0, 0);
    for k in 0..count {
        let wrench = Wrench::from_components(&columns.each_ref().map(|column| column[k]).into());
        let point = Vector3::new(out[0][k], out[1][k], out[2][k]);
        let normal = Vector3::new(out[3][k], out[4][k], out[5][k]);
        let gap = out[6][k];
        assert!(out.iter().all(|column| column[k].is_number()), "{k}");
        let near = |a: &Vector3<T>, b: &Vector3<T>, incidence: T| {
            let allowed = T::EPSILON * T::literal(400.0) / incidence.max(T::literal(1e-3));
            assert!((a - b).norm() <= allowed, "{k}: {a:?} instead of {b:?}");
        };
        match model.resolve(&wrench, surface) {
            Resolution::Contact(contact) => {
                // Rounding decides on lines that are nearly tangent.
                if contact.incidence() > T::literal(1e-3) {
                    met += 1;
                    assert_eq!(gap, T::zero(), "{k}: {contact:?}");
                    near(&point, &contact.point, contact.incidence());
                    near(&normal, &contact.normal, contact.incidence());
                }
            }
            Resolution::NoContact(NoContact::Misses {
                closest: Some(ClosestApproach { gap: expected, point: closest, .. }),
            }) => {
                missed += 1;
                if exact_misses && expected > T::literal(1e-3) {
                    assert!(
                        (gap - expected).abs() <= T::EPSILON * T::literal(400.0),
                        "{k}: {gap} {expected}"
                    );
                    near(&point, &closest, T::one());
                }
            }
            Resolution::NoContact(_) => {
                nothing += 1;
                assert_eq!((gap, point), (T::GREATEST, Vector3::zeros()), "{k}");
            }
        }
    }
    assert!(met > 1000 && nothing >= 50, "{met} {missed} {nothing}");
}

/// Wide vectors, narrow ones and the remainder of a loop all give the same bits.
fn alone_or_together<T: Real, S: BatchSurface<T>>(surface: &S, given: [&[T]; 6], together: &[Vec<T>; 7]) {
    for k in 0..together[0].len() {
        let [fx, fy, fz, tx, ty, tz] = given.map(|column| &column[k..=k]);
        let mut alone = [[T::zero()]; 7];
        let [px, py, pz, nx, ny, nz, gap] = &mut alone;
        surface.contacts(
            Wrenches { force: [fx, fy, fz], torque: [tx, ty, tz] },
            Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap },
        );
        for (alone, together) in alone.iter().zip(together) {
            assert_eq!(alone[0], together[k], "{k}");
        }
        splits_the_force(surface, given.map(|column| column[k]), alone[6][0]);
    }
}

/// The parts of the force, in line: of a line that misses too, where it is nearest.
fn splits_the_force<T: Real, S: BatchSurface<T>>(surface: &S, [fx, fy, fz, tx, ty, tz]: [T; 6], gap: T) {
    let force = Vector3::new(fx, fy, fz);
    for lines in [Lines::Any, Lines::Meeting] {
        let entered = surface.enter([fx, fy, fz], [tx, ty, tz], lines, surface.is_at_origin());
        if !entered.certain || gap > T::zero() && lines == Lines::Meeting {
            continue;
        }
        let normal = Vector3::from(entered.normal);
        let along = force.dot(&normal);
        let allowed = T::EPSILON * T::literal(100.0) * force.amax();
        // Squared, what rounding does is the root of it where there is nearly nothing.
        let across = (force - normal * along).norm();
        let parts = entered.parts;
        assert!((parts.normal + along).abs() <= allowed, "{lines:?} {gap} {} {along}", parts.normal);
        let off = (parts.tangential * parts.tangential - across * across).abs();
        assert!(off <= allowed * force.amax(), "{lines:?} {gap} {} {across}", parts.tangential);
    }
}

/// A surface that knows batches and nothing of single lines.
struct Plain(Sphere<f64>);

impl BatchSurface<f64> for Plain {
    fn contacts_in_line(&self, wrenches: Wrenches<'_, f64>, contacts: Contacts<'_, f64>) {
        self.0.contacts_in_line(wrenches, contacts);
    }
}

/// A line by itself, of a surface that does it as a batch of one.
#[test]
fn a_single_line_may_be_a_batch_of_one() {
    let sphere = Sphere::new(v(0.1, -0.2, 0.3), 1.0).unwrap();
    let plain = Plain(sphere);
    let force = [0.0, 0.5, -2.0];
    for (aside, meets) in [(0.0, true), (0.9, true), (3.0, false), (f64::NAN, false)] {
        let torque: [f64; 3] = Vector3::new(aside, 0.0, 0.0).cross(&Vector3::from(force)).into();
        let any = plain.enter(force, torque, Lines::Any, false);
        assert_eq!(any.certain, aside.is_finite());
        let expected = sphere.enter(force, torque, Lines::Any, false);
        assert_eq!((any.point, any.normal, any.gap), (expected.point, expected.normal, expected.gap));
        let meeting = plain.enter(force, torque, Lines::Meeting, false);
        assert_eq!(meeting.certain, meets, "{aside} {meeting:?}");
        if meets {
            let close = |a: f64, b: f64| (a - b).abs() < 1e-14;
            assert!(close(meeting.parts.normal, expected.parts.normal));
            assert!(close(meeting.parts.tangential, expected.parts.tangential));
        }
    }
}

fn v<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(x, y, z).map(T::literal)
}

macro_rules! batches {
    ($name:ident, $shape:expr, $exact:expr) => {
        #[test]
        fn $name() {
            fn check<T: Real>() {
                agrees::<T, _>(&$shape.unwrap(), $exact);
            }
            check::<f32>();
            check::<f64>();
        }
    };
}

batches!(sphere, Sphere::new(v(0.1, -0.2, 0.3), T::one()), true);
batches!(centred_sphere, Sphere::centred(T::one()), true);
batches!(small_sphere, Sphere::new(v(0.1, -0.2, 0.1), T::literal(0.4)), true);
batches!(plane, Plane::new(v(0.1, -0.2, 0.3), v(1.0, 2.0, 3.0)), true);
batches!(cylinder, Cylinder::new(v(0.1, -0.2, 0.3), v(1.0, 2.0, 3.0), T::one()), true);
batches!(ellipsoid, Ellipsoid::new(v(0.95, 0.8, 0.6)), false);
batches!(capsule, Capsule::new(v(0.1, -0.2, 0.3), v(1.0, 2.0, 3.0), T::literal(0.6), T::literal(0.5)), false);

batches!(cone, Cone::new(v(0.1, -0.2, 0.6), v(-1.0, -2.0, -3.0), T::literal(0.6)), true);
batches!(
    frustum,
    Frustum::new(v(0.1, -0.2, -0.6), v(0.0, 0.3, 3.0), T::literal(0.9), T::literal(0.5), T::one()),
    true
);
batches!(
    capped,
    CappedCylinder::new(v(0.1, -0.2, 0.1), v(1.0, 2.0, 3.0), T::literal(0.7), T::literal(0.6)),
    true
);
batches!(elliptic, EllipticCylinder::new([0.9, 0.6].map(T::literal), CylinderEnds::Unbounded), true);
batches!(
    open_elliptic,
    EllipticCylinder::new([0.9, 0.6].map(T::literal), CylinderEnds::Open(T::literal(0.7))),
    true
);
batches!(
    capped_elliptic,
    EllipticCylinder::new([0.9, 0.6].map(T::literal), CylinderEnds::Capped(T::literal(0.7))),
    true
);
batches!(paraboloid, Paraboloid::new([0.9, 0.6].map(T::literal)), true);
batches!(rounded_box, RoundedBox::new(v(0.9, 0.7, 0.5), T::literal(0.2)), true);
batches!(sharp_box, RoundedBox::new(v(0.9, 0.7, 0.5), T::zero()), true);

/// Every wrench as by itself, to the bit: those that a closed form tells, at flat angles, that miss, zero and NaN.
fn soft_as_alone<T: Real, S: SoftFingerSurface<T>>(surface: &S) {
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let count = 403;
    let wrenches: Vec<Wrench<T>> = (0..count)
        .map(|k| {
            let mut vector = |size: f64| Vector3::<f64>::from_fn(|_, _| random.random_range(-size..size));
            let (force, through) = (vector(2.0), vector(if k < 200 { 0.2 } else { 1.2 }));
            // Of every third the torque is that of the force alone.
            let spin = if k % 3 == 0 { Vector3::zeros() } else { vector([0.1, 3.0][k % 2]) };
            let torque = through.cross(&force) + spin;
            let (force, torque) = match k % 50 {
                47 => (force, torque * f64::NAN),
                48 => (Vector3::zeros(), torque),
                49 => (force * 1e-30, torque * 1e-30),
                _ => (force, torque),
            };
            Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal))
        })
        .collect();
    let column = |k: usize| wrenches.iter().map(|wrench| wrench.components()[k]).collect::<Vec<T>>();
    let given = [0, 1, 2, 3, 4, 5].map(column);
    let [fx, fy, fz, tx, ty, tz] = given.each_ref().map(|column| &column[..]);
    for model in [SoftFinger::new(T::zero()), SoftFinger::new(T::literal(0.5))] {
        let model = model.unwrap().without_friction_limit();
        // The shortest column counts.
        let mut out = [0, 1, 2, 3, 4, 5, 6].map(|k| vec![T::literal(7.0); count - k % 2]);
        let [px, py, pz, nx, ny, nz, spin_torque] = out.each_mut().map(|column| &mut column[..]);
        let (point, normal) = ([px, py, pz], [nx, ny, nz]);
        model.resolve_all(
            surface,
            Wrenches { force: [fx, fy, fz], torque: [tx, ty, tz] },
            SoftContacts { point, normal, spin_torque },
        );
        assert!((0..7).all(|k| out[k].get(count - 1).is_none_or(|last| *last == T::literal(7.0))));
        let mut met = 0;
        for (k, wrench) in wrenches.iter().take(count - 1).enumerate() {
            let found = out.each_ref().map(|column| column[k]);
            let expected = model.resolve(wrench, surface).contact().map_or([T::zero(); 7], |contact| {
                met += 1;
                let (c, n) = (contact.point, contact.normal);
                [c.x, c.y, c.z, n.x, n.y, n.z, contact.spin_torque]
            });
            assert_eq!(found, expected, "{k}: {wrench:?}");
        }
        assert!(met > 100, "{met}");
    }
}

#[test]
fn soft_fingers_in_columns() {
    fn check<T: Real>() {
        let l = T::literal;
        let axis: Vector3<T> = v(1.0, 2.0, 3.0);
        soft_as_alone(&Plane::new(v(0.1, -0.2, 0.3), axis).unwrap());
        soft_as_alone(&Sphere::new(v(0.1, -0.2, 0.3), T::one()).unwrap());
        soft_as_alone(&Ellipsoid::<T>::new(v(1.0, 0.8, 0.6)).unwrap());
        soft_as_alone(&Cylinder::new(v(0.1, -0.2, 0.3), axis, T::one()).unwrap());
        soft_as_alone(&Capsule::new(v(0.1, -0.2, 0.3), axis, l(0.6), l(0.5)).unwrap());
        soft_as_alone(&Cone::new(v(0.1, -0.2, 0.6), -axis, l(0.6)).unwrap());
        let frustum = Frustum::new(v(0.1, -0.2, -0.6), axis, l(0.9), l(0.5), T::one()).unwrap();
        soft_as_alone(&frustum);
        soft_as_alone(&CappedCylinder::new(v(0.1, -0.2, 0.1), axis, l(0.7), l(0.6)).unwrap());
        let ends = CylinderEnds::Capped(l(0.7));
        soft_as_alone(&EllipticCylinder::new([0.9, 0.6].map(T::literal), ends).unwrap());
        // Without a closed form, and in another place.
        soft_as_alone(&RoundedBox::new(v(0.9, 0.7, 0.5), l(0.2)).unwrap());
        let turned = RigidTransform::<T>::translation(v(0.1, 0.0, 0.2));
        soft_as_alone(&Posed::new(frustum, turned));
    }
    check::<f32>();
    check::<f64>();
}

/// The tests above have spheres of about one metre: here of a fingertip's size, and a building's, away from the origin.
#[test]
fn spheres_of_any_size_and_place() {
    let mut random = Pcg64Mcg::seed_from_u64(12);
    for radius in [1e-3, 0.013, 40.0] {
        let mut vector = |size: f64| Vector3::<f64>::from_fn(|_, _| random.random_range(-size..size));
        let sphere = Sphere::new(vector(3.0 * radius), radius).unwrap();
        for _ in 0..200 {
            let force = vector(2.0);
            let wrench = Wrench::from_force_at(&(sphere.centre() + vector(0.5 * radius)), force);
            let (mut point, mut normal, mut gap) = ([0.0; 3], [0.0; 3], [0.0]);
            let ([px, py, pz], [nx, ny, nz]) = (point.each_mut(), normal.each_mut());
            let component = |v: Vector3<f64>| [[v.x], [v.y], [v.z]];
            let (f, m) = (component(wrench.force()), component(wrench.torque()));
            sphere.contacts(
                Wrenches { force: f.each_ref().map(|x| &x[..]), torque: m.each_ref().map(|x| &x[..]) },
                Contacts {
                    point: [px, py, pz].map(core::slice::from_mut),
                    normal: [nx, ny, nz].map(core::slice::from_mut),
                    gap: &mut gap,
                },
            );
            let expected = PointContact::new(0.0).unwrap().resolve(&wrench, &sphere);
            let contact = expected.contact().unwrap();
            assert_eq!(gap, [0.0]);
            assert!((Vector3::from(point) - contact.point).amax() < 1e-12 * radius, "{point:?}");
            assert!((Vector3::from(normal) - contact.normal).amax() < 1e-12, "{normal:?}");
        }
    }
}

/// Of a line that misses an ellipsoid the gap is the distance from the plane that touches it where the contact is
/// reported, and a line that only misses is no certain contact.
#[test]
fn the_gap_of_an_ellipsoid_is_that_of_its_tangent_plane() {
    let mut random = Pcg64Mcg::seed_from_u64(14);
    for size in [1.0, 0.01] {
        let ellipsoid = Ellipsoid::new(v(1.0, 0.7, 0.4) * size).unwrap();
        let mut missed = 0;
        for _ in 0..1000 {
            let mut vector = |size: f64| Vector3::<f64>::from_fn(|_, _| random.random_range(-size..size));
            let (force, through) = (vector(2.0), vector(1.5 * size));
            let torque = through.cross(&force);
            let answer = ellipsoid.enter(force.into(), torque.into(), Lines::Any, false);
            let (point, normal) = (Vector3::from(answer.point), Vector3::from(answer.normal));
            let on_surface = point.component_div(&ellipsoid.semi_axes()).norm();
            assert!((on_surface - 1.0).abs() < 1e-12, "{point}");
            if answer.gap > 1e-6 * size {
                missed += 1;
                let gap = (through - point).dot(&normal);
                assert!((answer.gap - gap).abs() < 1e-11 * size, "{} {gap}", answer.gap);
                assert!(normal.dot(&force).abs() < 1e-11 * force.norm());
            }
            assert_eq!(answer.certain, answer.gap.is_finite());
            let meeting = ellipsoid.enter(force.into(), torque.into(), Lines::Meeting, false);
            assert_eq!(meeting.certain, answer.gap == 0.0, "{answer:?}");
        }
        assert!(missed > 200, "{missed}");
    }
}

/// A plane is met for certain by what presses on it, and by nothing that pulls.
#[test]
fn what_pulls_at_a_plane_is_no_certain_contact() {
    let plane = Plane::new(v(0.0, 0.0, 0.1), v::<f64>(0.0, 0.0, 1.0)).unwrap();
    for lines in [Lines::Any, Lines::Meeting] {
        let enter = |force: [f64; 3]| plane.enter(force, [0.01, 0.02, 0.0], lines, false);
        assert!(enter([0.1, 0.0, -1.0]).certain);
        assert!(!enter([0.1, 0.0, 1.0]).certain && !enter([1.0, 0.0, 0.0]).certain);
    }
}

/// Of a line that misses a capsule the gap is how far it passes its axis, less the radius.
#[test]
fn the_gap_of_a_capsule_is_the_distance_of_its_axis() {
    let mut random = Pcg64Mcg::seed_from_u64(15);
    let capsule = Capsule::new(v(0.1, -0.2, 0.3), v::<f64>(1.0, 2.0, 3.0), 0.3, 0.5).unwrap();
    let mut missed = 0;
    for _ in 0..500 {
        let mut vector = |size: f64| Vector3::<f64>::from_fn(|_, _| random.random_range(-size..size));
        let (force, through) = (vector(2.0), vector(1.5));
        let answer = capsule.enter(force.into(), through.cross(&force).into(), Lines::Any, false);
        let aside = |along: f64| {
            let from = capsule.centre() + capsule.axis() * along - through;
            from.cross(&force).norm() / force.norm()
        };
        let nearest = (-5000..=5000).map(|k| aside(f64::from(k) * 1e-4)).fold(f64::INFINITY, f64::min);
        if nearest > 0.301 {
            missed += 1;
            assert!((answer.gap - (nearest - 0.3)).abs() < 1e-6, "{} {nearest}", answer.gap);
        } else if nearest < 0.299 {
            assert_eq!(answer.gap, 0.0);
        }
    }
    assert!(missed > 100, "{missed}");
}
