//! Drawings, line by line: where each stroke and word stands.

use core::f64::consts::{PI, TAU};

use fingertip_calibration::bench::{Foil, Unrolled, drawing, placements, template, wiring};
use fingertip_calibration::design::{Bridge, Excitation, Placement, TubeLayout};
use fingertip_calibration::page::{Counting, Placed, thinned};
use fingertip_calibration::sheet::{Sheet, pdf};
use fingertip_wrench::gauge_layout::{Gauge, ThinWalledBeam};

use super::{Draw, to_ten_digits, unchanged};

fn layout(radius: f64, gauges: Vec<Gauge<f64>>) -> TubeLayout {
    let beam = ThinWalledBeam { radius, thickness: 2e-4, youngs_modulus: 7e10, poisson_ratio: 0.33 };
    TubeLayout { beam, gauges, bridges: Vec::new() }
}

/// Stacked rosettes; gauges on many rings and in all directions; some beyond the origin; a thin and a thick tube.
fn layouts() -> [TubeLayout; 4] {
    let rosette = |k: u32| {
        let theta = f64::from(k / 2) * TAU / 3.0;
        Gauge { z: 0.0, theta, q: if k.is_multiple_of(2) { 0.3 } else { -0.3 } }
    };
    let helix =
        |k: u32| Gauge { z: 1.7e-3 * f64::from(k), theta: 0.9 * f64::from(k), q: 0.5 * f64::from(k) - PI };
    let beyond = |k: u32| Gauge { z: 4e-3 * f64::from(k) - 9e-3, theta: TAU - 0.4 * f64::from(k), q: 0.1 };
    let mut bridged = layout(10e-3, (0..7).map(helix).collect());
    bridged.bridges = vec![Bridge::full([0, 3], [1, 4]); 7];
    bridged.bridges[6] = Bridge::quarter(5);
    [
        layout(7e-3, (0..6).map(rosette).collect()),
        layout(22e-3, (0..11).map(helix).collect()),
        bridged,
        layout(60e-3, (0..6).map(beyond).collect()),
    ]
}

fn lines(sheets: &[Sheet]) -> Vec<String> {
    sheets.iter().flat_map(|sheet| [sheet.to_svg(), sheet.to_figure()]).collect()
}

#[test]
fn of_tubes() {
    let mut unchanged = unchanged("sheets");
    let care = Placement { angle: 0.008, position: 5e-5 };
    let excitation = Excitation { supply: 3.3, gauge_factor: 2.0, amplifier_gain: 100.0 };
    let foil = Foil { grid: [2e-3, 1e-3], carrier: [5e-3, 3e-3], resistance: 1000.0 };
    for (number, layout) in layouts().iter().enumerate() {
        let foil = if number % 2 == 0 { Foil::default() } else { foil };
        let unrolled = Unrolled::new(layout, 18e-3, &foil, [0.0, 1e-4][number % 2]).unwrap();
        let tip = [None, Some(13e-3), Some(26e-3), Some(5e-3)][number];
        let of = |name: &str| format!("{name} of tube {number}");
        let mut sheets = vec![drawing(&unrolled, tip), template(&unrolled, care)];
        unchanged
            .note(&of("unrolled"), [to_ten_digits(&(&unrolled, unrolled.stacked(), unrolled.overlapping()))]);
        unchanged.note(&of("drawing"), lines(&sheets[..1]));
        unchanged.note(&of("template"), lines(&sheets[1..]));
        unchanged.note(&of("placements"), lines(&placements(&unrolled, care)));
        unchanged.note(&of("wiring"), lines(&wiring(layout, &foil, &excitation)));
        sheets.extend(placements(&unrolled, care));
        sheets.extend(wiring(layout, &foil, &excitation));
        unchanged.note(&of("pages"), [pdf(&sheets)]);
    }
    unchanged.check();
}

#[test]
fn of_numbers_along_axes() {
    let mut unchanged = unchanged("axes");
    let ranges = [
        (0.0, 1.0),
        (-3.0, 4.0),
        (1e-7, 5e-7),
        (-2e9, 1e9),
        (5.0, 5.0),
        (1e6, 1e6 + 1.0),
        (-1e-300, 1e-300),
        (0.099, 0.1),
    ];
    let told = ranges.map(|(low, high)| {
        let counting = Counting::of(low, high);
        let labels = [low, 0.5 * (low + high), high].map(|value| {
            (counting.said(value), [0.1, 1.0, 0.01].map(|share| counting.label(value, share * (high - low))))
        });
        to_ten_digits(&(counting.title("force"), labels))
    });
    unchanged.note("numbers", told);
    let draw = &mut Draw::new(14);
    let spans: Vec<(f64, f64)> = (0..40).map(|k| (12.0 * f64::from(k), 10.0 + 8.0 * draw.signed())).collect();
    unchanged.note(
        "labels that are left",
        [1, 5, 15, 40].map(|count| [6.0, 11.0, 30.0].map(|size| thinned(&spans[..count], size))),
    );
    let mut placed = Placed::default();
    let places: Vec<bool> = (0..60)
        .map(|_| {
            let [x, y] = [50.0 * draw.signed(), 20.0 * draw.signed()];
            placed.take([x, x + 10.0, y, y + 3.0])
        })
        .collect();
    unchanged.note("labels that have room", [places]);
    unchanged.check();
}
