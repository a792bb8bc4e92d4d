//! What every converter with a bus, a "ready" pin and a delay has.

/// Gives one face of such a converter the method to take it apart, and its statistics, which are those of its
/// `state`.
#[allow(unused_macros, reason = "without such a converter there is nobody to use it")]
macro_rules! parts {
    ($name:ident, $bus:path, $pin:path, $delay:path $(, $size:ident)?) => {
        impl<B: $bus, P: $pin, D: $delay $(, const $size: usize)?> $name<B, P, D $(, $size)?> {
            /// The parts.
            #[must_use]
            pub fn release(self) -> (B, P, D) {
                (self.bus, self.ready, self.delay)
            }

            /// How it has behaved so far.
            #[must_use]
            pub const fn statistics(&self) -> &$crate::converters::ConverterStatistics {
                &self.state.statistics
            }
        }
    };
}

pub(crate) use parts;
