//! Laws of every friction model.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

use super::{Claims, Draws};
use crate::FrictionModel;

/// Runs every law of a plain friction model on `count` draws: no more margin and no less use of the limit under more
/// tangential load; a contact that does not press holds nothing; a least normal force that is none below zero, holds
/// with the wanted safety, and is the least that does; what is not finite has the least margin, and no NaN comes out.
/// What `claims` says of homogeneity and convexity is asked too.
///
/// [`friction_laws`](super::friction_laws) runs these as well, for a [`FrictionLimit`](crate::FrictionLimit).
///
/// ```
/// use fingertip_friction::SoftFingerLimit;
/// use fingertip_friction::testing::{Claims, model_laws};
///
/// let claims = Claims { homogeneous: true, convex: true, arm: 3e-3, tolerance: 1e-12 };
/// model_laws(&SoftFingerLimit::new(0.5, 3e-3)?, &claims, 100);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
///
/// # Panics
/// Where a law is broken.
pub fn model_laws<T: Real>(model: &dyn FrictionModel<T>, claims: &Claims<T>, count: usize) {
    let mut draws = Draws::new(count as u64);
    let size = |force: &ContactForce<T>| {
        let spin = if claims.arm > T::zero() { force.spin.abs() / claims.arm } else { T::zero() };
        force.normal.abs() + force.tangential_magnitude() + spin
    };
    for _ in 0..count {
        let (force, other) = (draws.force(claims.arm), draws.force(claims.arm));
        let size = size(&force) + size(&other) + T::LEAST_NORMAL;
        check_model(model, claims, [&force, &other], size, &mut draws);
    }
    check_bad_input(model);
}

/// The laws on one force, and on another where they compare; errors are counted in `size`.
pub(super) fn check_model<T: Real>(
    model: &dyn FrictionModel<T>,
    claims: &Claims<T>,
    [force, other]: [&ContactForce<T>; 2],
    size: T,
    draws: &mut Draws,
) {
    let margin = model.slip_margin(force);
    assert!(model.slip_margin(force) == margin, "the same force, the same answer: {force:?} {margin:?}");
    if force.normal <= T::zero() {
        let used = margin.utilisation >= T::GREATEST || force.tangential_magnitude().is_zero();
        assert!(
            used && margin.newtons <= T::zero(),
            "a contact that does not press holds nothing: {force:?} {margin:?}"
        );
    }
    let sure = margin.newtons.abs() > claims.tolerance * size;
    assert!(
        margin.utilisation >= T::zero()
            && (!sure || (margin.utilisation < T::one()) == (margin.newtons > T::zero())),
        "utilisation: {force:?} {margin:?}"
    );

    let growth = T::literal(1.0 + 3.0 * draws.share());
    let grown = ContactForce { normal: force.normal, ..scaled(force, growth) };
    let strained = model.slip_margin(&grown);
    assert!(
        strained.newtons <= margin.newtons + claims.tolerance * size * growth
            && strained.utilisation >= margin.utilisation * (T::one() - claims.tolerance),
        "more load, less margin: {force:?} {margin:?}, times {growth:?} {strained:?}"
    );

    check_least_normal_force(model, claims, [force, &grown], size);
    if claims.homogeneous {
        for exponent in [-40.0, 0.3, 40.0] {
            let factor = T::literal(libm::exp2(exponent));
            let far = model.slip_margin(&scaled(force, factor));
            let wanted = margin.newtons * factor;
            assert!(
                (far.newtons - wanted).abs() <= claims.tolerance * size * factor,
                "homogeneity: {force:?} times {factor:?}: {far:?} against {wanted:?}"
            );
        }
    }
    if claims.convex {
        check_convexity(model, claims, [force, other], size, draws);
    }
}

/// Between two forces that hold, all hold; a force that does not is pressed until it does.
fn check_convexity<T: Real>(
    model: &dyn FrictionModel<T>,
    claims: &Claims<T>,
    forces: [&ContactForce<T>; 2],
    size: T,
    draws: &mut Draws,
) {
    let [one, other] = forces.map(|force| {
        let pressed = model.least_normal_force(force, T::literal(1.0 + draws.share()));
        ContactForce { normal: force.normal.max(pressed), ..*force }
    });
    if [one, other].iter().any(|force| !(model.slip_margin(force).newtons >= T::zero())) {
        return;
    }
    let there = model.slip_margin(&between(&one, &other, T::literal(draws.share())));
    let size = size + one.normal + other.normal;
    assert!(there.newtons >= -claims.tolerance * size, "convexity: {one:?} {other:?} {there:?}");
}

