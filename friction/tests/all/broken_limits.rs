//! The laws for friction limits bite: each of these limits has one fault, and the law that it breaks says so.

use std::panic::catch_unwind;

use fingertip_friction::testing::{Claims, friction_laws};
use fingertip_friction::{
    FrictionLimit, FrictionModel, LoadDependentLimit, SlipDirection, SlipMargin, SoftFingerLimit,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

const ARM: f64 = 3e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    HoldsTheWrongWay,
    UsesMore,
    HasASide,
    GrowsTooFast,
    IsTooFar,
    ProjectsNothing,
    ProjectsToTheApex,
    ProjectsInside,
    LeastBelowZero,
    LeastTooGreat,
    LeastTooSmall,
    KeepsTooLittle,
    KeepsTooMuch,
    HasNoDirection,
    DirectionIsLong,
    DirectionOfPush,
    DirectionOblique,
    MarginOfNan,
    LeastOfNan,
    ProjectionOfNan,
    DirectionOfNan,
    MarginOfTheGreatest,
}

struct Broken(SoftFingerLimit<f64>, Fault);

impl Broken {
    fn is(&self, fault: Fault) -> bool {
        self.1 == fault
    }

    fn bad(&self, force: &ContactForce<f64>, fault: Fault) -> bool {
        self.is(fault) && !force.is_finite()
    }
}

impl FrictionModel<f64> for Broken {
    fn slip_margin(&self, force: &ContactForce<f64>) -> SlipMargin<f64> {
        let mut margin = self.0.slip_margin(force);
        if self.is(Fault::UsesMore) && margin.newtons > 0.0 {
            margin.utilisation += 1.0;
        }
        if self.is(Fault::HasASide) && force.tangential.x > 0.0 {
            margin.newtons *= 1.0 + 1e-9;
        }
        if self.is(Fault::GrowsTooFast) {
            margin.newtons *= 1.0 + 1e-3 * force.normal.abs();
        }
        if self.is(Fault::IsTooFar) {
            margin.newtons *= 2.0;
        }
        let greatest = self.is(Fault::MarginOfTheGreatest) && force.normal == f64::MAX;
        if self.bad(force, Fault::MarginOfNan) || greatest {
            margin.newtons = f64::NAN;
        }
        margin
    }

    fn least_normal_force(&self, force: &ContactForce<f64>, safety: f64) -> f64 {
        let least = self.0.least_normal_force(force, safety);
        match self.1 {
            Fault::LeastBelowZero => -least - 1e-3,
            Fault::LeastTooGreat => least * (1.0 + 1e-9),
            Fault::LeastTooSmall => least * (1.0 - 1e-9),
            Fault::LeastOfNan if !force.is_finite() => f64::NAN,
            _ => least,
        }
    }
}

impl FrictionLimit<f64> for Broken {
    fn holds(&self, force: &ContactForce<f64>) -> bool {
        self.0.holds(force) != self.is(Fault::HoldsTheWrongWay)
    }

    fn normal_force_keeping(&self, force: &ContactForce<f64>, margin: f64) -> f64 {
        let keeping = self.0.normal_force_keeping(force, margin);
        match self.1 {
            Fault::KeepsTooLittle => keeping * (1.0 - 1e-9),
            Fault::KeepsTooMuch => keeping * (1.0 + 1e-9),
            _ => keeping,
        }
    }

    fn project(&self, force: &ContactForce<f64>) -> ContactForce<f64> {
        match self.1 {
            Fault::ProjectsNothing if force.is_finite() => *force,
            Fault::ProjectsToTheApex if !self.0.holds(force) => ContactForce::zero(),
            Fault::ProjectsInside => {
                let found = self.0.project(force);
                ContactForce { normal: found.normal * (1.0 + 1e-9), ..found }
            }
            Fault::ProjectionOfNan if !force.is_finite() => *force,
            _ => self.0.project(force),
        }
    }

    fn slip_direction(&self, force: &ContactForce<f64>) -> Option<SlipDirection<f64>> {
        if self.bad(force, Fault::DirectionOfNan) {
            return Some(SlipDirection { velocity: Vector3::x() * f64::NAN, spin: 0.0 });
        }
        let found = self.0.slip_direction(force)?;
        let v = found.velocity;
        match self.1 {
            Fault::HasNoDirection => None,
            Fault::DirectionIsLong => {
                Some(SlipDirection { velocity: v * (1.0 + 1e-9), spin: found.spin * (1.0 + 1e-9) })
            }
            Fault::DirectionOfPush => Some(SlipDirection { velocity: -v, spin: -found.spin }),
            Fault::DirectionOblique => {
                let turned = Vector3::new(v.x * 0.8 - v.y * 0.6, v.x * 0.6 + v.y * 0.8, 0.0);
                Some(SlipDirection { velocity: turned, ..found })
            }
            _ => Some(found),
        }
    }
}

