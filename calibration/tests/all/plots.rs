//! Plots of a report: where their points are.

use fingertip_calibration::report::{Outlier, SampleReport};

use super::report_forms::report;

/// Attribute of an element of SVG.
fn number(element: &str, attribute: &str) -> f64 {
    let text = element.split_once(&format!(" {attribute}=\"")).unwrap().1;
    text.split('"').next().unwrap().parse().unwrap()
}

/// Places and radii of the circles, those of the fit and those left out.
fn circles(svg: &str) -> Vec<(f64, f64, f64)> {
    let elements = svg.split("<circle").skip(1).map(|element| element.split_once('>').unwrap().0);
    elements.map(|element| (number(element, "cx"), number(element, "cy"), number(element, "r"))).collect()
}

#[test]
fn plots_show_errors_over_loads_and_samples() {
    let report = report();
    // 5 % on the left, −5 % on the right; the samples one after another.
    for (svg, places) in [
        (report.error_over_load(0).unwrap(), [-4.0, 8.0, 2.0]),
        (report.error_over_samples(0).unwrap(), [1.0, 2.0, 3.0]),
    ] {
        let found = circles(&svg);
        let errors = [2.5, -5.0, 0.0, 5.0, -2.5];
        assert_eq!(found.iter().map(|circle| circle.2).collect::<Vec<_>>(), [5.0, 5.0, 3.0, 3.0, 3.0]);
        // Hollow ones, of the loads left out, come first, below the others.
        let x = [places[0], places[1], places[0], places[1], places[2]];
        let y = [errors[3], errors[4], errors[0], errors[1], errors[2]];
        // Affine in both directions: whole pixels.
        let (left, right) = (found[2], found[3]);
        for (i, circle) in found.iter().enumerate() {
            let along = (x[i] - places[0]) / (places[1] - places[0]);
            assert!((circle.0 - left.0 - along * (right.0 - left.0)).abs() <= 1.5, "{svg}");
            let down = (y[i] - 2.5) / -7.5;
            assert!((circle.1 - left.1 - down * (right.1 - left.1)).abs() <= 1.5, "{svg}");
        }
        assert!(right.0 > left.0 + 50.0 && right.1 > left.1 + 50.0);
        // A margin: no point lies on the frame, all are within the picture.
        assert!(found.iter().all(|(x, y, _)| (70.0..470.0).contains(x) && (10.0..250.0).contains(y)));
        assert!(svg.contains(">\nb\n</text>") && !svg.contains(">\na\n</text>"), "{svg}");
    }
    assert_eq!((report.error_over_load(2), report.error_over_samples(9)), (None, None));
    assert!(report.error_over_load(1).unwrap().contains("Tz / N·m"));
    assert!(report.error_over_load(0).unwrap().contains("Fx / N"));
    assert!(report.error_over_samples(1).unwrap().contains("sample"));
}

/// The name of an outlier stands on the side of its point where there is room.
#[test]
fn names_of_outliers_stay_within_the_plot() {
    for (load, anchor) in [(8.0, "end"), (-4.0, "start")] {
        let mut report = report();
        report.details[1].applied[0] = load;
        report.details[0].applied[0] = 4.0 - load;
        let svg = report.error_over_load(0).unwrap();
        let name = svg.split("<text").find(|text| text.contains(">\nb\n</text>")).unwrap();
        assert!(name.contains(&format!("text-anchor=\"{anchor}\"")), "{name}");
        let place = circles(&svg)[3].0;
        let shift = number(name, "x") - place;
        assert!((shift.abs() - 9.0).abs() <= 1.0 && (shift < 0.0) == (anchor == "end"), "{shift}");
    }
}

#[test]
fn plots_of_one_load_or_no_error_have_room() {
    let mut report = report();
    for sample in &mut report.details {
        *sample = SampleReport {
            applied: vec![3.0, 0.0],
            measured: vec![3.0, 0.0],
            left_out: None,
            name: sample.name.clone(),
        };
    }
    let svg = report.error_over_load(0).unwrap();
    // All three in the middle, between ±1 % and 2 N and 4 N.
    let found = circles(&svg);
    assert!(found.len() == 3 && found.iter().all(|circle| *circle == found[0]), "{svg}");
    for tick in ["2", "4", "−1", "1", "0"] {
        assert!(svg.contains(&format!(">\n{tick}\n</text>")), "{tick} {svg}");
    }
    assert!(!svg.contains("\n-0\n") && !svg.contains("\n−0\n"));
    for bad in [f64::NAN, f64::INFINITY] {
        report.details[0].measured[0] = bad;
        assert_eq!(report.error_over_samples(0), None);
        report.details[0].measured[0] = 3.0;
        report.details[0].applied[0] = bad;
        assert_eq!(report.error_over_load(0), None);
        report.details[0].applied[0] = 3.0;
    }
    report.details.clear();
    assert_eq!(report.error_over_load(0), None);
}

