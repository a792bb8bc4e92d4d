//! Samples as messages of ROS 2 in CDR, the same ones that recordings hold.

use fingertip::friction::SlipVerdict;
use fingertip::wrench::Wrench;
use fingertip_recordings::mcap::{Header, Recorded, RecordedContact, RecordedTouch};
use nalgebra::Vector3;

use crate::{Pressed, Sample};

/// What messages call the fingertip.
const NAME: &str = "fingertip";

/// When it was made, and in which frame.
#[must_use]
pub fn header(sample: &Sample, frame: &str) -> Header {
    let seconds = i32::try_from(sample.stamp.as_secs()).unwrap_or(i32::MAX);
    Header { seconds, nanoseconds: sample.stamp.subsec_nanos(), frame: frame.to_owned() }
}

/// `geometry_msgs/msg/WrenchStamped`: as the sensor reports it, less its zero.
#[must_use]
pub fn wrench(sample: &Sample, header: &Header) -> Vec<u8> {
    Recorded::Wrench(sample.wrench).emit(header)
}

/// `tactile_msgs/msg/TactileContact`.
#[must_use]
pub fn contact(contact: &Pressed, header: &Header) -> Vec<u8> {
    let wrench = Wrench::on_fingertip(contact.force, contact.normal * contact.spin_torque);
    let Pressed { point, normal, .. } = *contact;
    Recorded::Contact(RecordedContact { name: NAME.to_owned(), position: point, normal, wrench }).emit(header)
}

/// `fingertip_msgs/msg/Touch`; `None` without a scene.
#[must_use]
pub fn touch(sample: &Sample, header: &Header) -> Option<Vec<u8>> {
    Some(Recorded::Touch(recorded_touch(sample)?).emit(header))
}

/// What was felt, as it is recorded; `None` without a scene. What there is none of is NaN.
#[must_use]
pub fn recorded_touch(sample: &Sample) -> Option<RecordedTouch> {
    let felt = sample.felt.as_ref()?;
    let none = Vector3::repeat(f64::NAN);
    let contact = felt.contact.as_ref();
    Some(RecordedTouch {
        number: sample.number,
        time: sample.time,
        status: felt.status.to_owned(),
        load: felt.load,
        point: contact.map_or(none, |contact| contact.point),
        normal: contact.map_or(none, |contact| contact.normal),
        normal_force: contact.map_or(f64::NAN, |contact| contact.normal_force),
        tangential_force: contact.map_or(none, |contact| contact.tangential_force),
        spin_torque: contact.map_or(f64::NAN, |contact| contact.spin_torque),
        margin: felt.margin.map_or(f64::NAN, |margin| margin.newtons),
        utilisation: felt.margin.map_or(f64::NAN, |margin| margin.utilisation),
        slip: match felt.slip {
            None => 0,
            Some(SlipVerdict::NotPressing) => 1,
            Some(SlipVerdict::Holding) => 2,
            Some(SlipVerdict::Warning) => 3,
            Some(SlipVerdict::Slipping) => 4,
        },
    })
}

#[cfg(test)]
mod tests {
    use fingertip_recordings::mcap::definitions;

    /// The package of ROS and what recordings carry say the same.
    #[test]
    fn the_package_of_ros_has_the_definition_of_recordings() {
        let [.., touch] = definitions();
        let file = include_str!("../ros/fingertip_msgs/msg/Touch.msg");
        let bare: Vec<&str> = file.lines().filter(|line| !line.starts_with('#')).collect();
        let recorded = touch.text.split("\n====").next().unwrap_or_default();
        assert_eq!(recorded.lines().collect::<Vec<_>>(), bare);
    }

    #[test]
    fn the_layout_for_foxglove_shows_what_there_is() {
        let layout = include_str!("../layouts/foxglove.json");
        let [.., touch] = definitions();
        for part in layout.split("\"/fingertip/touch.").skip(1) {
            let field = part.split(['"', '.']).next().unwrap_or_default();
            assert!(touch.text.contains(&format!(" {field}\n")), "{field}");
        }
        assert_eq!(layout.matches("\"/fingertip/touch.").count(), 4);
        assert_eq!(layout.matches('{').count(), layout.matches('}').count());
    }
}
