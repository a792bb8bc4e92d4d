//! How types that a constructor validates are written to a file and read from it.

/// Implements serde's traits for a type by way of the arguments of its constructor, so that what is read is
/// validated like what is built, and an unknown key is refused. What a value has seen since it was built is not
/// written: it starts anew when it is read.
///
/// `Type, [generics], |value| { key: Type = how to get it, … }, the constructor on the keys`. Generics are `T: Real`,
/// then numbers (`, const N: usize`), then frames (`; F: Frame`). The crate that uses it has serde by a feature of
/// that name.
#[doc(hidden)]
#[macro_export]
macro_rules! stored {
    (
        $type:ty, [T: Real $(, const $size:ident: usize)* $(; $frame:ident: Frame)*],
        |$value:ident| { $($(#[$attribute:meta])* $key:ident: $of:ty = $get:expr),* $(,)? },
        $make:expr
    ) => {
        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Serialize, serde::Deserialize)]
            #[serde(
                deny_unknown_fields,
                bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
            )]
            struct Parts<T: $crate::Real $(, const $size: usize)*> {
                $($(#[$attribute])* $key: $of,)*
            }

            impl<T: $crate::Real $(, const $size: usize)* $(, $frame: $crate::Frame)*> serde::Serialize for $type
            where
                T: serde::Serialize,
            {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    let $value = self;
                    Parts::<T $(, $size)*> { $($key: $get,)* }.serialize(serializer)
                }
            }

            impl<'de, T: $crate::Real $(, const $size: usize)* $(, $frame: $crate::Frame)*> serde::Deserialize<'de>
                for $type
            where
                T: serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    let Parts::<T $(, $size)*> { $($key),* } = serde::Deserialize::deserialize(deserializer)?;
                    $make.map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
