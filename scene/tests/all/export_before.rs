//! What stands before the pipeline in exported modules: filters, and the weight of what the sensor carries.

use fingertip::Step;
use fingertip::wrench::{Motion, Wrench};
use fingertip_scene::Scene;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::export_beside::pushes_on;
use crate::exported;

/// A ball that hangs on its sensor with a mount, behind a filter.
pub(crate) const CARRIES: &str = "
version = 2
[input]
convention = \"on_fingertip\"
sample_rate_Hz = 1000.0
[payload]
mass_kg = 0.021
centre_of_mass_m = [0.001, -0.002, 0.015]
inertia_kg_m2 = [[4e-6, 1e-7, 0.0], [1e-7, 5e-6, 0.0], [0.0, 0.0, 2e-6]]
[filter]
kind = \"low_pass\"
cutoff_Hz = 120.0
[surface]
shape = \"sphere\"
radius_m = 0.013
";

/// Filters, and the weight of what the sensor carries, before the pipeline.
#[test]
fn what_stands_before_the_pipeline_gives_its_bits() {
    let mut seen = 0;
    macro_rules! filtered {
        ($module:ident, $name:literal) => {{
            let entry = fingertip_scene::registry::FILTERS.iter().find(|entry| entry.name == $name).unwrap();
            let mut pipeline = Scene::from_text(&crate::choices::scene_with(entry)).unwrap().pipeline();
            let mut filter = exported::choices::$module::Filter::default();
            let (mut tip, mut last) = (exported::choices::$module::tip().unwrap(), None);
            for (k, push) in pushes_on(pipeline.surface(), 300).enumerate() {
                if k == 150 {
                    filter.start_anew();
                    pipeline.start_anew();
                    last = None;
                }
                let push = if k == 77 {
                    Wrench::on_fingertip(Vector3::repeat(f64::NAN), push.torque())
                } else {
                    push
                };
                let felt = pipeline.sense(push, 1e-3);
                let touch = tip.sense_wrench(filter.follow(push), Step::of(1e-3).with_last(last));
                last = touch.point();
                assert_eq!(format!("{:?}", felt.touch.resolution), format!("{:?}", touch.resolution));
                seen += usize::from(last.is_some());
            }
        }};
    }
    filtered!(filter_low_pass, "low_pass");
    filtered!(filter_notch, "notch");
    assert!(seen > 100, "{seen}");
    let mut pipeline = Scene::from_text(CARRIES).unwrap().pipeline();
    let (mut tip, payload) = (exported::carries::tip().unwrap(), exported::carries::payload().unwrap());
    let mut filter = exported::carries::Filter::default();
    let mut random = Pcg64Mcg::seed_from_u64(41);
    let mut last = None;
    for push in pushes_on(pipeline.surface(), 200) {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
        let motion = Motion {
            gravity: vector(9.81),
            angular_velocity: vector(3.0),
            angular_acceleration: vector(20.0),
        };
        let measured = push + payload.load(&motion);
        let felt = pipeline.sense_moving(measured, &motion, 1e-3);
        let wrench = filter.follow(exported::carries::unloaded(&payload, measured, &motion));
        let touch = tip.sense_wrench(wrench, Step::of(1e-3).with_last(last));
        last = touch.point();
        assert_eq!((felt.touch.wrench, felt.touch.resolution), (touch.wrench, touch.resolution));
    }
}
