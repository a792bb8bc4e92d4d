//! Recordings in MCAP files, with ROS 2 messages in CDR: Foxglove, PlotJuggler and `ros2 bag` (with its
//! MCAP storage) open them, since each file carries the definitions of its messages.
//!
//! | recorded | message |
//! |---|---|
//! | wrench | `geometry_msgs/msg/WrenchStamped` |
//! | signals | `fingertip_msgs/msg/Signals`: header, unit, values |
//! | contact | `tactile_msgs/msg/TactileContact`: header, name, position, normal, wrench |
//! | touch | `fingertip_msgs/msg/Touch`: header, contact, forces, margin, slip |
//!
//! Times are seconds, as everywhere; in the file they are whole nanoseconds from 0 to 2³¹ s. Files are
//! written in chunks with checksums and an index; with the feature `compression` they are read and written packed by
//! zstd or LZ4, too. Reading takes as much memory as the longest chunk, however long the file. What a recorder that was
//! killed has left is read up to where it is whole, and [`recover`] writes it anew.
//!
//! ```
//! use std::io::Cursor;
//! use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded};
//! use fingertip_wrench::Wrench;
//! use nalgebra::Vector3;
//!
//! let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
//! let topic = writer.wrenches("/fingertip/wrench", "tip")?;
//! let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
//! writer.write_wrench(topic, 0.25, &wrench)?;
//! let file = writer.finish()?.into_inner();
//!
//! let mut reader = McapReader::new(file.as_slice())?;
//! let entry = reader.next_entry()?.ok_or("nothing")?;
//! assert_eq!((entry.topic.as_str(), entry.time), ("/fingertip/wrench", 0.25));
//! assert_eq!(entry.recorded, Recorded::Wrench(wrench));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

mod cdr;
mod compression;
mod definitions;
mod error;
mod lengths;
mod messages;
mod reader;
mod records;
mod recover;
mod touch;
mod writer;

pub use cdr::{CdrError, CdrReader, CdrWriter};
pub use compression::Compression;
pub use definitions::{Definition, definitions};
pub use error::McapError;
pub use messages::{Header, Recorded, RecordedContact, RecordedSignals};
pub use reader::{Entry, McapReader};
pub use recover::{Recovered, recover};
pub use touch::RecordedTouch;
pub use writer::{McapWriter, Topic};
