//! All soft-finger contacts on a smooth surface.

use fingertip_surfaces::{Crossing, SmoothSurface, Topology, rare_crossings};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use super::closed_form::is_pure_force;
use super::convex::direction_on_ball;
use super::newton::{Place, Problem, State};
use crate::{Search, SoftContact};

/// More solutions than that are not told apart.
const MOST: usize = 16;

/// A grid that meets a surface in fewer points than that has not seen all of it.
const FEWEST_STARTS: usize = 24;

/// The soft-finger contacts of a wrench on a smooth surface, by Newton's method: what a shape
/// without a closed form calls from
/// [`soft_contacts`](crate::SoftFingerSurface::soft_contacts).
///
/// * On a [convex](Topology::Convex) surface the one contact is found by damped Newton from where it
///   would be on a ball, or from where the line of action enters, or by following a path that provably
///   leads to it. Whichever ends in a contact that presses has found the only one.
/// * On any other surface Newton starts from a grid of points all over the surface, and solutions
///   that coincide are merged. On a [closed](Topology::Closed) surface the signs of
///   `τ²κ + (f·n)²` over all contacts that press add up to half the Euler characteristic χ if
///   `f·m ≠ 0`; if they do not, the search is repeated on a finer grid, and if they still do not,
///   the answer is [`Search::Incomplete`], as it is for a surface that slips through the grid. (Proof: the map `(c, τ) ↦ c × f + τ n` from the
///   surface times the real line has, up to the factor `−1/2`, the Jacobian determinant of
///   `docs/theory/contact.md#surfaces-that-are-not-convex`. It is proper, so its degree can be counted at
///   large torques, where the preimages have `n = ±m/|m|`: χ in all, half of them pressing. Contacts cannot
///   pass between pressing and pulling, since `f·n = 0` implies `f·m = 0`.) So a ring has an even number of
///   contacts, as many with either sign. Of a surface of [unknown](Topology::Unknown) topology no such count is
///   known, and the answer is [`Search::Uncertified`].
pub fn newton_soft_contacts<T: Real, S: SmoothSurface<T>>(
    surface: &S,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    search(surface, wrench, last, &mut visit)
}

/// Compiled once for every surface, whoever visits.
fn search<T: Real, S: SmoothSurface<T>>(
    surface: &S,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let problem = Problem::new(surface, &wrench.force(), &wrench.torque());
    match surface.topology() {
        Topology::Convex => {
            let found = starts_on_convex(&problem, surface, wrench, last);
            match found {
                Found::Contact(state) => visit(problem.contact(&state)),
                Found::Nothing => {}
                Found::Lost => return Search::Incomplete,
            }
            Search::Complete
        }
        topology => {
            let mut solutions = Solutions::new();
            if let Some(last) = last {
                solutions.start(&problem, problem.inward(last));
            }
            for place in line_entries(&problem, surface, wrench).into_iter().flatten() {
                solutions.start_at(&problem, place);
            }
            let (mut complete, mut starts, mut certain) = (true, 0_usize, true);
            for lines in [6_u8, 11] {
                scatter(&problem, surface, lines, |point| {
                    starts += 1;
                    solutions.start(&problem, point);
                });
                // A surface thinner than the grid has slipped through it.
                complete = starts >= FEWEST_STARTS;
                let Topology::Closed { euler_characteristic } = topology else {
                    certain = false;
                    break;
                };
                complete &= is_pure_force(&wrench.force(), &wrench.torque())
                    || !solutions.contradict(&problem, euler_characteristic);
                if complete {
                    break;
                }
            }
            for state in solutions.states.iter().flatten() {
                visit(problem.contact(state));
            }
            match (complete, certain) {
                (true, true) => Search::Complete,
                (true, false) => Search::Uncertified,
                (false, _) => Search::Incomplete,
            }
        }
    }
}

enum Found<T: Real> {
    Contact(State<T>),
    /// There is none.
    Nothing,
    /// There may be one.
    Lost,
}

fn starts_on_convex<T: Real, S: SmoothSurface<T>>(
    problem: &Problem<'_, T, S>,
    surface: &S,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
) -> Found<T> {
    // The last contact is usually a few steps away.
    if let Some(place) = last.and_then(|last| problem.place(problem.inward(last)))
        && let Some(spin) = problem.spin_at(&place)
        && let Some(state) = problem.newton(place, spin, &problem.torque, 12)
        && state.converged
        && problem.presses(&state)
    {
        return Found::Contact(state);
    }
    // Nothing but Newton, from where the contact would be on the ball around the surface: it needs no
    // point of the surface, and where it ends well, the answer is certain, since a convex surface has
    // only one contact. Not without a spin torque, when there may be none.
    if problem.power.abs() > T::EPSILON.root() * problem.force.norm_squared()
        && let Some(state) = problem.starting_on_ball()
    {
        return Found::Contact(state);
    }
    let presses = |crossing: &Crossing<T>, direction: &Vector3<T>| crossing.normal.dot(direction) < T::zero();
    let line = wrench.line_of_action().map(|axis| axis.line);
    let entry = line.ok().and_then(|line| met_at(problem, surface, &line, &presses));
    if entry.is_none() && is_pure_force(&wrench.force(), &wrench.torque()) {
        return Found::Nothing;
    }
    // Where the spin torque is small the wrench's line of action enters near the contact; where it
    // rules, the normal points along the torque, which the ball around the surface knows.
    let squared = problem.force.norm_squared();
    let entry_first = entry.is_some() && problem.power.abs() < squared;
    if entry_first && let Some(state) = entry.and_then(|place| problem.on_convex(place)) {
        return Found::Contact(state);
    }
    let direction = direction_on_ball(&problem.force, &problem.torque);
    let centre = surface.extent().centre;
    let outer = met_at(problem, surface, &Line { point: centre, direction }, &|crossing, _| {
        crossing.along > T::zero()
    });
    if let Some(state) = outer.and_then(|place| problem.on_convex(place)) {
        return Found::Contact(state);
    }
    // Any place where the force presses will do to begin the path: the one that it presses on
    // most squarely, through the centre.
    let mut facing = None;
    let length = squared.root();
    if length > T::zero() {
        let direction = problem.force / length;
        facing = met_at(problem, surface, &Line { point: centre, direction }, &presses);
    }
    match facing.or(entry).and_then(|place| problem.on_convex(place)) {
        Some(state) => Found::Contact(state),
        None => Found::Lost,
    }
}

