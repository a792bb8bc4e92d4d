//! Laws that every friction limit keeps, to be run on one's own models.
//!
//! Each check panics with the law's name, the force and the figures where a law is broken. The
//! draws come from a fixed generator, so that a failure repeats.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

use crate::FrictionLimit;

/// Which of the laws a limit claims.
///
/// ```
/// use fingertip_friction::testing::{Claims, friction_laws};
/// use fingertip_friction::{Coulomb, LoadDependentLimit};
/// use fingertip_wrench::ContactForce;
///
/// let length = |change: &ContactForce<f64>| change.normal.hypot(change.tangential_magnitude());
/// let claims = Claims { homogeneous: true, convex: true, arm: 0.0, tolerance: 1e-12 };
/// friction_laws(&Coulomb::new(0.5)?, &claims, length, 100);
/// // A patch whose arm grows with the load makes no homogeneous limit, and is found out.
/// let (limit, claims) = (LoadDependentLimit::new(0.5, 3e-3, 1.0, 1.0 / 3.0)?, Claims { arm: 3e-3, ..claims });
/// assert!(std::panic::catch_unwind(|| friction_laws(&limit, &claims, length, 100)).is_err());
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Claims<T> {
    /// Margin and least normal force scale with the force.
    pub homogeneous: bool,
    /// The forces that hold form a convex set.
    pub convex: bool,
    /// Spin torque counts, with this arm \[m\]; zero where it doesn't.
    pub arm: T,
    /// Relative tolerance of the margin and of the projection, from the type's epsilon and the
    /// method.
    pub tolerance: T,
}

/// A fixed pseudo-random sequence (PCG-XSH-RR 32, O'Neill 2014).
///
/// ```
/// use fingertip_friction::testing::Draws;
///
/// // The same seed gives the same forces.
/// let (mut draws, mut again) = (Draws::new(7), Draws::new(7));
/// for _ in 0..100 {
///     let force = draws.force::<f64>(0.01);
///     assert_eq!(force, again.force(0.01));
///     assert!(force.normal.abs() <= 20.0 && force.spin.abs() <= 0.1);
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    state: u64,
}

impl Draws {
    /// From a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1) }
    }

    /// Evenly in [0, 1).
    pub fn share(&mut self) -> f64 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (((old >> 18) ^ old) >> 27) as u32;
        f64::from(mixed.rotate_right((old >> 59) as u32)) / 4_294_967_296.0
    }

    /// Evenly in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.share() - 1.0
    }

    /// A contact force in the plane across the third axis: mostly pressing, now and then pulling
    /// or without tangential load, with components up to about 10 N and spin up to 10 N times
    /// `arm`.
    pub fn force<T: Real>(&mut self, arm: T) -> ContactForce<T> {
        let size = if self.share() < 0.1 { 0.0 } else { 10.0 * self.share() };
        let angle = core::f64::consts::TAU * self.share();
        let normal = if self.share() < 0.1 { -10.0 * self.share() } else { 10.0 * self.share() };
        let spin = if self.share() < 0.2 { 0.0 } else { 10.0 * self.signed() };
        ContactForce {
            normal: T::literal(normal),
            tangential: Vector3::new(
                T::literal(size * libm::cos(angle)),
                T::literal(size * libm::sin(angle)),
                T::zero(),
            )
            .into(),
            spin: T::literal(spin) * arm,
        }
    }
}

fn between<T: Real>(a: &ContactForce<T>, b: &ContactForce<T>, share: T) -> ContactForce<T> {
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

/// Runs every law on `count` draws. `norm` is the length of a change of the contact force in the
/// norm that the model states for its margin.
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
        assert!(
            !sure || (margin.utilisation < T::one()) == (margin.newtons > T::zero()),
            "utilisation: {force:?} {margin:?}"
        );

        // Symmetry under reversal of the load.
        let reversed = ContactForce::new(force.normal, -*force.tangential, -force.spin);
        let back = model.slip_margin(&reversed);
        assert!(close(back.newtons, margin.newtons, size), "symmetry: {force:?} {margin:?} {back:?}");

        if claims.homogeneous {
            for exponent in [-40.0, 0.3, 40.0] {
                let factor = T::literal(libm::exp2(exponent));
                let far = model.slip_margin(&scaled(&force, factor));
                let wanted = margin.newtons * factor;
                assert!(
                    close(far.newtons, wanted, size * factor),
                    "homogeneity: {force:?} times {factor:?}: {far:?} against {wanted:?}"
                );
            }
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

        if claims.convex && model.holds(&force) && model.holds(&other) {
            let middle = between(&force, &other, T::literal(draws.share()));
            let there = model.slip_margin(&middle);
            assert!(there.newtons >= -claims.tolerance * size, "convexity: {force:?} {other:?} {there:?}");
        }

        check_projection(model, claims, &norm, &force, size);
        check_normal_forces(model, claims, &force, size);
        check_direction(model, claims, &force, &other, size);
    }
    check_bad_input(model);
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
    assert!(least >= T::zero() && least.is_number(), "least normal force: {force:?} {least:?}");
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

fn check_bad_input<T: Real>(model: &impl FrictionLimit<T>) {
    let nan = T::zero() / T::zero();
    let bad = [nan, T::one() / T::zero(), -T::one() / T::zero()];
    let good = ContactForce::new(T::one(), Vector3::x(), T::zero());
    for value in bad {
        for force in [
            ContactForce { normal: value, ..good },
            ContactForce { tangential: Vector3::new(T::zero(), value, T::zero()).into(), ..good },
        ] {
            let margin = model.slip_margin(&force);
            assert!(
                margin.newtons.is_number() && margin.utilisation.is_number(),
                "finite: {force:?} {margin:?}"
            );
            let least = model.least_normal_force(&force, T::one());
            assert!(least >= T::zero() && least.is_number(), "finite: {force:?} {least:?}");
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
            let margin = model.slip_margin(&force);
            assert!(
                margin.newtons.is_number() && margin.utilisation.is_number(),
                "finite: {force:?} {margin:?}"
            );
            assert!(model.project(&force).is_finite(), "finite: {force:?}");
        }
    }
}

fn close_to<T: Real>(a: T, b: T, tolerance: T) -> bool {
    (a - b).abs() <= tolerance
}
