//! Answers know no unit of force.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_wrench::{Real, Wrench};

use crate::common;
use crate::wrenches::Random;

/// A force that is measured in units of a power of two gives the same place and normal, and a spin torque in the
/// same units: to the last bit where the wrench is scaled first (`loose` is zero), to some where that would cost
/// more than the contact.
fn check<T: Real, S: SoftFingerSurface<T>>(
    name: &str,
    surface: &S,
    reach: f64,
    powers: [i32; 2],
    rounds: u32,
    loose: f64,
) {
    let model = SoftFinger::new(T::zero()).unwrap();
    let mut random = Random::new(29);
    let mut contacts = 0;
    for round in 0..rounds {
        let unit = T::literal(2_f64.powi(powers[(round % 2) as usize]));
        let through = random.direction() * random.uniform(0.0, reach);
        let force = random.direction();
        let spin = random.direction() * random.log_uniform(1e-6, 3.0) * reach;
        let (force, torque) = (force.map(T::literal), (through.cross(&force) + spin).map(T::literal));
        let ours = model.resolve(&Wrench::on_fingertip(force, torque), surface);
        let theirs = model.resolve(&Wrench::on_fingertip(force * unit, torque * unit), surface);
        let same = match (ours, theirs) {
            (Resolution::Contact(ours), Resolution::Contact(theirs)) => {
                contacts += 1;
                let flat = T::literal(loose) * T::EPSILON / ours.incidence();
                let size = T::literal(reach) + ours.point.amax();
                (ours.point - theirs.point).amax() <= flat * size
                    && (ours.normal - theirs.normal).amax() <= flat
                    && (ours.spin_torque * unit - theirs.spin_torque).abs() <= flat * size * unit
                    && ours.alternatives == theirs.alternatives
            }
            (
                Resolution::NoContact(NoContact::Misses { closest }),
                Resolution::NoContact(NoContact::Misses { closest: other }),
            ) => closest.map(|c| c.gap) == other.map(|c| c.gap),
            (Resolution::NoContact(ours), Resolution::NoContact(theirs)) => {
                core::mem::discriminant(&ours) == core::mem::discriminant(&theirs)
            }
            _ => false,
        };
        assert!(same, "{name} {unit}: {ours:?} {theirs:?}");
    }
    assert!(contacts > rounds / 5, "{name}: {contacts} of {rounds}");
}

macro_rules! units_test {
    ($($shape:ident, $reach:literal, $rounds:literal, $loose:literal;)*) => {$(
        #[test]
        fn $shape() {
            check::<f64, _>(stringify!($shape), &common::$shape::<f64>(), $reach, [300, -300], $rounds, $loose);
            check::<f32, _>(stringify!($shape), &common::$shape::<f32>(), $reach, [40, -40], $rounds, $loose);
        }
    )*};
}

units_test! {
    sphere, 0.013, 2000, 0.0;
    ellipsoid, 0.015, 2000, 16.0;
    plane, 0.01, 2000, 16.0;
    cylinder, 0.009, 2000, 16.0;
    elliptic_cylinder, 0.01, 2000, 0.0;
    cone, 0.01, 2000, 16.0;
    capsule, 0.01, 2000, 0.0;
    torus, 0.012, 300, 0.0;
    superquadric, 0.012, 300, 0.0;
    rounded_box, 0.012, 1000, 0.0;
    paraboloid, 0.01, 1000, 0.0;
    capped_cylinder, 0.01, 1000, 0.0;
    closed_elliptic_cylinder, 0.01, 1000, 0.0;
    frustum, 0.01, 1000, 0.0;
    spike, 0.01, 1000, 0.0;
    gel_tip, 0.01, 300, 0.0;
    heightfield, 0.01, 300, 0.0;
    mesh, 0.01, 300, 0.0;
    grown_ellipsoid, 0.015, 300, 0.0;
    compound, 0.01, 300, 0.0;
}
