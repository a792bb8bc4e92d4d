//! Every analytic Jacobian against dual numbers.

use fingertip_contact::{
    Contact, ContactCovariance, ContactJacobian, ContactModel, GeometrySensitivity, PointContact, SoftFinger,
    SoftFingerSurface,
};
use fingertip_surfaces::{ActiveSurface, Corner, DynSurface, SmoothSurface};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};
use num_dual::Dual64;

use crate::common;
use crate::wrenches::{Case, Random};

pub(crate) type Dual = Dual64;

pub(crate) fn lift(v: &Vector3<f64>) -> Vector3<Dual> {
    v.map(Dual::from_re)
}

/// The wrench with the derivative of its `axis`-th component switched on.
pub(crate) fn seeded(wrench: &Wrench<f64>, axis: Option<usize>) -> Wrench<Dual> {
    let mut components = wrench.components().map(Dual::from_re);
    if let Some(axis) = axis {
        components[axis].eps = 1.0;
    }
    Wrench::from_components(&components)
}

/// The derivative of the six local numbers, from a contact of dual numbers.
pub(crate) fn local(contact: &Contact<Dual>, tangents: &[Vector3<f64>; 2]) -> Vector6<f64> {
    let [e1, e2] = tangents;
    let change = contact.point.map(|x| x.eps);
    let (force, normal) = (contact.force, contact.normal);
    let pressing = -force.dot(&normal);
    let tangential = force + normal * pressing;
    let along = tangential.map(|x| x.eps);
    Vector6::new(
        change.dot(e1),
        change.dot(e2),
        pressing.eps,
        along.dot(e1),
        along.dot(e2),
        contact.spin_torque.eps,
    )
}

#[derive(Clone, Copy)]
pub(crate) enum Model {
    Point,
    Soft,
}

pub(crate) fn dual_contact<S: SoftFingerSurface<Dual> + SmoothSurface<Dual>>(
    model: Model,
    surface: &S,
    wrench: &Wrench<Dual>,
    near: &Vector3<f64>,
) -> Contact<Dual> {
    let near = lift(near);
    let resolution = match model {
        Model::Point => {
            PointContact::new(Dual::from_re(0.0)).unwrap().resolve_near(wrench, surface, Some(&near))
        }
        Model::Soft => {
            SoftFinger::new(Dual::from_re(0.0)).unwrap().resolve_near(wrench, surface, Some(&near))
        }
    };
    let contact = *resolution.contact().unwrap();
    let Model::Point = model else { return contact };
    // Bracketing finds the value but not its derivative: a Newton step along the line does. (Flat ends,
    // which are no part of the level function, are found in closed form.)
    let direction = contact.force.normalize();
    let level = surface.level(&contact.point);
    if (level.gradient.normalize() - contact.normal).norm().re > 1e-6 {
        return contact;
    }
    let point = contact.point - direction * (level.value / level.gradient.dot(&direction));
    Contact { point, normal: surface.level(&point).gradient.normalize(), ..contact }
}

pub(crate) fn contact_and_jacobian<S: SoftFingerSurface<f64> + SmoothSurface<f64>>(
    model: Model,
    surface: &S,
    case: &Case,
) -> (Contact<f64>, ContactJacobian<f64>) {
    let near = Some(&case.point);
    match model {
        Model::Point => {
            let contact = PointContact::new(0.0).unwrap().resolve_near(&case.wrench, surface, near);
            let contact = *contact.contact().unwrap();
            let bend = surface.shape_operator(&contact.point);
            (contact, ContactJacobian::of_point_contact(&contact, &case.wrench, &bend).unwrap())
        }
        Model::Soft => {
            let contact = SoftFinger::new(0.0).unwrap().without_friction_limit().resolve_near(
                &case.wrench,
                surface,
                near,
            );
            let contact = *contact.contact().unwrap();
            (contact, ContactJacobian::of_soft_finger_on(&contact, surface).unwrap())
        }
    }
}

