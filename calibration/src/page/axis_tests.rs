use rand::{RngExt, SeedableRng};

use super::{Axis, Tick, digits, step};

fn labels(axis: &Axis, most: usize) -> Vec<String> {
    axis.ticks(most).into_iter().map(|tick| tick.label).collect()
}

#[test]
fn ticks_are_round_and_few() {
    assert_eq!(labels(&Axis::linear("", 0.0, 30.0), 6), ["0", "5", "10", "15", "20", "25", "30"]);
    assert_eq!(labels(&Axis::linear("", -0.34, 0.31), 5), ["−0.2", "0.0", "0.2"]);
    assert_eq!(labels(&Axis::linear("", 1e-7, 3e-7), 2), ["100", "200", "300"]);
    assert_eq!(labels(&Axis::degrees("", -185.0, 185.0), 6), ["−180", "−90", "0", "90", "180"]);
    assert_eq!(labels(&Axis::degrees("", -5.0, 38.0), 6), ["0", "10", "20", "30"]);
    assert_eq!(labels(&Axis::degrees("", 0.0, 0.4), 4), ["0.0", "0.1", "0.2", "0.3", "0.4"]);
    assert_eq!(labels(&Axis::log("", 0.1, 30.0), 5), ["0.1", "1", "10"]);
    assert_eq!(labels(&Axis::log("", 1.0, 10.0), 5), ["1", "2", "5", "10"]);
    for (low, high) in [(0.0, 1e-12), (-1e9, 1e9), (5.0, 5.0), (f64::NAN, 1.0), (0.0, 1.07), (3.0, 3.1)] {
        let axis = Axis::linear("", low, high);
        let ticks = axis.ticks(5);
        assert!((1..=7).contains(&ticks.len()), "{low} to {high}: {ticks:?}");
        assert!(ticks.iter().all(|tick| (-0.01..=1.01).contains(&axis.place(tick.value))));
    }
}

#[test]
fn an_axis_tells_its_ends_in_six_digits() {
    for (value, said) in [
        (0.0, "0"),
        (-0.0, "0"),
        (1.0, "1.00000"),
        (-123.456_789, "-123.457"),
        (0.001_234_567_8, "0.00123457"),
        (99_999_960.0, "99999960"),
        (1e-15, "0.000000000000"),
    ] {
        assert_eq!(digits(value), said);
    }
}

#[test]
fn rounding_outward_keeps_the_range_inside() {
    for (low, high) in [(-3.2, 17.9), (0.0, 0.013), (-5e-6, -1e-6)] {
        let axis = Axis::rounded("", low, high);
        assert!(axis.low <= low && axis.high >= high);
        assert!(axis.high - axis.low < 2.0 * (high - low));
    }
}

/// What a reader makes of a label.
fn read(label: &str) -> f64 {
    label.replace('−', "-").parse().unwrap()
}

/// Ticks are all the multiples of one step that lie in the range, and their labels say their values.
fn check_even(axis: &Axis, ticks: &[Tick], step: f64) {
    let slack = 1e-6 * step;
    for (number, tick) in ticks.iter().enumerate() {
        assert!((tick.value / step - (tick.value / step).round()).abs() < 1e-6, "{tick:?} of {axis:?}");
        let said = axis.counting().said(tick.value);
        let close = 1e-6 * axis.counting().said(axis.low + step).abs().max(said.abs());
        assert!((read(&tick.label) - said).abs() <= close, "{tick:?} of {axis:?}");
        assert!(tick.label.chars().count() <= 6, "{tick:?} of {axis:?}");
        assert!((tick.value - ticks[0].value - number as f64 * step).abs() < slack, "{ticks:?}");
        assert!(tick.value >= axis.low - slack && tick.value <= axis.high + slack, "{tick:?} of {axis:?}");
    }
    let ends = (ticks[0].value - step, ticks[ticks.len() - 1].value + step);
    assert!(ends.0 < axis.low + slack && ends.1 > axis.high - slack, "ticks are missing: {axis:?} {ticks:?}");
}

#[test]
fn a_step_is_the_least_round_one_that_cuts_into_few_pieces() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    for _ in 0..2000 {
        let range = 10.0_f64.powf(random.random_range(-9.0..9.0));
        let most = random.random_range(1..9_usize);
        let round = (-12..12_i32).flat_map(|decade| [1.0, 2.0, 5.0].map(|lead| lead * 10.0_f64.powi(decade)));
        let expected = round.into_iter().find(|step| range / step <= most as f64 * 1.000_001).unwrap();
        let found = step(range, most);
        assert!((found / expected - 1.0).abs() < 1e-12, "{range} in {most}: {found} for {expected}");
    }
    // Exactly so many pieces are not too many; and none at all are one.
    assert_eq!((step(5.0, 5), step(30.0, 6), step(1.0, 0)), (1.0, 5.0, 1.0));
    for range in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(step(range, 5), 1.0);
    }
}

#[test]
fn linear_ticks_are_even_and_labelled_with_their_values() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(2);
    for _ in 0..2000 {
        let size = 10.0_f64.powf(random.random_range(-8.0..8.0));
        let low = size * random.random_range(-3.0..3.0);
        let axis = Axis::linear("", low, low + size * random.random_range(0.01..1.0));
        assert!((axis.place(axis.low), axis.place(axis.high)) == (0.0, 1.0));
        for most in [2, 3, 5, 7] {
            let ticks = axis.ticks(most);
            assert!(
                (1..=most + 1).contains(&ticks.len()) || ticks.is_empty() && most == 2,
                "{axis:?} {ticks:?}"
            );
            if !ticks.is_empty() {
                check_even(&axis, &ticks, step(axis.high - axis.low, most));
            }
        }
    }
}

