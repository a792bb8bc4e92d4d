//! The Jacobians of contacts through a skin, against dual numbers.

use fingertip_contact::{
    Compliant, CompliantContact, CompliantPointContact, CompliantSoftFinger, Contact, ContactJacobian,
    ContactModel, GeometrySensitivity, Hertz, Indentation, LinearStiffness, LocalHertz, PointContact,
    PowerLaw, SkinLaw, SoftFinger, SoftFingerSurface, Tabulated,
};
use fingertip_surfaces::{DynSurface, Ellipsoid, SmoothSurface, Sphere};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::common;
use crate::jacobians::{Dual, deviation, lift, local, seeded};
use crate::parameters::{on, sizes};
use crate::wrenches::Random;

/// A wrench of a contact at the place where a skin touches under it.
pub(crate) fn wrench_through<S, L>(
    random: &mut Random,
    surface: &S,
    law: &L,
    share: f64,
    spin: f64,
) -> Wrench<f64>
where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    L: SkinLaw<f64, S>,
{
    loop {
        let (point, normal) = random.place(surface, 0.017);
        let size = random.log_uniform(0.05, 20.0);
        let force = random.force(&normal, 0.6, size);
        let above =
            Contact { point, normal, force, spin_torque: 0.0, gap: 0.0, alternatives: 0, searched: false };
        let depth = law.indentation_at(surface, &above, -force.dot(&normal)).depth * share;
        // Not as deep as the tip of a cone is round, or an edge is near; nor near a fold, where two contacts
        // merge and all derivatives grow without bound.
        let (e1, e2) = (normal.cross(&force).normalize(), force.normalize());
        let smooth = [e1, -e1, e2, -e2].iter().all(|e| {
            let aside = (e - normal * e.dot(&normal)).normalize() * (depth * 3.0);
            surface.normal(&(point + aside)).dot(&normal) > 0.5
        });
        let bend = surface.shape_operator(&point);
        let torque = spin * force.norm() * 0.013 * random.uniform(-1.0, 1.0);
        let curvature = (bend.trace().powi(2) - bend.norm_squared()) / 2.0;
        let pressing = force.dot(&normal);
        let index = torque.powi(2) * curvature + pressing.powi(2);
        let greatest = torque.powi(2) * bend.norm_squared() + pressing.powi(2);
        if smooth && bend.norm() * depth < 0.3 && index > 0.1 * greatest {
            return Wrench::on_fingertip(force, (point - normal * depth).cross(&force) + normal * torque);
        }
    }
}

/// The derivative of the contact, by the fixed point of `shift = δ n` itself: from the contact that is
/// known, each turn of it brings the derivative nearer by the factor by which it contracts.
fn by_fixed_point<M, L, S>(
    rigid: &M,
    law: &L,
    share: f64,
    surface: &S,
    wrench: &Wrench<Dual>,
    found: &CompliantContact<f64>,
) -> Contact<Dual>
where
    M: ContactModel<Dual, S>,
    L: SkinLaw<Dual, S>,
    S: SmoothSurface<Dual>,
{
    let near = lift(&found.undeformed);
    let mut shift = lift(&(found.undeformed - found.contact.point));
    let mut last = None;
    for _ in 0..50 {
        let torque = wrench.torque() + shift.cross(&wrench.force());
        let effective = Wrench::on_fingertip(wrench.force(), torque);
        let contact = *rigid.resolve_near(&effective, surface, Some(&near)).contact().unwrap();
        let depth =
            law.indentation_at(surface, &contact, contact.normal_force()).depth * Dual::from_re(share);
        shift = contact.normal * depth;
        last = Some(Contact { point: contact.point - shift, ..contact });
    }
    last.unwrap()
}

pub(crate) enum Model<L> {
    Point(CompliantPointContact<f64, L>),
    Soft(CompliantSoftFinger<f64, L>),
}

impl<L: Copy> Model<L> {
    pub(crate) fn both(law: L, share: f64) -> [Self; 2] {
        [
            Self::Point(Compliant::new(PointContact::new(0.0).unwrap(), law).with_share(share).unwrap()),
            Self::Soft(
                Compliant::new(SoftFinger::new(0.0).unwrap().without_friction_limit(), law)
                    .with_share(share)
                    .unwrap(),
            ),
        ]
    }

    pub(crate) fn spin(&self) -> f64 {
        match self {
            Self::Point(_) => 0.01,
            Self::Soft(_) => 1.0,
        }
    }

    pub(crate) fn found<S>(&self, wrench: &Wrench<f64>, surface: &S) -> CompliantContact<f64>
    where
        L: SkinLaw<f64, S>,
        S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    {
        match self {
            Self::Point(model) => model.resolve_indented(wrench, surface, None),
            Self::Soft(model) => model.resolve_indented(wrench, surface, None),
        }
        .unwrap()
    }

