//! The page on which an ATI sensor tells its configuration.
#![no_main]

use fingertip_drivers::sensors::ati_rdt::Configuration;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|page: &str| {
    if let Ok(configuration) = Configuration::parse(page) {
        assert!(configuration.counts::<f64>().is_ok());
    }
});