fn claims() -> Claims<f64> {
    Claims { homogeneous: true, convex: true, arm: ARM, tolerance: 64.0 * f64::EPSILON }
}

fn norm(f: &ContactForce<f64>) -> f64 {
    f.tangential.vector().norm().hypot(f.spin / ARM).hypot(f.normal)
}

/// What the laws say of a limit; nothing if they hold.
fn said(claims: Claims<f64>, fault: Fault) -> Option<String> {
    let run = move || {
        let model = Broken(SoftFingerLimit::new(0.6, ARM).unwrap(), fault);
        friction_laws(&model, &claims, norm, 500);
    };
    catch_unwind(run).err().map(|panic| *panic.downcast::<String>().unwrap())
}

#[test]
fn each_law_notices_its_fault() {
    let plain = Claims { homogeneous: false, ..claims() };
    let unconvex = Claims { homogeneous: false, convex: false, ..claims() };
    assert_eq!(said(claims(), Fault::None), None);
    for (claims, fault, law) in [
        (claims(), Fault::HoldsTheWrongWay, "sign"),
        (claims(), Fault::UsesMore, "utilisation"),
        (claims(), Fault::HasASide, "symmetry"),
        (claims(), Fault::GrowsTooFast, "homogeneity"),
        (claims(), Fault::IsTooFar, "distance is 1-Lipschitz"),
        (claims(), Fault::ProjectsNothing, "projection holds"),
        (claims(), Fault::ProjectsToTheApex, "projection is nearest"),
        (plain, Fault::ProjectsInside, "projection keeps what holds"),
        (claims(), Fault::LeastBelowZero, "least normal force"),
        (claims(), Fault::LeastTooGreat, "least normal force uses 1/safety"),
        (claims(), Fault::LeastTooSmall, "least normal force keeps the safety"),
        (claims(), Fault::KeepsTooLittle, "normal force keeps the margin"),
        (claims(), Fault::KeepsTooMuch, "normal force is the least to keep the margin"),
        (claims(), Fault::HasNoDirection, "a load has a direction of slip"),
        (claims(), Fault::DirectionIsLong, "direction of slip is unit"),
        (claims(), Fault::DirectionOfPush, "friction opposes slip"),
        (claims(), Fault::DirectionOblique, "maximum dissipation"),
        (claims(), Fault::MarginOfNan, "finite"),
        (claims(), Fault::LeastOfNan, "finite"),
        (claims(), Fault::ProjectionOfNan, "finite"),
        (claims(), Fault::DirectionOfNan, "finite"),
        (claims(), Fault::MarginOfTheGreatest, "finite"),
    ] {
        let said = said(claims, fault);
        assert!(
            said.as_ref().is_some_and(|said| said.starts_with(&format!("{law}:"))),
            "{fault:?}: {said:?}"
        );
    }
    // What is not claimed is not asked.
    assert_eq!(said(unconvex, Fault::DirectionOblique), None);
    assert_eq!(said(plain, Fault::ProjectsToTheApex), None);
    assert!(said(plain, Fault::DirectionOblique).is_some());
}

/// A limit whose patch grows with the load is neither convex nor a cone. Its direction of slip is given in
/// the arm at 1 N, at which the laws ask for it.
struct Dented(LoadDependentLimit<f64>);

impl FrictionModel<f64> for Dented {
    fn slip_margin(&self, force: &ContactForce<f64>) -> SlipMargin<f64> {
        self.0.slip_margin(force)
    }

    fn least_normal_force(&self, force: &ContactForce<f64>, safety: f64) -> f64 {
        self.0.least_normal_force(force, safety)
    }
}

impl FrictionLimit<f64> for Dented {
    fn normal_force_keeping(&self, force: &ContactForce<f64>, margin: f64) -> f64 {
        self.0.normal_force_keeping(force, margin)
    }

    fn project(&self, force: &ContactForce<f64>) -> ContactForce<f64> {
        self.0.project(force)
    }

    fn slip_direction(&self, force: &ContactForce<f64>) -> Option<SlipDirection<f64>> {
        self.0.slip_direction(&ContactForce { normal: 1.0, ..*force })
    }
}

#[test]
fn a_dent_is_noticed() {
    let run = |convex: bool, homogeneous: bool| {
        catch_unwind(move || {
            let model = Dented(LoadDependentLimit::new(0.6, ARM, 1.0, 1.0).unwrap());
            let claims = Claims { homogeneous, convex, arm: ARM, tolerance: 1024.0 * f64::EPSILON };
            friction_laws(&model, &claims, norm, 3000);
        })
        .map_err(|panic| *panic.downcast::<String>().unwrap())
    };
    for (convex, homogeneous, law) in [(true, false, "convexity:"), (false, true, "homogeneity:")] {
        let said = run(convex, homogeneous).unwrap_err();
        assert!(said.starts_with(law), "{said}");
    }
}
