//! The laws of dynamic friction with one deflection (bristle) as state.

use fingertip_wrench::{Real, stored};

use crate::bad_parameter::{not_negative, positive};
use crate::{BadParameter, Stribeck};

/// A friction law `F = σ₀z + σ₁ż + σ₂v`, `ż = v − α(z, v) σ₀|v|z/g(|v|)`
/// (`docs/theory/friction.md#bristle-laws`).
///
/// Forces are in newtons, or per newton of normal force where the state is loaded
/// ([`Bristle::set_load`](crate::Bristle::set_load)). In two or three dimensions, `|v|` and `|z|`
/// are Euclidean.
///
/// # For implementers
/// `steady` lies between a positive bound and `greatest`, and `plastic_share` in \[0, 1\]:
/// boundedness and passivity of the integrators rest on just that.
///
/// ```
/// use fingertip_friction::{Bristle, BristleLaw, Dahl, LuGre};
///
/// fn greatest(law: &impl BristleLaw<f64>) -> f64 {
///     law.greatest()
/// }
///
/// assert!((greatest(&Dahl::new(1e5, 0.5)?) - 0.5).abs() < 1e-12);
/// assert!(greatest(&LuGre::reference()?) > 0.0);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no law of bristles in `{T}`",
    note = "take `Dahl`, `LuGre` or `ElastoPlastic`, or implement `BristleLaw`: `stiffness`, `steady` and `greatest`"
)]
pub trait BristleLaw<T: Real> {
    /// σ₀ \[N/m\].
    fn stiffness(&self) -> T;

    /// σ₁ \[N·s/m\].
    fn damping(&self) -> T {
        T::zero()
    }

    /// σ₂ \[N·s/m\].
    fn viscous(&self) -> T {
        T::zero()
    }

    /// g: the friction of steady sliding, without the viscous part \[N\].
    fn steady(&self, speed: T) -> T;

    /// F_s: the greatest value of `steady` \[N\].
    fn greatest(&self) -> T;

    /// α: how much of the motion slides; 0 while purely elastic. `deflection` is `|z|`, `opposed`
    /// tells that the motion unloads the bristle (`z·v < 0`).
    fn plastic_share(&self, _deflection: T, _opposed: bool, _speed: T) -> T {
        T::one()
    }
}

/// The methods of a law that slides as its field `sliding` does.
macro_rules! slides_by_lugre {
    () => {
        #[inline]
        fn stiffness(&self) -> T {
            self.sliding.stiffness()
        }

        #[inline]
        fn damping(&self) -> T {
            self.sliding.damping()
        }

        #[inline]
        fn viscous(&self) -> T {
            self.sliding.viscous()
        }

        #[inline]
        fn steady(&self, speed: T) -> T {
            self.sliding.steady(speed)
        }

        #[inline]
        fn greatest(&self) -> T {
            self.sliding.greatest()
        }
    };
}

/// Dahl's law (1968): LuGre without Stribeck effect and damping.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0); // N
/// let mut force = 0.0;
/// for _ in 0..1000 {
///     force = friction.step(&Vector1::new(0.01), 1e-4).end[0];
/// }
/// // Slid for a millimetre: about what friction holds of 2 N.
/// assert!((0.8..1.2).contains(&force), "{force}");
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dahl<T: Real> {
    sliding: LuGre<T>,
}

/// The LuGre law (Canudas de Wit, Olsson, Åström & Lischinsky 1995).
///
/// ```
/// use fingertip_friction::{Bristle, LuGre, Stribeck};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(LuGre::new(1e5, 300.0, 0.4, Stribeck::new(0.45, 0.55, 1e-3)?)?);
/// friction.set_load(2.0); // N
/// let mut force = 0.0;
/// for _ in 0..1000 {
///     force = friction.step(&Vector1::new(0.01), 1e-4).end[0];
/// }
/// // Slid for a millimetre: about what friction holds of 2 N.
/// assert!((0.8..1.2).contains(&force), "{force}");
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre<T: Real> {
    stiffness: T,
    damping: T,
    viscous: T,
    curve: Stribeck<T>,
}

/// The elasto-plastic law (Dupont, Hayward, Armstrong & Altpeter 2002): LuGre with a purely elastic
/// range, so that it does not creep under a load that stays below break-away.
///
/// ```
/// use fingertip_friction::{Bristle, ElastoPlastic, LuGre, Stribeck};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(ElastoPlastic::new(LuGre::new(1e5, 300.0, 0.4, Stribeck::new(0.45, 0.55, 1e-3)?)?, 0.5)?);
/// friction.set_load(2.0); // N
/// let mut force = 0.0;
/// for _ in 0..1000 {
///     force = friction.step(&Vector1::new(0.01), 1e-4).end[0];
/// }
/// // Slid for a millimetre: about what friction holds of 2 N.
/// assert!((0.8..1.2).contains(&force), "{force}");
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElastoPlastic<T: Real> {
    sliding: LuGre<T>,
    elastic_share: T,
}

impl<T: Real> Dahl<T> {
    /// From the stiffness σ₀ \[N/m\] and the friction F_c \[N\].
    ///
    /// # Errors
    /// [`BadParameter`] unless both are positive and finite.
    pub fn new(stiffness: T, friction: T) -> Result<Self, BadParameter> {
        let curve = Stribeck::constant(friction)?;
        Ok(Self { sliding: LuGre::new(stiffness, T::zero(), T::zero(), curve)? })
    }
}

impl<T: Real> BristleLaw<T> for Dahl<T> {
    slides_by_lugre!();
}

