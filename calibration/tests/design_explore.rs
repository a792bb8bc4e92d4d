//! Explore.
use fingertip_calibration::design::*;
fn tube() -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 10e-3, length: 40e-3,
        loads: NominalLoads { force: [10.0; 3], torque: [0.1; 3] } }
}
#[test]
fn tol() {
    let loads = NominalLoads { force: [2f64.sqrt(),1.0,1.0], torque: [2f64.sqrt()*0.01,0.01,0.01] };
    let r = |x: f64| x.to_radians();
    let space = TubeSpace::rosettes(3, (1e-3, 40e-3), (r(1.0), r(59.0)), (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3)).unwrap();
    let layout = space.layout(&[10e-3, r(19.792_4), 0.0]).unwrap();
    let touches = Touch::on_sphere(13e-3, 1.0, 0.5, 1.0).unwrap();
    let touches = Touches::new(&touches).unwrap();
    for (a, p) in [(0.5, 0.05e-3), (2.0, 0.2e-3)] {
        println!("{:?}", tolerance(&layout, &loads, Placement { angle: r(a), position: p }, Some(&touches), 4000, 1).unwrap());
    }
    let tip = fingertip_surfaces::Sphere::centred(13e-3).unwrap();
    let loads = NominalLoads::equal(30.0, 0.3).unwrap();
    let tube = LoadedTube { radius: 5e-3, length: 20e-3, loads, ..tube() };
    let p = TubeSpace::bicchi_dario((1e-3, 40e-3), (r(1.0), r(59.0)), (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
    let ps = TubeSpace::bicchi_dario((1e-3, 40e-3), (r(1.0), r(59.0)), (2e-3, 40e-3), tube, Wall::AtStrength{safety:2.0}).unwrap();
    let ros = TubeSpace::rosettes(3, (1e-3, 40e-3), (r(1.0), r(59.0)), (-20e-3, 20e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
    let ross = TubeSpace::rosettes(3, (1e-3, 40e-3), (r(1.0), r(59.0)), (-20e-3, 20e-3), tube, Wall::AtStrength{safety:2.0}).unwrap();
    for (name, layout) in [("paper", p.layout(&[5e-3, r(14.0), 10e-3])), ("paperopt", p.layout(&[6.55e-3, r(14.45), 13.46e-3])), ("rosette5", ros.layout(&[5e-3, r(19.792), 0.0])), ("rosette10", ros.layout(&[10e-3, r(19.792), 0.0])),
       ("paper strength", ps.layout(&[5e-3, r(14.0), 10e-3])),("paper10", ps.layout(&[10e-3, r(14.0), 10e-3])), ("rosette5s", ross.layout(&[5e-3, r(19.792), 0.0])), ("rosette10s", ross.layout(&[10e-3, r(19.792), 0.0]))] {
        let layout = match layout { Ok(l) => l, Err(e) => { println!("{name} {e}"); continue; } };
        println!("{name} s={} nc={}", layout.beam.thickness, Assessment::new(&layout.normalised(1.0, &loads).unwrap(), None).unwrap().condition_number);
        for (a, p) in [(0.0, 0.0), (0.5, 0.05e-3), (2.0, 0.2e-3)] {
            for matrix in [MatrixUsed::AsDesigned, MatrixUsed::Calibrated { loads: 100, load_error: 0.005 }] {
                let trial = Trial { loads, placement: Placement { angle: r(a), position: p }, noise: 1e-6, resolution: 0.0, matrix, sensors: 50, seed: 1 };
                let touches = Touch::on_sphere(13e-3, 1.0, 0.5, 10.0).unwrap();
                let x = trial.run(&layout, &tip, &touches).unwrap();
                println!("  {a} {matrix:?} {:.4} mm 95 {:.4} force {:.4} missed {}", x.position_rms*1e3, x.position_95*1e3, x.force_rms, x.missed);
            }
        }
    }
}
