//! A mesh in files: vertices and triangles.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::Mesh;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
struct Parts<T: Real> {
    vertices_m: Vec<Vector3<T>>,
    triangles: Vec<[u32; 3]>,
}

impl<T: Real + Serialize> Serialize for Mesh<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Parts { vertices_m: self.vertices().collect(), triangles: self.triangles.clone() }
            .serialize(serializer)
    }
}

impl<'de, T: Real + Deserialize<'de>> Deserialize<'de> for Mesh<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let parts = Parts::<T>::deserialize(deserializer)?;
        Self::new(&parts.vertices_m, &parts.triangles).map_err(Error::custom)
    }
}
