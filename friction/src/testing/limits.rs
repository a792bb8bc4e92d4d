//! Laws of every friction limit.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

use super::models::{check_bad_input, check_model};
use super::{Claims, Draws};
use crate::FrictionLimit;

/// Runs every law of a friction limit on `count` draws, those of [`model_laws`](super::model_laws) included. `norm` is
/// the length of a change of the contact force in the norm that the model states for its margin.
///
/// # Panics
/// Where a law is broken.
pub fn friction_laws<T: Real>(
    model: &impl FrictionLimit<T>,
    claims: &Claims<T>,
    norm: impl Fn(&ContactForce<T>) -> T,
    count: usize,
) {
    let mut draws = Draws::new(count as u64);
    let close = |a: T, b: T, size: T| (a - b).abs() <= claims.tolerance * size;
    for _ in 0..count {
        let force: ContactForce<T> = draws.force(claims.arm);
        let other: ContactForce<T> = draws.force(claims.arm);
        let size = norm(&force) + norm(&other) + T::LEAST_NORMAL;
        let margin = model.slip_margin(&force);

        // Membership.
        let sure = margin.newtons.abs() > claims.tolerance * size;
        assert!(!sure || model.holds(&force) == (margin.newtons > T::zero()), "sign: {force:?} {margin:?}");
        check_model(model, claims, [&force, &other], size, &mut draws);

        // Symmetry under reversal of the load.
        let reversed = ContactForce::new(force.normal, -*force.tangential, -force.spin);
        let back = model.slip_margin(&reversed);
        assert!(close(back.newtons, margin.newtons, size), "symmetry: {force:?} {margin:?} {back:?}");

        if claims.homogeneous {
            let step = norm(&ContactForce {
                normal: other.normal - force.normal,
                tangential: (*other.tangential - *force.tangential).into(),
                spin: other.spin - force.spin,
            });
            let change = (model.slip_margin(&other).newtons - margin.newtons).abs();
            assert!(
                change <= step + claims.tolerance * size,
                "distance is 1-Lipschitz: {force:?} {other:?}: {change:?} over {step:?}"
            );
        }

        check_projection(model, claims, &norm, &force, size);
        check_normal_forces(model, claims, &force, size);
        check_direction(model, claims, &force, &other, size);
    }
    check_bad_input(model);
    check_bad_shape_input(model);
}

fn check_projection<T: Real>(
    model: &impl FrictionLimit<T>,
    claims: &Claims<T>,
    norm: &impl Fn(&ContactForce<T>) -> T,
    force: &ContactForce<T>,
    size: T,
) {
    let projected = model.project(force);
    let there = model.slip_margin(&projected);
    assert!(
        there.newtons >= -claims.tolerance * size,
        "projection holds: {force:?} to {projected:?} {there:?}"
    );
    let spinless = claims.arm == T::zero();
    let step = norm(&ContactForce {
        normal: projected.normal - force.normal,
        tangential: (*projected.tangential - *force.tangential).into(),
        spin: if spinless { T::zero() } else { projected.spin - force.spin },
    });
    let wanted = (-model.slip_margin(force).newtons).max(T::zero());
    if claims.homogeneous {
        // The angle of a projection is known to the root of the tolerance only.
        let bound = claims.tolerance.root() * wanted + claims.tolerance * size;
        assert!(
            (step - wanted).abs() <= bound,
            "projection is nearest: {force:?} to {projected:?}, {step:?} against {wanted:?}"
        );
    }
    if model.holds(force) {
        assert!(step <= claims.tolerance * size, "projection keeps what holds: {force:?} {projected:?}");
    }
}