impl<T: Real> LuGre<T> {
    /// From σ₀ \[N/m\], σ₁ \[N·s/m\], σ₂ \[N·s/m\] and the Stribeck curve.
    ///
    /// # Errors
    /// [`BadParameter`] unless σ₀ is positive and σ₁, σ₂ not negative, all finite.
    pub fn new(stiffness: T, damping: T, viscous: T, curve: Stribeck<T>) -> Result<Self, BadParameter> {
        Ok(Self {
            stiffness: positive(stiffness, "stiffness")?,
            damping: not_negative(damping, "damping")?,
            viscous: not_negative(viscous, "viscous friction")?,
            curve,
        })
    }

    /// The parameters of the 1995 paper's Table I: σ₀ = 1e5 N/m, σ₁ = √1e5 N·s/m, σ₂ = 0.4 N·s/m,
    /// F_c = 1 N, F_s = 1.5 N, v_s = 1 mm/s.
    ///
    /// # Errors
    /// Never, for a type that holds these numbers.
    pub fn reference() -> Result<Self, BadParameter> {
        let curve = Stribeck::new(T::one(), T::literal(1.5), T::literal(1e-3))?;
        Self::new(T::literal(1e5), T::literal(1e5).root(), T::literal(0.4), curve)
    }

    /// The Stribeck curve.
    #[inline]
    #[must_use]
    pub const fn curve(&self) -> &Stribeck<T> {
        &self.curve
    }
}

impl<T: Real> BristleLaw<T> for LuGre<T> {
    #[inline]
    fn stiffness(&self) -> T {
        self.stiffness
    }

    #[inline]
    fn damping(&self) -> T {
        self.damping
    }

    #[inline]
    fn viscous(&self) -> T {
        self.viscous
    }

    #[inline]
    fn steady(&self, speed: T) -> T {
        self.curve.at(speed)
    }

    #[inline]
    fn greatest(&self) -> T {
        self.curve.breakaway()
    }
}

impl<T: Real> ElastoPlastic<T> {
    /// From the law of sliding and the share of the break-away deflection `F_s/σ₀` up to which the
    /// contact is purely elastic (`z_ba σ₀/F_s`).
    ///
    /// # Errors
    /// [`BadParameter`] unless the share is between 0 and the ratio of kinetic to static friction,
    /// beyond which steady sliding would be elastic.
    pub fn new(sliding: LuGre<T>, elastic_share: T) -> Result<Self, BadParameter> {
        let greatest = sliding.curve.kinetic() / sliding.curve.breakaway();
        if !(elastic_share >= T::zero() && elastic_share < greatest) {
            return Err(BadParameter {
                parameter: "elastic share",
                requirement: "from 0 to below the ratio of kinetic to static friction",
            });
        }
        Ok(Self { sliding, elastic_share })
    }
}

impl<T: Real> BristleLaw<T> for ElastoPlastic<T> {
    slides_by_lugre!();

    #[inline]
    fn plastic_share(&self, deflection: T, opposed: bool, speed: T) -> T {
        let elastic = self.elastic_share * self.greatest() / self.stiffness();
        let sliding = self.steady(speed) / self.stiffness();
        if opposed || deflection <= elastic {
            T::zero()
        } else if deflection >= sliding {
            T::one()
        } else {
            let middle = (sliding + elastic) * T::literal(0.5);
            let phase = T::pi() * (deflection - middle) / (sliding - elastic);
            ((phase.sine() + T::one()) * T::literal(0.5)).clamp(T::zero(), T::one())
        }
    }
}

/// Dry friction on a Stribeck curve with a stiff elastic contact: meant for
/// [`ReturnMap`](crate::ReturnMap), with which it sticks below F_s and slides at `g(v) + σ₂v`.
///
/// ```
/// use fingertip_friction::{Bristle, Stribeck, StribeckFriction};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(StribeckFriction::new(1e5, 0.0, Stribeck::new(0.45, 0.55, 1e-3)?)?);
/// friction.set_load(2.0); // N
/// let mut force = 0.0;
/// for _ in 0..1000 {
///     force = friction.step(&Vector1::new(0.01), 1e-4).end[0];
/// }
/// // Slid for a millimetre: about what friction holds of 2 N.
/// assert!((0.8..1.2).contains(&force), "{force}");
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StribeckFriction<T: Real> {
    sliding: LuGre<T>,
}

impl<T: Real> StribeckFriction<T> {
    /// From the stiffness of the stuck contact \[N/m\], σ₂ \[N·s/m\] and the curve.
    ///
    /// # Errors
    /// [`BadParameter`] unless the stiffness is positive and σ₂ not negative, both finite.
    pub fn new(stiffness: T, viscous: T, curve: Stribeck<T>) -> Result<Self, BadParameter> {
        Ok(Self { sliding: LuGre::new(stiffness, T::zero(), viscous, curve)? })
    }
}

impl<T: Real> BristleLaw<T> for StribeckFriction<T> {
    slides_by_lugre!();
}

stored! {
    Dahl<T>, [T: Real],
    |law| { stiffness: T = law.sliding.stiffness, friction: T = law.sliding.curve.kinetic() },
    Self::new(stiffness, friction)
}

stored! {
    LuGre<T>, [T: Real],
    |law| {
        stiffness: T = law.stiffness,
        damping: T = law.damping,
        viscous: T = law.viscous,
        curve: Stribeck<T> = law.curve,
    },
    Self::new(stiffness, damping, viscous, curve)
}

stored! {
    ElastoPlastic<T>, [T: Real],
    |law| { sliding: LuGre<T> = law.sliding, elastic_share: T = law.elastic_share },
    Self::new(sliding, elastic_share)
}

stored! {
    StribeckFriction<T>, [T: Real],
    |law| {
        stiffness: T = law.sliding.stiffness,
        viscous: T = law.sliding.viscous,
        curve: Stribeck<T> = law.sliding.curve,
    },
    Self::new(stiffness, viscous, curve)
}
