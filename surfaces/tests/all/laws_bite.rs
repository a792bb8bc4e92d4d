//! The laws that surfaces are tried by notice every kind of fault, and name the law that is broken.

use core::ops::AddAssign;

use fingertip_surfaces::testing::{Law, SurfaceLaws, Violation};
use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::{Rotation3, Vector3};

const TINY: f64 = 1e-9;

pub(crate) fn ball() -> Sphere<f64> {
    Sphere::new(Vector3::new(0.3, -0.2, 0.1), 1.0).unwrap()
}

fn laws() -> SurfaceLaws<f64> {
    SurfaceLaws::around(ball().centre(), 1.0)
}

/// A sphere of which one answer is wrong.
#[derive(Clone, Copy)]
struct Faulty<C, A, N, E, I> {
    crossing: C,
    approach: A,
    normal: N,
    entry: E,
    inside: I,
}

type Crossed = Option<Crossing<f64>>;

fn right_crossing(_: &Line<f64>, crossing: Crossing<f64>) -> Crossed {
    Some(crossing)
}

fn right_approach(_: &Line<f64>, approach: ClosestApproach<f64>) -> ClosestApproach<f64> {
    approach
}

fn right_normal(normal: Vector3<f64>, _: &Vector3<f64>) -> Vector3<f64> {
    normal
}

fn no_entry(_: Entry<f64>) -> Option<Entry<f64>> {
    None
}

fn right_inside(inside: bool, _: &Vector3<f64>) -> bool {
    inside
}

impl<C, A, N, E, I> ActiveSurface<f64> for Faulty<C, A, N, E, I>
where
    C: Fn(&Line<f64>, Crossing<f64>) -> Crossed,
    A: Fn(&Line<f64>, ClosestApproach<f64>) -> ClosestApproach<f64>,
    N: Fn(Vector3<f64>, &Vector3<f64>) -> Vector3<f64>,
    E: Fn(Entry<f64>) -> Option<Entry<f64>>,
    I: Fn(bool, &Vector3<f64>) -> bool,
{
    fn crossings(&self, line: &Line<f64>, mut visit: impl FnMut(Crossing<f64>)) {
        ball().crossings(line, |crossing| {
            if let Some(crossing) = (self.crossing)(line, crossing) {
                visit(crossing);
            }
        });
    }

    fn closest_approach(&self, line: &Line<f64>) -> Option<ClosestApproach<f64>> {
        ball().closest_approach(line).map(|approach| (self.approach)(line, approach))
    }

    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        (self.normal)(ball().normal(point), point)
    }

    fn contains(&self, point: &Vector3<f64>) -> bool {
        (self.inside)(ball().contains(point), point)
    }

    fn shortcuts(&self) -> impl Shortcuts<f64> {
        self
    }
}

impl<C, A, N, E, I> Shortcuts<f64> for Faulty<C, A, N, E, I>
where
    E: Fn(Entry<f64>) -> Option<Entry<f64>>,
{
    fn sole_entry(&self, push: &ForceLine<f64>) -> Option<Entry<f64>> {
        ball().sole_entry(push).and_then(|entry| (self.entry)(entry))
    }
}

pub(crate) fn broken(surface: &impl ActiveSurface<f64>) -> Option<Law> {
    laws().check(surface).err().map(|Violation { law, .. }| law)
}

fn with_crossings(crossing: impl Fn(&Line<f64>, Crossing<f64>) -> Crossed) -> Option<Law> {
    broken(&Faulty {
        crossing,
        approach: right_approach,
        normal: right_normal,
        entry: no_entry,
        inside: right_inside,
    })
}

fn with_approach(approach: impl Fn(&Line<f64>, ClosestApproach<f64>) -> ClosestApproach<f64>) -> Option<Law> {
    broken(&Faulty {
        crossing: right_crossing,
        approach,
        normal: right_normal,
        entry: no_entry,
        inside: right_inside,
    })
}

