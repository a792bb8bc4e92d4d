//! How the types of this crate are written to a file and read from it.

/// Implements serde's traits for a type by way of the arguments of its constructor, so that what is
/// read is validated as what is built. What a detector has seen is not written: one that is read
/// starts anew.
///
/// `Type, generics, |model| { field: Type = how to get it, … }, the constructor on the fields`.
macro_rules! stored {
    (
        $type:ty, [$($generics:tt)*],
        |$model:ident| { $($(#[$attribute:meta])* $field:ident: $of:ty = $value:expr),* $(,)? },
        $make:expr
    ) => {
        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Serialize, serde::Deserialize)]
            #[serde(bound(
                serialize = "T: serde::Serialize",
                deserialize = "T: serde::Deserialize<'de>"
            ))]
            struct Parts<T: Real> {
                $($(#[$attribute])* $field: $of,)*
            }

            impl<$($generics)*> serde::Serialize for $type
            where
                T: serde::Serialize,
            {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    let $model = self;
                    Parts::<T> { $($field: $value,)* }.serialize(serializer)
                }
            }

            impl<'de, $($generics)*> serde::Deserialize<'de> for $type
            where
                T: serde::Deserialize<'de>,
            {
                fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    let Parts::<T> { $($field),* } = serde::Deserialize::deserialize(deserializer)?;
                    $make.map_err(serde::de::Error::custom)
                }
            }
        };
    };
}

pub(crate) use stored;
