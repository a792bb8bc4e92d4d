//! The laws for friction models bite: each of these models has one fault, and the law that it breaks says so.

use core::cell::Cell;
use std::panic::catch_unwind;

use fingertip_friction::testing::{Claims, model_laws};
use fingertip_friction::{Coulomb, FrictionModel, SlipMargin};
use fingertip_wrench::ContactForce;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    Forgets,
    UsesLessThanNothing,
    UsesTooMuch,
    HoldsAPull,
    HoldsMoreUnderLoad,
    LeastBelowZero,
    LeastOfTheNormalForce,
    LeastTooSmall,
    LeastFarTooGreat,
    LessForMoreSafety,
    LessForMoreLoad,
    SlipsPressedHarder,
    MarginOfNan,
    LeastOfNan,
    Overflows,
    HoldsTheInfinite,
    HasAnOffset,
    IsDented,
}

struct Broken(Coulomb<f64>, Fault, Cell<u32>);

impl FrictionModel<f64> for Broken {
    fn slip_margin(&self, force: &ContactForce<f64>) -> SlipMargin<f64> {
        let mut margin = self.0.slip_margin(force);
        let load = force.tangential_magnitude();
        self.2.set(self.2.get() + 1);
        let finite = force.is_finite();
        match self.1 {
            Fault::Forgets => margin.newtons += 1e-12 * f64::from(self.2.get() % 2),
            Fault::UsesLessThanNothing if load == 0.0 => margin.utilisation = -1e-9,
            Fault::UsesTooMuch => margin.utilisation += 1.0,
            Fault::HoldsAPull if force.normal < 0.0 => margin.newtons = 1e-9,
            // What a limit tells that knows no loads above 5 N.
            Fault::HoldsMoreUnderLoad if load > 5.0 && finite && margin.newtons < 0.0 => {
                margin.newtons = -1e-6;
            }
            Fault::SlipsPressedHarder if force.normal > 10.0 && load > 0.0 && finite => {
                margin = SlipMargin { newtons: -1.0, utilisation: 2.0 };
            }
            Fault::MarginOfNan if !finite => margin.newtons = f64::NAN,
            Fault::Overflows => margin.newtons *= 2.0,
            Fault::HoldsTheInfinite if !finite => {
                margin = SlipMargin { newtons: 1.0, utilisation: 0.0 };
            }
            Fault::HasAnOffset if margin.newtons > 0.0 && load > 0.0 => {
                margin.newtons += 1e-3 * (1.0 - margin.utilisation) / (1.0 + force.normal);
            }
            // A sector that holds nothing.
            Fault::IsDented if finite && force.tangential.x > 3.0 * force.tangential.y.abs() => {
                margin = SlipMargin { newtons: -load, utilisation: f64::MAX };
            }
            _ => {}
        }
        margin
    }

    fn least_normal_force(&self, force: &ContactForce<f64>, safety: f64) -> f64 {
        let least = self.0.least_normal_force(force, safety);
        match self.1 {
            Fault::LeastBelowZero => -least - 1e-3,
            Fault::LeastOfTheNormalForce => least + 1e-9 * force.normal.abs().min(1.0),
            Fault::LeastTooSmall => least * (1.0 - 1e-9),
            Fault::LeastFarTooGreat => least * 1.2,
            Fault::LessForMoreSafety => least / (safety * safety),
            Fault::LessForMoreLoad => safety * 100.0 / (1.0 + force.tangential_magnitude()),
            Fault::LeastOfNan if !force.is_finite() => f64::NAN,
            // Nothing holds in a dent.
            Fault::IsDented if force.tangential.x > 3.0 * force.tangential.y.abs() => f64::MAX,
            _ => least,
        }
    }
}

fn said(claims: Claims<f64>, fault: Fault) -> Option<String> {
    let run = move || {
        let model = Broken(Coulomb::new(0.6).unwrap(), fault, Cell::new(0));
        model_laws(&model, &claims, 500);
    };
    catch_unwind(run).err().map(|panic| *panic.downcast::<String>().unwrap())
}

#[test]
fn each_law_notices_its_fault() {
    let all = Claims { homogeneous: true, convex: true, arm: 0.0, tolerance: 64.0 * f64::EPSILON };
    let plain = Claims { homogeneous: false, convex: false, ..all };
    let convex = Claims { homogeneous: false, ..all };
    assert_eq!(said(all, Fault::None), None);
    let mut others = Vec::new();
    for (claims, fault, law) in [
        (plain, Fault::Forgets, "the same force, the same answer"),
        (plain, Fault::UsesLessThanNothing, "utilisation"),
        (plain, Fault::UsesTooMuch, "utilisation"),
        (plain, Fault::HoldsAPull, "a contact that does not press holds nothing"),
        (plain, Fault::HoldsMoreUnderLoad, "more load, less margin"),
        (plain, Fault::LeastBelowZero, "least normal force"),
        (plain, Fault::LeastOfTheNormalForce, "least normal force is of the load alone"),
        (plain, Fault::LessForMoreSafety, "more safety, no less normal force"),
        (plain, Fault::LessForMoreLoad, "more load, no less normal force"),
        (plain, Fault::LeastTooSmall, "least normal force keeps the safety"),
        (plain, Fault::SlipsPressedHarder, "least normal force keeps the safety"),
        (plain, Fault::LeastFarTooGreat, "least normal force is the least"),
        (plain, Fault::MarginOfNan, "finite"),
        (plain, Fault::LeastOfNan, "finite"),
        (plain, Fault::Overflows, "finite"),
        (plain, Fault::HoldsTheInfinite, "what is not finite has the least margin"),
        (all, Fault::HasAnOffset, "homogeneity"),
        (convex, Fault::IsDented, "convexity"),
    ] {
        let said = said(claims, fault);
        if !said.as_ref().is_some_and(|said| said.starts_with(&format!("{law}:"))) {
            others.push((fault, said));
        }
    }
    assert!(others.is_empty(), "{others:#?}");
    // What is not claimed is not asked.
    assert_eq!(said(convex, Fault::HasAnOffset), None);
    assert_eq!(said(plain, Fault::IsDented), None);
}
