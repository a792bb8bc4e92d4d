//! Scripts of the simulated fingertip, as `fingertip simulate --script` reads them.
#![no_main]

use fingertip_simulation::{Options, Script, SimulatedFingertip};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(script) = toml::from_str::<Script>(text) else { return };
    let again = toml::to_string(&script).ok().and_then(|text| toml::from_str::<Script>(&text).ok());
    assert_eq!(again.map(|script| script.segments.len()), Some(script.segments.len()));
    let Ok(fingertip) = SimulatedFingertip::new(&script, Options::default()) else { return };
    assert!(fingertip.duration().is_finite() && fingertip.duration() >= 0.0);
    for sample in fingertip.take(50) {
        assert!(sample.truth.wrench.is_finite() && sample.time.is_finite());
    }
});