/// Of many outliers at one place one name stands, and long names are cut; those that have room all stand.
#[test]
fn names_of_outliers_do_not_run_into_each_other() {
    let mut report = report();
    let (sample, outlier) = (report.details[1].clone(), report.outliers[0].clone());
    (report.details, report.outliers) = (Vec::new(), Vec::new());
    for index in 0..200 {
        let name =
            if index < 199 { format!("a sample with the long name {index}") } else { "far".to_owned() };
        let mut sample = SampleReport { name: name.clone(), ..sample.clone() };
        if index == 199 {
            sample.applied[0] = -sample.applied[0];
        }
        report.details.push(sample);
        report.outliers.push(Outlier { sample: name, index, ..outlier.clone() });
    }
    let svg = report.error_over_load(0).unwrap();
    // Beside one dot there is room for a line of letters, one above it and one below.
    assert_eq!(svg.matches(">\na sample with the long n…\n</text>").count(), 3, "{svg}");
    assert_eq!(svg.matches(">\nfar\n</text>").count(), 1, "{svg}");
    // One after another there is room for some, a line of letters apart.
    let samples = report.error_over_samples(0).unwrap();
    let shown = samples.matches(">\na sample with the long n…\n</text>").count();
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
        for (index, sample) in report.details.iter_mut().enumerate() {
            let error = 1e-9 * (index as f64 - 1.0);
            sample.left_out = None;
            sample.applied.iter_mut().for_each(|load| *load *= size);
            sample.measured = sample.applied.iter().map(|load| load + error * size).collect();
        }
        let svg = report.error_over_load(0).unwrap();
        for anchor in ["middle", "end"] {
            let ticks: Vec<&str> = svg
                .split("<text")
                .skip(1)
                .filter(|text| text.contains(&format!("text-anchor=\"{anchor}\"")))
                .filter_map(|text| Some(text.split_once('>')?.1.split('<').next()?.trim()))
                .filter(|label| label.replace('−', "-").parse::<f64>().is_ok())
                .collect();
            let mut different = ticks.clone();
            different.sort_unstable();
            different.dedup();
            assert!(ticks.len() > 2 && different.len() == ticks.len(), "{size}: {ticks:?}");
            assert!(ticks.iter().all(|tick| tick.chars().count() <= 6), "{size}: {ticks:?}");
        }
        assert!(svg.contains("error / 10⁻⁹ % of full scale") || svg.contains("error / 10⁻⁶ %"), "{svg}");
    }
}

/// What an axis of a plot says: pixels of the two outermost of its ticks with their numbers give that of any value.
/// Ticks of the errors stand right of their numbers (`end`), those of the other axis above (`middle`).
fn scale(svg: &str, anchor: &str, along: &str) -> impl Fn(f64) -> f64 + use<> {
    let marks: Vec<(f64, f64)> = svg
        .split("<text")
        .skip(1)
        .filter(|text| text.contains(&format!("text-anchor=\"{anchor}\"")))
        .filter_map(|text| {
            let label = text.split_once('>')?.1.split('<').next()?;
            Some((label.trim().replace('−', "-").parse().ok()?, number(text, along)))
        })
        .collect();
    let (first, last) = (marks[0], marks[marks.len() - 1]);
    assert!(last.0 != first.0, "{marks:?}");
    move |value| first.1 + (value - first.0) * (last.1 - first.1) / (last.0 - first.0)
}

/// Points are where the axes of the plot say, which end a twentieth of the range beyond the outermost loads and a tenth
/// beyond the greatest error.
#[test]
fn points_are_where_the_axes_say() {
    let report = report();
    for (svg, places, ends) in [
        (report.error_over_load(0).unwrap(), [-4.0, 8.0, 2.0], [-4.6, 8.6]),
        (report.error_over_samples(0).unwrap(), [1.0, 2.0, 3.0], [0.9, 3.1]),
    ] {
        let (x, y) = (scale(&svg, "middle", "x"), scale(&svg, "end", "y"));
        let near = |pixel: f64, expected: f64| {
            assert!((pixel - expected).abs() <= 1.5, "{pixel} for {expected}: {svg}");
        };
        // % of 8 N: of the loads left out, and of the fit.
        let points = [(0, 5.0), (1, -2.5), (0, 2.5), (1, -5.0), (2, 0.0)];
        for ((across, down, _), (sample, error)) in circles(&svg).into_iter().zip(points) {
            near(across, x(places[sample]));
            near(down, y(error));
        }
        // The picture is 480 by 300 pixels: 8 of them are margin, 64 and 44 labels.
        near(72.0, x(ends[0]));
        near(471.0, x(ends[1]));
        near(8.0, y(5.5));
        near(247.0, y(-5.5));
        // The name of the outlier stands beside its point.
        let name = svg.split("<text").find(|text| text.contains(">\nb\n</text>")).unwrap();
        near(number(name, "y"), y(-5.0));
    }
}
