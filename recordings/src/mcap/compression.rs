//! Packed chunks.

#[cfg(feature = "compression")]
use std::io::Read;

use super::error::McapError;

/// How the chunks of a file are packed.
///
/// ```
/// use fingertip_recordings::mcap::{Compression, McapWriter};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let size = |compression| {
///     let mut writer = McapWriter::with_compression(Cursor::new(Vec::new()), compression)?;
///     let topic = writer.wrenches("tip/wrench", "sensor")?;
///     for i in 0..1000 {
///         writer.write_wrench(topic, f64::from(i) * 1e-3, &Wrench::zero())?;
///     }
///     Ok::<_, fingertip_recordings::mcap::McapError>(writer.finish()?.into_inner().len())
/// };
/// // A thousand times the same.
/// assert!(size(Compression::Zstd)? < size(Compression::None)? / 2);
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    #[default]
    None,
    /// By LZ4, which is fast.
    #[cfg(feature = "compression")]
    Lz4,
    /// By zstd, which makes them small.
    #[cfg(feature = "compression")]
    Zstd,
}

impl Compression {
    pub(super) const fn of_library(self) -> Option<::mcap::Compression> {
        match self {
            Self::None => None,
            #[cfg(feature = "compression")]
            Self::Lz4 => Some(::mcap::Compression::Lz4),
            #[cfg(feature = "compression")]
            Self::Zstd => Some(::mcap::Compression::Zstd),
        }
    }
}

/// Unpacks up to `most` bytes; `false` if what is packed is cut or damaged: then `to` has what came before.
///
/// # Errors
/// [`McapError::File`] for a compression that is not known.
#[cfg(feature = "compression")]
pub(super) fn unpack(name: &[u8], packed: &[u8], most: u64, to: &mut Vec<u8>) -> Result<bool, McapError> {
    let unpacked = match name {
        b"zstd" => zstd(packed, most, to),
        b"lz4" => lz4::Decoder::new(packed).and_then(|decoder| pass(decoder, most, to)),
        _ => return Err(unknown(name)),
    };
    Ok(unpacked.is_ok())
}

/// Without the feature `compression` nothing packed is read.
#[cfg(not(feature = "compression"))]
pub(super) fn unpack(name: &[u8], _: &[u8], _: u64, _: &mut Vec<u8>) -> Result<bool, McapError> {
    Err(unknown(name))
}

fn unknown(name: &[u8]) -> McapError {
    let name = String::from_utf8_lossy(name).into_owned();
    McapError::File(::mcap::McapError::UnsupportedCompression(name))
}

/// Memory for what was said before, as a power of two: those who pack chunks of a few MB need less.
#[cfg(feature = "compression")]
const WINDOW: u32 = 26;

#[cfg(feature = "compression")]
fn zstd(packed: &[u8], most: u64, to: &mut Vec<u8>) -> std::io::Result<()> {
    let mut decoder = ::zstd::stream::read::Decoder::with_buffer(packed)?;
    decoder.window_log_max(WINDOW)?;
    pass(decoder, most, to)
}

/// What was read before an error stays.
#[cfg(feature = "compression")]
fn pass(decoder: impl Read, most: u64, to: &mut Vec<u8>) -> std::io::Result<()> {
    // One byte more tells a chunk that is longer than it says.
    decoder.take(most.saturating_add(1)).read_to_end(to).map(drop)
}
