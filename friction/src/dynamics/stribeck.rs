//! How sliding friction falls with speed.

use fingertip_wrench::{Real, stored};

use crate::BadParameter;
use crate::bad_parameter::positive;

/// Stribeck's curve `g(v) = F_c + (F_s − F_c) e^{−(v/v_s)²}`: the friction force of steady sliding
/// without its viscous part (`docs/theory/friction.md#bristle-laws`).
///
/// ```
/// use fingertip_friction::Stribeck;
///
/// let curve = Stribeck::new(0.45, 0.55, 1e-3)?; // sliding, breaking away, and the speed between [m/s]
/// assert!((curve.at(0.0) - 0.55_f64).abs() < 1e-12 && curve.at(0.1) < 0.4501);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck<T: Real> {
    kinetic: T,
    breakaway: T,
    speed: T,
}

impl<T: Real> Stribeck<T> {
    /// From the kinetic friction F_c, the static friction F_s (newtons, or coefficients where the
    /// law is loaded by a normal force), and the Stribeck speed v_s \[m/s\].
    ///
    /// # Errors
    /// [`BadParameter`] unless all are positive and finite and F_s ≥ F_c.
    pub fn new(kinetic: T, breakaway: T, speed: T) -> Result<Self, BadParameter> {
        let kinetic = positive(kinetic, "kinetic friction")?;
        let breakaway = positive(breakaway, "static friction")?;
        if breakaway < kinetic {
            return Err(BadParameter {
                parameter: "static friction",
                requirement: "at least the kinetic friction",
            });
        }
        Ok(Self { kinetic, breakaway, speed: positive(speed, "Stribeck speed")? })
    }

    /// The same friction at every speed.
    ///
    /// # Errors
    /// [`BadParameter`] unless it is positive and finite.
    pub fn constant(friction: T) -> Result<Self, BadParameter> {
        Self::new(friction, friction, T::one())
    }

    /// `g(|v|)`: from F_s at rest down to F_c. A NaN gives F_c.
    #[inline]
    #[must_use]
    pub fn at(&self, speed: T) -> T {
        let relative = (speed / self.speed).abs();
        // Beyond this the exponential is below the rounding of any result.
        if relative < T::literal(26.0) && self.breakaway > self.kinetic {
            self.kinetic + (self.breakaway - self.kinetic) * (-(relative * relative)).exponential()
        } else {
            self.kinetic
        }
    }

    /// F_c.
    #[inline]
    #[must_use]
    pub const fn kinetic(&self) -> T {
        self.kinetic
    }

    /// F_s.
    #[inline]
    #[must_use]
    pub const fn breakaway(&self) -> T {
        self.breakaway
    }

    /// v_s \[m/s\].
    #[inline]
    #[must_use]
    pub const fn speed(&self) -> T {
        self.speed
    }
}

stored! {
    Stribeck<T>, [T: Real],
    |curve| {
        kinetic: T = curve.kinetic,
        #[serde(rename = "static")]
        breakaway: T = curve.breakaway,
        #[serde(rename = "speed_m_per_s")]
        speed: T = curve.speed,
    },
    Self::new(kinetic, breakaway, speed)
}
