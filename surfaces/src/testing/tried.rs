//! A surface on trial, behind a pointer.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::{
    ActiveSurface, ClosestApproach, Crossing, Entry, ForceLine, LineInDouble, Shortcuts, is_closed_convex,
};

/// What the laws ask of a surface, so that they are compiled once for all of them rather than once for
/// each: compilation is most of what trying a surface costs.
trait Answers<T: Real> {
    fn crossings(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>));
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>>;
    fn normal(&self, point: &Vector3<T>) -> Vector3<T>;
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>>;
    fn surface_residual(&self, point: &Vector3<T>) -> T;
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble>;
    fn contains(&self, point: &Vector3<T>) -> bool;
}

impl<T: Real, S: ActiveSurface<T>> Answers<T> for S {
    fn crossings(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
        ActiveSurface::crossings(self, line, visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        ActiveSurface::closest_approach(self, line)
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        ActiveSurface::normal(self, point)
    }

    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.shortcuts().sole_entry(push)
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.shortcuts().surface_residual(point)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.shortcuts().entry_in_double(line, near)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        ActiveSurface::contains(self, point)
    }
}

/// Any surface.
#[derive(Clone, Copy)]
pub(super) struct Tried<'a, T: Real> {
    surface: &'a dyn Answers<T>,
    /// What [`Shortcuts::CLOSED_CONVEX`] promises.
    pub(super) closed_convex: bool,
}

impl<'a, T: Real> Tried<'a, T> {
    pub(super) fn new<S: ActiveSurface<T>>(surface: &'a S) -> Self {
        Self { surface, closed_convex: is_closed_convex(&surface.shortcuts()) }
    }
}

impl<T: Real> ActiveSurface<T> for Tried<'_, T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.surface.crossings(line, &mut visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.surface.closest_approach(line)
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.surface.normal(point)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.surface.contains(point)
    }

    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Tried<'_, T> {
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.surface.sole_entry(push)
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.surface.surface_residual(point)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.surface.entry_in_double(line, near)
    }
}
