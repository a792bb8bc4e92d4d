//! Point contact or soft finger, as the wrench asks for.

use fingertip_surfaces::BadShape;
use fingertip_surfaces::numeric::vectors::length;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::uncertainty::is_covariance;
use crate::{ContactModel, NoContact, PointContact, Resolution, SoftFinger, SoftFingerSurface};

/// Which model the pitch of a wrench asks for.
///
/// ```
/// use fingertip_contact::{Auto, Choice, PointContact, SoftFinger};
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// // 10 mN and 0.1 N·mm of noise; friction times torque arm is 1 mm.
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let auto = Auto::new(PointContact::new(0.05)?, SoftFinger::new(0.05)?, noise)?.with_greatest_pitch(1e-3, 3.0)?;
/// let of = |newton_metres: f64| {
///     let wrench = Wrench::on_fingertip(-Vector3::z(), Vector3::new(0.0, 0.0, newton_metres));
///     auto.test(&wrench).map(|test| test.choice)
/// };
/// assert_eq!(of(5e-5), Some(Choice::PointContact));
/// assert_eq!(of(8e-4), Some(Choice::SoftFinger));
/// assert_eq!(of(5e-3), Some(Choice::NotOneContact));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The pitch is within the noise: no spin torque can be told from none.
    PointContact,
    /// There is a spin torque.
    SoftFinger,
    /// The pitch is more than a single contact can give.
    NotOneContact,
}

/// The pitch test of a wrench, and what follows from it.
///
/// ```
/// use fingertip_contact::{Auto, PitchTest, PointContact, SoftFinger};
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// // The torque has 0.1 N·mm of noise, the force next to none.
/// let noise = Matrix6::from_diagonal(&[1e-12, 1e-12, 1e-12, 1e-8, 1e-8, 1e-8].into());
/// let auto = Auto::new(PointContact::new(0.05)?, SoftFinger::new(0.05)?, noise)?;
/// // 0.5 N·mm along 2 N: a pitch of 0.25 mm, known to 0.05 mm; five deviations, of which T is the square.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, 2.0), Vector3::new(0.0, 0.0, 5e-4));
/// let test: PitchTest<f64> = auto.test(&wrench).ok_or("no force")?;
/// assert!((test.pitch - 0.25e-3).abs() < 1e-9 && (test.deviation - 0.05e-3).abs() < 1e-9);
/// assert!((test.statistic - 25.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PitchTest<T: Real> {
    /// Pitch `f·m/|f|²` \[m\].
    pub pitch: T,
    /// Its standard deviation \[m\], from the noise of the wrench.
    pub deviation: T,
    /// `(f·m)²/var(f·m)`: follows χ² with one degree of freedom if the pitch is zero.
    pub statistic: T,
    /// By how many standard deviations the pitch exceeds what one contact can give; negative if it
    /// does not.
    pub excess: T,
    /// The verdict.
    pub choice: Choice,
}

/// Chooses between [`PointContact`] and [`SoftFinger`] by the pitch test, sample by sample.
///
/// A single hard point contact gives a wrench of pitch zero. So
/// `T = (f·m)²/(mᵀΣ_ff m + 2mᵀΣ_fm f + fᵀΣ_mm f)` follows χ² with one degree of freedom
/// (`docs/theory/contact.md#pitch-test`); above the threshold there is a spin torque, and the soft finger
/// finds the place where it acts about the normal. Below, the point contact is as good, and less noisy.
///
/// A soft finger with friction coefficient `μ` and torque arm `e` (for Hertz's patch of radius
/// `a`, `3πa/16`) has a pitch of at most `e μ`. A pitch above that by more than so many
/// standard deviations is of no single contact: [`NoContact::NotOneContact`].
///
/// What the test cannot tell: parallel forces at several places have no pitch either, and look
/// like one contact between them (`docs/theory/contact.md#what-six-numbers-cannot-tell`).
///
/// ```
/// use fingertip_contact::{Auto, ContactModel, PointContact, SoftFinger};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// // 10 mN and 0.1 N·mm of noise.
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let auto = Auto::new(PointContact::new(0.05)?, SoftFinger::new(0.05)?, noise)?;
/// // 2 N at the top of a sphere of 10 mm, with a spin torque of 3 N·mm, which noise does not explain.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, 3e-3));
/// let contact = auto.resolve(&wrench, &Sphere::centred(0.01)?).into_result()?;
/// assert!((contact.spin_torque - 3e-3_f64).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Auto<T: Real> {
    point: PointContact<T>,
    soft: SoftFinger<T>,
    noise: Matrix6<T>,
    threshold: T,
    greatest_pitch: Option<(T, T)>,
}

