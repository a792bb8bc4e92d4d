//! What a grasp cannot resist.

use core::fmt;

use fingertip_wrench::{Frame, Real};
use nalgebra::Vector3;

use crate::Grasp;
use crate::grasp::spectrum::Spectrum;

/// A motion of the object that no contact resists, however hard the fingers press.
///
/// It prints as words:
///
/// ```
/// use fingertip_hand::{Grasp, GraspContact};
/// use nalgebra::Vector3;
///
/// // Between two point contacts the object turns about their line.
/// let left: GraspContact<f64> = GraspContact::point(-Vector3::x() * 0.02, Vector3::x(), 0.5)?;
/// let right = GraspContact::point(Vector3::x() * 0.02, -Vector3::x(), 0.5)?;
/// let grasp = Grasp::new([Some(left), Some(right)]);
/// assert_eq!(grasp.rank(), 5);
/// let freedom = grasp.freedoms()[0].expect("one");
/// assert_eq!(freedom.to_string(), "turning about the line through contacts 0 and 1");
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Freedom<T: Real, const N: usize> {
    /// Angular velocity \[rad/s\] of the motion; zero for sliding. Only the direction of the whole has a meaning.
    pub turning: Vector3<T>,
    /// Velocity \[m/s\] of the body's point at the origin of the frame.
    pub velocity: Vector3<T>,
    kind: Kind<T>,
    /// Whether the axis runs through the contact.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    through: [bool; N],
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
enum Kind<T: Real> {
    Sliding { along: Vector3<T> },
    Turning { along: Vector3<T>, point: Vector3<T> },
    Screwing { along: Vector3<T>, point: Vector3<T>, pitch: T },
}

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// How many independent wrenches the contacts can bear at all: the rank of the grasp map, 6 for a grasp that can
    /// hold anything given the right forces. Decided at half the digits of the scalar type.
    #[must_use]
    pub fn rank(&self) -> usize {
        Spectrum::new(self.blocks().flatten()).rank()
    }

    /// The motions that no contact resists, `6 − rank` of them first and then `None`: a basis of the left null space
    /// of the grasp map (`docs/theory/hand.md#what-a-grasp-cannot-resist`).
    #[must_use]
    pub fn freedoms(&self) -> [Option<Freedom<T, N>>; 6] {
        let spectrum = Spectrum::new(self.blocks().flatten());
        let threshold = spectrum.threshold();
        let mut found = [None; 6];
        let none = spectrum.values.iter().zip(spectrum.directions.column_iter());
        let none = none.filter(|(value, _)| !(**value > threshold));
        for (freedom, (_, direction)) in found.iter_mut().zip(none) {
            let velocity = direction.fixed_rows::<3>(0).into_owned();
            let turning = direction.fixed_rows::<3>(3).into_owned();
            *freedom = Some(self.freedom(velocity, turning));
        }
        found
    }

    /// From the velocity of the centre and the angular velocity times the length.
    fn freedom(&self, velocity: Vector3<T>, turning: Vector3<T>) -> Freedom<T, N> {
        let small = T::EPSILON.root().root();
        let rate = turning.norm_squared().root();
        let mut through = [false; N];
        let kind = if rate <= small * velocity.norm_squared().root() {
            Kind::Sliding { along: velocity }
        } else {
            let along = turning / rate;
            let point = self.centre() + along.cross(&velocity) * (self.length() / rate);
            for (through, contact) in through.iter_mut().zip(self.contacts()) {
                if let Some(contact) = contact {
                    let away = along.cross(&(contact.place() - point)).norm_squared().root();
                    *through = away <= small * self.length();
                }
            }
            let pitch = along.dot(&velocity) * (self.length() / rate);
            if pitch.abs() <= small * self.length() {
                Kind::Turning { along, point }
            } else {
                Kind::Screwing { along, point, pitch }
            }
        };
        let turning = turning / self.length();
        Freedom { turning, velocity: velocity - turning.cross(&self.centre()), kind, through }
    }
}

impl<T: Real, const N: usize> fmt::Display for Freedom<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let write = |f: &mut fmt::Formatter<'_>, v: &Vector3<T>| {
            // No negative zeros.
            let [x, y, z] = v.map(|x| x.to_f64() + 0.0).into();
            write!(f, "({x:.3}, {y:.3}, {z:.3})")
        };
        let (along, point, pitch) = match &self.kind {
            Kind::Sliding { along } => {
                f.write_str("sliding along ")?;
                return write(f, along);
            }
            Kind::Turning { along, point } => (along, point, None),
            Kind::Screwing { along, point, pitch } => (along, point, Some(pitch)),
        };
        f.write_str("turning about the line ")?;
        let touched = self.through.iter().filter(|through| **through).count();
        let mut indices = (0..N).zip(&self.through).filter(|(_, through)| **through).map(|(i, _)| i);
        match (touched, indices.next(), indices.next()) {
            (2, Some(first), Some(second)) => write!(f, "through contacts {first} and {second}")?,
            (1, Some(only), _) => {
                write!(f, "through contact {only} along ")?;
                write(f, along)?;
            }
            _ => {
                f.write_str("through ")?;
                write(f, point)?;
                f.write_str(" m along ")?;
                write(f, along)?;
            }
        }
        match pitch {
            Some(pitch) => write!(f, " and sliding {:.4} m for each radian", pitch.to_f64()),
            None => Ok(()),
        }
    }
}
