//! One sample, with all that was made of it.

use core::time::Duration;
use std::time::{SystemTime, UNIX_EPOCH};

use fingertip::Touch;
use fingertip::contact::ConfidenceEllipse;
use fingertip::friction::{SlipMargin, SlipVerdict};
use fingertip::wrench::Wrench;
use nalgebra::Vector3;

/// One sample.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::Sample;
/// use nalgebra::Vector6;
///
/// let wrench = Wrench::from_components(&Vector6::new(0.0, 0.0, -2.0, 0.0, 0.0, 0.0));
/// let sample = Sample::new(0.5, wrench, None);
/// // Without a scene the load is what the sensor reports, and nothing is known of a contact.
/// assert_eq!((sample.load(), sample.contact()), (wrench, None));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Counted by the hub, from 0.
    pub number: u64,
    /// On the clock of the stream \[s\].
    pub time: f64,
    /// When it was made here, since 1970.
    pub stamp: Duration,
    /// The wrench less its zero, as the sensor reports it.
    pub wrench: Wrench<f64>,
    /// What a scene makes of it; `None` without one.
    pub felt: Option<Felt>,
}

/// What a scene makes of a sample.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::{Felt, Sample};
/// use nalgebra::Vector6;
///
/// // The scene turns the sensor's convention round.
/// let reported: Wrench<f64> = Wrench::from_components(&Vector6::new(0.0, 0.0, 2.0, 0.0, 0.0, 0.0));
/// let load = Wrench::from_components(&-reported.components());
/// let felt = Felt { status: "misses", load, contact: None, margin: None, slip: None };
/// assert_eq!(Sample::new(0.5, reported, Some(felt)).load().force().z, -2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// Whether there is a contact, or why not, as in `contacts.csv`.
    pub status: &'static str,
    /// The load on the fingertip, by the convention of the scene.
    pub load: Wrench<f64>,
    /// The contact, if there is one.
    pub contact: Option<Pressed>,
    /// How far it is from the friction limit.
    pub margin: Option<SlipMargin<f64>>,
    /// What the slip detector says.
    pub slip: Option<SlipVerdict>,
}

/// A contact.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::{Felt, Pressed, Sample};
/// use nalgebra::Vector3;
///
/// // 2 N on the top of a ball of 13 mm.
/// let (point, force) = (Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -2.0));
/// let pressed = Pressed {
///     point,
///     normal: Vector3::z(),
///     force,
///     normal_force: 2.0,
///     tangential_force: Vector3::zeros(),
///     spin_torque: 0.0,
///     ellipse: None,
/// };
/// let load = Wrench::from_force_at(&point, force);
/// let felt = Felt { status: "contact", load, contact: Some(pressed), margin: None, slip: None };
/// let sample = Sample::new(0.5, load, Some(felt));
/// assert_eq!(sample.contact().map(|contact| contact.normal_force), Some(2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Where \[m\].
    pub point: Vector3<f64>,
    /// Outward unit normal.
    pub normal: Vector3<f64>,
    /// On the fingertip \[N\].
    pub force: Vector3<f64>,
    /// Positive when pressing \[N\].
    pub normal_force: f64,
    /// On the fingertip, across the normal \[N\].
    pub tangential_force: Vector3<f64>,
    /// Along the outward normal \[N·m\].
    pub spin_torque: f64,
    /// Where the point lies with 95 %, by the noise of the sensor, once that is known.
    pub ellipse: Option<ConfidenceEllipse<f64>>,
}

impl Sample {
    /// A sample of now, at a time \[s\] of the stream.
    #[must_use]
    pub fn new(time: f64, wrench: Wrench<f64>, felt: Option<Felt>) -> Self {
        let stamp = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self { number: 0, time, stamp, wrench, felt }
    }

    /// The load on the fingertip: by the scene's convention, or as the sensor reports it.
    #[must_use]
    pub fn load(&self) -> Wrench<f64> {
        self.felt.map_or(self.wrench, |felt| felt.load)
    }

    /// The contact, if there is one.
    #[must_use]
    pub fn contact(&self) -> Option<&Pressed> {
        self.felt.as_ref().and_then(|felt| felt.contact.as_ref())
    }
}

impl Felt {
    /// Of what the pipeline of a scene felt, with how it ended in a word.
    #[must_use]
    pub fn of(
        touch: &Touch<f64, Option<SlipMargin<f64>>, Option<SlipVerdict>>,
        status: &'static str,
        ellipse: Option<ConfidenceEllipse<f64>>,
    ) -> Self {
        let contact = touch.resolution.contact().zip(touch.force).map(|(contact, force)| Pressed {
            point: contact.point,
            normal: contact.normal,
            force: contact.force,
            normal_force: force.normal,
            tangential_force: *force.tangential,
            spin_torque: contact.spin_torque,
            ellipse,
        });
        Self { status, load: touch.wrench, contact, margin: touch.grip.flatten(), slip: touch.slip }
    }
}
