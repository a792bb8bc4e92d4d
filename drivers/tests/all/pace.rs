//! The steps of a simulated sensor on the clock, on a machine of any speed.
#![cfg(feature = "simulators")]

use core::time::Duration;
use std::time::Instant;

use fingertip_drivers::sensors::Pace;

#[test]
fn a_step_is_due_at_once_and_then_not_before_its_period() {
    let mut pace = Pace::new(Duration::from_secs(3600));
    let start = Instant::now();
    assert!(pace.is_due());
    // It naps for a millisecond and says no, instead of sleeping for an hour.
    assert!((0..5).all(|_| !pace.is_due()));
    assert!(start.elapsed() >= Duration::from_millis(5) && start.elapsed() < Duration::from_secs(1800));
    pace.restart();
    assert!(pace.is_due() && !pace.is_due());
}

/// Steps that are due in a row after a pause, and how long pause and steps took.
fn behind(period: Duration, pause: Duration) -> (u128, Duration) {
    let mut pace = Pace::new(period);
    let start = Instant::now();
    assert!(pace.is_due());
    std::thread::sleep(pause);
    let mut due = 0;
    while pace.is_due() {
        due += 1;
    }
    (due, start.elapsed())
}

#[test]
fn steps_that_are_late_are_made_up_for_but_not_after_a_long_pause() {
    let period = Duration::from_millis(10);
    let mut tried = 0;
    let due = loop {
        let (due, took) = behind(period, Duration::from_millis(45));
        // A machine that was busy for longer may have had a long pause: that is another case.
        if took < Duration::from_millis(90) {
            // As many as periods have passed, or one less if the last began on the way.
            assert!(due >= 4 && due <= took.as_nanos() / period.as_nanos(), "{due} in {took:?}");
            break due;
        }
        tried += 1;
        assert!(tried < 600);
    };
    assert!(due >= 4);
    let pause = Duration::from_millis(500);
    let (due, took) = behind(period, pause);
    // Those of the pause are left out; what passed behind it may have some more.
    let behind = (took.saturating_sub(pause)).as_nanos() / period.as_nanos();
    assert!(due <= 3 + behind, "{due} in {took:?}");
}
