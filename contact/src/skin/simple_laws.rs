//! Laws of one or two constants.

use fingertip_surfaces::BadShape;
use fingertip_wrench::Real;

use super::Indentation;

/// Depth in proportion to the force, `δ = N/k`, with a patch as a rigid flat cuts it out of a
/// sphere, `a = √(2Rδ)`: a soft layer of springs (Winkler) in the small.
///
/// ```
/// use fingertip_contact::LinearStiffness;
///
/// // 2 N/mm, on a fingertip of 8 mm: under 1 N half a millimetre, and a patch of √(2 · 8 mm · 0.5 mm).
/// let indentation = LinearStiffness::new(2000.0_f64, 0.008)?.indentation(1.0);
/// assert!((indentation.depth - 0.5e-3).abs() < 1e-12);
/// assert!((indentation.patch[0] - 8e-6_f64.sqrt()).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearStiffness<T: Real> {
    stiffness: T,
    radius: T,
}

impl<T: Real> LinearStiffness<T> {
    /// From the stiffness \[N/m\] and the radius of the fingertip \[m\], which gives the patch.
    ///
    /// # Errors
    /// [`BadShape`] unless both are positive and finite.
    pub fn new(stiffness: T, radius: T) -> Result<Self, BadShape> {
        BadShape::check_length("linear skin", "stiffness", stiffness)
            .map_err(|bad| BadShape { requirement: "positive and finite", ..bad })?;
        BadShape::check_length("linear skin", "radius", radius)?;
        Ok(Self { stiffness, radius })
    }
}

impl<T: Real> LinearStiffness<T> {
    /// The indentation under a normal force \[N\].
    #[inline]
    #[must_use]
    pub fn indentation(&self, normal_force: T) -> Indentation<T> {
        let depth = normal_force / self.stiffness;
        let radius = (self.radius * (depth + depth)).root();
        Indentation { depth, patch: [radius; 2] }
    }

    /// How fast the depth grows with the normal force \[m/N\].
    #[must_use]
    pub fn compliance(&self, _normal_force: T) -> T {
        T::one() / self.stiffness
    }
}

/// Powers of the force: `a = c_a N^γ_a`, `δ = c_δ N^γ_δ`.
///
/// For a material whose stress grows as the power ν of strain, `γ_a = 1/(2 + ν)` and
/// `γ_δ = 2γ_a`; γ_a lies between 0 (all the patch at once) and 1/3 (linearly elastic: Hertz).
/// Xydas & Kao (1999) measured γ_a of soft fingers between 0.1 and 1/3.
///
/// ```
/// use fingertip_contact::PowerLaw;
///
/// // At 1 N a patch of 2 mm and 0.4 mm deep; they grow as the 1/3 and the 2/3 power of the force.
/// let law = PowerLaw::new([2e-3_f64, 1.0 / 3.0], [4e-4, 2.0 / 3.0])?;
/// let under_8_newtons = law.indentation(8.0);
/// assert!((under_8_newtons.patch[0] - 4e-3).abs() < 1e-12);
/// assert!((under_8_newtons.depth - 1.6e-3).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PowerLaw<T: Real> {
    patch: T,
    patch_exponent: T,
    depth: T,
    depth_exponent: T,
}

impl<T: Real> PowerLaw<T> {
    /// From the patch radius at 1 N \[m\] with its exponent, and the depth at 1 N \[m\] with its
    /// exponent.
    ///
    /// # Errors
    /// [`BadShape`] unless the lengths are positive and finite, and the exponents between 0
    /// (excluded) and 1.
    pub fn new(patch: [T; 2], depth: [T; 2]) -> Result<Self, BadShape> {
        for [length, exponent] in [patch, depth] {
            BadShape::check_length("power-law skin", "lengths at 1 N", length)?;
            BadShape::check(
                "power-law skin",
                "exponents",
                "above 0 and at most 1",
                exponent > T::zero() && exponent <= T::one(),
            )?;
        }
        let ([patch, patch_exponent], [depth, depth_exponent]) = (patch, depth);
        Ok(Self { patch, patch_exponent, depth, depth_exponent })
    }
}

impl<T: Real> PowerLaw<T> {
    /// The indentation under a normal force \[N\].
    #[inline]
    #[must_use]
    pub fn indentation(&self, normal_force: T) -> Indentation<T> {
        if !(normal_force > T::zero()) {
            return Indentation { depth: T::zero(), patch: [T::zero(); 2] };
        }
        let radius = self.patch * normal_force.power(self.patch_exponent);
        let depth = self.depth * normal_force.power(self.depth_exponent);
        Indentation { depth: depth.min(T::GREATEST), patch: [radius.min(T::GREATEST); 2] }
    }

    /// How fast the depth grows with the normal force \[m/N\]: `γ_δ δ/N`; at no force without bound, but for an
    /// exponent of 1.
    #[must_use]
    pub fn compliance(&self, normal_force: T) -> T {
        self.depth * self.depth_exponent * normal_force.max(T::zero()).power(self.depth_exponent - T::one())
    }
}
