//! Elastic bodies: the theory of Hertz.

use fingertip_surfaces::BadShape;
use fingertip_wrench::Real;

use super::Indentation;
use super::carlson::{r_d, r_f};

/// The contact modulus `E*` \[Pa\] of two bodies: `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`, from their
/// Young's moduli \[Pa\] and Poisson's ratios. An infinite modulus is a rigid body.
///
/// # Errors
/// [`BadShape`] unless the moduli are positive, one of them finite, and the ratios between −1 and
/// ½.
pub fn contact_modulus<T: Real>(young: [T; 2], poisson: [T; 2]) -> Result<T, BadShape> {
    let half = T::literal(0.5);
    let stiff = young.iter().all(|e| *e > T::zero());
    let good = stiff && poisson.iter().all(|nu| *nu > -T::one() && *nu <= half);
    let compliance = |e: T, nu: T| (T::one() - nu * nu) / e;
    let modulus = T::one() / (compliance(young[0], poisson[0]) + compliance(young[1], poisson[1]));
    BadShape::check(
        "contact of two bodies",
        "elastic constants",
        "positive moduli, one of them finite, and Poisson's ratios between −1 and 1/2",
        good && modulus > T::zero() && modulus.is_number(),
    )
    .map(|()| modulus)
}

/// Hertz's contact of two smooth elastic bodies, with an elliptic patch: depth as the 2/3, patch as
/// the 1/3 power of the force (Hertz 1881; Johnson 1985, chapter 4).
///
/// With relative radii of curvature `R_x ≥ R_y` (`1/R = 1/R₁ + 1/R₂` in each plane),
/// `A = 1/(2R_x)`, `B = 1/(2R_y)`, and the patch's ratio `k = b/a ≤ 1`:
///
/// ```text
/// B/A = R_D(0, 1, k²)/R_D(0, k², 1)
/// a³  = F R_D(0, k², 1)/(2π E* A),  b = k a,  p₀ = 3F/(2πab),  δ = p₀ b R_F(0, k², 1)/E*
/// ```
///
/// in Carlson's integrals, which do not cancel as the patch becomes round, as Legendre's do. The
/// constructor solves for `k`; a sample takes two roots.
///
/// ```
/// use fingertip_contact::{Hertz, contact_modulus};
///
/// // A rubber ball of 10 mm (0.75 MPa, ν = ½, so that E* = 1 MPa) on steel, under 1 N.
/// let skin = Hertz::sphere(0.01, contact_modulus([0.75e6, 210e9], [0.5, 0.3])?)?;
/// let indentation = skin.indentation(1.0);
/// // a³ = 3FR/(4E*), δ = a²/R: a patch of 2 mm, 0.38 mm deep.
/// let radius = (3.0 * 0.01 / 4e6_f64).cbrt();
/// assert!((indentation.patch[0] / radius - 1.0).abs() < 1e-3);
/// assert!((indentation.depth / (radius * radius / 0.01) - 1.0).abs() < 1e-3);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hertz<T: Real> {
    ratio: T,
    /// `a/F^(1/3)`.
    patch: T,
    /// `δ/F^(2/3)`.
    depth: T,
}