/// A case with a moderate spin torque: none for a point contact on a surface that the line hits.
/// Not near the apex of a cone, where the curvature has no bound and takes digits with it, nor near a
/// fold, where two contacts merge and all derivatives grow without bound.
pub(crate) fn case<S: ActiveSurface<f64> + SmoothSurface<f64>>(
    random: &mut Random,
    surface: &S,
    size: f64,
    model: Model,
) -> Case {
    let greatest = match model {
        Model::Point => 1e-2,
        Model::Soft => 3.0,
    };
    loop {
        let case = Case::random(random, surface, size, [1e-4, greatest], 2.0);
        let bend = surface.shape_operator(&case.point);
        let curvature = (bend.trace().powi(2) - bend.norm_squared()) / 2.0;
        let pressing = case.wrench.force().dot(&case.normal);
        let index = case.spin.powi(2) * curvature + pressing.powi(2);
        let greatest = case.spin.powi(2) * bend.norm_squared() + pressing.powi(2);
        if case.incidence > 0.3 && bend.norm() * size < 8.0 && index.abs() > 0.02 * greatest {
            return case;
        }
    }
}

/// Greatest deviation, relative to the greatest entry of each row.
pub(crate) fn deviation(ours: &Matrix6<f64>, dual: &Matrix6<f64>) -> f64 {
    let of_row = |row: usize| (ours.row(row) - dual.row(row)).norm() / dual.row(row).amax().max(1e-3);
    Worst::of((0..6).map(of_row)).get()
}

fn by_wrench<S, D>(name: &str, surface: &S, dual: &D, size: f64, tolerance: f64)
where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    D: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
{
    for model in [Model::Point, Model::Soft] {
        let mut random = Random::new(23);
        let mut worst = Worst::new();
        for _ in 0..200 {
            let case = case(&mut random, surface, size, model);
            let (contact, jacobian) = contact_and_jacobian(model, surface, &case);
            let mut reference = Matrix6::zeros();
            for axis in 0..6 {
                let found = dual_contact(model, dual, &seeded(&case.wrench, Some(axis)), &contact.point);
                reference.set_column(axis, &local(&found, &jacobian.tangents()));
                // The point moves in the tangent plane.
                let change = found.point.map(|x| x.eps);
                assert!(change.dot(&contact.normal).abs() <= tolerance * change.norm().max(1e-3), "{name}");
                let whole = jacobian.point().column(axis) - change;
                assert!(
                    whole.norm() <= tolerance * change.norm().max(size),
                    "{name} {whole} {change} {case:?}"
                );
                let turned = jacobian.normal_change().column(axis) - found.normal.map(|x| x.eps);
                assert!(turned.norm() <= tolerance * 10.0 * (1.0 + change.norm() / size), "{name} {turned}");
            }
            worst.see(deviation(&jacobian.local(), &reference));
        }
        let worst = worst.get();
        let which = match model {
            Model::Point => "point",
            Model::Soft => "soft",
        };
        println!("{name:16} {which:5} ∂/∂(f, m) against dual numbers: {worst:.1e}");
        assert!(worst <= tolerance, "{name} {worst:e}");
    }
}

macro_rules! by_wrench {
    ($name:ident, $size:literal) => {
        #[test]
        fn $name() {
            by_wrench(stringify!($name), &common::$name::<f64>(), &common::$name::<Dual>(), $size, 1e-12);
        }
    };
}

/// Through [`DynSurface`], which is compiled once.
macro_rules! by_wrench_of_any {
    ($name:ident, $size:literal) => {
        #[test]
        fn $name() {
            let (surface, dual) =
                (DynSurface::from(common::$name::<f64>()), DynSurface::from(common::$name::<Dual>()));
            by_wrench(stringify!($name), &surface, &dual, $size, 1e-12);
        }
    };
}

