//! A shape inside a wrapper answers as it does alone, and in the same way.

use fingertip_surfaces::testing::{Kept, Law, SurfaceLaws, Violation};
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;

fn laws<T: Real>() -> SurfaceLaws<T> {
    SurfaceLaws::around(Vector3::zeros(), T::literal(1.3)).with_lines(200)
}

fn v<T: Real>(x: f64, y: f64, z: f64) -> Vector3<T> {
    Vector3::new(x, y, z).map(T::literal)
}

/// Every wrapper that may be put around any shape.
fn check<T: Real, S: ActiveSurface<T>>(laws: SurfaceLaws<T>, shape: S) {
    laws.check_wrapper(&shape, &&shape, Kept::All).unwrap();
    let identity = RigidTransform::from_parts(nalgebra::Rotation3::identity(), Vector3::zeros());
    laws.check_wrapper(&shape, &Posed::new(&shape, identity), Kept::All).unwrap();
    let pose: RigidTransform<T> =
        RigidTransform::from_axis_angle(v(1.0, 2.0, -1.0), v(0.3, 0.0, 1.0)).unwrap();
    let there_and_back = Posed::new(Posed::new(&shape, pose), pose.inverse());
    laws.check_wrapper(&shape, &there_and_back, Kept::All).unwrap();
    let everywhere = Trimmed::new(&shape, |_: &Vector3<T>| true);
    laws.check_wrapper(&shape, &everywhere, Kept::Entry).unwrap();
    let far = Sphere::new(v(0.0, 0.0, 50.0), T::one()).unwrap();
    laws.check_wrapper(&shape, &Compound::new(&shape, far), Kept::Residual).unwrap();
    laws.check_wrapper(&shape, &Compound::new(far, &shape), Kept::Residual).unwrap();
}

/// And those of shapes that a file can name.
fn check_named<T: Real, S: ActiveSurface<T> + Into<DynSurface<T>> + Clone>(laws: SurfaceLaws<T>, shape: S) {
    check(laws, shape.clone());
    let any: DynSurface<T> = shape.clone().into();
    laws.check_wrapper(&shape, &any, Kept::Entry).unwrap();
    let far = Sphere::new(v(0.0, 0.0, 50.0), T::one()).unwrap();
    laws.check_wrapper(&shape, &DynSurface::union(vec![any.clone()]).unwrap(), Kept::Entry).unwrap();
    let farther = Sphere::new(v(0.0, 90.0, 0.0), T::one()).unwrap();
    for parts in [vec![any.clone(), far.into()], vec![far.into(), any.clone(), farther.into()]] {
        laws.check_wrapper(&shape, &DynSurface::union(parts).unwrap(), Kept::Residual).unwrap();
    }
}

/// A shape that does not tell where a line enters in double precision, as its offset, which is another surface, cannot.
struct InItsPrecision<S>(S);

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for InItsPrecision<S> {
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        self.0.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.0.closest_approach(line)
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.0.normal(point)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.0.contains(point)
    }

    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real, S: ActiveSurface<T>> Shortcuts<T> for InItsPrecision<S> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.0.shortcuts().surface_residual(point)
    }
}

fn check_offset<T: Real, S: SignedDistance<T> + Copy>(laws: SurfaceLaws<T>, shape: S) {
    let none = Offset::new(shape, T::zero()).unwrap();
    let laws = laws.with_roundings(T::literal(256.0));
    laws.check_wrapper(&InItsPrecision(shape), &none, Kept::Residual).unwrap();
}

/// Every shape, in every wrapper.
fn every_shape<T: Real>() {
    let l = T::literal;
    let laws = laws::<T>();
    let edged = laws.with_edges();
    let sphere = Sphere::new(v(0.1, -0.2, 0.1), l(0.9)).unwrap();
    check_named(laws, sphere);
    check_named(laws, SphericalCap::with_opening(sphere, v(1.0, 0.5, 0.0), l(0.54)).unwrap());
    check_named(laws, Plane::new(v(0.0, 0.0, 0.1), v(1.0, -2.0, 3.0)).unwrap());
    check_named(laws, Disk::new(v(0.0, 0.0, 0.1), v(1.0, -2.0, 3.0), l(1.0)).unwrap());
    check_named(laws, Rectangle::new(v(0.0, 0.0, 0.1), v(0.5, 0.0, 0.0), v(0.0, 0.3, 0.4)).unwrap());
    let ellipsoid = Ellipsoid::new(v(1.2, 0.8, 0.5)).unwrap();
    check_named(laws, ellipsoid);
    let cylinder = Cylinder::new(v(0.3, -0.2, 0.1), v(1.0, 2.0, 3.0), l(0.7)).unwrap();
    check_named(laws, cylinder.with_half_length(l(1.0)).unwrap());
    let axis = || v(1.0, 2.0, 3.0);
    let capped = CappedCylinder::new(v(0.1, -0.2, 0.1), axis(), l(0.7), l(0.8)).unwrap();
    check_named(edged, capped);
    check_named(edged, EllipticCylinder::new([l(1.0), l(0.4)], CylinderEnds::Capped(l(0.8))).unwrap());
    let capsule = Capsule::new(v(0.1, -0.2, 0.1), axis(), l(0.5), l(0.6)).unwrap();
    check_named(laws, capsule);
    check_named(edged, Cone::new(v(0.3, -0.2, -0.4), axis(), l(0.6)).unwrap().with_depth(l(1.0)).unwrap());
    let frustum = Frustum::new(v(0.1, -0.6, -0.5), axis(), l(0.8), l(0.4), l(1.5)).unwrap();
    check_named(edged, frustum);
    let torus = Torus::new(l(0.9), l(0.3)).unwrap();
    check_named(laws.with_roundings(l(128.0)), torus);
    let rounded = RoundedBox::new(v(1.0, 0.8, 0.4), l(0.2)).unwrap();
    check_named(laws, rounded);
    check_named(laws, Superquadric::new(v(1.0, 0.8, 0.5), [l(0.7), l(1.2)]).unwrap());
    check_named(laws, Paraboloid::new([l(1.0), l(0.6)]).unwrap().with_depth(l(1.0)).unwrap());

    check_offset(laws, sphere);
    check_offset(laws, ellipsoid);
    check_offset(edged, capped);
    check_offset(laws, capsule);
    check_offset(edged, frustum);
    check_offset(laws, torus);
    check_offset(laws, rounded);
}

