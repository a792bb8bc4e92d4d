//! Explore.
use fingertip_calibration::design::*;
use std::time::Instant;
fn tube() -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 10e-3, length: 40e-3,
        loads: NominalLoads { force: [10.0; 3], torque: [0.1; 3] } }
}
#[test]
fn explore() {
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let r = |x: f64| x.to_radians();
    for (name, space) in [
        ("paper", TubeSpace::bicchi_dario((2e-3, 15e-3), (r(1.0), r(59.0)), (2e-3, 40e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()),
        ("wide", TubeSpace::bicchi_dario((1e-3, 40e-3), (r(1.0), r(89.0)), (1e-3, 80e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()),
        ("strength", TubeSpace::bicchi_dario((3e-3, 15e-3), (r(1.0), r(59.0)), (2e-3, 40e-3), tube(), Wall::AtStrength{safety: 2.0}).unwrap()),
        ("1987", TubeSpace::bicchi_dario((1e-3, 40e-3), (r(1.0), r(59.0)), (1e-3, 80e-3), tube(), Wall::Fixed(0.2e-3)).unwrap().with_theory(TubeTheory::Reconstructed1987)),
        ("rosettes", TubeSpace::rosettes(3, (1e-3, 40e-3), (r(1.0), r(59.0)), (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()),
        ("rings", TubeSpace::rings(2, 4, false, (1e-3, 40e-3), (-30e-3, 30e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()),
        ("free", TubeSpace::free(6, (-20e-3, 20e-3), tube(), Wall::Fixed(0.2e-3)).unwrap()),
    ] {
        for seed in 1..3 { if name=="free" {continue;}
            let t = Instant::now();
            let found = search(&space, &Criterion::ConditionNumber, &loads, &Search { starts: 20, seed, ..Search::default() }, &|_| ()).unwrap();
            println!("{name} {:?} evals {} failed {}", t.elapsed(), found.evaluations, found.failed);
            for m in found.minima.iter().take(6) {
                let v: Vec<String> = m.values.iter().zip(space.parameters()).map(|(v, p)| format!("{}={:.3}{}", p.name, p.display(*v), p.display_unit())).collect();
                println!("   {:?}\n   {:.6} share {:.2} {}", m.equivalents, m.criterion, m.share, v.join(" "));
            }
        }
    }
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
}
