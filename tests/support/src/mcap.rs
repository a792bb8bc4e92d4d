//! MCAP files written by hand, record by record, after the specification of the format.

/// What a file begins with.
pub const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";

/// A text behind its length.
#[must_use]
pub fn string(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

/// A record behind its kind and length.
#[must_use]
pub fn record(opcode: u8, contents: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(contents.len() as u64).to_le_bytes(), contents].concat()
}

/// A schema.
#[must_use]
pub fn schema(id: u16, name: &str) -> Vec<u8> {
    record(3, &[id.to_le_bytes().to_vec(), string(name), string("ros2msg"), string("float64 x")].concat())
}

/// A channel of a schema.
#[must_use]
pub fn channel(id: u16, schema: u16, topic: &str, encoding: &str) -> Vec<u8> {
    let metadata = [string("key"), string("value")].concat();
    let length = (metadata.len() as u32).to_le_bytes().to_vec();
    let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
    record(4, &[ids, string(topic), string(encoding), length, metadata].concat())
}

/// A message of a channel.
#[must_use]
pub fn message(channel: u16, log_time: u64, data: &[u8]) -> Vec<u8> {
    let head = [&channel.to_le_bytes()[..], &[7, 0, 0, 0], &log_time.to_le_bytes(), &[0; 8]].concat();
    record(5, &[&head[..], data].concat())
}

/// The end of the data.
#[must_use]
pub fn data_end() -> Vec<u8> {
    record(15, &[0; 4])
}

/// Header, stamp 3.25 s in the frame "tip", force 1, 2, 3 and torque 4, 5, 6.
#[must_use]
pub fn wrench() -> Vec<u8> {
    let mut cdr = vec![0, 1, 0, 0, 3, 0, 0, 0, 0x80, 0xB2, 0xE6, 0x0E, 4, 0, 0, 0, b't', b'i', b'p', 0];
    for component in [1.0, 2.0, 3.0, 4.0, 5.0, 6.0_f64] {
        cdr.extend(component.to_le_bytes());
    }
    cdr
}

/// The schema of wrenches.
pub const WRENCH: &str = "geometry_msgs/msg/WrenchStamped";

/// A schema and a channel of wrenches with the number 1.
#[must_use]
pub fn definitions() -> Vec<u8> {
    [schema(1, WRENCH), channel(1, 1, "/tip", "cdr")].concat()
}

/// A file of these records.
#[must_use]
pub fn file(records: &[Vec<u8>]) -> Vec<u8> {
    [MAGIC.to_vec(), records.concat()].concat()
}
