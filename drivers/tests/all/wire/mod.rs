//! The bytes of each sensor, written out by hand from what its maker publishes.
//!
//! Nothing here is encoded by the code under test, so that a field, a sign, an order of bytes or a checksum
//! that is wrong both in reading and in writing is found.
#![cfg(all(
    feature = "ati-rdt",
    feature = "bota-serial",
    feature = "dynpick",
    feature = "optoforce",
    feature = "resense",
    feature = "robotous",
    feature = "schunk-fts"
))]

mod ati_rdt;
mod bota_serial;
mod dynpick;
mod optoforce;
mod resense;
mod robotous;
mod robotous_can;
mod schunk_fts;

use fingertip_drivers::Sample;
use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_wrench::Wrench;

type Decoded<F> = Result<Sample<f64, Wrench<f64>>, F>;

/// What a decoder makes of bytes of which the last one ends a frame, and no other does.
fn decoded<D: LineDecoder<f64>>(decoder: &mut D, bytes: &[u8]) -> Option<Decoded<D::Fault>> {
    let (last, others) = bytes.split_last().unwrap();
    assert!(others.iter().all(|byte| decoder.push(*byte).is_none()), "a frame ends too soon");
    decoder.push(*last)
}

/// The six components, forces first.
fn components(decoded: &Sample<f64, Wrench<f64>>) -> [f64; 6] {
    decoded.value.components().into()
}

/// Adds bytes up without carry.
fn sum(bytes: &[u8]) -> u16 {
    let mut sum = 0_u32;
    for byte in bytes {
        sum += u32::from(*byte);
    }
    (sum % 65_536) as u16
}
