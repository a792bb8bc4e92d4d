//! The records of an MCAP file, one after another, those in chunks among them.

use core::ops::Range;
use std::io::{self, Read};

use ::mcap::MAGIC;
use ::mcap::records::op;
use crc::{CRC_32_ISO_HDLC, Crc};

use super::compression::unpack;
use super::error::McapError;

/// The CRC of MCAP is that of zlib.
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The longest chunk, or message outside of one, that is read as it stands: 256 MiB. Writers make chunks of about one.
pub(super) const LONGEST: u64 = 1 << 28;

/// The longest chunk once it is unpacked: 64 MiB. A few bytes can be packed that say a thousand times as much.
pub(super) const LONGEST_UNPACKED: u64 = 1 << 26;

/// The kinds that are looked at; the rest are passed over.
const READ: [u8; 5] = [op::HEADER, op::SCHEMA, op::CHANNEL, op::MESSAGE, op::CHUNK];

/// Reads record after record, holding one chunk at a time. The checksum of a chunk is checked before anything in it is
/// given, but for one that the end of the file has cut: of that all whole records are given.
pub(super) struct Records<R> {
    file: R,
    /// The contents of the record at hand.
    record: Vec<u8>,
    /// What a packed chunk holds.
    unpacked: Vec<u8>,
    /// Where the records of a chunk stand that are still to come, and in which of the two.
    chunk: Range<usize>,
    is_packed: bool,
    /// The file ends within the chunk at hand.
    is_cut: bool,
    ended: bool,
}

/// A record of a file: its kind, and where its contents stand.
type Found = (u8, Range<usize>);

impl<R> Records<R> {
    /// How much of the chunk at hand is still to come \[bytes\].
    pub(super) fn left_of_chunk(&self) -> usize {
        self.chunk.len()
    }

    fn bytes(&self) -> &[u8] {
        if self.is_packed { &self.unpacked } else { &self.record }
    }
}

impl<R: Read> Records<R> {
    pub(super) fn new(mut file: R) -> Result<Self, McapError> {
        let mut magic = [0; MAGIC.len()];
        match file.read_exact(&mut magic) {
            Ok(()) if magic == MAGIC => {}
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => return Err(error.into()),
            _ => return Err(McapError::File(::mcap::McapError::BadMagic)),
        }
        Ok(Self {
            file,
            record: Vec::new(),
            unpacked: Vec::new(),
            chunk: 0..0,
            is_packed: false,
            is_cut: false,
            ended: false,
        })
    }

    /// The next record of those that are looked at, or `None` at the end of the data.
    ///
    /// # Errors
    /// [`McapError::Cut`] behind all that is whole, and once: then there is `None`. Behind [`McapError::File`] of a
    /// chunk the next record is that behind the chunk, unless the system refuses.
    pub(super) fn next(&mut self) -> Result<Option<(u8, &[u8])>, McapError> {
        let (opcode, contents) = loop {
            if self.ended {
                return Ok(None);
            }
            let in_chunk = !self.chunk.is_empty();
            let (opcode, contents) = if !in_chunk {
                if self.is_cut {
                    return Err(self.end_cut());
                }
                self.is_packed = false;
                match self.read()? {
                    Some(found) => found,
                    None => return Err(self.end_cut()),
                }
            } else {
                match next_in_chunk(if self.is_packed { &self.unpacked } else { &self.record }, &self.chunk) {
                    Some((found, behind)) => {
                        self.chunk.start = behind;
                        found
                    }
                    None if self.is_cut => return Err(self.end_cut()),
                    None => {
                        self.chunk = 0..0;
                        return Err(malformed());
                    }
                }
            };
            match opcode {
                op::CHUNK if !in_chunk => self.open_chunk()?,
                // What follows are repetitions and the index.
                op::DATA_END if !in_chunk => self.ended = true,
                // Neither may stand in a chunk.
                op::CHUNK | op::DATA_END => {}
                _ if READ.contains(&opcode) => break (opcode, contents),
                _ => {}
            }
        };
        Ok(Some((opcode, self.bytes().get(contents).unwrap_or_default())))
    }

    fn end_cut(&mut self) -> McapError {
        self.ended = true;
        McapError::Cut
    }