    pub(crate) fn jacobian<S>(
        &self,
        found: &CompliantContact<f64>,
        wrench: &Wrench<f64>,
        surface: &S,
    ) -> ContactJacobian<f64>
    where
        L: SkinLaw<f64, S>,
        S: SmoothSurface<f64>,
    {
        match self {
            Self::Point(model) => model.jacobian(found, wrench, surface),
            Self::Soft(model) => model.jacobian(found, surface),
        }
        .unwrap()
    }

    pub(crate) fn dual<S, D>(
        &self,
        law: &D,
        share: f64,
        surface: &S,
        wrench: &Wrench<Dual>,
        found: &CompliantContact<f64>,
    ) -> Contact<Dual>
    where
        D: SkinLaw<Dual, S>,
        S: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
    {
        let zero = Dual::from_re(0.0);
        match self {
            Self::Point(_) => {
                by_fixed_point(&PointContact::new(zero).unwrap(), law, share, surface, wrench, found)
            }
            Self::Soft(_) => {
                by_fixed_point(&SoftFinger::new(zero).unwrap(), law, share, surface, wrench, found)
            }
        }
    }
}

pub(crate) fn through<S, D, L, M>(
    name: &str,
    (surface, dual): (&S, &D),
    (law, dual_law): (L, M),
    tolerance: f64,
) where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    D: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
    L: SkinLaw<f64, S> + Copy,
    M: SkinLaw<Dual, D>,
{
    let share = 0.9;
    let mut random = Random::new(101);
    let mut worst = [Worst::new(); 2];
    for (model, worst) in Model::both(law, share).iter().zip(&mut worst) {
        for _ in 0..20 {
            let wrench = wrench_through(&mut random, surface, &law, share, model.spin());
            let found = model.found(&wrench, surface);
            let jacobian = model.jacobian(&found, &wrench, surface);
            let mut reference = Matrix6::zeros();
            for axis in 0..6 {
                let moved = model.dual(&dual_law, share, dual, &seeded(&wrench, Some(axis)), &found);
                reference.set_column(axis, &local(&moved, &jacobian.tangents()));
                let change = moved.point.map(|x| x.eps);
                let off = jacobian.point().column(axis) - change;
                let rise = change.dot(&found.contact.normal) - jacobian.height()[axis];
                let deviation = off.norm().hypot(rise) / change.norm().max(1e-2);
                assert!(deviation <= tolerance, "{name} {deviation:e}");
            }
            worst.see(deviation(&jacobian.local(), &reference));
        }
    }
    let worst = worst.map(Worst::get);
    println!(
        "{name:24} through a skin, ∂/∂(f, m) against dual numbers: point {:.1e}, soft {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst.iter().all(|worst| *worst <= tolerance), "{name} {worst:?}");
}

pub(crate) fn spring<T: Real>() -> LinearStiffness<T> {
    LinearStiffness::new(T::literal(8000.0), T::literal(0.013)).unwrap()
}

pub(crate) fn hertz<T: Real>() -> Hertz<T> {
    Hertz::new([T::literal(0.013), T::literal(0.009)], T::literal(2e6)).unwrap()
}

pub(crate) fn power<T: Real>() -> PowerLaw<T> {
    PowerLaw::new([0.003, 0.25].map(T::literal), [0.0005, 0.4].map(T::literal)).unwrap()
}

pub(crate) fn table<T: Real>() -> Tabulated<T, [[T; 3]; 3]> {
    Tabulated::new(
        [[1.0, 0.0004, 0.002], [5.0, 0.0009, 0.004], [20.0, 0.0016, 0.005]]
            .map(|point| point.map(T::literal)),
    )
    .unwrap()
}

#[test]
fn by_wrench() {
    macro_rules! through {
        ($shape:ident, $law:ident) => {
            through(
                concat!(stringify!($shape), ", ", stringify!($law)),
                (&DynSurface::from(common::$shape::<f64>()), &DynSurface::from(common::$shape::<Dual>())),
                ($law::<f64>(), $law::<Dual>()),
                1e-12,
            );
        };
    }
    through!(sphere, spring);
    through!(ellipsoid, spring);
    through!(ellipsoid, hertz);
    through!(cylinder, power);
    through!(capsule, hertz);
    through!(plane, table);
    through!(cone, power);
    through!(paraboloid, hertz);
    through!(superquadric, hertz);
    through!(capped_cylinder, spring);
    through!(torus, table);
    through!(posed, hertz);
}

/// Of a law that knows its slopes from differences, against differences of fourth order of the contact:
/// both are good for two thirds of the digits.
pub(crate) fn through_by_differences<S, L>(name: &str, surface: &S, law: L)
where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    L: SkinLaw<f64, S> + Copy,
{
    let mut random = Random::new(103);
    let mut worst = Worst::new();
    for model in &Model::both(law, 0.9) {
        for _ in 0..25 {
            let wrench = wrench_through(&mut random, surface, &law, 0.9, model.spin());
            let found = model.found(&wrench, surface);
            let jacobian = model.jacobian(&found, &wrench, surface);
            let size = Vector6::new(1.0, 1.0, 1.0, 0.013, 0.013, 0.013) * (wrench.force().norm() * 2e-4);
            for axis in 0..6 {
                let at = |steps: f64| {
                    let mut moved = wrench.components();
                    moved[axis] += steps * size[axis];
                    model.found(&Wrench::from_components(&moved), surface).contact.point
                };
                let slope = ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * size[axis]);
                let off = (jacobian.point().column(axis) - slope).norm();
                assert!(off <= 1e-8 * slope.norm().max(1e-2), "{name} {off:e} {slope}");
                worst.see(off / slope.norm().max(1e-2));
            }
        }
    }
    let worst = worst.get();
    println!("{name:24} through a skin, ∂c/∂(f, m) against differences: {worst:.1e}");
}

