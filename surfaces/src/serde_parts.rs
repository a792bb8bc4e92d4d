//! How shapes are written in files, in one place.

/// Serialises a shape as a plain struct of its parameters, with units in the keys, and validates
/// it again on reading.
///
/// `serde_parts!(Shape { key: Type = |shape| getter, … } => |parts| constructor)`
macro_rules! serde_parts {
    (
        $shape:ident { $( $(#[$attribute:meta])* $key:ident: $type:ty = $getter:expr ),+ $(,)? }
        => |$parts:ident| $build:expr
    ) => {
        #[cfg(feature = "serde")]
        const _: () = {
            #[derive(serde::Serialize, serde::Deserialize)]
            #[serde(
                deny_unknown_fields,
                bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
            )]
            struct Parts<T: Real> {
                $( $(#[$attribute])* $key: $type, )+
            }

            impl<T: Real + serde::Serialize> serde::Serialize for $shape<T> {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    fn get<A, B>(shape: &A, getter: impl FnOnce(&A) -> B) -> B {
                        getter(shape)
                    }
                    Parts { $( $key: get(self, $getter), )+ }.serialize(serializer)
                }
            }

            impl<'de, T: Real + serde::Deserialize<'de>> serde::Deserialize<'de> for $shape<T> {
                fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    let $parts = Parts::<T>::deserialize(deserializer)?;
                    $build.map_err(serde::de::Error::custom)
                }
            }
        };
    };
}

pub(crate) use serde_parts;
