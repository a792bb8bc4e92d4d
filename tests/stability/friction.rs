//! Friction limits against 220 bits, and dynamic friction against its invariants.

use fingertip_friction::{
    Bristle, BristleLaw, Coulomb, Dahl, Drive, ElastoPlastic, Exponential, FrictionModel, Implicit,
    Integrator, LuGre, PowerLimit, ReturnMap, SoftFingerLimit, Stribeck, StribeckFriction,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::{SVector, Vector1, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::big::{Big, big3, dot};
use super::matrix::Row;

/// Margin and least normal force of a cone over a load that `load` gives in 220 bits.
fn limit<T: Real, M: FrictionModel<T>>(
    name: &str,
    model: &M,
    mu: f64,
    load: impl Fn(&ContactForce<T>) -> Big,
    trials: usize,
    rows: &mut Vec<Row>,
) {
    let epsilon = T::EPSILON.to_f64();
    let far = if epsilon > 1e-10 { 1e15 } else { 1e150 };
    for (case, normal, tangential) in [
        ("ordinary", 1.0, 0.4),
        ("at the limit", 1.0, mu),
        ("normal force to 0", 1.0 / far, 1.0),
        ("no load", 1.0, 0.0),
        ("tiny", 1.0 / far, 0.4 / far),
        ("huge", far, 0.4 * far),
        ("pulling", -1.0, 0.4),
    ] {
        let mut row = Row::new::<T>(name, case);
        let mut random = Pcg64Mcg::seed_from_u64(36);
        for _ in 0..trials * 4 {
            let angle: f64 = random.random_range(0.0..core::f64::consts::TAU);
            let force = ContactForce::new(
                T::literal(normal * random.random_range(0.999..1.001)),
                Vector3::new(angle.cos(), angle.sin(), 0.0).map(|x| T::literal(x * tangential)),
                T::literal(tangential * 1e-3 * random.random_range(-1.0..1.0)),
            );
            let load = load(&force);
            let new = Big::new;
            let (mu, pressing) = (new(mu), new(force.normal.to_f64()));
            let holding = &mu * &pressing;
            let one = new(1.0);
            let apex = (&(&mu * &load) + &pressing).to_f64() <= 0.0;
            let exact = if apex {
                -(&(&load * &load) + &(&pressing * &pressing)).sqrt()
            } else {
                &(&holding - &load) / &(&one + &(&mu * &mu)).sqrt()
            };
            let margin = model.slip_margin(&force);
            let size = load.to_f64().abs() + pressing.to_f64().abs();
            let note = || format!("{force:?}: {margin:?}");
            let off = (&new(margin.newtons.to_f64()) - &exact).to_f64();
            row.error(off, 16.0 * epsilon * size, note);
            row.expect(!margin.utilisation.to_f64().is_nan(), note);
            let least = model.least_normal_force(&force, T::one());
            let wanted = (&load / &mu).to_f64();
            row.error(least.to_f64() - wanted, 16.0 * epsilon * wanted + f64::MIN_POSITIVE, note);
        }
        rows.push(row);
    }
    let mut row = Row::new::<T>(name, "no force, NaN, infinities");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..3 {
            let mut force = ContactForce::new(T::one(), Vector3::zeros(), T::zero());
            match place {
                0 => force.normal = T::literal(bad),
                1 => force.tangential = Vector3::new(T::literal(bad), T::zero(), T::zero()).into(),
                _ => force.spin = T::literal(bad),
            }
            let margin = model.slip_margin(&force);
            // A limit without spin may leave the spin torque alone.
            let typed = margin.newtons <= -T::GREATEST || place == 2;
            row.expect(typed && margin.newtons.is_number(), || format!("{bad}: {margin:?}"));
        }
    }
    let margin = model.slip_margin(&ContactForce::zero());
    row.expect(margin.newtons.to_f64() == 0.0 && !margin.utilisation.to_f64().is_nan(), || {
        format!("{margin:?}")
    });
    rows.push(row);
}

fn tangential<T: Real>(force: &ContactForce<T>) -> Big {
    let t = big3(force.tangential.map(Real::to_f64).into());
    dot(&t, &t).sqrt()
}

/// `1 − e^{−x}` in 220 bits, by the series of a small part and repeated squaring.
fn fall(x: &Big) -> Big {
    if x.to_f64() > 120.0 {
        return Big::new(1.0);
    }
    let small = &-x.clone() * &Big::new(2.0_f64.powi(-10));
    let (mut sum, mut term) = (Big::new(0.0), Big::new(1.0));
    for k in 1..40_u32 {
        term = &(&term * &small) / &Big::new(f64::from(k));
        sum = &sum + &term;
    }
    // e^{2a} − 1 = (e^a − 1)(e^a + 1).
    for _ in 0..10 {
        sum = &sum * &(&sum + &Big::new(2.0));
    }
    -sum
}

/// What is above zero of a number; a NaN stays one.
fn excess(x: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { x }
}

/// `|z| ≤ F_s/σ₀`, no energy from nothing, and no NaN, for any motion.
fn invariants<T: Real, L: BristleLaw<T> + Copy, M: Integrator, const D: usize>(
    row: &mut Row,
    law: L,
    (speed, step): (f64, f64),
    random: &mut Pcg64Mcg,
) {
    let mut bristle = Bristle::<T, L, D, M>::with_method(law);
    let (epsilon, bound) = (T::EPSILON.to_f64(), (law.greatest() / law.stiffness()).to_f64());
    for index in 0..20 {
        let v = SVector::<T, D>::from_fn(|_, _| T::literal(speed * random.random_range(-1.0..1.0)));
        let before = bristle.energy().to_f64();
        let force = bristle.step(&v, T::literal(step)).mean;
        let after = bristle.energy().to_f64();
        let note = || format!("step {index}: {v:?} {force:?} {:?}", bristle.deflection());
        let length = bristle.deflection().norm().to_f64();
        row.error(excess(length / bound - 1.0), 16.0 * epsilon, note);
        let work = (0..D).map(|k| force[k].to_f64() * v[k].to_f64()).sum::<f64>() * step;
        let elastic = law.stiffness().to_f64() * length;
        let size = before + after + (force.norm().to_f64() + elastic) * v.norm().to_f64() * step;
        let gained = excess(after - before - work);
        row.error(gained, 64.0 * epsilon * size + f64::MIN_POSITIVE, note);
    }
}

fn body<T: Real, L: BristleLaw<T> + Copy>(
    row: &mut Row,
    law: L,
    (speed, step, mass): (f64, f64, f64),
    random: &mut Pcg64Mcg,
) {
    let mut bristle = Bristle::<T, L, 1>::new(law);
    let l = T::literal;
    let mut v = Vector1::new(l(speed));
    for _ in 0..20 {
        let force = l(2.0 * law.greatest().to_f64() * random.random_range(-1.0..1.0));
        let drive = Drive { mass: Vector1::new(l(mass)), force: Vector1::new(force), stiffness: T::zero() };
        let energy =
            |v: &Vector1<T>, b: &Bristle<T, L, 1>| 0.5 * mass * v[0].to_f64().powi(2) + b.energy().to_f64();
        let before = energy(&v, &bristle);
        let end = bristle.step_body(&v, &drive, l(step)).velocity;
        let after = energy(&end, &bristle);
        let work = force.to_f64() * end[0].to_f64() * step;
        let size = before + after + work.abs();
        let gained = excess(after - before - work);
        let bound = 256.0 * T::EPSILON.to_f64() * size + f64::MIN_POSITIVE;
        row.error(gained, bound, || format!("{v:?} to {end:?}, force {force:?}"));
        v = end;
    }
}

fn dynamics<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let l = T::literal;
    for (case, stiffness, damping, stribeck, speed, step, mass) in [
        ("ordinary", 1e5, 316.0, 1e-3, 1e-2, 1e-4, 1.0),
        ("σ0 = 1e8, m = 1e-4, h = 1e-3, 10 m/s", 1e8, 316.0, 1e-3, 10.0, 1e-3, 1e-4),
        ("σ0 = 1e8, σ1 = 1e5, h = 1 s", 1e8, 1e5, 1e-3, 10.0, 1.0, 1e-4),
        ("Stribeck speed 1e-9 m/s", 1e5, 316.0, 1e-9, 1e-2, 1e-3, 1.0),
        ("step 1e-12 s", 1e5, 316.0, 1e-3, 1.0, 1e-12, 1.0),
        ("speed 1e-12 m/s", 1e5, 316.0, 1e-3, 1e-12, 1e-3, 1.0),
        ("speed 1e6 m/s", 1e5, 316.0, 1e-3, 1e6, 1e-3, 1.0),
    ] {
        let curve = Stribeck::new(l(1.0), l(1.5), l(stribeck)).expect("a curve");
        let lugre = LuGre::new(l(stiffness), l(damping), l(0.4), curve).expect("a law");
        let mut random = Pcg64Mcg::seed_from_u64(37);
        let motion = (speed, step);
        macro_rules! run {
            ($name:literal, $law:expr, $method:ty) => {
                let law = $law.expect("a law");
                let mut row = Row::new::<T>($name, case);
                for _ in 0..trials {
                    invariants::<T, _, $method, 1>(&mut row, law, motion, &mut random);
                    invariants::<T, _, $method, 3>(&mut row, law, motion, &mut random);
                }
                rows.push(row);
            };
        }
        let known = Ok::<_, fingertip_friction::BadParameter>(lugre);
        run!("LuGre, exponential", known, Exponential);
        run!("LuGre, implicit", known, Implicit);
        run!("LuGre, return map", known, ReturnMap);
        run!("elasto-plastic, exponential", ElastoPlastic::new(lugre, l(0.6)), Exponential);
        run!("Dahl, exponential", Dahl::new(l(stiffness), l(1.0)), Exponential);
        run!("Stribeck, return map", StribeckFriction::new(l(stiffness), l(0.4), curve), ReturnMap);
        let mut row = Row::new::<T>("LuGre, passive step of a mass", case);
        for _ in 0..trials {
            body::<T, _>(&mut row, lugre, (speed, step, mass), &mut random);
        }
        rows.push(row);
        // At constant velocity the exponential step is exact.
        let mut row = Row::new::<T>("LuGre, exponential, against the exact solution", case);
        for _ in 0..trials {
            let v = l(speed * random.random_range(0.1..1.0));
            let mut bristle = Bristle::<T, _, 1>::new(lugre);
            bristle.step(&Vector1::new(v), l(step));
            let new = Big::new;
            let limit = &new(lugre.steady(v).to_f64()) / &new(l(stiffness).to_f64());
            let way = &new(v.to_f64()) * &new(l(step).to_f64());
            let exact = &limit * &fall(&(&way / &limit));
            let off = (&new(bristle.deflection()[0].to_f64()) - &exact).to_f64();
            let bound = 8.0 * T::EPSILON.to_f64() * exact.to_f64();
            row.error(off, bound, || format!("v {v:?}: {:?} for {}", bristle.deflection(), exact.to_f64()));
        }
        rows.push(row);
    }
    let mut row = Row::new::<T>("LuGre, exponential", "no force, NaN, infinities");
    let law = LuGre::<T>::reference().expect("a law");
    let mut bristle = Bristle::<T, _, 1>::new(law);
    bristle.step(&Vector1::new(l(1e-3)), l(1e-3));
    let before = bristle;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let force = bristle.step(&Vector1::new(l(bad)), l(1e-3)).end;
        row.expect(force[0].is_number() && bristle == before, || format!("velocity {bad}"));
        let force = bristle.step(&Vector1::new(l(1e-3)), l(bad)).end;
        row.expect(force[0].is_number() && bristle == before, || format!("time {bad}"));
    }
    rows.push(row);
}

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let l = T::literal;
    for (mu, name) in [(0.5, "Coulomb cone, μ 0.5"), (1e-3, "Coulomb cone, μ 1e-3")] {
        let model = Coulomb::new(l(mu)).expect("a coefficient");
        limit::<T, _>(name, &model, l(mu).to_f64(), tangential, trials, rows);
    }
    let (mu, arm, exponent) = (l(0.5).to_f64(), l(1e-3).to_f64(), l(1.72).to_f64());
    let spin = |force: &ContactForce<T>| &Big::new(force.spin.to_f64()).abs() / &Big::new(arm);
    let model = SoftFingerLimit::new(l(mu), l(arm)).expect("a limit");
    let load = |force: &ContactForce<T>| {
        let (t, s) = (tangential(force), spin(force));
        (&(&t * &t) + &(&s * &s)).sqrt()
    };
    limit::<T, _>("soft-finger ellipse", &model, mu, load, trials, rows);
    let model = PowerLimit::new(l(mu), l(arm), l(exponent)).expect("a limit");
    let load = |force: &ContactForce<T>| {
        let q = Big::new(exponent);
        let sum = &tangential(force).powf(&q) + &spin(force).powf(&q);
        sum.powf(&(&Big::new(1.0) / &q))
    };
    limit::<T, _>("soft-finger power limit", &model, mu, load, trials, rows);
    dynamics::<T>(trials, rows);
}