fn with_normals(normal: impl Fn(Vector3<f64>, &Vector3<f64>) -> Vector3<f64>) -> Option<Law> {
    broken(&Faulty {
        crossing: right_crossing,
        approach: right_approach,
        normal,
        entry: no_entry,
        inside: right_inside,
    })
}

fn with_entries(entry: impl Fn(Entry<f64>) -> Option<Entry<f64>>) -> Option<Law> {
    broken(&Faulty {
        crossing: right_crossing,
        approach: right_approach,
        normal: right_normal,
        entry,
        inside: right_inside,
    })
}

/// Of crossing and surface alike.
fn with_all_normals(turned: impl Fn(Vector3<f64>) -> Vector3<f64> + Copy) -> Option<Law> {
    broken(&Faulty {
        crossing: move |_: &Line<f64>, c: Crossing<f64>| Some(Crossing { normal: turned(c.normal), ..c }),
        approach: move |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach {
            normal: turned(a.normal),
            ..a
        },
        normal: move |n: Vector3<f64>, _: &Vector3<f64>| turned(n),
        entry: no_entry,
        inside: right_inside,
    })
}

fn leaves(line: &Line<f64>, crossing: &Crossing<f64>) -> bool {
    crossing.normal.dot(&line.direction) > 0.0
}

#[test]
fn a_sphere_breaks_none() {
    assert_eq!(with_crossings(right_crossing), None);
    assert_eq!(with_entries(Some), None);
    assert_eq!(laws().check(&ball()), Ok(()));
}

#[test]
fn crossings_beside_line_or_surface() {
    let aside = |line: &Line<f64>, c: Crossing<f64>| {
        Some(Crossing { point: c.point + line.direction.cross(&c.normal) * TINY, ..c })
    };
    assert_eq!(with_crossings(aside), Some(Law::CrossingOnLine));
    let wrong_place = |_: &Line<f64>, c: Crossing<f64>| Some(Crossing { along: c.along + TINY, ..c });
    assert_eq!(with_crossings(wrong_place), Some(Law::CrossingOnLine));
    let early = |line: &Line<f64>, c: Crossing<f64>| {
        let by = if leaves(line, &c) { 0.0 } else { -TINY };
        Some(Crossing { along: c.along + by, point: c.point + line.direction * by, ..c })
    };
    assert_eq!(with_crossings(early), Some(Law::CrossingOnSurface));
}

#[test]
fn crossings_that_depend_on_how_one_looks() {
    // A ray in the place of a line.
    let forward = |_: &Line<f64>, c: Crossing<f64>| (c.along > -0.5).then_some(c);
    assert_eq!(with_crossings(forward), Some(Law::SameLineSamePoints));
    // Points that are less exact the farther the line's own point is away.
    let far = |line: &Line<f64>, c: Crossing<f64>| {
        let by = if c.along > 0.5 { TINY } else { 0.0 };
        // Square to the normal: still on the surface, but for the square of so little.
        let slide = (line.direction - c.normal * c.normal.dot(&line.direction)).normalize() * by;
        let along = c.along + slide.dot(&line.direction);
        Some(Crossing { along, point: line.at(along), ..c })
    };
    assert!(matches!(with_crossings(far), Some(Law::SameLineSamePoints | Law::CrossingOnSurface)));
}

