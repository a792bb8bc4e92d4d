//! Plain matrices, as CSV and as NumPy saves them, and the calibrations that they become.
#![no_main]

use fingertip_calibration::file::{PlainMatrix, PlainUnits, SignalUnit, plain_csv, plain_npy};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use fingertip_calibration::units::{ForceUnit, TorqueUnit};
use libfuzzer_sys::fuzz_target;

fn check(plain: &DMatrix<f64>) {
    for matrix in [PlainMatrix::LoadPerSignal, PlainMatrix::SignalPerLoad] {
        let units = PlainUnits {
            matrix,
            signal: SignalUnit::Volt,
            force: ForceUnit::Newton,
            torque: TorqueUnit::NewtonMetre,
            nominal: [10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
            reaction: false,
        };
        let Ok(file) = units.calibration(plain) else { continue };
        assert!(file.validate().is_ok());
        assert!(plain.iter().all(|number| number.is_finite()));
        let gauges = file.gauges();
        let sizes = if matrix == PlainMatrix::LoadPerSignal { (6, gauges) } else { (gauges, 6) };
        assert_eq!(plain.shape(), sizes);
        let _ = file.load(DVector::from_element(gauges, 1.0).as_slice());
    }
}

fuzz_target!(|bytes: &[u8]| {
    if let Ok(text) = core::str::from_utf8(bytes)
        && let Ok(plain) = plain_csv(text)
    {
        assert!(plain.iter().all(|number| number.is_finite()));
        check(&plain);
    }
    if let Ok(plain) = plain_npy(bytes) {
        check(&plain);
    }
    // Numbers behind a header that is right: which one, the first byte says.
    let Some((choice, numbers)) = bytes.split_first() else { return };
    let kind = ["<f8", ">f8", "<f4", ">f4"][usize::from(choice % 4)];
    let order = if choice & 4 == 0 { "False" } else { "True" };
    let shape = if choice & 8 == 0 { "(6, 6)" } else { "(7, 6)" };
    let header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let length = (header.len() as u16).to_le_bytes();
    let file = [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), numbers].concat();
    if let Ok(plain) = plain_npy(&file) {
        check(&plain);
    }
});
