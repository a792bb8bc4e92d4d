//! The frames of surface and contact: `tf2_msgs/msg/TFMessage`.

use std::time::{SystemTime, UNIX_EPOCH};

use fingertip_recordings::mcap::{CdrWriter, Header};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::{About, Pressed};

fn transform(header: &Header, child: &str, at: &Vector3<f64>, axes: [Vector3<f64>; 3]) -> Vec<u8> {
    let turn =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(Matrix3::from_columns(&axes)));
    let mut to = CdrWriter::default();
    to.u32(1);
    header.write(&mut to);
    to.string(child);
    to.f64s(at.iter().copied());
    to.f64s([turn.i, turn.j, turn.k, turn.w]);
    to.into_message()
}

/// The frame of the surface, `NAME_surface`: at its centre, its third axis out of the fingertip.
pub(super) fn surface(about: &About) -> Vec<u8> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let header = Header {
        seconds: i32::try_from(now.as_secs()).unwrap_or(i32::MAX),
        nanoseconds: now.subsec_nanos(),
        frame: about.frame.clone(),
    };
    transform(&header, &format!("{}_surface", about.frame), &about.centre, about.axes)
}

/// The frame of the contact, `NAME_contact`: at the point, its third axis the outward normal.
pub(super) fn contact(contact: &Pressed, about: &About, header: &Header) -> Vec<u8> {
    let normal = contact.normal;
    let helper = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let first = (helper - normal * helper.dot(&normal)).try_normalize(0.0).unwrap_or_else(Vector3::x);
    transform(
        header,
        &format!("{}_contact", about.frame),
        &contact.point,
        [first, normal.cross(&first), normal],
    )
}

#[cfg(test)]
mod tests {
    use fingertip_recordings::mcap::{CdrReader, Header};
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};

    use super::contact;
    use crate::{About, Pressed};

    #[test]
    fn the_third_axis_of_the_contact_is_its_normal() {
        for normal in
            [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::z(), Vector3::new(0.48, 0.6, -0.64)]
        {
            let (zero, point) = (Vector3::zeros(), Vector3::new(1.0, 2.0, 3.0));
            let pressed = Pressed {
                point,
                normal,
                force: zero,
                normal_force: 0.0,
                tangential_force: zero,
                spin_torque: 0.0,
                ellipse: None,
            };
            let about = About { frame: "tip".to_owned(), ..About::default() };
            let message = contact(&pressed, &about, &Header::default());
            let mut reader = CdrReader::new(&message).unwrap();
            assert_eq!(
                (reader.u32(), reader.i32(), reader.u32(), reader.string()),
                (Ok(1), Ok(0), Ok(0), Ok(""))
            );
            assert_eq!((reader.string(), reader.f64s()), (Ok("tip_contact"), Ok([1.0, 2.0, 3.0])));
            let [i, j, k, w] = reader.f64s().unwrap();
            let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
            assert!((turn * Vector3::z() - normal).norm() < 1e-12, "{normal}");
        }
    }
}