#[test]
fn degrees_are_cut_at_parts_of_the_circle() {
    for (range, most, expected) in [
        (360.0, 6, 90.0),
        (270.0, 6, 45.0),
        (269.0, 6, 45.0),
        (180.0, 6, 30.0),
        (90.0, 6, 15.0),
        (60.0, 6, 10.0),
        (29.0, 6, 5.0),
        (12.0, 6, 2.0),
        (6.0, 6, 1.0),
        (5.9, 6, 1.0),
        // Finer than a degree as any other axis, and farther than parts of the circle reach.
        (2.9, 6, 0.5),
        (541.0, 6, 100.0),
    ] {
        let axis = Axis::degrees("", -0.3 * range, 0.7 * range);
        check_even(&axis, &axis.ticks(most), expected);
    }
}

#[test]
fn logarithmic_axes_have_all_their_round_numbers() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
    for _ in 0..1000 {
        let low = 10.0_f64.powf(random.random_range(-5.0..5.0));
        let high = low * 10.0_f64.powf(random.random_range(0.0..6.0));
        let axis = Axis::log("", low, high);
        // At least a decade, about the same middle.
        assert!(axis.high / axis.low > 9.999 && axis.low <= low && axis.high >= high, "{axis:?}");
        assert!((axis.low * axis.high / (low * high) - 1.0).abs() < 1e-9, "{axis:?}");
        let within = |leads: &[f64]| -> Vec<f64> {
            let all =
                (-8..=14_i32).flat_map(|decade| leads.iter().map(move |lead| lead * 10.0_f64.powi(decade)));
            all.filter(|value| *value >= axis.low * 0.999 && *value <= axis.high * 1.001).collect()
        };
        let most = random.random_range(3..8_usize);
        let fine = within(&[1.0, 2.0, 5.0]);
        let expected = if fine.len() <= most { fine } else { within(&[1.0]) };
        // Of more decades than have room every second or third.
        let every = expected.len().div_ceil(most + 2);
        let expected: Vec<f64> = expected.into_iter().step_by(every).collect();
        assert!(expected.len() <= most + 2);
        let ticks = axis.ticks(most);
        assert_eq!(ticks.iter().map(|tick| tick.value).collect::<Vec<_>>(), expected, "{axis:?}");
        for tick in ticks {
            assert!((read(&tick.label) / tick.value - 1.0).abs() < 1e-12, "{tick:?}");
        }
    }
    let axis = Axis::log("", 0.01, 100.0);
    let places = [0.01, 0.1, 1.0, 100.0, 0.0, -3.0, f64::INFINITY].map(|value| axis.place(value));
    // Three decades below the low end is as far down as it goes, here three quarters of the axis.
    for (found, expected) in places.into_iter().zip([0.0, 0.25, 0.5, 1.0, -0.75, -0.75, 2.0]) {
        assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
    }
    for (low, high) in [(0.0, 1.0), (-1.0, 1.0), (2.0, 1.0), (1.0, f64::INFINITY), (f64::NAN, 1.0)] {
        let axis = Axis::log("", low, high);
        assert!((axis.low - 0.1).abs() < 1e-12 && (axis.high - 1.0).abs() < 1e-12, "{axis:?}");
    }
}

#[test]
fn what_gives_no_range_has_one_all_the_same() {
    let ends = |axis: &Axis| (axis.low, axis.high);
    assert_eq!(ends(&Axis::linear("", 3.0, 7.0)), (3.0, 7.0));
    assert_eq!(ends(&Axis::linear("", 5.0, 5.0)), (2.5, 7.5));
    assert_eq!(ends(&Axis::linear("", -4.0, -4.0)), (-6.0, -2.0));
    assert_eq!(ends(&Axis::linear("", 0.0, 0.0)), (-1.0, 1.0));
    assert_eq!(ends(&Axis::linear("", 2.0, 1.0)), (1.0, 3.0));
    assert_eq!(ends(&Axis::linear("", 1.0, f64::INFINITY)), (0.0, 1.0));
    assert_eq!(ends(&Axis::rounded("", -3.2, 17.9)), (-5.0, 20.0));
    assert_eq!(ends(&Axis::rounded("", 0.0, 20.0)), (0.0, 20.0));
    let axis = Axis::linear("", 2.0, 4.0);
    assert_eq!([3.0, 5.0, -9.0, 99.0].map(|value| axis.place(value)), [0.5, 1.5, -1.0, 2.0]);
}

#[test]
fn labels_are_short_and_have_a_true_minus() {
    assert_eq!(labels(&Axis::linear("", -2e6, 2e6), 2), ["−2", "0", "2"]);
    assert_eq!(labels(&Axis::linear("", 0.0, 999_999.0), 2), ["0", "500000"]);
    assert_eq!(labels(&Axis::linear("", -0.001, 0.001), 2), ["−1", "0", "1"]);
    assert_eq!(labels(&Axis::linear("", -0.02, 0.02), 2), ["−0.02", "0.00", "0.02"]);
    assert_eq!(labels(&Axis::linear("", 0.0, 9e-5), 1), ["0"]);
    assert_eq!(
        labels(&Axis::log("", 1e-300, 1e300), 4),
        // Of 601 decades every 101st.
        ["1e−300", "1e−199", "1e−98", "1000", "1e104", "1e205"]
    );
}

/// Times since 1970 and other numbers far from zero are counted from one of them, which the name says.
#[test]
fn what_lies_far_from_zero_is_counted_from_nearby() {
    let axis = Axis::linear("time / s", 1_763_931_791.5, 1_763_931_799.0);
    assert_eq!(labels(&axis, 5), ["2", "4", "6", "8"]);
    assert_eq!(axis.title(), "time − 1763931790 / s");
    assert_eq!(axis.in_words(), "time − 1763931790 / s;1.50000;9.00000");
}
