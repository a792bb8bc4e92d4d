//! Debugging.
use fingertip_surfaces::*; use fingertip_wrench::Line; use nalgebra::Vector3;
#[test] fn dbg() {
 let s = Offset::new(Torus::new(1.0_f32,0.3).unwrap(),0.05).unwrap();
 let t = Torus::new(1.0_f32,0.35).unwrap();
 let line = Line{point: Vector3::new(-0.58416045, 1.9177524, 3.7155874), direction: Vector3::new(-0.4073436, 0.48073798, 0.7765064)};
 println!("norm {}", line.direction.norm());
 for k in 0..5 { let l = Line{point: line.at(k as f32*0.31), direction: line.direction};
 s.crossings(&l, |c| println!("offset {k} {:?} {} {}", c.point, c.normal.dot(&line.direction), c.along));
 t.crossings(&l, |c| println!("torus  {k} {:?} {} {}", c.point, c.normal.dot(&line.direction), c.along)); }
}