/// Where a line meets a convex surface, of its two crossings the one that is asked for. Out of line, for it is asked three
/// times, and seldom.
#[inline(never)]
fn met_at<T: Real, S: SmoothSurface<T>>(
    problem: &Problem<'_, T, S>,
    surface: &S,
    line: &Line<T>,
    is_asked_for: &dyn Fn(&Crossing<T>, &Vector3<T>) -> bool,
) -> Option<Place<T>> {
    let mut found = None;
    rare_crossings(surface, line, &mut |crossing| {
        if found.is_none() && is_asked_for(&crossing, &line.direction) {
            found = Some(crossing.point);
        }
    });
    problem.place(problem.inward(&found?))
}

/// Where the wrench's line of action enters the surface: exact where there is no spin torque.
fn line_entries<T: Real, S: SmoothSurface<T>>(
    problem: &Problem<'_, T, S>,
    surface: &S,
    wrench: &Wrench<T>,
) -> [Option<Place<T>>; 4] {
    let mut entries = [None; 4];
    let mut free = entries.iter_mut();
    if let Ok(axis) = wrench.line_of_action() {
        surface.crossings(&axis.line, |crossing| {
            if crossing.normal.dot(&axis.line.direction) < T::zero()
                && let Some(entry) = free.next()
            {
                *entry = problem.place(problem.inward(&crossing.point));
            }
        });
    }
    entries
}

/// Points all over the surface: where it is met by lines through a square grid, along each of the
/// three axes.
fn scatter<T: Real, S: SmoothSurface<T>>(
    problem: &Problem<'_, T, S>,
    surface: &S,
    lines: u8,
    mut visit: impl FnMut(Vector3<T>),
) {
    let extent = surface.extent();
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let step = (extent.radius + extent.radius) / T::literal(f64::from(lines));
    // A little off the middle of each cell, since shapes like to be symmetric.
    let at = |index: u8| step * T::literal(f64::from(index) + 0.4831) - extent.radius;
    for turn in 0..3 {
        let direction = axes[turn];
        let (across, up) = (axes[(turn + 1) % 3], axes[(turn + 2) % 3]);
        for i in 0..lines {
            for j in 0..lines {
                let point = extent.centre + across * at(i) + up * at(j);
                surface
                    .crossings(&Line { point, direction }, |crossing| visit(problem.inward(&crossing.point)));
            }
        }
    }
}

struct Solutions<T: Real> {
    states: [Option<State<T>>; MOST],
}

impl<T: Real> Solutions<T> {
    fn new() -> Self {
        Self { states: [None; MOST] }
    }

    fn start<S: SmoothSurface<T>>(&mut self, problem: &Problem<'_, T, S>, point: Vector3<T>) {
        if let Some(place) = problem.place(point) {
            self.start_at(problem, place);
        }
    }

    fn start_at<S: SmoothSurface<T>>(&mut self, problem: &Problem<'_, T, S>, place: Place<T>) {
        let Some(spin) = problem.spin_at(&place) else { return };
        // Two guesses of the spin torque: one from the force, one from the torque.
        let direct = (problem.torque - place.point.cross(&problem.force)).dot(&place.normal);
        for guess in [spin, direct] {
            if let Some(state) = problem.newton(place, guess, &problem.torque, 24)
                && state.converged
                && problem.presses(&state)
            {
                self.keep(state);
            }
        }
    }

    fn keep(&mut self, state: State<T>) {
        let near = T::EPSILON.root() * T::literal(8.0);
        for slot in &mut self.states {
            match slot {
                Some(known) if (known.place.point - state.place.point).amax() <= near => return,
                Some(_) => {}
                None => {
                    *slot = Some(state);
                    return;
                }
            }
        }
    }

    /// `true` if solutions must be missing, under a wrench that is no pure force.
    fn contradict<S: SmoothSurface<T>>(&self, problem: &Problem<'_, T, S>, euler_characteristic: i8) -> bool {
        let index: i8 = self
            .states
            .iter()
            .flatten()
            .map(|state| if problem.determinant(state) > T::zero() { 1 } else { -1 })
            .sum();
        index + index != euler_characteristic
    }
}
