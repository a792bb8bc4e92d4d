//! Which of several crossings is the contact, or why none is: the rules written down once more.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A surface that is crossed where it is told, along the z axis, and missed by so much.
struct Told {
    crossings: Vec<Crossing<f64>>,
    gap: f64,
    leans: f64,
    active: bool,
}

impl Told {
    fn nearest(&self) -> ClosestApproach<f64> {
        let normal = facing(self.leans);
        ClosestApproach { gap: self.gap, point: Vector3::x() * self.gap, normal, active: self.active }
    }
}

impl ActiveSurface<f64> for Told {
    fn crossings(&self, _: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        self.crossings.iter().copied().for_each(visit);
    }

    fn closest_approach(&self, _: &Line<f64>) -> Option<ClosestApproach<f64>> {
        Some(self.nearest())
    }

    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.crossings.iter().find(|c| c.point == *point).map_or_else(Vector3::z, |c| c.normal)
    }
}

/// A normal at this cosine of incidence of a force along −z.
fn facing(incidence: f64) -> Vector3<f64> {
    Vector3::new(((1.0 - incidence) * (1.0 + incidence)).sqrt(), 0.0, incidence)
}

/// What is documented, without a shortcut.
fn expected(told: &Told, friction: Option<f64>, gap: f64, last: Option<f64>) -> Resolution<f64> {
    let least = friction.map_or(0.0, |mu| 1.0 / (1.0 + mu * mu).sqrt());
    let (active, outside): (Vec<&Crossing<f64>>, Vec<&Crossing<f64>>) =
        told.crossings.iter().partition(|c| c.active);
    let mut held: Vec<_> = active.iter().filter(|c| c.normal.z > 0.0 && c.normal.z >= least).collect();
    held.sort_by(|a, b| match last {
        Some(z) => (a.point.z - z).abs().total_cmp(&(b.point.z - z).abs()),
        None => b.normal.z.total_cmp(&a.normal.z),
    });
    let force = Vector3::z() * -2.0;
    let contact = |point, normal| Contact {
        point,
        normal,
        force,
        spin_torque: 0.0,
        gap: 0.0,
        alternatives: 0,
        searched: false,
    };
    if let Some(best) = held.first() {
        let alternatives = u8::try_from(held.len() - 1).unwrap();
        return Resolution::Contact(Contact { alternatives, ..contact(best.point, best.normal) });
    }
    let tangent = active.iter().rfind(|c| c.normal.z <= 0.0 && c.normal.z > -1e-14);
    if let (Some(tangent), None) = (tangent, friction) {
        return Resolution::Contact(contact(tangent.point, tangent.normal));
    }
    let pressing = active.iter().filter(|c| c.normal.z > 0.0);
    Resolution::NoContact(if let Some(flat) = pressing.max_by(|a, b| a.normal.z.total_cmp(&b.normal.z)) {
        let friction_ratio = flat.normal.x / flat.normal.z;
        NoContact::BeyondFriction { point: flat.point, friction_ratio }
    } else if let Some(pulls) = active.last() {
        NoContact::OnlyPulling { point: pulls.point }
    } else if let Some(beyond) = outside.last() {
        NoContact::OutsideActiveRegion { point: beyond.point }
    } else {
        let ClosestApproach { gap: away, point, normal, active } = told.nearest();
        if away <= gap && active && told.leans.max(0.0) >= least {
            return Resolution::Contact(Contact { gap: away, ..contact(point, normal) });
        }
        NoContact::Misses { closest: Some(told.nearest()) }
    })
}

fn same(found: &Resolution<f64>, expected: &Resolution<f64>) -> bool {
    match (found, expected) {
        (
            Resolution::NoContact(NoContact::BeyondFriction { point: a, friction_ratio: one }),
            Resolution::NoContact(NoContact::BeyondFriction { point: b, friction_ratio: other }),
        ) => a == b && (one / other - 1.0).abs() < 1e-12,
        _ => found == expected,
    }
}

