//! What the contact answers, of every shape, is held bit for bit.

/// The shapes in both precisions, as files have them: so every model is compiled once for all of them.
macro_rules! each_shape {
    ($do:ident, $unchanged:ident; $($shape:ident)*) => {$(
        let (name, double) = (stringify!($shape), DynSurface::from(common::$shape::<f64>()));
        $do(&mut $unchanged, &format!("{name} f64"), &double, &double);
        $do(&mut $unchanged, &format!("{name} f32"), &DynSurface::from(common::$shape::<f32>()), &double);
    )*};
}

mod draw;
mod over_time;

use fingertip_contact::batch::{BatchSurface, Lines};
use fingertip_contact::{
    Auto, Compliant, Contact, ContactBound, ContactCovariance, ContactJacobian, ContactModel, ConvexBound,
    GeometrySensitivity, GeometryUncertainty, Hertz, LinearStiffness, LocalHertz, PaperBounds, PointContact,
    PowerLaw, Resolution, SkinLaw, SoftFinger, SoftFingerSurface, Tabulated, WorstErrors, WrenchSpread,
    newton_soft_contacts,
};
use fingertip_surfaces::{DynSurface, SmoothSurface, Sphere};
use fingertip_test_support::Unchanged;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Vector3, Vector6};

use self::draw::{Draw, noise};
use crate::common;

type Double = DynSurface<f64>;

fn small_covariance<T: Real>() -> WrenchSpread<'static, T> {
    WrenchSpread::Isotropic { force: T::literal(4e-6), torque: T::literal(9e-10) }
}

/// All that can be said of how sure a contact is.
fn sureness<T: Real, S: SmoothSurface<T>>(
    contact: &Contact<T>,
    wrench: &Wrench<T>,
    surface: &S,
    soft: bool,
) -> impl core::fmt::Debug + use<T, S> {
    let bend = surface.shape_operator(&contact.point);
    let jacobian = if soft {
        ContactJacobian::of_soft_finger_on(contact, surface)
    } else {
        ContactJacobian::of_point_contact(contact, wrench, &bend)
    };
    let covariance = noise();
    let short = if soft {
        ContactCovariance::soft_finger_position(contact, surface, &covariance)
    } else {
        ContactCovariance::point_contact_position(contact, wrench, small_covariance())
    };
    let errors = Vector6::new(2e-3, 1e-3, 3e-3, 2e-5, 3e-5, 1e-5).map(T::literal);
    let of = jacobian.map(|jacobian| {
        let found = ContactCovariance::new(&jacobian, &covariance);
        let pivot = Vector3::new(0.001, -0.002, -0.02).map(T::literal);
        let motions = GeometrySensitivity::rigid_motions(surface, &contact.point, &pivot);
        let geometry = GeometryUncertainty {
            offset: T::literal(4e-10),
            position: Matrix3::identity() * T::literal(1e-10),
            attitude: Matrix3::identity() * T::literal(4e-6),
            pivot,
        };
        let with = found.with_geometry(&jacobian, &geometry);
        (
            (jacobian.worst_case(&errors), jacobian.normal_change(), jacobian.height()),
            motions.map(|motion| jacobian.answer_to(&motion)),
            (with, found.point(), found.height_variance()),
            (found.ellipse(T::literal(0.95)), found.normal_and_tangential(contact)),
        )
    });
    (of, short)
}

fn resolved<T: Real, S: SmoothSurface<T>>(
    resolution: Resolution<T>,
    wrench: &Wrench<T>,
    surface: &S,
    soft: bool,
) -> (Resolution<T>, impl core::fmt::Debug + use<T, S>) {
    let sure = resolution.contact().map(|contact| sureness(contact, wrench, surface, soft));
    (resolution, sure)
}

