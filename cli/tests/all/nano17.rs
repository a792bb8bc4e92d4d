//! Real input: two Nano17 under human finger pads, with the scene that ships with the project.

use fingertip_test_support::recording;

use crate::common::{Contacts, Folder, scene};

const ROLL: &str = "nano17_three_finger/roll.csv";

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn fingers_on_a_cylinder_are_found_on_their_pads() {
    let Some(recording) = recording(ROLL) else { return };
    let recording = recording.display().to_string();
    let folder = Folder::new();
    // Median friction ratio and number of samples above 1 N for thumb and ring finger, computed from
    // the same rows by an independent script with the author's formulas.
    for (sensor, ratio_expected, samples_expected) in [("S1", 0.245, 1287), ("S2", 0.169, 1302)] {
        let scene = scene("nano17_cylinder.toml");
        folder.succeed(&["analyze", &recording, "--scene", &scene, "--sensor", sensor]);
        let contacts = Contacts::parse(&folder.read("contacts.csv"));
        assert_eq!(contacts.len(), 1602);
        let status = contacts.words("status");
        let loaded: Vec<usize> = (0..status.len()).filter(|row| status[*row] != "below_threshold").collect();
        assert_eq!(loaded.len(), samples_expected, "{sensor}: samples above 1 N");

        // The line of action meets the cylinder in all of them …
        for row in &loaded {
            assert!(
                matches!(status[*row], "contact" | "outside_active_region" | "only_pulling"),
                "{sensor}, row {row}: {}",
                status[*row]
            );
        }
        // … and on the pad, whose half height is 10.9965 mm, in at least 99.4 %.
        let on_pad: Vec<usize> = loaded.iter().copied().filter(|row| status[*row] == "contact").collect();
        let share = on_pad.len() as f64 / loaded.len() as f64;
        assert!(share >= 0.994, "{sensor}: {share}");

        let (x, y, z) = (contacts.numbers("x_m"), contacts.numbers("y_m"), contacts.numbers("z_m"));
        let (sin, cos) = 42_f64.to_radians().sin_cos();
        for row in &on_pad {
            // In the cylinder's frame: on its surface, and between the pad's ends.
            let (across, along) = (cos * x[*row] + sin * y[*row], cos * y[*row] - sin * x[*row]);
            assert!((across.hypot(z[*row] + 0.027_347) - 0.04).abs() < 1e-8, "{sensor}, row {row}");
            assert!(along.abs() <= 0.011, "{sensor}, row {row}: {along}");
        }
        // The finger is on the pad's side: angles within −27° to 30° from the 5th to the 95th
        // hundredth.
        let mut angles: Vec<f64> = on_pad
            .iter()
            .map(|row| (cos * x[*row] + sin * y[*row]).atan2(z[*row] + 0.027_347).to_degrees())
            .collect();
        angles.sort_by(f64::total_cmp);
        let (low, high) = (angles[angles.len() / 20], angles[angles.len() * 19 / 20]);
        assert!(low > -27.0 && high < 30.0, "{sensor}: {low} to {high}");

        let ratios = contacts.numbers("ratio");
        let ratio = median(on_pad.iter().map(|row| ratios[*row]).collect());
        assert!((0.12..=0.28).contains(&ratio), "{sensor}: {ratio}");
        assert!((ratio - ratio_expected).abs() < 0.002, "{sensor}: {ratio}");
    }
}

#[test]
fn the_other_convention_puts_the_contacts_on_the_far_side() {
    let Some(recording) = recording(ROLL) else { return };
    let recording = recording.display().to_string();
    let folder = Folder::new();
    let text = std::fs::read_to_string(scene("nano17_cylinder.toml")).unwrap();
    folder.write("wrong.toml", &text.replace("\"on_fingertip\"", "\"reaction\""));
    folder.succeed(&["analyze", &recording, "--scene", "wrong.toml", "--sensor", "S1", "--no-report"]);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let heights: Vec<f64> = contacts.numbers("z_m").into_iter().filter(|z| !z.is_nan()).collect();
    assert!(heights.len() > 100);
    assert!(heights.iter().filter(|z| **z < -0.027_347).count() as f64 > 0.99 * heights.len() as f64);
}

#[test]
fn a_choice_between_two_sensors_must_be_made() {
    let Some(recording) = recording(ROLL) else { return };
    let recording = recording.display().to_string();
    let folder = Folder::new();
    let scene = scene("nano17_cylinder.toml");
    let error = folder.fail(1, &["analyze", &recording, "--scene", &scene]);
    assert!(error.contains("choose one of: s1, s2"), "{error}");
    let error = folder.fail(1, &["analyze", &recording, "--scene", &scene, "--sensor", "S3"]);
    assert!(error.contains("S3") && error.contains("s1, s2"), "{error}");
    // Nothing was written for a run that never began.
    assert!(!folder.path("contacts.csv").exists());
}
