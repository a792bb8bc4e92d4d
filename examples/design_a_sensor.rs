//! From what a sensor shall measure to a layout of gauges, a simulated calibration and the accuracy
//! to expect. The same as a command, with a report: `fingertip design`.
//!
//! `cargo run --release --example design_a_sensor`

use core::error::Error;

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::surfaces::Sphere;
use fingertip::wrench::{DummyGaugeAccumulator, GaussianElimination};
use fingertip_calibration::design::{
    Assessment, ContactWeight, Criterion, DesignTouch, Excitation, LayoutFile, LoadedTube, Material,
    MatrixUsed, NominalLoads, Placement, Search, Trial, TubeSpace, Wall, search,
};
use fingertip_simulation::{
    Design, Options, SessionReport, SessionScore, SimulatedFingertip, standard_session,
};

fn main() -> Result<(), Box<dyn Error>> {
    // 1. What is wanted: 30 N and 0.3 N·m on a fingertip of 13 mm, on a tube of at most 7 mm mean radius
    //    that is clamped 20 mm behind the centre of the tip, turned from aluminium to 0.2 mm.
    let loads = NominalLoads::equal(30.0, 0.3)?;
    let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 7e-3, length: 20e-3, loads };
    let (tip_radius, wall) = (13e-3, 0.2e-3);
    let touches = DesignTouch::on_sphere(tip_radius, 90_f64.to_radians(), 0.5, 3.0)?;
    let weight = ContactWeight::over(touches.iter().copied())?.normalised(&loads.components());

    // 2. The family: three pairs of gauges at ±Q around one ring; and what to make small: the error of
    //    the contact point.
    let angles = (5_f64.to_radians(), 50_f64.to_radians());
    let space = TubeSpace::rosettes(3, (4e-3, 7e-3), angles, (0.0, 15e-3), tube, Wall::Fixed(wall))?;
    let criterion = Criterion::ContactError(weight);
    let found = search(&space, &criterion, &loads, &Search::default(), &|_| ())?;
    let best = found.best().ok_or("no design")?;
    let layout = space.layout(&best.values)?;
    println!(
        "Best of {} local minima, reached from {:.0} % of the starts:",
        found.minima.len(),
        best.share * 100.0
    );
    for (parameter, value) in ["R", "Q", "Z"].iter().zip(&best.values) {
        let shown = if *parameter == "Q" {
            format!("{:.2}°", value.to_degrees())
        } else {
            format!("{:.2} mm", value * 1e3)
        };
        println!("  {parameter} = {shown}");
    }

    // 3. Whether it holds, and how well it is conditioned.
    let tube = LoadedTube { radius: layout.beam.radius, ..tube };
    println!("It bears {:.1} times the loads.", tube.strength(wall)?.safety());
    let judged = Assessment::new(&layout.normalised(1.0, &loads)?, Some(&weight)).ok_or("not a sensor")?;
    println!("Condition number {:.2}.", judged.condition_number);

    // 4. The file that solvers and simulation load, with the sums and differences that decouple it.
    let excitation = Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 2000.0 };
    let text = LayoutFile::new(&layout, &tube, excitation)?.to_toml()?;
    let file = LayoutFile::from_toml(&text)?;
    if let Some(decoupling) = file.find_decoupling()? {
        println!("Combinations of the signals for Fx … Tz: {:?}", decoupling.rows);
    }

    // 5. Twenty specimens with gauges placed to 0.5° and 0.05 mm, with and without calibration.
    let sphere = Sphere::centred(tip_radius)?;
    for (name, matrix) in [
        ("as designed", MatrixUsed::AsDesigned),
        ("calibrated", MatrixUsed::Calibrated { loads: 100, load_error: 2e-3 }),
    ] {
        let trial = Trial {
            loads,
            placement: Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 },
            noise: 0.2e-6,
            resolution: 0.0,
            matrix,
            sensors: 20,
            seed: 1,
        };
        let accuracy = trial.run(&layout, &sphere, &touches)?;
        println!(
            "At 3 N, {name}: contact to {:.3} mm (rms), force to {:.2} %.",
            accuracy.position_rms * 1e3,
            accuracy.force_rms * 100.0
        );
    }

    // 6. The whole signal chain (bridges, converter, temperature, imperfect calibration), played on the
    //    paper's sensor and on the new one.
    let paper = Design::default();
    let designed = Design { beam: file.layout().beam, gauges: file.gauge_layout()?.gauges, ..paper };
    for (name, design) in [("paper", paper), ("this design", designed)] {
        for level in play(design)?.levels() {
            println!(
                "{name}: presses of {:.1} N found within {:.3} mm on average",
                level.force,
                level.mean_position_error * 1e3
            );
        }
    }
    Ok(())
}

/// The standard session through the pipeline.
fn play(design: Design) -> Result<SessionReport, Box<dyn Error>> {
    let mut simulated =
        SimulatedFingertip::new(&standard_session(), Options { design, ..Options::default() })?;
    let mut score = SessionScore::new(&simulated);
    let mut zero = DummyGaugeAccumulator::default();
    let first = loop {
        match simulated.next() {
            Some(sample) if sample.truth.phase == 0 => {
                zero.add(&sample.reading());
            }
            other => break other,
        }
    };
    let mut fingertip = Fingertip::builder()
        .zero(zero.finish()?)
        .solver(GaussianElimination::new(simulated.calibrated_matrix())?)
        .contact(simulated.sphere(), PointContact::new(0.05)?)
        .build();
    let step = simulated.options().sample_rate.recip();
    for sample in first.into_iter().chain(&mut simulated) {
        let touch = fingertip.sense(&sample.reading(), step);
        let point = touch.resolution.contact().map(|contact| contact.point);
        score.add(&sample, &touch.wrench, point.as_ref(), false);
    }
    Ok(score.report())
}