/// A law whose slope is left to differences.
#[derive(Clone, Copy)]
pub(crate) struct Plain<L>(L);

impl<S, L: SkinLaw<f64, S>> SkinLaw<f64, S> for Plain<L> {
    fn indentation_at(&self, surface: &S, contact: &Contact<f64>, normal_force: f64) -> Indentation<f64> {
        self.0.indentation_at(surface, contact, normal_force)
    }
}

#[test]
fn by_wrench_where_slopes_are_differences() {
    let local = LocalHertz::new(2e6, 0.0, 0.1).unwrap();
    through_by_differences("ellipsoid, local Hertz", &common::ellipsoid::<f64>(), local);
    through_by_differences("paraboloid, local Hertz", &common::paraboloid::<f64>(), local);
    through_by_differences("ellipsoid, plain Hertz", &common::ellipsoid::<f64>(), Plain(hertz::<f64>()));
}

/// Sizes and place of the undeformed surface.
fn by_parameter<S, D, const P: usize>(
    name: &str,
    surface: &S,
    sensitivities: impl Fn(&Vector3<f64>) -> [GeometrySensitivity<f64>; P],
    dual: impl Fn(usize) -> D,
) where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    D: SoftFingerSurface<Dual> + SmoothSurface<Dual>,
{
    let mut random = Random::new(107);
    let mut worst = Worst::new();
    for model in &Model::both(hertz::<f64>(), 0.9) {
        for _ in 0..40 {
            let wrench = wrench_through(&mut random, surface, &hertz::<f64>(), 0.9, model.spin());
            let found = model.found(&wrench, surface);
            let jacobian = model.jacobian(&found, &wrench, surface);
            for (index, change) in sensitivities(&found.undeformed).iter().enumerate() {
                let change = jacobian.of_deformed(change);
                let moved = model.dual(&hertz::<Dual>(), 0.9, &dual(index), &seeded(&wrench, None), &found);
                let reference = local(&moved, &jacobian.tangents());
                let force = wrench.force().norm() / 0.013;
                let scale = Vector6::new(1.0, 1.0, force, force, force, force * 0.013);
                let off = (jacobian.answer_to(&change) - reference).component_div(&scale).norm();
                let point = jacobian.point_answer_to(&change) - moved.point.map(|x| x.eps);
                assert!(off.hypot(point.norm()) <= 1e-12, "{name} {index} {off:e} {point}");
                worst.see(off.hypot(point.norm()));
            }
        }
    }
    let worst = worst.get();
    println!("{name:24} through a skin, ∂/∂θ against dual numbers: {worst:.1e}");
}

#[test]
fn by_geometry() {
    let sphere = common::sphere::<f64>();
    let (centre, radius) = (sphere.centre(), sphere.radius());
    by_parameter(
        "sphere",
        &sphere,
        |point| {
            let moved = GeometrySensitivity::rigid_motions(&sphere, point, &Vector3::zeros());
            [sphere.sensitivity(0, point).unwrap(), moved[0], moved[1], moved[2]]
        },
        |index| {
            let moved =
                Vector3::new(on(centre.x, index == 1), on(centre.y, index == 2), on(centre.z, index == 3));
            Sphere::new(moved, on(radius, index == 0)).unwrap()
        },
    );
    let ellipsoid = common::ellipsoid::<f64>();
    let axes = ellipsoid.semi_axes();
    by_parameter(
        "ellipsoid",
        &ellipsoid,
        |point| sizes::<3>(&ellipsoid, point),
        |index| {
            let axes = Vector3::from_fn(|k, _| on(axes[k], k == index));
            Ellipsoid::new(axes).unwrap()
        },
    );
}