#[test]
fn crossings_that_are_missing() {
    // Half of a sphere is not closed.
    let half = |_: &Line<f64>, c: Crossing<f64>| (c.normal.z > -0.1).then_some(c);
    assert_eq!(with_crossings(half), Some(Law::Alternation));
    // A dent that nobody told the inside of.
    let nowhere = Faulty {
        crossing: |line: &Line<f64>, c: Crossing<f64>| (line.direction.z.abs() < 0.9).then_some(c),
        approach: right_approach,
        normal: right_normal,
        entry: no_entry,
        inside: |_: bool, _: &Vector3<f64>| false,
    };
    assert!(broken(&nowhere).is_some());
    for grown in [0.9, 1.1] {
        let other = Sphere::new(ball().centre(), grown).unwrap();
        let surface = Faulty {
            crossing: right_crossing,
            approach: right_approach,
            normal: right_normal,
            entry: no_entry,
            inside: move |_: bool, point: &Vector3<f64>| other.contains(point),
        };
        assert_eq!(broken(&surface), Some(Law::AllCrossingsFound), "{grown}");
        // Of an open surface nobody asks for an inside.
        assert_eq!(laws().without_inside().check(&surface), Ok(()));
    }
}

#[test]
fn normals() {
    let long = |_: &Line<f64>, c: Crossing<f64>| Some(Crossing { normal: c.normal * (1.0 + TINY), ..c });
    assert_eq!(with_crossings(long), Some(Law::UnitNormal));
    assert_eq!(with_normals(|n, _| n * (1.0 + TINY)), Some(Law::UnitNormal));
    assert_eq!(with_normals(|n, _| n * (1.0 - TINY)), Some(Law::UnitNormal));
    let turn = Rotation3::from_euler_angles(1e-3, 2e-3, -1e-3);
    assert_eq!(with_normals(move |n, _| turn * n), Some(Law::NormalAgrees));
    assert_eq!(with_all_normals(move |n| turn * n), Some(Law::NormalIsGradient));
    assert_eq!(with_all_normals(|n| -n), Some(Law::Alternation));
    let of_approach =
        |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach { normal: turn * a.normal, ..a };
    assert_eq!(with_approach(of_approach), Some(Law::NormalAgrees));
    let long =
        |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach { normal: a.normal * (1.0 + TINY), ..a };
    assert_eq!(with_approach(long), Some(Law::UnitNormal));
}

#[test]
fn entries() {
    let off = |e: Entry<f64>| Some(Entry { point: e.point + e.normal.cross(&Vector3::x()) * TINY, ..e });
    assert_eq!(with_entries(off), Some(Law::SoleEntry));
    assert_eq!(with_entries(|e| Some(Entry { active: false, ..e })), Some(Law::SoleEntry));
    // An exit is no entry.
    let other = |e: Entry<f64>| Some(Entry { point: ball().centre() * 2.0 - e.point, ..e });
    assert_eq!(with_entries(other), Some(Law::SoleEntry));
    let parts = |normal: f64, tangential: f64| {
        with_entries(move |e| {
            let parts = e.parts.map(|parts| ForceParts {
                normal: parts.normal + normal,
                tangential: parts.tangential + tangential,
            });
            Some(Entry { parts, ..e })
        })
    };
    assert!(
        ball()
            .sole_entry(&ForceLine::along(&Line { point: ball().centre(), direction: Vector3::x() }))
            .is_some_and(|entry| entry.parts.is_some())
    );
    assert_eq!(parts(0.0, 0.0), None);
    for wrong in [1e-4, -1e-4] {
        assert_eq!(parts(wrong, 0.0), Some(Law::ForceParts));
        assert_eq!(parts(0.0, wrong), Some(Law::ForceParts));
    }
}

#[test]
fn closest_approaches() {
    let point = |line: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach {
        point: a.point + line.direction.cross(&a.normal) * 1e-9,
        ..a
    };
    // Square to line and normal: only the distance from the line tells, by the square of so little.
    assert_eq!(with_approach(point), None);
    let lifted =
        |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach { point: a.point + a.normal * 1e-9, ..a };
    assert_eq!(with_approach(lifted), Some(Law::ClosestOnSurface));
    let lifted = |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach {
        point: a.point + a.normal * 1e-9,
        gap: a.gap - 1e-9,
        ..a
    };
    assert_eq!(with_approach(lifted), Some(Law::ClosestOnSurface));
    for gap in [1e-9, -1e-9] {
        let wrong = move |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach { gap: a.gap + gap, ..a };
        assert_eq!(with_approach(wrong), Some(Law::ClosestOnSurface));
    }
    let negative = |line: &Line<f64>, a: ClosestApproach<f64>| {
        // On the line, with no gap, a distance of less than nothing.
        let foot = line.at((a.point - line.point).dot(&line.direction));
        ClosestApproach { point: foot, gap: -1e-14, ..a }
    };
    assert_eq!(with_approach(negative), Some(Law::ClosestOnSurface));
    let far_side = |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach {
        gap: a.gap + 2.0,
        point: a.point - a.normal * 2.0,
        normal: -a.normal,
        ..a
    };
    assert_eq!(with_approach(far_side), Some(Law::NothingIsCloser));
}

