//! The normal force to command next.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::{not_negative, positive};
use crate::{BadParameter, FrictionModel, SlipVerdict};

/// Limits and habits of a gripping finger; [`GripController::new`] validates them.
///
/// ```
/// use fingertip_friction::{GripController, GripSettings};
///
/// let settings = GripSettings { safety: 1.5, least: 0.3, greatest: 15.0, rise: 200.0, fall: 2.0, slip_boost: 1.25 };
/// assert!(GripController::new(settings).is_ok());
/// assert!(GripController::new(GripSettings { safety: 0.5, ..settings }).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GripSettings<T> {
    /// Factor of safety on the friction limit, at least 1.
    pub safety: T,
    /// The least normal force to command \[N\].
    pub least: T,
    /// The greatest \[N\].
    pub greatest: T,
    /// How fast it may rise \[N/s\].
    pub rise: T,
    /// How fast it may fall \[N/s\]; slower than the rise, so that a grip is not lost to noise.
    pub fall: T,
    /// The factor at each slip, at least 1, on the present command or, where that is more, on what the load needs.
    pub slip_boost: T,
}

/// Keeps the grip just firm enough: the least normal force that holds the present load with a
/// factor of safety, within limits of force and rate, and a good deal more at once when it slips.
///
/// The people's grip does the same (Johansson & Westling 1984). A boost after slip decays at the
/// falling rate.
///
/// ```
/// use fingertip_friction::{Coulomb, GripController, GripSettings, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut grip = GripController::new(GripSettings {
///     safety: 1.5, least: 0.3, greatest: 15.0, rise: 200.0, fall: 2.0, slip_boost: 1.25,
/// })?;
/// let force = ContactForce::new(2.0, Vector3::new(1.0, 0.0, 0.0), 0.0);
/// let mut command = 0.0;
/// for _ in 0..100 {
///     command = grip.command(&Coulomb::new(0.5)?, &force, SlipVerdict::Holding, 1e-3);
/// }
/// assert!((command - 3.0_f64).abs() < 1e-9); // 1 N over 0.5, with a reserve of half
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripController<T> {
    settings: GripSettings<T>,
    command: T,
    /// The command wanted since the last slip, which decays \[N\].
    boosted: T,
}

impl<T: Real> GripController<T> {
    /// Starts at the least normal force.
    ///
    /// # Errors
    /// [`BadParameter`] unless all settings are finite, the factors at least 1, the rates positive,
    /// and the least force not negative and not above the greatest.
    pub fn new(settings: GripSettings<T>) -> Result<Self, BadParameter> {
        let factor = |value: T, parameter| {
            if value >= T::one() && value.is_number() {
                Ok(())
            } else {
                Err(BadParameter { parameter, requirement: "at least 1 and finite" })
            }
        };
        factor(settings.safety, "factor of safety")?;
        factor(settings.slip_boost, "boost at slip")?;
        positive(settings.rise, "rate of rise")?;
        positive(settings.fall, "rate of fall")?;
        let least = not_negative(settings.least, "least grip force")?;
        if positive(settings.greatest, "greatest grip force")? < least {
            return Err(BadParameter {
                parameter: "greatest grip force",
                requirement: "at least the least grip force",
            });
        }
        Ok(Self { settings, command: least, boosted: least })
    }

    /// The normal force \[N\] to command for the next sample.
    ///
    /// `friction` is the limit to keep, with the coefficient one trusts: from the low quantile of
    /// an estimate, not from its mean. A contact force that is not finite, or a time step that is
    /// not positive and finite, leaves the command as it is: a finger never opens on a fault. Nor does it on a limit that
    /// answers with a NaN, which counts for the present command.
    #[inline]
    pub fn command(
        &mut self,
        friction: &impl FrictionModel<T>,
        force: &ContactForce<T>,
        slip: SlipVerdict,
        time_step: T,
    ) -> T {
        let good = force.is_finite() && time_step > T::zero() && time_step.is_number();
        if !good {
            return self.command;
        }
        let settings = &self.settings;
        self.boosted = (self.boosted - settings.fall * time_step).max(settings.least);
        let needed = friction.least_normal_force(force, settings.safety);
        // Not where it is a NaN.
        let needed = if needed >= T::zero() || needed < T::zero() { needed } else { self.command };
        if slip == SlipVerdict::Slipping {
            // Of a command of nothing no factor makes a grip.
            let held = self.command.max(needed.min(settings.greatest));
            self.boosted = (held * settings.slip_boost).clamp(settings.least, settings.greatest);
        }
        let wanted = needed.max(self.boosted).clamp(settings.least, settings.greatest);
        let lowest = self.command - settings.fall * time_step;
        let highest = self.command + settings.rise * time_step;
        self.command = wanted.clamp(lowest, highest);
        self.command
    }

    /// The command now in force \[N\].
    #[inline]
    #[must_use]
    pub const fn present(&self) -> T {
        self.command
    }

    /// Puts the command at a force, as at the start of a grasp; held to the limits. A NaN changes
    /// nothing.
    pub fn start_at(&mut self, normal_force: T) {
        if normal_force.is_number() {
            self.command = normal_force.clamp(self.settings.least, self.settings.greatest);
            self.boosted = self.settings.least;
        }
    }
}

stored! {
    GripController<T>, [T: Real],
    |grip| { settings: GripSettings<T> = grip.settings },
    Self::new(settings)
}

#[cfg(test)]
mod tests {
    use super::{GripController, GripSettings};
    use crate::{Coulomb, FrictionModel, SlipMargin, SlipVerdict};
    use fingertip_wrench::{ContactForce, Real};
    use nalgebra::Vector3;

