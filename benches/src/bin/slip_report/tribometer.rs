//! The recording of a tribometer, where it is present.

use core::fmt::Write as _;

use crate::Failure;
use crate::detectors::quantile;
use crate::page::Page;

#[path = "../../../../friction/tests/support/tribometer.rs"]
mod recording;

use recording::Recording;

/// Peaks and onsets of the strokes.
pub(crate) fn report(page: &mut Page) -> Result<(), Failure> {
    page.say("\n## Tribometer: 100 recorded strokes with displacement\n");
    let Some(recording) = Recording::open() else {
        page.say("The recording is not there; FINGERTIP_DATA names the folder of the data.");
        return Ok(());
    };
    let mut peaks: Vec<f64> = recording.peak_errors()?.iter().map(|error| error.abs() * 100.0).collect();
    peaks.sort_by(f64::total_cmp);
    let onsets = recording.onsets()?;
    let mut text =
        String::from("| figure | found | median | 5 % | 95 % | worst |\n|---|---|---|---|---|---|\n");
    writeln!(
        text,
        "| error of the peak friction % | {} | {:.3} | {:.3} | {:.3} | {:.3} |",
        peaks.len(),
        quantile(&peaks, 0.5),
        quantile(&peaks, 0.05),
        quantile(&peaks, 0.95),
        quantile(&peaks, 1.0),
    )?;
    let mut delays = |name: &str, label: &dyn Fn(&[f64]) -> Option<f64>| -> Result<usize, Failure> {
        let delay = |stroke: &Vec<f64>| {
            let onset = onsets.times.iter().find(|time| **time >= stroke[0] && **time <= stroke[1])?;
            Some((onset - label(stroke)?) * 1e3)
        };
        let mut delays: Vec<f64> = recording.strokes.iter().filter_map(delay).collect();
        delays.sort_by(f64::total_cmp);
        let worst = delays
            .iter()
            .fold(0.0_f64, |worst, delay| if delay.abs() > worst.abs() { *delay } else { worst });
        writeln!(
            text,
            "| {name} | {} | {:.0} | {:.0} | {:.0} | {worst:.0} |",
            delays.len(),
            quantile(&delays, 0.5),
            quantile(&delays, 0.05),
            quantile(&delays, 0.95),
        )?;
        Ok(delays.iter().filter(|delay| delay.abs() <= 50.0 + 1e-6).count())
    };
    let published = delays("onset after the published 5 µm label ms", &|stroke| stroke.get(8).copied())?;
    let own =
        delays("onset after slip by 5 µm for good ms", &|stroke| recording.slipped_for_good(stroke, 1.0))?;
    page.say(&text);
    let dwells = onsets.times.len()
        - recording
            .strokes
            .iter()
            .filter(|stroke| onsets.times.iter().any(|time| *time >= stroke[0] && *time <= stroke[1]))
            .count();
    page.say(&format!(
        "Motion-aware detector (incipient slip): {published} of {} onsets within 50 ms of the published label, {own} \
         within 50 ms of the time at which slip passed 5 µm for good; {dwells} alarms in the dwells. One published \
         label marks a fall of the apparent slip. The others move by 20 ms with one standard deviation of the \
         stiffness they rest on (0.7 %), and the recording has 200 samples a second.",
        recording.strokes.len(),
    ));
    Ok(())
}
