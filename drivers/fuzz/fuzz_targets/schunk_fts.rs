//! Datagrams, commands and answers of a SCHUNK FTS.
#![no_main]

use fingertip_drivers::sensors::schunk_fts::{Command, CommandAnswer, FtsReceiver, Packet};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok((counter, command)) = Command::parse(bytes) {
        assert_eq!(command.emit(counter), bytes);
    }
    if let Ok((counter, answer)) = CommandAnswer::parse(bytes) {
        assert_eq!(answer.emit(counter), bytes);
    }
    let Ok(packet) = Packet::new_checked(bytes) else { return };
    let mut receiver = FtsReceiver::default();
    for wrench in receiver.accept::<f64>(&packet).into_iter().flatten().flatten() {
        assert!(wrench.is_finite());
    }
});