by_wrench!(sphere, 0.017);
by_wrench!(ellipsoid, 0.017);
by_wrench!(plane, 0.017);
by_wrench!(cylinder, 0.017);
by_wrench!(elliptic_cylinder, 0.017);
by_wrench!(cone, 0.017);
by_wrench!(capsule, 0.017);
by_wrench!(paraboloid, 0.02);
by_wrench!(superquadric, 0.017);
by_wrench!(rounded_box, 0.017);
by_wrench!(pillow, 0.012);
by_wrench!(torus, 0.0135);
by_wrench_of_any!(disk, 0.013);
by_wrench_of_any!(rectangle, 0.013);
by_wrench_of_any!(spherical_cap, 0.017);
by_wrench_of_any!(capped_cylinder, 0.014);
by_wrench_of_any!(closed_elliptic_cylinder, 0.014);
by_wrench_of_any!(frustum, 0.014);
by_wrench_of_any!(revolution, 0.014);
by_wrench_of_any!(heightfield, 0.010);
by_wrench_of_any!(mesh, 0.012);
by_wrench_of_any!(posed, 0.014);
by_wrench_of_any!(trimmed, 0.017);
by_wrench!(compound, 0.020);
by_wrench!(grown_ellipsoid, 0.019);
by_wrench!(grown_cylinder, 0.017);
by_wrench!(dyn_surface, 0.020);

/// Under any wrench, on faces, edges and tips. Edges and tips have no shape operator: the point moves along
/// the edge or stays, and the normal turns.
pub(crate) fn wherever_it_touches<S, D>(name: &str, surface: &S, dual: &D, size: f64)
where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    D: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
{
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let mut random = Random::new(24);
    let (mut corners, mut faces, mut worst) = (0, 0, Worst::new());
    while corners + faces < 150 {
        let wrench = Wrench::on_fingertip(random.direction(), random.direction() * size);
        let Some(contact) = model.resolve(&wrench, surface).contact().copied() else { continue };
        let bend = surface.bend(&contact.point, &contact.normal, [&Vector3::x(), &Vector3::y()]);
        let is_corner = bend.sum().is_nan();
        // As the spin torque that holds a contact on an edge or the load on a face vanishes all derivatives
        // grow without bound, and so do the digits that both ways lose.
        let edge = surface.corner(&contact.point, &contact.normal);
        let held = match edge {
            Some(Corner::Edge { bend, .. }) if is_corner => contact.spin_torque.abs() * bend,
            _ if is_corner => contact.spin_torque.abs() / size,
            _ => contact.incidence(),
        };
        // Nor near the apex of a cone, where the curvature has no bound.
        let round = surface.shape_operator(&contact.point).norm() * size;
        if held < 0.3 || contact.incidence() < 0.1 || !is_corner && round > 8.0 {
            continue;
        }
        corners += usize::from(is_corner);
        faces += usize::from(!is_corner);
        let jacobian = ContactJacobian::of_soft_finger_on(&contact, surface).unwrap();
        let mut reference = Matrix6::zeros();
        for axis in 0..6 {
            let found = dual_contact(Model::Soft, dual, &seeded(&wrench, Some(axis)), &contact.point);
            reference.set_column(axis, &local(&found, &jacobian.tangents()));
            let change = found.point.map(|x| x.eps);
            let off = (jacobian.point().column(axis) - change).norm() / change.norm().max(size);
            let turned = (jacobian.normal_change().column(axis) - found.normal.map(|x| x.eps)).norm();
            assert!(off <= 1e-12 && turned * size <= 1e-12, "{name} {off:e} {turned:e}");
        }
        // The position across an edge is zero: both positions in units of the greater.
        let greatest =
            |row: usize| reference.rows(if row < 2 { 0 } else { row }, if row < 2 { 2 } else { 1 }).amax();
        for row in 0..6 {
            let off = (jacobian.local().row(row) - reference.row(row)).norm() / greatest(row).max(1e-3);
            assert!(off <= 1e-12, "{name} {row} {off:e}");
            worst.see(off);
        }
        // Noise of the wrench moves it along the edge only, or not at all.
        if is_corner {
            let covariance = ContactCovariance::soft_finger_position(&contact, surface, &Matrix6::identity());
            let position = covariance.unwrap();
            let straight = ContactCovariance::new(&jacobian, &Matrix6::identity()).position();
            assert!((position - straight).norm() <= 1e-13 * straight.norm(), "{position} {straight}");
            assert_eq!(position.m22, 0.0);
            assert!(matches!(edge, Some(Corner::Tip)) == (position.m11 == 0.0));
        }
    }
    let worst = worst.get();
    println!(
        "{name:26} ∂/∂(f, m) against dual numbers: {worst:.1e}, {corners} on edges and tips, {faces} on faces"
    );
    assert!(corners > 10 && faces > 10, "{name} {corners} {faces}");
}

