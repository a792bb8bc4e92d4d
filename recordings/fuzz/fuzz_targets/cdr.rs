//! Messages in CDR.
#![no_main]

use fingertip_recordings::mcap::Recorded;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let names =
        ["geometry_msgs/msg/WrenchStamped", "fingertip_msgs/msg/Signals", "tactile_msgs/msg/TactileContact"];
    for name in names {
        if let Ok((header, recorded)) = Recorded::parse(name, bytes) {
            // A string may hold a zero, behind which nothing is written, and numbers may be NaN: what is
            // written must be read, and written the same again.
            let once = recorded.emit(&header);
            match Recorded::parse(name, &once) {
                Ok((header, recorded)) => assert_eq!(recorded.emit(&header), once),
                Err(error) => panic!("{error}"),
            }
        }
    }
});
