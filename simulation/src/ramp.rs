//! How loads go from one value to the next.

/// The share of the way at a share `u` of the time: `3u² − 2u³`, which begins and ends at rest; outside of 0 and 1 it stays.
pub(crate) fn smooth(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}