#[test]
fn on_faces_edges_and_tips() {
    macro_rules! check {
        ($($shape:ident $size:literal),+) => {
            $(
                let (surface, dual) =
                    (DynSurface::from(common::$shape::<f64>()), DynSurface::from(common::$shape::<Dual>()));
                wherever_it_touches(stringify!($shape), &surface, &dual, $size);
            )+
        };
    }
    check!(
        capped_cylinder 0.014,
        closed_elliptic_cylinder 0.014,
        frustum 0.014,
        cone 0.010,
        mesh 0.012,
        heightfield 0.010,
        posed 0.014,
        dyn_surface 0.020
    );
    wherever_it_touches("compound", &common::compound::<f64>(), &common::compound::<Dual>(), 0.020);
}

/// A surface that moves as a whole: the contact answers as it does to the change of the surface at the
/// contact, point contact and soft finger.
#[test]
fn motions_are_changes_of_the_surface() {
    let surface = common::ellipsoid::<f64>();
    for model in [Model::Point, Model::Soft] {
        let mut random = Random::new(25);
        for _ in 0..200 {
            let case = case(&mut random, &surface, 0.017, model);
            let (contact, jacobian) = contact_and_jacobian(model, &surface, &case);
            let pivot = random.direction() * 0.02;
            let changes = GeometrySensitivity::rigid_motions(&surface, &contact.point, &pivot);
            for (index, change) in changes.iter().enumerate() {
                let axis: Vector3<f64> = Vector3::ith(index % 3, 1.0);
                let (shift, turn) =
                    if index < 3 { (axis, Vector3::zeros()) } else { (pivot.cross(&axis), axis) };
                let (answer, rise) = jacobian.answer_to_motion(&shift, &turn);
                let scale = 1.0 + jacobian.local().norm();
                let off = (answer - jacobian.answer_to(change)).norm();
                assert!(
                    off <= 1e-13 * scale && (rise - change.displacement).abs() < 1e-15,
                    "{index} {off:e}"
                );
            }
        }
    }
}

#[test]
fn agrees_with_the_position_sensitivity_of_a_contact() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(31);
    for _ in 0..300 {
        let case = case(&mut random, &surface, 0.017, Model::Point);
        let (contact, jacobian) = contact_and_jacobian(Model::Point, &surface, &case);
        let other = contact.sensitivity(&case.wrench).unwrap();
        assert!((jacobian.point() - other).norm() <= 1e-13 * other.norm());
    }
}

#[test]
fn spin_steadies_a_contact_on_a_sphere() {
    // ‖∂c/∂m‖ = 1/√(f_n² + (τ/R)²) (`docs/theory/contact.md#general-surfaces`).
    let surface = common::sphere::<f64>();
    let mut random = Random::new(37);
    for _ in 0..300 {
        let case = case(&mut random, &surface, 0.017, Model::Soft);
        let (contact, jacobian) = contact_and_jacobian(Model::Soft, &surface, &case);
        let by_torque = jacobian.local().fixed_view::<2, 3>(0, 3).into_owned();
        let squared = (by_torque * by_torque.transpose()).symmetric_eigenvalues().max();
        let expected = 1.0 / contact.normal_force().hypot(contact.spin_torque / surface.radius());
        assert!((squared.sqrt() / expected - 1.0).abs() < 1e-12);
    }
    assert!(Dual::literal(2.0).root().re.is_number());
}