#[test]
fn the_rules_are_the_documented_ones() {
    let mut random = Pcg64Mcg::seed_from_u64(61);
    let mut kinds = [0; 7];
    // The third is the least cosine of a friction of 3/4.
    let incidences = [1.0, 0.9, 0.8, 0.5, 0.31, 0.0, -1e-15, -0.3, -1.0];
    let gaps = [0.0, 0.25, 0.5];
    for _ in 0..20_000 {
        let count = random.random_range(0..5);
        let mut heights: Vec<_> = (0..count).map(|_| random.random_range(-1.0..1.0)).collect();
        heights.dedup();
        let crossings = heights.iter().map(|height: &f64| Crossing {
            along: -height,
            point: Vector3::z() * *height,
            normal: facing(incidences[random.random_range(0..incidences.len())]),
            active: random.random_bool(0.7),
        });
        let crossings = crossings.collect();
        let gap = gaps[random.random_range(0..3)];
        let leans = [0.0, 1e-9, 0.8, -0.1][random.random_range(0..4)];
        let told = Told { crossings, gap, leans, active: random.random_bool(0.7) };
        let friction = [None, Some(0.75), Some(5.0), Some(0.0)][random.random_range(0..4)];
        let accepted = gaps[random.random_range(0..3)];
        let last = random.random_bool(0.5).then(|| random.random_range(-1.0..1.0));
        let mut model = PointContact::new(0.0).unwrap().with_greatest_gap(accepted).unwrap();
        if let Some(mu) = friction {
            model = model.with_greatest_friction(mu).unwrap();
        }
        let push = Wrench::from_force_at(&Vector3::zeros(), Vector3::z() * -2.0);
        let found = model.resolve_near(&push, &told, last.map(|z| Vector3::z() * z).as_ref());
        let wanted = expected(&told, friction, accepted, last);
        // Equally square presses are decided by their order, which nobody promises.
        let mut cosines: Vec<_> = told.crossings.iter().map(|c| c.normal.z).collect();
        cosines.sort_by(f64::total_cmp);
        if cosines.windows(2).any(|pair| pair[0] == pair[1]) {
            continue;
        }
        assert!(same(&found, &wanted), "{found:?}\n{wanted:?}\n{friction:?} {last:?}");
        let kind = match found {
            Resolution::Contact(Contact { gap: 0.0, .. }) => 0,
            Resolution::Contact(_) => 1,
            Resolution::NoContact(NoContact::BeyondFriction { .. }) => 2,
            Resolution::NoContact(NoContact::OnlyPulling { .. }) => 3,
            Resolution::NoContact(NoContact::OutsideActiveRegion { .. }) => 4,
            Resolution::NoContact(NoContact::Misses { .. }) => 5,
            Resolution::NoContact(_) => 6,
        };
        kinds[kind] += 1;
        let mut candidates = Vec::new();
        let all = model.candidates(&push, &told, |c| candidates.push(c));
        match model.resolve(&push, &told) {
            Resolution::Contact(best) => {
                assert!(all.is_ok() && candidates.len() == usize::from(best.alternatives) + 1);
                assert!(candidates.iter().any(|c| c.point == best.point && c.normal == best.normal));
            }
            Resolution::NoContact(reason) => {
                assert!(same(&Resolution::NoContact(all.unwrap_err()), &Resolution::NoContact(reason)));
                assert!(candidates.is_empty());
            }
        }
    }
    assert!(kinds[..6].iter().all(|count| *count > 30) && kinds[6] == 0, "{kinds:?}");
}

/// Shares of the force, by its angle to the normal.
#[test]
fn parts_of_a_contact_are_those_of_its_force() {
    let normal = Vector3::z();
    let of = |force: Vector3<f64>| Contact {
        point: Vector3::zeros(),
        normal,
        force,
        spin_torque: 0.5,
        gap: 0.0,
        alternatives: 0,
        searched: false,
    };
    for scale in [1e-300, 1.0, 1e300] {
        let pressed = of(Vector3::new(3.0, 0.0, -4.0) * scale);
        assert!((pressed.incidence() - 0.8).abs() < 1e-15);
        assert!((pressed.normal_force() / scale - 4.0).abs() < 1e-14);
        assert!((pressed.tangential_force() / scale - Vector3::new(3.0, 0.0, 0.0)).norm() < 1e-14);
        assert_eq!(pressed.contact_force().spin, 0.5);
        assert_eq!(of(Vector3::z() * scale).incidence(), 0.0);
        assert_eq!(of(Vector3::z() * -scale).incidence(), 1.0);
    }
    let bound = of(Vector3::new(3.0, 0.0, -4.0));
    let bound = Contact { point: Vector3::new(0.0, 0.02, 0.0), ..bound };
    // (|δm| + |c||δf|)/(|f| cos φ).
    let found = bound.first_order_bound(0.5, 0.01).unwrap();
    assert!((found - (0.01 + 0.02 * 0.5) / (5.0 * 0.8)).abs() < 1e-17);
    assert_eq!(of(Vector3::x()).first_order_bound(0.5, 0.01), None);
}