fn check_normal_forces<T: Real>(
    model: &impl FrictionLimit<T>,
    claims: &Claims<T>,
    force: &ContactForce<T>,
    size: T,
) {
    let safety = T::literal(1.5);
    let least = model.least_normal_force(force, safety);
    let there = model.slip_margin(&ContactForce { normal: least, ..*force });
    if least > claims.tolerance * size {
        assert!(
            close_to(there.utilisation * safety, T::one(), claims.tolerance * T::literal(16.0)),
            "least normal force uses 1/safety: {force:?} {least:?} {there:?}"
        );
    }
    let margin = T::literal(0.25);
    let keeping = model.normal_force_keeping(force, margin);
    let there = model.slip_margin(&ContactForce { normal: keeping, ..*force });
    assert!(
        there.newtons >= margin - claims.tolerance * (size + keeping),
        "normal force keeps the margin: {force:?} {keeping:?} {there:?}"
    );
    assert!(
        !claims.homogeneous || there.newtons <= margin + claims.tolerance * (size + keeping),
        "normal force is the least to keep the margin: {force:?} {keeping:?} {there:?}"
    );
    let below = model.slip_margin(&ContactForce { normal: keeping * T::literal(0.9), ..*force });
    assert!(
        below.newtons < margin + claims.tolerance * size,
        "normal force is the least to keep the margin: {force:?} {keeping:?} {below:?}"
    );
}

fn check_direction<T: Real>(
    model: &impl FrictionLimit<T>,
    claims: &Claims<T>,
    force: &ContactForce<T>,
    other: &ContactForce<T>,
    size: T,
) {
    let Some(direction) = model.slip_direction(force) else {
        let unloaded = force.tangential_magnitude() <= T::zero() && (claims.arm * force.spin).is_zero();
        assert!(unloaded, "a load has a direction of slip: {force:?}");
        return;
    };
    let spin = claims.arm * direction.spin;
    let length = (direction.velocity.norm_squared() + spin * spin).root();
    assert!(close_to(length, T::one(), claims.tolerance), "direction of slip is unit: {direction:?}");
    let power = |f: &ContactForce<T>| f.tangential.dot(&direction.velocity) + f.spin * direction.spin;
    assert!(power(force) <= T::zero(), "friction opposes slip: {force:?} {direction:?}");
    // Maximum dissipation, at one normal force: no other force that holds there takes more power.
    if claims.convex {
        let used =
            |f: &ContactForce<T>| model.slip_margin(&ContactForce { normal: T::one(), ..*f }).utilisation;
        let (own, others) = (used(force), used(other));
        if own > T::literal(1e-3) && others > T::literal(1e-3) {
            let (own, others) = (power(force) / own, power(other) / others);
            assert!(
                own <= others + claims.tolerance.root() * claims.tolerance.root() * size * T::literal(64.0),
                "maximum dissipation: {force:?} {other:?}: {own:?} {others:?}"
            );
        }
    }
}

fn check_bad_shape_input<T: Real>(model: &impl FrictionLimit<T>) {
    let nan = T::zero() / T::zero();
    let bad = [nan, T::one() / T::zero(), -T::one() / T::zero()];
    let good = ContactForce::new(T::one(), Vector3::x(), T::zero());
    for value in bad {
        for force in [
            ContactForce { normal: value, ..good },
            ContactForce { tangential: Vector3::new(T::zero(), value, T::zero()).into(), ..good },
        ] {
            assert!(model.project(&force).is_finite(), "finite: {force:?}");
            if let Some(direction) = model.slip_direction(&force) {
                let finite = direction.velocity.iter().all(|x| x.is_number()) && direction.spin.is_number();
                assert!(finite, "finite: {force:?} {direction:?}");
            }
        }
    }
    for value in [T::zero(), T::LEAST_NORMAL, T::GREATEST] {
        for normal in [value, -value, T::one()] {
            let force = ContactForce::new(normal, Vector3::new(value, -value, T::zero()), value);
            assert!(model.project(&force).is_finite(), "finite: {force:?}");
        }
    }
}

fn close_to<T: Real>(a: T, b: T, tolerance: T) -> bool {
    (a - b).abs() <= tolerance
}
