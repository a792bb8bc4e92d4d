//! Plots of a report, read as their reader does: by the marks along their axes.

use fingertip_calibration::page::Figure;
use fingertip_calibration::report::{Outlier, Report, SampleReport};
use fingertip_test_support::read_back::{Ruler, Text, assert_readable, paths, points, rulers, texts};

use super::report_forms::report;

/// Changes the samples of a report.
fn changed(report: &mut Report, change: impl Fn(usize, &mut SampleReport)) {
    let samples = report.details.iter().enumerate().map(|(index, mut sample)| {
        change(index, &mut sample);
        sample
    });
    report.details = samples.collect();
}

/// Points of the fit, or of the loads left out, as they are drawn.
fn drawn(figure: &Figure, class: &str) -> Vec<(f64, f64)> {
    let mut points = points(&figure.svg, class);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

const FITTED: &str = "dots a";
const LEFT_OUT: &str = "squares d";

fn near(ruler: Ruler, place: f64, expected: f64) {
    assert!((ruler.at(place) - expected).abs() <= 2.0 * ruler.error(), "{} for {expected}", ruler.at(place));
}

/// The names beside points.
fn names(figure: &Figure) -> Vec<Text> {
    texts(&figure.svg).into_iter().filter(|text| text.class == "halo").collect()
}

#[test]
fn points_are_where_the_axes_say() {
    let report = report();
    // 2.5 % on the left, −5 % on the right; the samples one after another.
    for (figure, places, ends) in [
        (report.error_over_load(0).unwrap(), [-4.0, 8.0, 2.0], "-4.60000;8.60000"),
        (report.error_over_samples(0).unwrap(), [1.0, 2.0, 3.0], "0.900000;3.10000"),
    ] {
        assert_readable(&figure.svg);
        let (across, up) = rulers(&figure.svg);
        let expected = |errors: &[f64]| {
            let mut all: Vec<(f64, f64)> = places.into_iter().zip(errors.iter().copied()).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all
        };
        for (class, errors) in [(FITTED, &[2.5, -5.0, 0.0][..]), (LEFT_OUT, &[5.0, -2.5])] {
            let drawn = drawn(&figure, class);
            assert_eq!(drawn.len(), errors.len(), "{}", figure.svg);
            for ((x, y), (place, error)) in drawn.into_iter().zip(expected(errors)) {
                near(across, x, place);
                near(up, y, error);
            }
        }
        // A line where there is no error, from edge to edge.
        let least = places.iter().copied().fold(f64::INFINITY, f64::min);
        let most = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_zero = |line: &[(f64, f64)]| {
            let (Some(from), Some(to)) = (line.first(), line.last()) else { return false };
            let level = [from, to].iter().all(|end| up.at(end.1).abs() <= 2.0 * up.error());
            level && across.at(from.0) < least && across.at(to.0) > most
        };
        let lines = paths(&figure.svg).into_iter().filter(|path| path.class == "axis");
        assert!(lines.flat_map(|path| path.pieces).any(|line| is_zero(&line)), "{}", figure.svg);
        // A twentieth of the range beyond the outermost loads, a tenth beyond the greatest error.
        assert!(figure.svg.contains(&format!("{ends}\"")), "{}", figure.svg);
        assert!(figure.svg.contains("data-y=\"error / % of full scale;-5.50000;5.50000\""), "{}", figure.svg);
        // The outlier is named beside its point, and no other.
        let [name] = &names(&figure)[..] else { panic!("{}", figure.svg) };
        assert_eq!(name.text, "b");
        assert!((up.at(name.at.1 - 0.33 * 11.5) + 5.0).abs() < 4.0 * up.error(), "{name:?}");
        let keys: Vec<&str> = figure.keys.iter().map(|(class, _)| *class).collect();
        assert_eq!(keys, ["a spot", "d square"]);
    }
    assert!(report.error_over_load(2).is_none() && report.error_over_samples(9).is_none());
    assert!(report.error_over_load(1).unwrap().svg.contains("data-x=\"Tz / N·m;"));
    assert!(report.error_over_load(0).unwrap().svg.contains("data-x=\"Fx / N;"));
    assert!(report.error_over_samples(1).unwrap().svg.contains("data-x=\"sample;"));
    assert_eq!(report.error_over_samples(1).unwrap().title, "Tz: error, sample after sample");
}

/// The name of an outlier stands on the side of its point where there is room.
#[test]
fn names_of_outliers_stay_within_the_plot() {
    for (load, anchor) in [(8.0, "end"), (-4.0, "start")] {
        let mut report = report();
        changed(&mut report, |index, sample| match index {
            0 => sample.applied[0] = 4.0 - load,
            1 => {
                sample.applied[0] = load;
                sample.measured[0] = load - 0.4;
            }
            _ => {}
        });
        let figure = report.error_over_load(0).unwrap();
        let [name] = &names(&figure)[..] else { panic!("{}", figure.svg) };
        assert_eq!((name.text.as_str(), name.anchor.as_str()), ("b", anchor));
        let (across, _) = rulers(&figure.svg);
        let place = drawn(&figure, FITTED).into_iter().find(|(x, _)| (across.at(*x) - load).abs() < 0.1);
        let shift = name.at.0 - place.unwrap().0;
        assert!((shift.abs() - 7.0).abs() < 0.2 && (shift < 0.0) == (anchor == "end"), "{shift}");
    }
}

#[test]
fn plots_of_one_load_or_no_error_have_room() {
    let mut report = report();
    changed(&mut report, |_, sample| {
        (sample.applied, sample.measured) = (vec![3.0, 0.0], vec![3.0, 0.0]);
        sample.left_out = None;
    });
    let figure = report.error_over_load(0).unwrap();
    // All three in the middle, between ±1 % and 2 N and 4 N; one is seen.
    let (across, up) = rulers(&figure.svg);
    let [(x, y)] = drawn(&figure, FITTED)[..] else { panic!("{}", figure.svg) };
    near(across, x, 3.0);
    near(up, y, 0.0);
    assert!(figure.svg.contains(";2.00000;4.00000\"") && figure.svg.contains(";-1.00000;1.00000\""));
    assert!(!figure.svg.contains(">-0<") && !figure.svg.contains(">−0<"));
    assert_eq!(figure.keys.len(), 1, "nothing is left out");
    for bad in [f64::NAN, f64::INFINITY] {
        let mut measured = report.clone();
        changed(&mut measured, |index, sample| sample.measured[0] = if index == 0 { bad } else { 3.0 });
        assert!(measured.error_over_samples(0).is_none());
        let mut applied = report.clone();
        changed(&mut applied, |index, sample| sample.applied[0] = if index == 0 { bad } else { 3.0 });
        assert!(applied.error_over_load(0).is_none());
    }
    report.details = core::iter::empty().collect();
    assert!(report.error_over_load(0).is_none());
}

/// Of many outliers at one place one name stands, and long names are cut; those that have room all stand.
#[test]
fn names_of_outliers_do_not_run_into_each_other() {
    let mut report = report();
    let (sample, outlier) = (report.details.get(1).unwrap(), report.outliers[0].clone());
    let name = |index: usize| match index {
        199 => "far".to_owned(),
        _ => format!("a sample with the long name {index}"),
    };
    let sample = |index: usize| {
        let mut sample = SampleReport { name: name(index), ..sample.clone() };
        if index == 199 {
            sample.applied[0] = -sample.applied[0];
        }
        sample
    };
    report.details = (0..200).map(sample).collect();
    report.outliers =
        (0..200).map(|index| Outlier { sample: name(index), index, ..outlier.clone() }).collect();
    let figure = report.error_over_load(0).unwrap();
    assert_readable(&figure.svg);
    let shown = |figure: &Figure, name: &str| names(figure).iter().filter(|text| text.text == name).count();
    // Beside one dot there is room for a line of letters, one above it and one below.
    assert_eq!(shown(&figure, "a sample with the long n…"), 3, "{}", figure.svg);
    assert_eq!(shown(&figure, "far"), 1, "{}", figure.svg);
    // One after another there is room for some, a line of letters apart.
    let samples = report.error_over_samples(0).unwrap();
    assert_readable(&samples.svg);
    let shown = shown(&samples, "a sample with the long n…");
    assert!((1..20).contains(&shown), "{shown}");
}

/// Errors of a nanonewton and loads of a giganewton have ticks that say them.
#[test]
fn numbers_of_any_size_are_told_apart() {
    for size in [1e-12, 1e-6, 1.0, 1e6, 1e90] {
        let mut report = report();
        for axis in &mut report.axes {
            axis.full_scale *= size;
        }
        changed(&mut report, |index, sample| {
            let error = 1e-9 * (index as f64 - 1.0);
            sample.left_out = None;
            sample.applied.iter_mut().for_each(|load| *load *= size);
            sample.measured = sample.applied.iter().map(|load| load + error * size).collect();
        });
        let figure = report.error_over_load(0).unwrap();
        assert_readable(&figure.svg);
        for anchor in ["middle", "end"] {
            let ticks: Vec<String> = texts(&figure.svg)
                .into_iter()
                .filter(|text| text.class == "tick" && text.anchor == anchor)
                .map(|text| text.text)
                .collect();
            let mut different = ticks.clone();
            different.sort_unstable();
            different.dedup();
            assert!(ticks.len() >= 2 && different.len() == ticks.len(), "{size}: {ticks:?}");
            assert!(ticks.iter().all(|tick| tick.chars().count() <= 6), "{size}: {ticks:?}");
        }
        let svg = &figure.svg;
        assert!(svg.contains("error / 10⁻⁹ % of full scale") || svg.contains("error / 10⁻⁶ %"), "{svg}");
    }
}
