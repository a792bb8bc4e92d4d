//! The blow that a contact begins with.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// A blow: the force rose and fell again.
///
/// ```
/// use fingertip_contact::{ContactEvents, Impact};
/// use nalgebra::Vector3;
///
/// // Noise of 10 mN. A blow of half a sine, 10 ms long and 2 N high, sampled at 1 kHz.
/// let mut events = ContactEvents::new(0.01, 0.06, 1e6)?;
/// let newtons = |ms: u8| match ms {
///     5..15 => 2.0 * (f64::from(ms - 5) * 0.1 * core::f64::consts::PI).sin(),
///     _ => 0.0,
/// };
/// let blow: Impact<f64> = (0..60)
///     .find_map(|ms| events.observe(&Vector3::new(0.0, 0.0, -newtons(ms)), 1e-3).impact)
///     .ok_or("no blow")?;
/// // Its impulse is 2/π of height times length.
/// assert!((blow.peak - 2.0).abs() < 0.01 && (blow.impulse.z + 0.02 * 2.0 / core::f64::consts::PI).abs() < 5e-4);
/// assert!(blow.duration > 5e-3 && blow.duration < 15e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Impact<T: Real> {
    /// Greatest magnitude of the force \[N\]. Of a greatest one noise makes a little more than there is.
    pub peak: T,
    /// The force summed over the time of the blow, on the fingertip \[N·s\].
    pub impulse: Vector3<T>,
    /// From the first sign of the touch to where the force was least after its peak \[s\].
    pub duration: T,
}

/// The force from the first sign of a touch on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blow<T: Real> {
    time: T,
    impulse: Vector3<T>,
    before: Vector3<T>,
    peak: T,
    peaked: T,
    /// When it was half the peak, and where it was least since then.
    fallen: Option<Fallen<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Fallen<T: Real> {
    time: T,
    least: T,
    least_time: T,
    impulse: Vector3<T>,
}

/// What may be a blow: how long it takes to fall to half its peak at most [s], and how far two samples of the same force
/// are apart at most [N].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits<T: Real> {
    pub(super) longest: T,
    pub(super) apart: T,
}

/// What is known of a blow.
pub(super) enum Progress<T: Real> {
    Going,
    Over(Impact<T>),
    /// The force does not fall soon enough: a press.
    Press,
}

impl<T: Real> Blow<T> {
    pub(super) fn begin(force: &Vector3<T>, size: T) -> Self {
        Self {
            time: T::zero(),
            impulse: Vector3::zeros(),
            before: *force,
            peak: size,
            peaked: T::zero(),
            fallen: None,
        }
    }

    /// Takes the next force and its size, the trapezoidal rule between.
    pub(super) fn take(&mut self, force: &Vector3<T>, size: T, time: T, limits: &Limits<T>) -> Progress<T> {
        let half = T::literal(0.5);
        self.time += time;
        self.impulse += (self.before * half + force * half) * time;
        self.before = *force;
        if size > self.peak {
            (self.peak, self.peaked, self.fallen) = (size, self.time, None);
        }
        match &mut self.fallen {
            None => {
                if size < self.peak * half && self.peak - size > limits.apart {
                    self.fallen = Some(Fallen {
                        time: self.time,
                        least: size,
                        least_time: self.time,
                        impulse: self.impulse,
                    });
                } else if !(self.time <= limits.longest) {
                    return Progress::Press;
                }
            }
            Some(fallen) => {
                // By more than noise alone would find it lower.
                if fallen.least - size > limits.apart * half {
                    (fallen.least, fallen.least_time, fallen.impulse) = (size, self.time, self.impulse);
                } else if size - fallen.least > limits.apart
                    || self.time - fallen.least_time >= fallen.time - self.peaked
                {
                    return self.over().map_or(Progress::Press, Progress::Over);
                }
            }
        }
        Progress::Going
    }

    /// The blow, if the force has fallen: up to where it was least.
    pub(super) fn over(&self) -> Option<Impact<T>> {
        let fallen = self.fallen?;
        let impact = Impact { peak: self.peak, impulse: fallen.impulse, duration: fallen.least_time };
        (impact.peak + impact.impulse.sum() + impact.duration).is_number().then_some(impact)
    }
}
