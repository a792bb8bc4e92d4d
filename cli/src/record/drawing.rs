//! The fingertip and what touches it, as a scene that Foxglove draws, in a recording: where the command was built with that.

use std::io::{Seek, Write};

#[cfg(feature = "foxglove")]
use fingertip_bridges::foxglove::SceneRecording;
use fingertip_bridges::{About, Sample};
#[cfg(feature = "foxglove")]
use fingertip_recordings::mcap::Topic;
use fingertip_recordings::mcap::{McapError, McapWriter};

/// What is drawn, and where it goes.
pub(super) struct Drawing {
    #[cfg(feature = "foxglove")]
    scene: SceneRecording,
    #[cfg(feature = "foxglove")]
    topic: Topic,
}

impl Drawing {
    /// Begins the topic of a stream; `None` where nothing is drawn.
    pub(super) fn begin<W: Write + Seek>(
        writer: &mut McapWriter<W>,
        about: &About,
    ) -> Result<Option<Self>, McapError> {
        #[cfg(feature = "foxglove")]
        if let Some(encoded) = SceneRecording::encoded() {
            let [name, encoding] = encoded.schema.each_ref().map(String::as_str);
            let topic = writer.others(encoded.topic, &encoded.messages, [name, encoding], &encoded.text)?;
            return Ok(Some(Self { scene: SceneRecording::new(about.clone()), topic }));
        }
        let _ = (writer, about);
        Ok(None)
    }

    /// Writes what is due at a sample.
    pub(super) fn write<W: Write + Seek>(
        &mut self,
        writer: &mut McapWriter<W>,
        time: f64,
        sample: &Sample,
    ) -> Result<(), McapError> {
        #[cfg(feature = "foxglove")]
        for message in self.scene.messages(sample) {
            writer.write_other(self.topic, time, &message)?;
        }
        let _ = (writer, time, sample);
        Ok(())
    }
}