    fn settings<T: Real>() -> GripSettings<T> {
        GripSettings {
            safety: T::literal(1.5),
            least: T::literal(0.5),
            greatest: T::literal(20.0),
            rise: T::literal(100.0),
            fall: T::literal(2.0),
            slip_boost: T::literal(1.25),
        }
    }

    fn load<T: Real>(tangential: f64) -> ContactForce<T> {
        ContactForce::new(T::one(), Vector3::new(T::zero(), T::literal(tangential), T::zero()), T::zero())
    }

    fn follows_the_load<T: Real>() {
        let friction = Coulomb::new(T::literal(0.5)).unwrap();
        let mut grip = GripController::new(settings::<T>()).unwrap();
        let step = T::literal(1e-3);
        let mut last = grip.present();
        for index in 0..5000 {
            let tangential = if index < 2500 { 2.0 } else { 0.5 };
            let now = grip.command(&friction, &load(tangential), SlipVerdict::Holding, step);
            let rounding = T::literal(64.0) * T::EPSILON;
            assert!(now - last <= T::literal(0.1) + rounding && last - now <= T::literal(2e-3) + rounding);
            last = now;
            if index == 2499 {
                assert!((now - T::literal(6.0)).abs() < T::literal(16.0) * T::EPSILON * now);
            }
        }
        // 2.5 s at 2 N/s down from 6 N, to what 0.5 N of load needs.
        assert!((last - T::literal(1.5)).abs() < T::literal(1e-3), "{last:?}");
    }

    #[test]
    fn command_follows_the_load_within_its_rates() {
        follows_the_load::<f64>();
        follows_the_load::<f32>();
    }

    #[test]
    fn slip_tightens_and_decays() {
        let friction = Coulomb::new(0.5).unwrap();
        let mut grip = GripController::new(settings::<f64>()).unwrap();
        grip.start_at(6.0);
        grip.command(&friction, &load(2.0), SlipVerdict::Slipping, 0.1);
        assert!((grip.present() - 7.5).abs() < 1e-12);
        grip.command(&friction, &load(2.0), SlipVerdict::Holding, 0.1);
        assert!((grip.present() - 7.3).abs() < 1e-12);
        for _ in 0..20 {
            grip.command(&friction, &load(2.0), SlipVerdict::Holding, 0.1);
        }
        assert!((grip.present() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_slip_tightens_a_grip_that_may_be_nothing() {
        let friction = Coulomb::new(0.5).unwrap();
        let mut grip = GripController::new(GripSettings { least: 0.0, ..settings::<f64>() }).unwrap();
        assert_eq!(grip.present(), 0.0);
        // 1.5 times 2 N over 0.5, and a quarter more.
        grip.command(&friction, &load(2.0), SlipVerdict::Slipping, 1.0);
        assert!((grip.present() - 7.5).abs() < 1e-12, "{}", grip.present());
        // A command above that is what counts.
        grip.start_at(8.0);
        grip.command(&friction, &load(2.0), SlipVerdict::Slipping, 1.0);
        assert!((grip.present() - 10.0).abs() < 1e-12, "{}", grip.present());
    }

    /// A limit that answers with what it is.
    struct Answer(f64);

    impl FrictionModel<f64> for Answer {
        fn slip_margin(&self, _: &ContactForce<f64>) -> SlipMargin<f64> {
            SlipMargin { newtons: self.0, utilisation: self.0 }
        }

        fn least_normal_force(&self, _: &ContactForce<f64>, _: f64) -> f64 {
            self.0
        }
    }

    #[test]
    fn a_limit_that_fails_does_not_open_the_finger() {
        for (answer, slip, wanted) in [
            (f64::NAN, SlipVerdict::Holding, 6.0),
            (f64::NAN, SlipVerdict::Slipping, 7.5),
            (f64::INFINITY, SlipVerdict::Holding, 20.0),
            (f64::INFINITY, SlipVerdict::Slipping, 20.0),
            (-1.0, SlipVerdict::Holding, 4.0),
            (f64::NEG_INFINITY, SlipVerdict::Holding, 4.0),
        ] {
            let mut grip = GripController::new(settings::<f64>()).unwrap();
            grip.start_at(6.0);
            grip.command(&Answer(answer), &load(1.0), slip, 1.0);
            assert!((grip.present() - wanted).abs() < 1e-12, "{answer} {}", grip.present());
        }
    }

    #[test]
    fn faults_never_open_the_finger() {
        let friction = Coulomb::new(0.5).unwrap();
        let mut grip = GripController::new(settings::<f64>()).unwrap();
        grip.start_at(6.0);
        for bad in [f64::NAN, f64::INFINITY] {
            grip.command(&friction, &load(bad), SlipVerdict::Holding, 1.0);
            grip.command(&friction, &load(1.0), SlipVerdict::Holding, bad);
            grip.start_at(f64::NAN);
        }
        grip.command(&friction, &load(0.0), SlipVerdict::Holding, -1.0);
        assert_eq!(grip.present(), 6.0);
        // A load that no grip holds saturates at the greatest force.
        for _ in 0..100 {
            grip.command(&friction, &load(1e300), SlipVerdict::Slipping, 1.0);
        }
        assert_eq!(grip.present(), 20.0);
        for bad in [0.5, f64::NAN] {
            assert!(GripController::new(GripSettings { safety: bad, ..settings::<f64>() }).is_err());
            assert!(GripController::new(GripSettings { greatest: bad * 0.1, ..settings::<f64>() }).is_err());
        }
    }
}