    /// Takes the next record of the file: its kind, its length in eight bytes, and so many bytes, which are passed
    /// over if nobody looks at them. `None` if the file ends within it, but for a chunk.
    fn read(&mut self) -> Result<Option<Found>, McapError> {
        let mut head = [0; 9];
        match self.file.read_exact(&mut head) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
            read => read?,
        }
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        self.record.clear();
        let chunk = opcode == op::CHUNK;
        // A chunk whose length nobody has come to write down is the last of its file.
        let open = chunk && length == u64::MAX;
        let mut contents = Read::take(&mut self.file, if open { LONGEST } else { length });
        let read = if !READ.contains(&opcode) {
            io::copy(&mut contents, &mut io::sink())
        } else if length > LONGEST && !open {
            self.ended = true;
            return Err(McapError::File(::mcap::McapError::ChunkTooLarge(length)));
        } else {
            // It takes no more memory than there are bytes, whatever the length says.
            contents.read_to_end(&mut self.record).map(|read| read as u64)
        };
        self.is_cut = read? < length;
        if self.is_cut && !chunk {
            return Ok(None);
        }
        Ok(Some((opcode, 0..self.record.len())))
    }

    /// Goes into the chunk at hand.
    fn open_chunk(&mut self) -> Result<(), McapError> {
        let Some(Chunk { stated, crc, compression, length, records }) = Chunk::parse(&self.record) else {
            return if self.is_cut { Ok(()) } else { Err(malformed()) };
        };
        if !self.is_cut && length != records.len() as u64 {
            return Err(malformed());
        }
        self.is_packed = !compression.is_empty();
        if self.is_packed {
            let stated = if self.is_cut { stated.min(LONGEST_UNPACKED) } else { stated };
            if stated > LONGEST_UNPACKED {
                return Err(McapError::File(::mcap::McapError::ChunkTooLarge(stated)));
            }
            self.unpacked.clear();
            let unpacked = unpack(compression, records, stated, &mut self.unpacked)?;
            if !self.is_cut && (!unpacked || self.unpacked.len() as u64 != stated) {
                return Err(malformed());
            }
        }
        let (bytes, start) = match self.is_packed {
            true => (self.unpacked.as_slice(), 0),
            // The records are the last field.
            false => (records, self.record.len() - records.len()),
        };
        // Zero means that there is none.
        let calculated = if crc == 0 || self.is_cut { crc } else { CRC.checksum(bytes) };
        if crc != calculated {
            return Err(McapError::File(::mcap::McapError::BadChunkCrc { saved: crc, calculated }));
        }
        self.chunk = start..start + bytes.len();
        Ok(())
    }
}

/// The fields of a chunk.
struct Chunk<'a> {
    /// The length of its records, unpacked.
    stated: u64,
    crc: u32,
    compression: &'a [u8],
    /// The length of its records, as they stand in the file.
    length: u64,
    records: &'a [u8],
}

impl<'a> Chunk<'a> {
    fn parse(chunk: &'a [u8]) -> Option<Self> {
        // Two times come first.
        let (stated, behind) = chunk.get(16..)?.split_first_chunk::<8>()?;
        let (crc, behind) = behind.split_first_chunk::<4>()?;
        let (length, behind) = behind.split_first_chunk::<4>()?;
        let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
        let (compression, behind) = behind.split_at_checked(length)?;
        let (length, records) = behind.split_first_chunk::<8>()?;
        let (stated, length) = (u64::from_le_bytes(*stated), u64::from_le_bytes(*length));
        Some(Self { stated, crc: u32::from_le_bytes(*crc), compression, length, records })
    }
}

/// The next record of a chunk, and where the one behind it begins; `None` if the chunk ends within it.
///
/// The library's own readers either do not look at the checksums of chunks or trust the lengths of the records in
/// them.
fn next_in_chunk(bytes: &[u8], chunk: &Range<usize>) -> Option<(Found, usize)> {
    let rest = bytes.get(chunk.clone())?;
    let (&[opcode, length @ ..], behind) = rest.split_first_chunk::<9>()?;
    let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
    let (contents, rest) = behind.split_at_checked(length)?;
    let end = chunk.end - rest.len();
    Some(((opcode, end - contents.len()..end), end))
}

fn malformed() -> McapError {
    McapError::File(::mcap::McapError::UnexpectedEof)
}
