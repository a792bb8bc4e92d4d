//! Samples to topics.

use alloc::sync::Arc;
use core::sync::atomic::Ordering;
use core::time::Duration;
use std::time::Instant;

use fingertip_recordings::mcap::{CdrWriter, Header};
use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::{Publisher, QosProfile};

use super::node::{Participant, name};
use super::raw::Raw;
use super::{NodeError, Options, Shared, frames, markers};
use crate::{About, Hub, Pressed, Sample, messages};

/// How long it waits for samples before it looks whether it is to end.
const NAP: Duration = Duration::from_millis(50);
/// How often the contact is drawn, and the surface.
const DRAWN: Duration = Duration::from_millis(33);
const SURFACE: Duration = Duration::from_secs(1);

/// The publishers of a node.
pub(super) struct Publishing {
    hub: Hub,
    wrench: Publisher<Raw>,
    touch: Publisher<Raw>,
    contact: Publisher<Raw>,
    point: Publisher<Raw>,
    markers: Publisher<Raw>,
    frames: Publisher<Raw>,
    fixed: Publisher<Raw>,
}

impl Publishing {
    pub(super) fn new(
        participant: &mut Participant,
        options: &Options,
        hub: &Hub,
    ) -> Result<Self, NodeError> {
        // As deep as a burst is long that the library has not sent yet.
        let best_effort = QosProfile::subscription_default().history(History::KeepLast { depth: 1000 });
        let reliable = QosProfile::publisher_default()
            .history(History::KeepLast { depth: 1000 })
            .reliability_reliable(WhenFull::DEFAULT);
        let samples = if options.reliable { reliable.clone() } else { best_effort };
        // Whoever comes later gets the last one, too.
        let kept = QosProfile::publisher_default().durability(Durability::TransientLocal);
        let mut publisher = |base: &str, kind: [&str; 2], qos: &QosProfile| {
            participant.publisher(&name(&options.namespace, base)?, kind, qos)
        };
        Ok(Self {
            hub: hub.clone(),
            wrench: publisher("wrench", ["geometry_msgs", "WrenchStamped"], &samples)?,
            touch: publisher("touch", ["fingertip_msgs", "Touch"], &samples)?,
            contact: publisher("contact", ["tactile_msgs", "TactileContact"], &samples)?,
            point: publisher("point", ["geometry_msgs", "PointStamped"], &samples)?,
            markers: publisher("markers", ["visualization_msgs", "MarkerArray"], &reliable)?,
            frames: participant.publisher(&name("/", "tf")?, ["tf2_msgs", "TFMessage"], &reliable)?,
            fixed: participant.publisher(&name("/", "tf_static")?, ["tf2_msgs", "TFMessage"], &kept)?,
        })
    }

    pub(super) fn run(self, shared: &Arc<Shared>) {
        let mut reader = self.hub.subscribe();
        let mut samples = Vec::new();
        let (mut drawn, mut surface) = (None::<Instant>, None::<Instant>);
        let is_due =
            |last: Option<Instant>, period: Duration| last.is_none_or(|last| last.elapsed() >= period);
        let about = self.hub.about();
        let send = |publisher: &Publisher<Raw>, message: Vec<u8>| {
            let refused = publisher.publish(Raw(message)).is_err();
            shared.refused.fetch_add(u64::from(refused), Ordering::Relaxed);
        };
        if about.has_scene {
            send(&self.fixed, frames::surface(about));
        }
        // What is there when the stream has ended is still sent.
        while !shared.ends.load(Ordering::Relaxed) || (!samples.is_empty() && self.hub.is_closed()) {
            samples.clear();
            let news = reader.wait(&mut samples, NAP);
            shared.missed.store(reader.missed(), Ordering::Relaxed);
            samples.iter().for_each(|sample| self.sample(sample, about, &send));
            let Some(last) = samples.last().filter(|_| about.has_scene) else {
                if news.closed {
                    std::thread::sleep(NAP);
                }
                continue;
            };
            if is_due(drawn, DRAWN) {
                drawn = Some(Instant::now());
                let header = messages::header(last, &about.frame);
                let is_due = is_due(surface, SURFACE);
                if is_due {
                    surface = Some(Instant::now());
                }
                send(&self.markers, markers::markers(last, about, &header, is_due));
                if let Some(contact) = last.contact() {
                    send(&self.frames, frames::contact(contact, about, &header));
                }
            }
        }
    }

    fn sample(&self, sample: &Sample, about: &About, send: &impl Fn(&Publisher<Raw>, Vec<u8>)) {
        let header = messages::header(sample, &about.frame);
        send(&self.wrench, messages::wrench(sample, &header));
        if let Some(touch) = messages::touch(sample, &header) {
            send(&self.touch, touch);
        }
        if let Some(contact) = sample.contact() {
            send(&self.contact, messages::contact(contact, &header));
            send(&self.point, point(contact, &header));
        }
    }
}

/// `geometry_msgs/msg/PointStamped`.
fn point(contact: &Pressed, header: &Header) -> Vec<u8> {
    let mut to = CdrWriter::default();
    header.write(&mut to);
    to.f64s(contact.point.iter().copied());
    to.into_message()
}
