//! Arrays of any length but zero in files: serde itself knows only lengths that are written out.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub(crate) fn serialize<V: Serialize, S: Serializer, const N: usize>(
    values: &[V; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(N)?;
    for value in values {
        tuple.serialize_element(value)?;
    }
    tuple.end()
}

pub(crate) fn deserialize<'de, V: Deserialize<'de> + Copy, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<[V; N], D::Error> {
    deserializer.deserialize_tuple(N, Array(PhantomData))
}

struct Array<V, const N: usize>(PhantomData<V>);

impl<'de, V: Deserialize<'de> + Copy, const N: usize> Visitor<'de> for Array<V, N> {
    type Value = [V; N];

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "an array of {N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<[V; N], A::Error> {
        let mut next = |i: usize| elements.next_element()?.ok_or_else(|| Error::invalid_length(i, &self));
        let mut values = [next(0)?; N];
        for (i, value) in values.iter_mut().enumerate().skip(1) {
            *value = next(i)?;
        }
        Ok(values)
    }
}
