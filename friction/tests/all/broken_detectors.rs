//! The laws for slip detectors bite: each of these detectors has one fault, and the law that it breaks says so.

use core::panic::AssertUnwindSafe;
use std::panic::catch_unwind;

use fingertip_friction::testing::detector_laws;
use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, SlipVerdict};
use fingertip_wrench::ContactForce;

use crate::laws_of_detectors::trial;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    CriesInAHold,
    WarnsOfNothing,
    IsDeaf,
    DiffersFromItsTwin,
    HoldsInTheAir,
    HoldsAPull,
    ForgetsNothingWhenOpen,
    HoldsNan,
    KeepsNan,
    KeepsItsPastOverAReset,
    CannotBeResetAfterABadTime,
}

#[derive(Clone, Copy)]
struct Broken {
    inner: DropDetector<f64>,
    fault: Fault,
    /// Which one of those made it is.
    number: u32,
    samples: u32,
    sum: f64,
}

impl SlipDetector<f64> for Broken {
    fn update(&mut self, force: &ContactForce<f64>, time_step: f64) -> SlipVerdict {
        let finite = force.is_finite();
        let verdict = self.inner.update(force, time_step);
        self.samples += 1;
        match self.fault {
            Fault::CriesInAHold if self.samples == 1050 => SlipVerdict::Slipping,
            Fault::WarnsOfNothing if self.samples == 1050 => SlipVerdict::Warning,
            Fault::IsDeaf if verdict == SlipVerdict::Slipping => SlipVerdict::Holding,
            Fault::DiffersFromItsTwin if self.number == 3 && self.samples == 140 => SlipVerdict::Warning,
            Fault::HoldsInTheAir if *force == ContactForce::zero() => SlipVerdict::Holding,
            Fault::HoldsAPull if force.normal < 0.0 => SlipVerdict::Holding,
            Fault::HoldsNan if !finite => SlipVerdict::Holding,
            // A mean that a NaN spoils for good.
            Fault::KeepsNan => {
                self.sum += force.normal;
                if self.sum.is_finite() || !finite { verdict } else { SlipVerdict::NotPressing }
            }
            // A warning that is due at 1200 samples, be there a reset or not.
            Fault::KeepsItsPastOverAReset if self.samples > 1200 && finite => SlipVerdict::Warning,
            Fault::CannotBeResetAfterABadTime => {
                if !time_step.is_finite() {
                    self.sum = time_step;
                }
                if self.sum == 0.0 { verdict } else { SlipVerdict::NotPressing }
            }
            _ => verdict,
        }
    }

    fn update_open(&mut self, time_step: f64) -> SlipVerdict {
        if self.fault == Fault::ForgetsNothingWhenOpen {
            return SlipVerdict::NotPressing;
        }
        self.update(&ContactForce::zero(), time_step)
    }

    fn reset(&mut self) {
        self.inner.reset();
        if !matches!(self.fault, Fault::KeepsItsPastOverAReset | Fault::CannotBeResetAfterABadTime) {
            (self.samples, self.sum) = (0, 0.0);
        }
    }
}

fn said(fault: Fault) -> Option<String> {
    let inner = DropDetector::new(ForceNoise::isotropic(0.01).unwrap()).unwrap();
    let mut number = 0;
    let make = || {
        number += 1;
        Broken { inner, fault, number, samples: 0, sum: 0.0 }
    };
    let run = AssertUnwindSafe(|| detector_laws(make, &trial()));
    catch_unwind(run).err().map(|panic| *panic.downcast::<String>().unwrap())
}

#[test]
fn each_law_notices_its_fault() {
    assert_eq!(said(Fault::None), None);
    for (fault, law) in [
        (Fault::CriesInAHold, "a hold is no slip"),
        (Fault::WarnsOfNothing, "a hold is no slip"),
        (Fault::IsDeaf, "a slip is seen"),
        (Fault::DiffersFromItsTwin, "the same samples, the same verdicts"),
        (Fault::HoldsInTheAir, "an open contact does not press"),
        (Fault::HoldsAPull, "an open contact does not press"),
        (Fault::ForgetsNothingWhenOpen, "open is no force"),
        (Fault::HoldsNan, "not finite does not press"),
        (Fault::KeepsNan, "not finite leaves no trace"),
        (Fault::KeepsItsPastOverAReset, "a reset is as new"),
        (Fault::CannotBeResetAfterABadTime, "a reset is as new"),
    ] {
        let said = said(fault);
        assert!(
            said.as_ref().is_some_and(|said| said.starts_with(&format!("{law}:"))),
            "{fault:?}: {said:?}"
        );
    }
}
