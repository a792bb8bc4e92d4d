//! A script that shows everything once.

use crate::script::Script;
use crate::surface_point::SurfacePoint;

/// The session of `fingertip demo`, 26 s: one second of rest for the tare; presses of 0.1, 1, 10 and
/// 30 N at the top and four other points of the active surface, the last one behind the equator; a
/// roll from near the top down to the equator; eight drags with slip, from 1 to 20 N, with static
/// friction of 0.4 to 0.8, in all directions; between two of them the grip is doubled, which is no
/// slip.
pub fn standard_session() -> Script {
    let mut script = Script::default().rest(1.0);
    let points = [(0.0, 0.0), (30.0, 0.0), (60.0, 120.0), (90.0, 240.0), (110.0, 330.0)];
    for force in [0.1, 1.0, 10.0, 30.0] {
        for (from_top, azimuth) in points {
            let at = SurfacePoint::degrees(from_top, azimuth);
            script = script.press(at, force, 0.15).hold(0.25).release(0.1).rest(0.05);
        }
    }
    script = script
        .press(SurfacePoint::degrees(15.0, 200.0), 3.0, 0.2)
        .hold(0.1)
        .roll(SurfacePoint::degrees(85.0, 280.0), 1.5)
        .hold(0.1)
        .release(0.2)
        .rest(0.1);
    // From the top, azimuth, heading [degrees]; normal force [N]; static and kinetic coefficient.
    let drags = [
        (0.0, 0.0, 0.0, 1.0, (0.6, 0.45)),
        (30.0, 90.0, 180.0, 2.0, (0.5, 0.35)),
        (45.0, 180.0, 90.0, 5.0, (0.4, 0.3)),
        (60.0, 270.0, -90.0, 5.0, (0.8, 0.6)),
        (75.0, 30.0, 45.0, 10.0, (0.5, 0.4)),
        (90.0, 150.0, 180.0, 20.0, (0.45, 0.35)),
    ];
    for (from_top, azimuth, heading, force, friction) in drags {
        script = script
            .press(SurfacePoint::degrees(from_top, azimuth), force, 0.2)
            .hold(0.1)
            .drag(f64::to_radians(heading), friction, 0.6, 0.25)
            .hold(0.1)
            .release(0.2)
            .rest(0.1);
    }
    // Slip, a firmer grip under the same pull, and slip again.
    script
        .press(SurfacePoint::degrees(40.0, 60.0), 4.0, 0.2)
        .hold(0.1)
        .drag(0.0, (0.5, 0.4), 0.6, 0.2)
        .squeeze(8.0, 0.4)
        .hold(0.1)
        .drag(0.0, (0.5, 0.4), 0.6, 0.2)
        .hold(0.1)
        .release(0.2)
        .rest(0.2)
}
