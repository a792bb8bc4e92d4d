//! Several fingertips as one.

use fingertip_wrench::{Real, Wrench};

use crate::{AnyTouch, Step, TouchSensor};

/// The fingertips of a hand: an array of fingertips of one kind, or of `&mut dyn TouchSensor`, or, where speed matters and
/// they differ, a tuple of two to five, each with its own type and no call through a pointer.
///
/// ```
/// use fingertip::contact::{PointContact, SoftFinger};
/// use fingertip::surfaces::{Capsule, Sphere};
/// use fingertip::wrench::Wrench;
/// use fingertip::{Fingertip, Fingertips, Step};
/// use nalgebra::Vector3;
///
/// /// How many fingers touch.
/// fn touching<const N: usize>(hand: &mut impl Fingertips<f64, N>, wrenches: &[Wrench<f64>; N]) -> usize {
///     let touches = hand.feel_all(wrenches, &[Step::of(1e-3); N]);
///     touches.iter().filter(|touch| touch.point().is_some()).count()
/// }
///
/// let thumb = Fingertip::builder().contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?).build();
/// let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 7e-3, 6e-3)?;
/// let index = Fingertip::builder().contact(tip, SoftFinger::new(0.1)?).build();
///
/// let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.0), Vector3::zeros());
/// assert_eq!(touching(&mut (thumb, index), &[push, push]), 2);
/// assert_eq!(touching(&mut [thumb, thumb, thumb], &[push, Wrench::zero(), push]), 2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` are not {N} fingertips of `{T}`",
    note = "give an array or a tuple of {N} values that implement `TouchSensor`, or implement `Fingertips` for a struct of them"
)]
pub trait Fingertips<T: Real, const N: usize> {
    /// One wrench on each fingertip, in the frame of its sensor, and what is known of the sample beside it.
    fn feel_all(&mut self, wrenches: &[Wrench<T>; N], steps: &[Step<T>; N]) -> [AnyTouch<T>; N];

    /// All forget the samples before, as [`TouchSensor::start_anew`].
    fn start_all_anew(&mut self);
}

impl<T: Real, S: TouchSensor<T>, const N: usize> Fingertips<T, N> for [S; N] {
    fn feel_all(&mut self, wrenches: &[Wrench<T>; N], steps: &[Step<T>; N]) -> [AnyTouch<T>; N] {
        let mut samples = wrenches.iter().zip(steps);
        self.each_mut().map(|finger| match samples.next() {
            Some((wrench, step)) => finger.feel(*wrench, *step),
            // There are as many samples as fingers.
            None => finger.feel(Wrench::zero(), Step::of(T::zero())),
        })
    }

    fn start_all_anew(&mut self) {
        self.iter_mut().for_each(S::start_anew);
    }
}

macro_rules! tuple {
    ($count:literal: $($finger:ident $wrench:ident $step:ident $kind:ident),+) => {
        impl<T: Real, $($kind: TouchSensor<T>),+> Fingertips<T, $count> for ($($kind,)+) {
            #[inline]
            fn feel_all(&mut self, wrenches: &[Wrench<T>; $count], steps: &[Step<T>; $count]) -> [AnyTouch<T>; $count] {
                let ($($finger,)+) = self;
                let [$($wrench),+] = *wrenches;
                let [$($step),+] = *steps;
                [$($finger.feel($wrench, $step)),+]
            }

            fn start_all_anew(&mut self) {
                let ($($finger,)+) = self;
                $($finger.start_anew();)+
            }
        }
    };
}

tuple!(2: a wa sa A, b wb sb B);
tuple!(3: a wa sa A, b wb sb B, c wc sc C);
tuple!(4: a wa sa A, b wb sb B, c wc sc C, d wd sd D);
tuple!(5: a wa sa A, b wb sb B, c wc sc C, d wd sd D, e we se E);
