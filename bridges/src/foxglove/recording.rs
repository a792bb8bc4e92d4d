//! The scene that Foxglove draws, for recordings.

use core::time::Duration;

use foxglove::Encode;
use foxglove::messages::SceneUpdate;

use super::{DRAWN, SCENE, SURFACE, drawing};
use crate::{About, Sample};

/// What a recording says once of a topic.
///
/// ```
/// use fingertip_bridges::foxglove::SceneRecording;
///
/// let encoded = SceneRecording::encoded().unwrap();
/// assert_eq!((encoded.topic, encoded.messages.as_str()), ("/fingertip/scene", "protobuf"));
/// assert!(!encoded.text.is_empty());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    /// What the topic is called.
    pub topic: &'static str,
    /// How its messages are encoded.
    pub messages: String,
    /// The schema of the messages, and how that is encoded.
    pub schema: [String; 2],
    /// The schema itself.
    pub text: Vec<u8>,
}

/// Messages `foxglove.SceneUpdate` of a recording: the surface once a second, the contact thirty times.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::foxglove::SceneRecording;
/// use fingertip_bridges::{About, Net, Sample};
/// use nalgebra::{Vector3, Vector6};
///
/// let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Some(Vector3::new(x, y, 0.0)));
/// let surface = Net { points: corners.repeat(2), columns: 3 };
/// let mut scene = SceneRecording::new(About { surface, ..About::default() });
/// let sample = Sample::new(0.0, Wrench::from_components(&Vector6::zeros()), None);
/// assert_eq!(SceneRecording::encoded().unwrap().schema, ["foxglove.SceneUpdate", "protobuf"]);
/// // The surface, and that nothing touches it.
/// assert_eq!(scene.messages(&sample).len(), 2);
/// assert!(scene.messages(&sample).is_empty());
/// ```
#[derive(Clone, Debug)]
pub struct SceneRecording {
    about: About,
    surface: Option<Duration>,
    contact: Option<Duration>,
}

impl SceneRecording {
    /// Of a stream.
    #[must_use]
    pub const fn new(about: About) -> Self {
        Self { about, surface: None, contact: None }
    }

    /// What is said once of the topic; `None` if the library has no schema.
    #[must_use]
    pub fn encoded() -> Option<Encoded> {
        let schema = SceneUpdate::get_schema()?;
        Some(Encoded {
            topic: SCENE,
            messages: SceneUpdate::get_message_encoding(),
            schema: [schema.name, schema.encoding],
            text: schema.data.into_owned(),
        })
    }

    /// The messages that are due at the stamp of a sample.
    #[must_use]
    pub fn messages(&mut self, sample: &Sample) -> Vec<Vec<u8>> {
        let now = sample.stamp;
        let is_due = |last: Option<Duration>, period| last.is_none_or(|last| now.abs_diff(last) >= period);
        let mut due = Vec::new();
        if is_due(self.surface, SURFACE) {
            self.surface = Some(now);
            due.push(drawing::surface(&self.about, now));
        }
        if is_due(self.contact, DRAWN) {
            self.contact = Some(now);
            due.push(drawing::contact(sample, &self.about));
        }
        due.iter()
            .filter_map(|update| {
                let mut message = Vec::with_capacity(update.encoded_len().unwrap_or(0));
                update.encode(&mut message).ok().map(|()| message)
            })
            .collect()
    }
}
