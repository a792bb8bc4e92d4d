//! A converter as a source of signals.

/// Makes both faces of a converter on SPI with a "ready" pin sources of counts, by their method `read`. The polled
/// source is each chip's own.
#[allow(unused_macros, reason = "without such a converter there is nobody to use it")]
macro_rules! sources {
    ($blocking:ident, $awaited:ident) => {
        impl<T: fingertip_wrench::Real, S, P, D, const N: usize> $crate::Source<T, nalgebra::SVector<T, N>>
            for $blocking<S, P, D, N>
        where
            S: embedded_hal::spi::SpiDevice,
            P: embedded_hal::digital::InputPin,
            D: embedded_hal::delay::DelayNs,
        {
            type Error = $crate::converters::ConverterError<S::Error, P::Error>;

            fn next_sample(
                &mut self,
            ) -> Result<Option<$crate::Sample<T, nalgebra::SVector<T, N>>>, Self::Error> {
                let value = self.read()?.signals()?;
                Ok(Some($crate::Sample { time: None, value }))
            }
        }

        impl<T: fingertip_wrench::Real, S, P, D, const N: usize>
            $crate::AsyncSource<T, nalgebra::SVector<T, N>> for $awaited<S, P, D, N>
        where
            S: embedded_hal_async::spi::SpiDevice,
            P: embedded_hal_async::digital::Wait,
            D: embedded_hal_async::delay::DelayNs,
        {
            type Error = $crate::converters::ConverterError<S::Error, P::Error>;

            async fn next_sample(
                &mut self,
            ) -> Result<Option<$crate::Sample<T, nalgebra::SVector<T, N>>>, Self::Error> {
                let value = self.read().await?.signals()?;
                Ok(Some($crate::Sample { time: None, value }))
            }
        }
    };
}

pub(crate) use sources;
