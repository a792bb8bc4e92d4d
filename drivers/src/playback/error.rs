//! What kind of errors those of recordings are.

use fingertip_recordings::RecordingError;
#[cfg(feature = "mcap")]
use fingertip_recordings::mcap::McapError;

use crate::{SourceError, SourceErrorKind};

impl SourceError for RecordingError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Open { .. } | Self::Read { .. } | Self::Write { .. } => SourceErrorKind::Transport,
            Self::Empty { .. } | Self::Ragged { .. } | Self::NotANumber { .. } | Self::TooLong { .. } => {
                SourceErrorKind::Corrupt
            }
            _ => SourceErrorKind::Unsupported,
        }
    }
}

#[cfg(feature = "mcap")]
impl SourceError for McapError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            error if error.is_transport() => SourceErrorKind::Transport,
            Self::Cut | Self::File(_) | Self::Length { .. } | Self::Message { .. } => {
                SourceErrorKind::Corrupt
            }
            _ => SourceErrorKind::Unsupported,
        }
    }
}
