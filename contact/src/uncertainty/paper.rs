//! The error bounds of the first paper, mended.

use fingertip_surfaces::BadShape;
use fingertip_wrench::Real;
use nalgebra::Vector3;

/// Bounds (3) to (9) of Bicchi & Dario (1987) on a point contact with a sphere around the origin,
/// for relative errors of every force and torque component of at most `E`.
///
/// The print has errors (of the scan or of the type-setter): signs, a misplaced bracket in
/// (4)-(6), a denominator in `K`. The functions here return the corrected bounds and the sharp
/// ones. With `B₁ = |F₂F₆| + |F₃F₅|` and so on in cyclic order, `w` half the chord, `u = F/|F|`,
/// and `q` the angle between force and normal:
///
/// | | printed | corrected | sharp |
/// |---|---|---|---|
/// | (3) `|dF|/|F|` | 2E | E | E |
/// | (4)-(6) `|dX_i|` | `(2/F²) E·2B_i + K|F_i|` | `(2E/F²)(2B_i + K|F_i|)` | [`ContactJacobian::worst_case`](crate::ContactJacobian::worst_case) |
/// | `K` | `(F⁴R² + 2B₁² + B₂² + B₃²)/(w|F|)` | `(F⁴R² + 2ΣB²)/(w|F|³)` | |
/// | (7) `|dX_i|`, force through the centre | `2R|u_i| E` | the same | `2R|u_i|(1 − u_i²) E` |
/// | (8) `|dX|`, force through the centre | `2R E` | the same | `R E √(1 − min_s (Σ s_i u_i²)²)`, `s_i = ±1` |
/// | (9) `f(q)`, tan q = 0.1 | 1.08 | 1.082 | 0.100 (worst frame 0.552) |
/// | (9) `f(q)`, tan q = 0.3 | 1.62 | 1.606 | 0.300 (worst frame 0.672) |
/// | (9) `f(q)`, tan q = 0.5 | 2.30 | 2.343 | 0.500 (worst frame 0.809) |
///
/// In (9) the error is `2R E f(q)`: a contact on the first axis with a force at the angle `q` to
/// the normal in a coordinate plane. "Worst frame" is the sharp value over all orientations of the
/// sensor frame. 1 % of error means a contact known to 0.573° on the sphere (8, sharp).
///
/// ```
/// use fingertip_contact::PaperBounds;
/// use nalgebra::Vector3;
///
/// // A sphere of 10 mm, and one per cent of error in each component.
/// let bounds = PaperBounds::new(0.01, 0.01)?;
/// let force = Vector3::new(0.3, -0.2, -1.0);
/// // The sharp bound on a force through the centre is within R E = 0.1 mm, and within the paper's.
/// let sharp = bounds.central_distance_sharp(&force);
/// assert!(sharp <= 0.1e-3 && sharp <= bounds.central_distance());
/// // Where the force is as much aside as inward, the error grows by tan 45° in the paper's frame.
/// assert!((bounds.obliquity_sharp(core::f64::consts::FRAC_PI_4) - 1.0).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperBounds<T: Real> {
    radius: T,
    relative_error: T,
}

impl<T: Real> PaperBounds<T> {
    /// For a sphere of this radius \[m\] and this relative error `E` of each component.
    ///
    /// # Errors
    /// [`BadShape`] unless the radius is a positive finite length and the error finite and not negative.
    pub fn new(radius: T, relative_error: T) -> Result<Self, BadShape> {
        let radius = BadShape::check_length("bounds", "radius", radius)?;
        let good = relative_error >= T::zero() && relative_error.is_number();
        BadShape::check("bounds", "relative error", "finite and not negative", good)?;
        Ok(Self { radius, relative_error })
    }

    /// (3): relative error of the force's magnitude, and of the force as a vector. Sharp.
    #[must_use]
    pub const fn force(&self) -> T {
        self.relative_error
    }

    /// (4)-(6): greatest error of each coordinate of the contact \[m\], for a wrench `F₁ … F₆` about
    /// the centre whose line of action hits the sphere; infinite where it touches or misses.
    #[must_use]
    pub fn contact(&self, force: &Vector3<T>, torque: &Vector3<T>) -> Vector3<T> {
        let two = T::one() + T::one();
        let unit = T::one() / self.radius;
        let scale = force.amax().normalising_factor();
        let f = force * scale;
        // In radii.
        let m = torque * (scale * unit);
        let squared = f.norm_squared();
        let magnitude = squared.root();
        let b = Vector3::new(
            (f.y * m.z).abs() + (f.z * m.y).abs(),
            (f.z * m.x).abs() + (f.x * m.z).abs(),
            (f.x * m.y).abs() + (f.y * m.x).abs(),
        );
        let foot = f.cross(&m) / squared;
        let chord = T::one() - foot.norm_squared();
        if !(chord > T::zero()) {
            return Vector3::repeat(T::one() / T::zero());
        }
        let k = (squared * squared + two * b.norm_squared()) / (chord.root() * magnitude * squared);
        (b * two + f.abs() * k) * (two * self.relative_error / squared * self.radius)
    }

    /// (7): the same for a force through the centre.
    #[must_use]
    pub fn central_contact(&self, force: &Vector3<T>) -> Vector3<T> {
        unit(force).abs() * (self.radius * self.relative_error * T::literal(2.0))
    }

    /// (7), sharp: `2R|u_i|(1 − u_i²)E`.
    #[must_use]
    pub fn central_contact_sharp(&self, force: &Vector3<T>) -> Vector3<T> {
        let size = self.radius * self.relative_error * T::literal(2.0);
        unit(force).map(|u| u.abs() * (T::one() - u) * (T::one() + u) * size)
    }

    /// (8): distance \[m\] that the contact of a force through the centre moves at most.
    #[must_use]
    pub fn central_distance(&self) -> T {
        self.radius * self.relative_error * T::literal(2.0)
    }

    /// (8), sharp; never more than `R E`.
    #[must_use]
    pub fn central_distance_sharp(&self, force: &Vector3<T>) -> T {
        let u = unit(force);
        let [a, b, c] = [u.x * u.x, u.y * u.y, u.z * u.z];
        // The least |±a ± b ± c| of numbers that add up to 1.
        let least = (a + b - c).abs().min((a - b + c).abs()).min((b + c - a).abs());
        self.radius * self.relative_error * ((T::one() - least) * (T::one() + least)).root()
    }

    /// (9): the corrected `f(q) = √((1 + 4 sin² q)² + (3 tan q)²)`; the error is `2R E f(q)`.
    #[must_use]
    pub fn obliquity(&self, angle: T) -> T {
        let (sin, tan) = (angle.sine(), angle.tangent());
        let (x, y) = (T::one() + T::literal(4.0) * sin * sin, T::literal(3.0) * tan);
        (x * x + y * y).root()
    }

    /// (9), sharp in the paper's frame: `tan q`.
    #[must_use]
    pub fn obliquity_sharp(&self, angle: T) -> T {
        angle.tangent().abs()
    }

    /// (9), sharp over all orientations of the frame: `(tan q + sec q)/2`.
    #[must_use]
    pub fn obliquity_worst_frame(&self, angle: T) -> T {
        (angle.tangent().abs() + T::one() / angle.cosine()) * T::literal(0.5)
    }
}

fn unit<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    let scaled = v * v.amax().normalising_factor();
    let length = scaled.norm_squared().root();
    if length > T::zero() { scaled / length } else { Vector3::zeros() }
}
