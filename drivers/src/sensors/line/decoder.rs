//! What the bytes of a line mean.

use fingertip_wrench::{Real, Wrench};
#[cfg(any(feature = "bota-serial", feature = "resense", feature = "schunk-fts"))]
use nalgebra::Vector3;

use super::deframer::LineStatistics;
use crate::{Sample, SourceError};

/// Turns the bytes that a device sends into samples, one byte at a time, without I/O and without a
/// clock.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::LineDecoder;
///
/// // Byte by byte, as from an interrupt.
/// let mut decoder = BotaDecoder::new();
/// let mut samples = Vec::new();
/// for byte in Frame::default().emit() {
///     samples.extend(LineDecoder::<f64>::push(&mut decoder, byte));
/// }
/// assert_eq!(samples.len(), 1);
/// assert_eq!(LineDecoder::<f64>::statistics(&decoder).frames, 1);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not read samples of `{T}` from a serial line",
    note = "a protocol of your own implements `LineDecoder`: `push`, `restart`, `statistics`"
)]
pub trait LineDecoder<T: Real> {
    /// What the device can say is wrong with itself.
    type Fault: SourceError;
    /// How many bytes may pass without a frame before the line is said to carry none: a wrong baud
    /// rate or device. Some tens of frames.
    const PATIENCE: usize;

    /// Takes the next byte. If it completes a sound frame, its wrench, or why there is none.
    #[allow(clippy::type_complexity, reason = "a name for it would hide that a frame can be a fault")]
    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, Self::Fault>>;

    /// Forgets what waits for the rest of its frame: a frame begins with the next byte, as after a
    /// silence of the line.
    fn restart(&mut self);

    /// How the line has behaved so far.
    fn statistics(&self) -> LineStatistics;
}

/// The load on the fingertip from what a device reports, if it is finite.
#[cfg(any(feature = "bota-serial", feature = "resense", feature = "schunk-fts"))]
pub(crate) fn finite_wrench<T: Real>(components: [f64; 6]) -> Option<Wrench<T>> {
    let [fx, fy, fz, tx, ty, tz] = components.map(T::literal);
    let wrench = Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
    wrench.is_finite().then_some(wrench)
}