#[test]
fn no_wrapper_changes_an_answer_or_the_way_to_it_f64() {
    every_shape::<f64>();
}

#[test]
fn no_wrapper_changes_an_answer_or_the_way_to_it_f32() {
    every_shape::<f32>();
}

/// A wrapper that forwards what it was written to forward.
struct Forwards<'a> {
    inner: &'a Sphere<f64>,
    closest: bool,
    normal: Vector3<f64>,
}

impl ActiveSurface<f64> for Forwards<'_> {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        self.inner.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<f64>) -> Option<ClosestApproach<f64>> {
        self.inner.closest_approach(line).filter(|_| self.closest)
    }

    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        (self.inner.normal(point) + self.normal).normalize()
    }
}

/// A wrapper that passes on some of the shortcuts.
struct PassesOn<'a, const ENTRY: bool, const RESIDUAL: bool, const PROMISE: bool>(&'a Sphere<f64>);

impl<const ENTRY: bool, const RESIDUAL: bool, const PROMISE: bool> ActiveSurface<f64>
    for PassesOn<'_, ENTRY, RESIDUAL, PROMISE>
{
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        self.0.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<f64>) -> Option<ClosestApproach<f64>> {
        self.0.closest_approach(line)
    }

    fn shortcuts(&self) -> impl Shortcuts<f64> {
        self
    }
}

impl<const ENTRY: bool, const RESIDUAL: bool, const PROMISE: bool> Shortcuts<f64>
    for PassesOn<'_, ENTRY, RESIDUAL, PROMISE>
{
    const CLOSED_CONVEX: bool = PROMISE;

    fn sole_entry(&self, push: &ForceLine<f64>) -> Option<Entry<f64>> {
        self.0.sole_entry(push).filter(|_| ENTRY)
    }

    fn surface_residual(&self, point: &Vector3<f64>) -> f64 {
        if RESIDUAL { self.0.surface_residual(point) } else { 0.0 }
    }
}

#[test]
fn the_law_fails_for_a_wrapper_that_forgets() {
    let sphere = Sphere::new(v(0.1, -0.2, 0.1), 0.9).unwrap();
    let broken = |wrapper: &dyn Fn(Kept) -> Result<(), Violation<f64>>| {
        [Kept::Answers, Kept::Residual, Kept::Entry, Kept::All]
            .map(|kept| wrapper(kept).err().map(|violation| violation.law))
    };
    macro_rules! laws_broken {
        ($wrapper:expr) => {{
            let wrapper = $wrapper;
            broken(&|kept| laws().check_wrapper(&sphere, &wrapper, kept))
        }};
    }
    let all = PassesOn::<true, true, true>(&sphere);
    assert_eq!(laws_broken!(all), [None; 4]);
    let no_promise = PassesOn::<true, true, false>(&sphere);
    assert_eq!(laws_broken!(no_promise), [None, None, None, Some(Law::WrapperKeepsPromise)]);
    let no_entry = PassesOn::<false, true, true>(&sphere);
    let lost = Some(Law::WrapperKeepsEntry);
    assert_eq!(laws_broken!(no_entry), [None, None, lost, lost]);
    let no_residual = PassesOn::<true, false, true>(&sphere);
    let lost = Some(Law::WrapperKeepsResidual);
    assert_eq!(laws_broken!(no_residual), [None, lost, lost, lost]);
    // What was written when there were no shortcuts, as the command's sphere was.
    let unaware = Forwards { inner: &sphere, closest: true, normal: Vector3::zeros() };
    let and_entry = Some(Law::WrapperKeepsEntry);
    assert_eq!(laws_broken!(unaware), [None, lost, and_entry, and_entry]);
    // Whatever it keeps beside: where it forgets that as well, either may be seen first.
    let changed = Some(Law::WrapperKeepsAnswers);
    let no_closest = Forwards { inner: &sphere, closest: false, normal: Vector3::zeros() };
    assert_eq!(laws_broken!(no_closest)[0], changed);
    let other_normal = Forwards { inner: &sphere, closest: true, normal: v(1e-3, 0.0, 0.0) };
    assert_eq!(laws_broken!(other_normal)[0], changed);
    let elsewhere = Sphere::new(v(0.1, -0.2, 0.1 + 1e-9), 0.9).unwrap();
    assert_eq!(laws_broken!(elsewhere), [changed; 4]);
    let half = Trimmed::new(&sphere, |p: &Vector3<f64>| p.z > 0.0);
    assert_eq!(laws_broken!(half)[0], changed);
}