impl<T: Real> Hertz<T> {
    /// From the relative radii of curvature in the two principal planes \[m\], in any order, and the
    /// contact modulus \[Pa\] ([`contact_modulus`]).
    ///
    /// # Errors
    /// [`BadShape`] unless all are positive and finite, the radii within a factor `1/√ε` of each
    /// other.
    pub fn new(radii: [T; 2], modulus: T) -> Result<Self, BadShape> {
        // One by one: the greater of a number and a NaN is the number.
        for radius in radii {
            BadShape::check_length("Hertz contact", "radii of curvature", radius)?;
        }
        let (long, short) = (radii[0].max(radii[1]), radii[0].min(radii[1]));
        BadShape::check(
            "Hertz contact",
            "radii of curvature",
            "of comparable size",
            short / long >= T::EPSILON.root(),
        )?;
        BadShape::check(
            "Hertz contact",
            "contact modulus",
            "positive and finite",
            modulus > T::zero() && modulus.is_number(),
        )?;
        let ratio = patch_ratio(short / long);
        let squared = ratio * ratio;
        let two_pi = T::two_pi();
        let integral = r_d(T::zero(), squared, T::one());
        // 1/(2π E* A) = R_x/(π E*)
        let patch = (integral * (long + long) / (two_pi * modulus)).cube_root();
        // δ = 3F/(2πa) R_F/E*
        let depth = T::literal(3.0) * r_f(T::zero(), squared, T::one()) / (two_pi * patch * modulus);
        BadShape::check(
            "Hertz contact",
            "radii and modulus",
            "such that depth and patch can be represented",
            // Of a patch of zero the depth is infinite.
            (patch + depth).is_number(),
        )?;
        Ok(Self { ratio, patch, depth })
    }

    /// Of a sphere on a flat object, or of a sphere in a spherical one with relative radius `R`
    /// \[m\].
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn sphere(radius: T, modulus: T) -> Result<Self, BadShape> {
        Self::new([radius; 2], modulus)
    }

    /// Peak pressure in the middle of the patch \[Pa\]: `3F/(2πab)`.
    #[must_use]
    pub fn peak_pressure(&self, normal_force: T) -> T {
        if !(normal_force > T::zero()) {
            return T::zero();
        }
        let [a, b] = self.indentation(normal_force).patch;
        T::literal(1.5) * normal_force / (T::pi() * a * b)
    }
}

impl<T: Real> Hertz<T> {
    /// The indentation under a normal force \[N\].
    #[inline]
    #[must_use]
    pub fn indentation(&self, normal_force: T) -> Indentation<T> {
        let root = normal_force.max(T::zero()).cube_root();
        let a = self.patch * root;
        Indentation { depth: self.depth * root * root, patch: [a, a * self.ratio] }
    }

    /// How fast the depth grows with the normal force \[m/N\]: two thirds of `δ/F`; at no force without bound.
    #[must_use]
    pub fn compliance(&self, normal_force: T) -> T {
        self.depth * T::literal(2.0 / 3.0) / normal_force.max(T::zero()).cube_root()
    }
}

/// The patch's ratio `b/a` for a ratio `R_y/R_x ≤ 1` of the radii: the equation above is close to
/// a straight line in the logarithms, of slope −3/2 (−1 at the round end of the bracket), so the
/// secant method in a bracket takes few steps.
fn patch_ratio<T: Real>(radii: T) -> T {
    if radii >= T::one() {
        return T::one();
    }
    let excess = |log: T| {
        let squared = (log + log).exponential();
        let quotient = r_d(T::zero(), T::one(), squared) / r_d(T::zero(), squared, T::one());
        (quotient * radii).logarithm()
    };
    // The excess falls with the logarithm of the ratio: positive at R_y/R_x, negative at 1.
    let (mut low, mut high) = (radii.logarithm(), T::zero());
    let (mut at_low, mut at_high) = (excess(low), radii.logarithm());
    // So nearly round that rounding hides which side of the zero this is on: the bracket is the answer.
    if !(at_low > T::zero()) {
        return radii;
    }
    let mut guess = low * T::literal(2.0 / 3.0);
    for _ in 0..64 {
        let value = excess(guess);
        let before = guess;
        if value > T::zero() {
            low = guess;
            at_low = value;
            at_high *= T::literal(0.5);
        } else {
            high = guess;
            at_high = value;
            at_low *= T::literal(0.5);
        }
        guess = low + (high - low) * (at_low / (at_low - at_high));
        if !((guess - before).abs() > T::EPSILON) || value.is_zero() {
            break;
        }
    }
    guess.exponential()
}
