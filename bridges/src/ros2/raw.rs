//! Messages that are CDR already.

use serde::ser::{Serialize, SerializeTuple, Serializer};

/// Bytes of how CDR says its encoding, which DDS writes itself.
const ENCODING: usize = 4;

/// A message in little-endian CDR with its encoding, as recordings hold it.
pub(super) struct Raw(pub(super) Vec<u8>);

impl Serialize for Raw {
    /// One byte after another: bytes have no alignment, so that the message is what it was.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let body = self.0.get(ENCODING..).unwrap_or_default();
        let mut tuple = serializer.serialize_tuple(body.len())?;
        body.iter().try_for_each(|byte| tuple.serialize_element(byte))?;
        tuple.end()
    }
}
