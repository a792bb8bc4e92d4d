//! The line of action over the range of forces and torques.

use fingertip_wrench::{NoLineOfAction, Real, Wrench};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::big::{Big, big3, dot, line_of_action};
use super::levels::direction;
use super::matrix::Row;

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let mut random = Pcg64Mcg::seed_from_u64(32);
    let epsilon = T::EPSILON.to_f64();
    let far = if epsilon > 1e-10 { 1e30 } else { 1e290 };
    for (case, force, torque, turn) in [
        ("ordinary", 1.0, 1.0, 1.0),
        ("tiny", 1.0 / far, 1.0 / far, 1.0),
        ("huge", far, far, 1.0),
        ("lever arm 1e6 m", 1.0, 1e6, 1.0),
        ("lever arm 1e-6 m", 1.0, 1e-6, 1.0),
        ("torque along the force but for 1e-6", 1.0, 1.0, 1e-6),
        ("torque along the force", 1.0, 1.0, 0.0),
    ] {
        let mut row = Row::new::<T>("line of action", case);
        for _ in 0..trials * 4 {
            let along = direction(&mut random);
            let f = along * force;
            let m = (along + direction(&mut random) * turn) * torque;
            let wrench: Wrench<T> = Wrench::on_fingertip(f.map(T::literal), m.map(T::literal));
            let (f, m) = (wrench.force().map(Real::to_f64), wrench.torque().map(Real::to_f64));
            let Ok(found) = wrench.line_of_action() else {
                row.expect(false, || format!("{wrench:?}"));
                continue;
            };
            let (foot, axis) = line_of_action(f.into(), m.into());
            let difference = |found: &Vector3<T>, exact: &[Big; 3]| {
                let found = big3(found.map(Real::to_f64).into());
                (0..3).map(|k| (&found[k] - &exact[k]).to_f64().powi(2)).sum::<f64>().sqrt()
            };
            let (force, torque) = (big3(f.into()), big3(m.into()));
            let squared = dot(&force, &force);
            let pitch = &dot(&force, &torque) / &squared;
            let arm = (&dot(&torque, &torque) / &squared).sqrt().to_f64();
            let note = || format!("{wrench:?}");
            row.error(difference(&found.line.point, &foot), 8.0 * epsilon * arm, note);
            row.error(difference(&found.line.direction, &axis), 8.0 * epsilon, note);
            let off = (&Big::new(found.pitch.to_f64()) - &pitch).to_f64();
            row.error(off, 8.0 * epsilon * arm, note);
            let size = squared.sqrt().to_f64();
            row.error(found.force.to_f64() - size, 8.0 * epsilon * size, note);
        }
        rows.push(row);
    }
    let mut row = Row::new::<T>("line of action", "no force, NaN, infinities");
    let (o, x) = (Vector3::<T>::zeros(), Vector3::<T>::x());
    let answer = |f, m| Wrench::<T>::on_fingertip(f, m).line_of_action();
    row.expect(answer(o, o) == Err(NoLineOfAction::NoForce), || "no load".to_owned());
    row.expect(answer(o, x) == Err(NoLineOfAction::NoForce), || "a couple".to_owned());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..3 {
            let mut v = x;
            v[k] = T::literal(bad);
            row.expect(answer(v, x) == Err(NoLineOfAction::NotFinite), || format!("force {bad}"));
            row.expect(answer(x, v) == Err(NoLineOfAction::NotFinite), || format!("torque {bad}"));
        }
    }
    rows.push(row);
}