/// Every model on one shape, with the loads drawn on its twin in double precision.
fn of_shape<T: Real, S>(unchanged: &mut Unchanged, name: &str, surface: &S, double: &Double, count: usize)
where
    S: SoftFingerSurface<T> + SmoothSurface<T>,
{
    let number = T::literal;
    let size = 0.015;
    let mut draw = Draw::new(17);
    let mut loads = Vec::new();
    for kind in 0..count {
        let [force, torque, point] = draw.load(double, kind, size);
        let strength = [1.0, 0.03, 1e-9, 1e9][kind / 8 % 4];
        let wrench = Wrench::on_fingertip((force * strength).map(number), (torque * strength).map(number));
        let last = (kind / 4 % 3 == 1).then(|| (point + draw.vector() * 0.002).map(number));
        loads.push((wrench, last));
    }
    let point = PointContact::new(T::zero()).unwrap();
    let gap = point.with_greatest_gap(number(0.002)).unwrap().with_greatest_friction(number(1.5)).unwrap();
    let soft = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    let bound = SoftFinger::new(number(1e-3)).unwrap();
    let bound = bound.with_greatest_friction(number(2.0)).unwrap().with_torque_arm(number(0.004)).unwrap();
    let auto = Auto::new(point, soft, noise()).unwrap();
    let strict = auto.with_threshold(number(2.7)).unwrap();
    let strict = strict.with_greatest_pitch(number(0.003), number(2.0)).unwrap();

    let each = || loads.iter();
    unchanged.note(
        &format!("{name} point"),
        each().map(|(wrench, last)| {
            let found = point.resolve_near(wrench, surface, last.as_ref());
            resolved(found, wrench, surface, false)
        }),
    );
    unchanged.note(
        &format!("{name} soft"),
        each().map(|(wrench, last)| {
            let found = soft.resolve_near(wrench, surface, last.as_ref());
            resolved(found, wrench, surface, true)
        }),
    );
    unchanged.note(
        &format!("{name} limited"),
        each().map(|(wrench, last)| {
            let mut all = Vec::new();
            let visited = point.candidates(wrench, surface, |contact| all.push(contact));
            let gap = gap.resolve_near(wrench, surface, last.as_ref());
            (gap, bound.resolve_near(wrench, surface, last.as_ref()), all, format!("{visited:?}"))
        }),
    );
    unchanged.note(
        &format!("{name} auto"),
        each().map(|(wrench, last)| {
            let found = strict.resolve_with_test(wrench, surface, last.as_ref());
            (found, auto.resolve_near(wrench, surface, last.as_ref()))
        }),
    );
    unchanged.note(
        &format!("{name} patches"),
        each().take(count / 4).map(|(wrench, last)| {
            let mut all = Vec::new();
            let search = surface.soft_contacts(wrench, last.as_ref(), |contact| all.push(contact));
            let at = all.first().map_or_else(Vector3::zeros, |contact| contact.point);
            let sensitivities: Vec<_> = (0..4).map(|size| surface.sensitivity(size, &at)).collect();
            let mut newton = Vec::new();
            let searched =
                newton_soft_contacts(surface, wrench, last.as_ref(), |contact| newton.push(contact));
            (search, all, surface.patch(&at), sensitivities, searched, newton)
        }),
    );
}

fn skins<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    let number = T::literal;
    let hertz = Hertz::new([number(0.013), number(0.02)], number(2e5)).unwrap();
    let local = LocalHertz::new(number(2e5), number(5.0), number(0.05)).unwrap();
    let power = PowerLaw::new([number(1e-3), number(0.3)], [number(2e-4), number(0.7)]).unwrap();
    let points = [[0.1, 4e-4, 3e-5], [0.5, 1e-3, 1e-4], [2.0, 2e-3, 3e-4], [5.0, 3e-3, 4e-4]];
    let table = Tabulated::new(points.map(|row| row.map(number))).unwrap();
    let linear = LinearStiffness::new(number(1e4), number(0.013)).unwrap();
    skin(unchanged, &format!("{name} hertz"), surface, double, hertz);
    skin(unchanged, &format!("{name} local hertz"), surface, double, local);
    skin(unchanged, &format!("{name} power"), surface, double, power);
    skin(unchanged, &format!("{name} table"), surface, double, table);
    skin(unchanged, &format!("{name} linear"), surface, double, linear);
}

fn skin<T: Real, L: SkinLaw<T, DynSurface<T>> + Clone>(
    unchanged: &mut Unchanged,
    name: &str,
    surface: &DynSurface<T>,
    double: &Double,
    law: L,
) {
    let mut draw = Draw::new(23);
    let hard = Compliant::new(PointContact::new(T::literal(1e-4)).unwrap(), law.clone());
    let soft = Compliant::new(SoftFinger::new(T::literal(1e-4)).unwrap(), law);
    let soft = soft.with_share(T::literal(0.7)).unwrap();
    let answers = (0..160).map(|kind| {
        let [force, torque, _] = draw.load(double, kind, 0.015);
        let strength = [0.01, 0.4, 3.0, 20.0][kind / 8 % 4];
        let wrench =
            Wrench::on_fingertip((force * strength).map(T::literal), (torque * strength).map(T::literal));
        let [one, other] =
            [hard.resolve_indented(&wrench, surface, None), soft.resolve_indented(&wrench, surface, None)];
        let one =
            one.map(|found| (hard.slope(&found, surface), hard.jacobian(&found, &wrench, surface), found));
        let other = other.map(|found| (soft.slope(&found, surface), soft.jacobian(&found, surface), found));
        (one, other)
    });
    unchanged.note(name, answers);
}