fn check_least_normal_force<T: Real>(
    model: &dyn FrictionModel<T>,
    claims: &Claims<T>,
    [force, grown]: [&ContactForce<T>; 2],
    size: T,
) {
    let safety = T::literal(1.5);
    let least = model.least_normal_force(force, safety);
    assert!(least >= T::zero() && least.is_number(), "least normal force: {force:?} {least:?}");
    let pressed = ContactForce { normal: force.normal + T::one(), ..*force };
    assert!(
        model.least_normal_force(&pressed, safety) == least,
        "least normal force is of the load alone: {force:?} {least:?}"
    );
    let almost = least * (T::one() - claims.tolerance);
    let safer = model.least_normal_force(force, safety * T::literal(2.0));
    assert!(safer >= almost, "more safety, no less normal force: {force:?} {least:?} {safer:?}");
    let loaded = model.least_normal_force(grown, safety);
    assert!(loaded >= almost, "more load, no less normal force: {force:?} {least:?}, {grown:?} {loaded:?}");
    // Where the largest number is not enough, or rounding all that is left.
    if least >= T::GREATEST || least <= claims.tolerance * size {
        return;
    }
    let used = |normal: T| model.slip_margin(&ContactForce { normal, ..*force }).utilisation * safety;
    let slack = claims.tolerance * T::literal(16.0);
    for factor in [1.0, 2.0] {
        let used = used(least * T::literal(factor));
        assert!(
            used <= T::one() + slack,
            "least normal force keeps the safety: {force:?} {least:?} times {factor} uses {used:?}"
        );
    }
    let below = used(least * T::literal(0.9));
    assert!(below >= T::one() - slack, "least normal force is the least: {force:?} {least:?} {below:?}");
}

/// What is not finite, and the ends of the range.
pub(super) fn check_bad_input<T: Real>(model: &dyn FrictionModel<T>) {
    let finite = |force: &ContactForce<T>| {
        let margin = model.slip_margin(force);
        let least = model.least_normal_force(force, T::one());
        assert!(margin.newtons.is_number() && margin.utilisation.is_number(), "finite: {force:?} {margin:?}");
        assert!(least >= T::zero() && least.is_number(), "finite: {force:?} {least:?}");
        margin
    };
    let nan = T::zero() / T::zero();
    let good = ContactForce::new(T::one(), Vector3::x(), T::zero());
    for value in [nan, T::one() / T::zero(), -T::one() / T::zero()] {
        for force in [
            ContactForce { normal: value, ..good },
            ContactForce { tangential: Vector3::new(T::zero(), value, T::zero()).into(), ..good },
        ] {
            let margin = finite(&force);
            assert!(
                margin.newtons <= -T::GREATEST,
                "what is not finite has the least margin: {force:?} {margin:?}"
            );
        }
        // A model may do without the spin torque.
        finite(&ContactForce { spin: value, ..good });
    }
    for value in [T::zero(), T::LEAST_NORMAL, T::GREATEST] {
        for normal in [value, -value, T::one()] {
            finite(&ContactForce::new(normal, Vector3::new(value, -value, T::zero()), value));
        }
    }
}

pub(super) fn between<T: Real>(a: &ContactForce<T>, b: &ContactForce<T>, share: T) -> ContactForce<T> {
    ContactForce {
        normal: a.normal + (b.normal - a.normal) * share,
        tangential: (*a.tangential + (*b.tangential - *a.tangential) * share).into(),
        spin: a.spin + (b.spin - a.spin) * share,
    }
}

fn scaled<T: Real>(force: &ContactForce<T>, factor: T) -> ContactForce<T> {
    ContactForce {
        normal: force.normal * factor,
        tangential: force.tangential.scaled(factor),
        spin: force.spin * factor,
    }
}
