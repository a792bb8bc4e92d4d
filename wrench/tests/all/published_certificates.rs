//! Factory certificates of four six-axis sensors: from the derived volts back to the measured
//! wrench.

use crate::support::greatest;
use fingertip_test_support::recording_text;
use fingertip_wrench::{
    Conditioning, ErrorBound, GaussianElimination, Inverse, LeastSquares, Refined, SensorMatrix, Uncertainty,
    WrenchSolver,
};
use nalgebra::{Matrix6, Vector6};
use serde_json::Value;

fn numbers(value: &Value) -> Vector6<f64> {
    Vector6::from_iterator(
        value.as_array().expect("six numbers").iter().map(|x| x.as_f64().expect("a number")),
    )
}

#[test]
fn derived_volts_give_the_measured_wrench() {
    let (Some(certificates), Some(loads)) =
        (recording_text("ati_cert_loads/certificates.json"), recording_text("ati_cert_loads/loads.csv"))
    else {
        return;
    };
    let certificates: Value = serde_json::from_str(&certificates).expect("JSON");
    let mut lines = loads.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| names.iter().position(|n| *n == name).expect("a column");
    let (measured, volts) = (column("measured_fx"), column("v0_reconstructed"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let mut seen = 0;
    for (serial, certificate) in certificates.as_object().expect("by serial number") {
        let user_axes = certificate["cal_user"].as_array().expect("six rows");
        // Units as published: newtons, and newton metres or newton millimetres.
        let published =
            Matrix6::from_rows(&core::array::from_fn::<_, 6, _>(|i| numbers(&user_axes[i]).transpose()));
        let full_scale = numbers(&certificate["fs"]);
        let sensor = SensorMatrix::from_inverse(&published, full_scale).expect("regular");
        let conditioning = Conditioning::of(&sensor);
        assert!((1.5..6.0).contains(&conditioning.condition_number()), "{serial}");
        let gauss = GaussianElimination::new(&sensor).expect("regular");
        let refined = Refined::new(&sensor).expect("regular");
        let inverse = Inverse::new(&sensor).expect("regular");
        let least_squares = LeastSquares::new(&sensor).expect("regular");
        let solvers: [&dyn WrenchSolver<f64, 6>; 4] = [&gauss, &refined, &inverse, &least_squares];
        // Volts are printed with six decimals.
        let printed = Uncertainty::of_signals(Vector6::repeat(0.5e-6));
        let bound = ErrorBound::new(&sensor, &gauss, &printed).expect("bounded");
        // The inverse of the inverse is the published matrix.
        assert!(greatest(&(inverse.matrix() - published)) < 1e-14 * greatest(&published));
        for row in rows.iter().filter(|row| row[0] == serial) {
            let six =
                |first: usize| Vector6::from_fn(|i, _| row[first + i].parse::<f64>().expect("a number"));
            let (expected, signals) = (six(measured), six(volts));
            for solver in solvers {
                let found = solver.solve(&signals);
                let off = (found.components() - expected).abs();
                let allowed = bound.at(&signals, &found);
                // Measured wrenches are printed with five decimals.
                assert!((0..6).all(|i| off[i] <= allowed[i] + 0.51e-5), "{serial}: {off} {allowed}");
            }
            seen += 1;
        }
    }
    assert_eq!(seen, 102);
}
