//! What a tracker says after a sample.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector2, Vector3};

/// How a sample fits to those before it.
///
/// ```
/// use fingertip_contact::{Continuity, Sighting, Tracker};
/// use fingertip_surfaces::Sphere;
/// use nalgebra::{Matrix2, Vector3};
///
/// let ball = Sphere::centred(0.013)?;
/// // Seen to 0.1 mm, below and then at the side.
/// let seen = |normal: Vector3<f64>, tangent| {
///     Sighting::new(normal * 0.013, normal, [tangent, normal.cross(&tangent)], Matrix2::identity() * 1e-8)
/// };
/// let (below, aside) = (seen(-Vector3::z(), Vector3::x()), seen(Vector3::x(), Vector3::y()));
/// let mut tracker = Tracker::new(0.01, 0.1)?;
/// let mut follow = |seen: &Option<_>| tracker.follow(&ball, seen.as_ref(), 1e-3).map(|now| now.continuity);
/// assert_eq!([follow(&below), follow(&below)], [Some(Continuity::New), Some(Continuity::Followed)]);
/// // One sample elsewhere may be wrong, two are another contact.
/// assert_eq!([follow(&aside), follow(&aside)], [Some(Continuity::Doubted), Some(Continuity::New)]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Continuity {
    /// Another contact than before, or the first: what was known of the old one is forgotten.
    New,
    /// The same contact, a little farther.
    Followed,
    /// Too far away for the same contact. It may be a sample gone wrong, so the track waits for the next one: if
    /// that is there, too, it is a new contact.
    Doubted,
    /// No contact was seen, but the track still knows better where it would be than a sample does.
    Bridged,
}

/// Where a contact is, by all samples so far.
///
/// Numbers in a plane refer to `tangents`, which are carried along the surface without turning about the normal.
///
/// ```
/// use fingertip_contact::{Sighting, Tracked, Tracker};
/// use fingertip_surfaces::Sphere;
/// use nalgebra::{Matrix2, Vector3};
///
/// // A contact at rest below a ball of 13 mm, each sample seen to 0.1 mm.
/// let (ball, normal) = (Sphere::centred(0.013)?, -Vector3::z());
/// let seen = Sighting::new(normal * 0.013, normal, [Vector3::x(), -Vector3::y()], Matrix2::identity() * 1e-8);
/// let mut tracker = Tracker::new(0.001, 0.1)?;
/// let tracked: Tracked<f64> =
///     (0..100).filter_map(|_| tracker.follow(&ball, seen.as_ref(), 1e-3)).last().ok_or("no contact")?;
/// // A hundred samples know the place better than one.
/// assert!(tracked.deviation() < 0.05e-3 && tracked.velocity.norm() < 1e-9);
/// assert!((tracked.point - normal * 0.013).norm() < 1e-9 && !tracked.is_new());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Tracked<T: Real> {
    /// Where it is \[m\], on the surface.
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// Two unit vectors in the tangent plane, right-handed with the normal.
    pub tangents: [Vector3<T>; 2],
    /// How fast it moves over the fingertip \[m/s\], in the tangent plane.
    pub velocity: Vector3<T>,
    /// Covariance of the position along the tangents \[m²\].
    pub position_covariance: Matrix2<T>,
    /// Covariance of the velocity along the tangents \[m²/s²\].
    pub velocity_covariance: Matrix2<T>,
    /// From where the contact was expected to where this sample saw it, along the tangents of the sample before
    /// \[m\]; zero of the first sample, and without one.
    pub innovation: Vector2<T>,
    /// The same squared over its variance: χ² of two degrees of freedom while the contact moves as it was said to. The
    /// greatest number of a sample on another side of the body.
    pub surprise: T,
    /// How the sample fits to those before.
    pub continuity: Continuity,
}

impl<T: Real> Tracked<T> {
    /// Whether this is another contact than before.
    #[inline]
    #[must_use]
    pub fn is_new(&self) -> bool {
        self.continuity == Continuity::New
    }

    /// The velocity along the tangents \[m/s\], as its covariance has it.
    #[inline]
    #[must_use]
    pub fn velocity_in_plane(&self) -> Vector2<T> {
        Vector2::new(self.velocity.dot(&self.tangents[0]), self.velocity.dot(&self.tangents[1]))
    }

    /// Standard deviation of the position in the direction in which it is known worst \[m\]: the root of the
    /// greater eigenvalue.
    #[inline]
    #[must_use]
    pub fn deviation(&self) -> T {
        let p = &self.position_covariance;
        let half = T::literal(0.5);
        let (mean, apart) = ((p.m11 + p.m22) * half, (p.m11 - p.m22) * half);
        let scale = apart.abs().max(p.m12.abs()).normalising_factor();
        let (x, y) = (apart * scale, p.m12 * scale);
        (mean + (x * x + y * y).root() / scale).max(T::zero()).root()
    }
}