impl<T: Real> Auto<T> {
    /// From the two models and the covariance of the wrench `[Fx … Tz]` \[N², N·N·m, (N·m)²\]. The
    /// threshold is 6.635, which one wrench in a hundred of a point contact exceeds.
    ///
    /// # Errors
    /// [`BadShape`] unless the covariance is finite, symmetric and has no negative variance in any direction,
    /// but for rounding.
    pub fn new(point: PointContact<T>, soft: SoftFinger<T>, noise: Matrix6<T>) -> Result<Self, BadShape> {
        let requirement = "finite, symmetric and without a negative variance";
        BadShape::check("pitch test", "covariance", requirement, is_covariance(&noise))?;
        Ok(Self { point, soft, noise, threshold: T::literal(6.634_896_601_021_213), greatest_pitch: None })
    }

    /// Another quantile of χ² with one degree of freedom: 3.841 for 5 %, 10.828 for one in a
    /// thousand.
    ///
    /// # Errors
    /// [`BadShape`] unless it is positive and finite.
    pub fn with_threshold(self, threshold: T) -> Result<Self, BadShape> {
        let good = threshold > T::zero() && threshold.is_number();
        BadShape::check("pitch test", "threshold", "positive and finite", good)
            .map(|()| Self { threshold, ..self })
    }

    /// A single contact has a pitch of at most `greatest_pitch` \[m\], friction coefficient times
    /// torque arm; one that exceeds it by more than `deviations` standard deviations (3 is usual)
    /// is refused.
    ///
    /// # Errors
    /// [`BadShape`] unless both are finite and not negative.
    pub fn with_greatest_pitch(self, greatest_pitch: T, deviations: T) -> Result<Self, BadShape> {
        let good = greatest_pitch >= T::zero() && deviations >= T::zero();
        let finite = (greatest_pitch + deviations).is_number();
        BadShape::check("pitch test", "greatest pitch", "finite and not negative", good && finite)
            .map(|()| Self { greatest_pitch: Some((greatest_pitch, deviations)), ..self })
    }

    /// The test alone. `None` if the wrench has no line of action.
    #[must_use]
    pub fn test(&self, wrench: &Wrench<T>) -> Option<PitchTest<T>> {
        let axis = wrench.line_of_action().ok()?;
        let scale = wrench.force().amax().normalising_factor();
        let (f, m) = (wrench.force() * scale, wrench.torque() * scale);
        let spread =
            |gradient: &Vector6<T>| gradient.dot(&(self.noise * gradient)).max(T::zero()).root() * scale;
        // d(f·m) = m·df + f·dm, and the same less twice the pitch for f·m/|f|².
        let power = f.dot(&m);
        let flat = Vector6::new(m.x, m.y, m.z, f.x, f.y, f.z);
        let z = power.abs() / spread(&flat);
        // Without noise any pitch but zero is certain.
        let statistic = if power.is_zero() { T::zero() } else { (z * z).min(T::GREATEST) };
        let less = m - f * (axis.pitch + axis.pitch);
        let steep = Vector6::new(less.x, less.y, less.z, f.x, f.y, f.z);
        let deviation = spread(&steep) / f.norm_squared();
        let (excess, refused) =
            self.greatest_pitch.map_or((-T::GREATEST, false), |(greatest, deviations)| {
                let beyond = axis.pitch.abs() - greatest;
                let excess = if beyond.is_zero() { T::zero() } else { beyond / deviation };
                (excess.max(-T::GREATEST).min(T::GREATEST), excess > deviations)
            });
        let choice = if refused {
            Choice::NotOneContact
        } else if statistic > self.threshold {
            Choice::SoftFinger
        } else {
            Choice::PointContact
        };
        Some(PitchTest { pitch: axis.pitch, deviation, statistic, excess, choice })
    }

    /// The contact, with the test that chose the model; no test where the wrench has no line of
    /// action.
    pub fn resolve_with_test<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> (Resolution<T>, Option<PitchTest<T>>) {
        let test = self.test(wrench);
        let resolution = match test {
            Some(PitchTest { choice: Choice::NotOneContact, pitch, excess, .. })
                if length(&wrench.force()) >= self.point.least_force() =>
            {
                Resolution::NoContact(NoContact::NotOneContact { pitch, excess })
            }
            Some(PitchTest { choice: Choice::SoftFinger, .. }) | None => {
                self.soft.resolve_near(wrench, surface, last)
            }
            Some(_) => self.point.resolve_near(wrench, surface, last),
        };
        (resolution, test)
    }
}

impl<T: Real, S: SoftFingerSurface<T>> ContactModel<T, S> for Auto<T> {
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T> {
        self.resolve_with_test(wrench, surface, last).0
    }
}