fn bounds<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    let mut draw = Draw::new(31);
    let model = PointContact::new(T::zero()).unwrap();
    let answers = (0..200).map(|kind| {
        let [force, torque, _] = draw.load(double, [0, 2, 5][kind % 3], 0.015);
        let wrench = Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal));
        let [of_force, of_torque] = [1e-3, 1e-5].map(|size| T::literal(size * draw.small(1e-9)));
        let errors = WorstErrors::of_wrench(of_force, of_torque);
        let large = WorstErrors { radius: T::literal(2e-4), centre: T::literal(1e-4), ..errors };
        let ball =
            Sphere::new(Vector3::new(0.001, -0.002, 0.003).map(T::literal), T::literal(0.013)).unwrap();
        let of_sphere = ContactBound::on_sphere(&ball, &wrench, &errors)
            .map(|bound| (ContactBound::on_sphere(&ball, &wrench, &large), bound));
        let of_convex = match model.resolve(&wrench, surface) {
            Resolution::Contact(contact) => {
                let first = contact.first_order_bound(of_force, of_torque);
                let spread = (contact.sensitivity(&wrench), contact.covariance(&wrench, &noise()));
                let sure = [
                    ConvexBound::new(surface, &wrench, &errors, T::literal(0.05)),
                    ConvexBound::new(surface, &wrench, &large, T::literal(0.05)),
                ];
                Some((first, spread, sure))
            }
            Resolution::NoContact(_) => None,
        };
        let paper = PaperBounds::new(T::literal(0.013), of_force).unwrap();
        let (f, m) = (wrench.force(), wrench.torque());
        let paper = (paper.contact(&f, &m), paper.central_contact(&f), paper.central_contact_sharp(&f));
        (of_sphere, of_convex, paper)
    });
    unchanged.note(name, answers);
}

fn cheap<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    of_shape(unchanged, name, surface, double, 400);
}

fn dear<T: Real>(unchanged: &mut Unchanged, name: &str, surface: &DynSurface<T>, double: &Double) {
    of_shape(unchanged, name, surface, double, 200);
}

#[test]
fn of_every_shape() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/shapes.txt");
    each_shape!(cheap, unchanged; sphere ellipsoid plane cylinder elliptic_cylinder cone capsule paraboloid disk
        rectangle spherical_cap capped_cylinder closed_elliptic_cylinder frustum spike posed trimmed);
    each_shape!(dear, unchanged; torus superquadric rounded_box revolution heightfield mesh dyn_surface);
    let grown = common::grown_ellipsoid::<f64>();
    of_shape(&mut unchanged, "grown_ellipsoid f64", &grown, &common::ellipsoid().into(), 200);
    unchanged.check();
}

#[test]
fn through_skins() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/skins.txt");
    each_shape!(skins, unchanged; sphere ellipsoid cylinder capsule torus);
    unchanged.check();
}

#[test]
fn bounds_of_contacts() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/bounds.txt");
    each_shape!(bounds, unchanged; sphere ellipsoid capsule capped_cylinder rounded_box mesh);
    unchanged.check();
}

/// Lines of a batch, whether they meet or miss, of both kinds of loops.
#[test]
fn of_batches() {
    fn batch<T: Real>(
        unchanged: &mut Unchanged,
        name: &str,
        surface: &impl BatchSurface<T>,
        double: &Double,
    ) {
        let mut draw = Draw::new(37);
        let answers = (0..600).map(|kind| {
            let [force, torque, _] = draw.load(double, kind, 0.015);
            let strength = [1.0, 1e-3, 1e5, 1e-9][kind / 8 % 4];
            let [force, torque] = [force, torque].map(|v| [v.x, v.y, v.z].map(|x| T::literal(x * strength)));
            [Lines::Any, Lines::Meeting]
                .map(|lines| surface.enter(force, torque, lines, surface.is_at_origin()))
        });
        unchanged.note(name, answers);
    }
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/batches.txt");
    macro_rules! each {
        ($($shape:ident)*) => {$(
            let (name, double) = (stringify!($shape), common::$shape::<f64>());
            batch(&mut unchanged, &format!("{name} f64"), &double, &double.into());
            batch(&mut unchanged, &format!("{name} f32"), &common::$shape::<f32>(), &double.into());
        )*};
    }
    each!(sphere ellipsoid plane);
    unchanged.check();
}