#[test]
fn what_is_not_a_number() {
    let nan = |x: f64| if x.abs() > 1e100 { f64::NAN } else { 0.0 };
    for k in 0..3 {
        let crossing = move |line: &Line<f64>, mut c: Crossing<f64>| {
            [&mut c.along, &mut c.point.y, &mut c.normal.z][k].add_assign(nan(line.point.x));
            Some(c)
        };
        // A line from so far away seldom meets the sphere: there is one that does.
        let _ = with_crossings(crossing);
        let approach = move |line: &Line<f64>, mut a: ClosestApproach<f64>| {
            [&mut a.gap, &mut a.point.y, &mut a.normal.z][k].add_assign(nan(line.point.x));
            a
        };
        assert_eq!(with_approach(approach), Some(Law::NoNan), "{k}");
    }
    assert_eq!(with_normals(move |n, p| n + Vector3::repeat(nan(p.x))), Some(Law::NoNan));
}

#[test]
fn scaling() {
    let centre = ball().centre();
    let right = |k: f64| Sphere::new(centre * k, k).ok();
    assert_eq!(laws().check_scaling(right), Ok(()));
    let law = |make: &dyn Fn(f64) -> Option<Sphere<f64>>| laws().check_scaling(make).err().map(|v| v.law);
    assert_eq!(law(&|k| Sphere::new(centre * k, k.powf(1.0 + 1e-9)).ok()), Some(Law::Scaling));
    assert_eq!(law(&|k| Sphere::new(centre * k.powf(1.0 + 1e-9), k).ok()), Some(Law::Scaling));
    // One that is missing: the lines miss it.
    assert_eq!(law(&|k| Sphere::new(centre * (k + 100.0 * (k - 1.0)), k).ok()), Some(Law::Scaling));
    // What a shape does not allow is not asked.
    assert_eq!(law(&|k| if k > 1.0 { None } else { right(k) }), None);
}

/// A surface that answers well but roughly passes where that much is allowed.
#[test]
fn tolerances_are_what_they_are_set_to() {
    let off = 1e-12;
    let rough = Faulty {
        crossing: move |line: &Line<f64>, c: Crossing<f64>| {
            let by = if leaves(line, &c) { 0.0 } else { -off };
            Some(Crossing { along: c.along + by, point: c.point + line.direction * by, ..c })
        },
        approach: |_: &Line<f64>, a: ClosestApproach<f64>| a,
        normal: right_normal,
        entry: no_entry,
        inside: right_inside,
    };
    assert!(laws().check(&rough).is_err());
    assert_eq!(laws().with_roundings(1e4).with_gap_roundings(1e5).check(&rough), Ok(()));
    let gap = Faulty {
        crossing: right_crossing,
        approach: move |_: &Line<f64>, a: ClosestApproach<f64>| ClosestApproach { gap: a.gap + off, ..a },
        normal: right_normal,
        entry: no_entry,
        inside: right_inside,
    };
    // 4096 roundings of a size of 1.37 are 1.2e-12.
    assert_eq!(laws().check(&gap), Ok(()));
    assert!(laws().with_gap_roundings(1024.0).check(&gap).is_err());
}
