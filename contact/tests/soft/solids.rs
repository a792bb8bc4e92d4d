//! Bodies with flat ends in arithmetic of 220 bits: their sides, and what there is beside them.

use fingertip_surfaces::{CappedCylinder, CylinderEnds, EllipticCylinder, Frustum, Knot, Revolution};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::big::{Big, Big3, cross, dot};
use crate::exact::{Exact, length, minus, number, plus, split, times, unit, wide};

/// One end of a solid: what is flat, and the edge around it.
struct End {
    origin: Big3,
    outward: Big3,
    /// The side's normal is along `ρ + lean·outward`.
    lean: Big,
}

fn zero() -> Big {
    Big::new(0.0)
}

fn at_least(a: &Big, b: &Big) -> bool {
    !(b - a).is_positive()
}

impl End {
    fn torque_about(&self, force: &Big3, torque: &Big3) -> Big3 {
        minus(torque, &cross(&self.origin, force))
    }

    /// The contact on the plane, from the origin: `m − τ n` with `τ = f·m/f·n` has no part along the force,
    /// and its axis meets the plane at `n × (m − τ n)/n·f`.
    fn on_plane(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let pressing = dot(force, &self.outward);
        if !(-pressing.clone()).is_positive() {
            return None;
        }
        let torque = self.torque_about(force, torque);
        let rest = minus(&torque, &times(&self.outward, &(&dot(force, &torque) / &pressing)));
        Some(cross(&self.outward, &rest).map(|x| &x / &pressing))
    }

    /// The contact on the edge of semi-axes `a`, `b` along two unit vectors, from the origin: where
    /// `m − c × f` is across the edge, and between the normals of end and side.
    fn on_edge(&self, force: &Big3, torque: &Big3, [e1, e2]: [&Big3; 2], [a, b]: [&Big; 2]) -> Option<Big3> {
        let torque = self.torque_about(force, torque);
        // c = a cos θ e1 + b sin θ e2, along the edge −a sin θ e1 + b cos θ e2, and their product is ab along
        // e1 × e2: x cos θ − y sin θ + z = 0.
        let (x, y) = (b * &dot(&torque, e2), a * &dot(&torque, e1));
        let z = &(a * b) * &dot(force, &cross(e1, e2));
        let squared = &(&x * &x) + &(&y * &y);
        let rest = &squared - &(&z * &z);
        if rest == zero() || !rest.is_positive() {
            return None;
        }
        let root = rest.sqrt();
        let pulls = dot(force, &torque).is_positive();
        [root.clone(), -root].into_iter().find_map(|root| {
            let cosine = &(&(&root * &y) - &(&z * &x)) / &squared;
            let sine = &(&(&root * &x) + &(&z * &y)) / &squared;
            let point = plus(&times(e1, &(a * &cosine)), &times(e2, &(b * &sine)));
            let left = minus(&torque, &cross(&point, force));
            let normal = if pulls { left.map(|x| -x) } else { left };
            let side = unit(&plus(&times(e1, &(b * &cosine)), &times(e2, &(a * &sine))));
            let (up, out) = (dot(&normal, &self.outward), dot(&normal, &side));
            let between = at_least(&out, &zero()) && at_least(&up, &(&self.lean * &out));
            between.then_some(point)
        })
    }

    /// The contact at a tip, where the end has no extent.
    fn at_tip(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let left = self.torque_about(force, torque);
        let normal = if dot(force, &left).is_positive() { left.map(|x| -x) } else { left };
        let up = dot(&normal, &self.outward);
        let out = length(&minus(&normal, &times(&self.outward, &up)));
        (at_least(&up, &(&self.lean * &out))).then(|| self.origin.clone())
    }

    fn on_round(&self, force: &Big3, torque: &Big3, radius: &Big) -> Option<Big3> {
        if *radius == zero() {
            return self.at_tip(force, torque);
        }
        if let Some(point) = self.on_plane(force, torque)
            && at_least(radius, &length(&point))
        {
            return Some(plus(&self.origin, &point));
        }
        // Any two directions across the axis.
        let aside = (0..3).map(|k| Vector3::<f64>::ith(k, 1.0)).min_by(|a, b| {
            let along = |v: &Vector3<f64>| dot(&wide(v), &self.outward).abs().to_f64();
            along(a).total_cmp(&along(b))
        });
        let e1 = unit(&cross(&self.outward, &wide(&aside?)));
        let e2 = cross(&self.outward, &e1);
        self.on_edge(force, torque, [&e1, &e2], [radius, radius]).map(|point| plus(&self.origin, &point))
    }
}

/// A solid around an axis, from the centre of its base.
struct Solid {
    base: Big3,
    axis: Big3,
    height: Big,
    /// Of the base and of the top.
    radii: [Big; 2],
}

impl Solid {
    fn of_frustum<T: Real>(frustum: &Frustum<T>) -> Self {
        Self {
            base: wide(&frustum.base_centre()),
            axis: unit(&wide(&frustum.axis())),
            height: number(frustum.height()),
            radii: [number(frustum.base_radius()), number(frustum.top_radius())],
        }
    }

    fn of_cylinder<T: Real>(cylinder: &CappedCylinder<T>) -> Self {
        let (axis, half) = (unit(&wide(&cylinder.axis())), number(cylinder.half_length()));
        let base = minus(&wide(&cylinder.centre()), &times(&axis, &half));
        Self {
            base,
            axis,
            height: &half + &half,
            radii: [number(cylinder.radius()), number(cylinder.radius())],
        }
    }

    /// The top and the bottom, and their radii.
    fn ends(&self) -> [(End, &Big); 2] {
        let [below, above] = &self.radii;
        let lean = &(below - above) / &self.height;
        let origin = plus(&self.base, &times(&self.axis, &self.height));
        let top = End { origin, outward: self.axis.clone(), lean: lean.clone() };
        let bottom = End { origin: self.base.clone(), outward: self.axis.clone().map(|x| -x), lean: -lean };
        [(top, above), (bottom, below)]
    }

    fn on_ends(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        self.ends().into_iter().find_map(|(end, radius)| end.on_round(force, torque, radius))
    }

    fn through_ends(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        self.ends().into_iter().find_map(|(end, radius)| {
            let point = end.on_plane(force, torque)?;
            at_least(radius, &length(&point)).then(|| [plus(&end.origin, &point), end.outward])
        })
    }
}

impl<T: Real> Exact for Frustum<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let (height, across, axis) = split(point, &self.base_centre(), &self.axis());
        let [below, above] = [number(self.base_radius()), number(self.top_radius())];
        let taper = &(&below - &above) / &number(self.height());
        let cosine = &Big::new(1.0) / &(&Big::new(1.0) + &(&taper * &taper)).sqrt();
        let slanted = plus(&unit(&across), &times(&axis, &taper));
        let excess = &(&length(&across) - &below) + &(&height * &taper);
        (&excess * &cosine, times(&slanted, &cosine))
    }

    fn holds(&self, point: &Big3) -> bool {
        let (height, _, _) = split(point, &self.base_centre(), &self.axis());
        at_least(&height, &zero()) && at_least(&number(self.height()), &height)
    }

    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        Solid::of_frustum(self).on_ends(force, torque)
    }

    fn through_end(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        Solid::of_frustum(self).through_ends(force, torque)
    }
}

impl<T: Real> Exact for CappedCylinder<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let (_, across, _) = split(point, &self.centre(), &self.axis());
        (&length(&across) - &number(self.radius()), unit(&across))
    }

    fn holds(&self, point: &Big3) -> bool {
        let (height, _, _) = split(point, &self.centre(), &self.axis());
        at_least(&number(self.half_length()), &height.abs())
    }

    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        Solid::of_cylinder(self).on_ends(force, torque)
    }

    fn through_end(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        Solid::of_cylinder(self).through_ends(force, torque)
    }
}

/// The flat ends, if there are any.
fn ends_of_elliptic<T: Real>(cylinder: &EllipticCylinder<T>) -> Option<[End; 2]> {
    let CylinderEnds::Capped(half) = cylinder.ends() else { return None };
    let up = wide(&Vector3::<f64>::ith(2, 1.0));
    let end = |outward: Big3| End { origin: times(&outward, &number(half)), outward, lean: zero() };
    Some([end(up.clone()), end(up.map(|x| -x))])
}

fn within_ellipse(point: &Big3, [a, b]: [&Big; 2]) -> bool {
    let (x, y) = (&point[0] / a, &point[1] / b);
    at_least(&Big::new(1.0), &(&(&x * &x) + &(&y * &y)))
}

impl<T: Real> Exact for EllipticCylinder<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let [a, b] = self.semi_axes().map(number);
        let (x, y) = (&point[0] / &a, &point[1] / &b);
        let gauge = (&(&x * &x) + &(&y * &y)).sqrt();
        let gradient = [&(&x / &a) / &gauge, &(&y / &b) / &gauge, Big::new(0.0)];
        (&(&gauge - &Big::new(1.0)) / &length(&gradient), unit(&gradient))
    }

    fn holds(&self, point: &Big3) -> bool {
        match self.ends() {
            CylinderEnds::Capped(half) => at_least(&number(half), &point[2].abs()),
            _ => true,
        }
    }

    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let [a, b] = self.semi_axes().map(number);
        let [e1, e2] = [0, 1].map(|k| wide(&Vector3::<f64>::ith(k, 1.0)));
        ends_of_elliptic(self).into_iter().flatten().find_map(|end| {
            let on_plane = end.on_plane(force, torque).filter(|point| within_ellipse(point, [&a, &b]));
            let found = on_plane.or_else(|| end.on_edge(force, torque, [&e1, &e2], [&a, &b]));
            found.map(|point| plus(&end.origin, &point))
        })
    }

    fn through_end(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        let [a, b] = self.semi_axes().map(number);
        ends_of_elliptic(self).into_iter().flatten().find_map(|end| {
            let point = end.on_plane(force, torque)?;
            within_ellipse(&point, [&a, &b]).then(|| [plus(&end.origin, &point), end.outward])
        })
    }
}

/// A profile of one radius: a tube around the third axis. Its flat ends touch nothing.
impl<T: Real> Exact for Revolution<T, [Knot<T>; 3]> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let [[_, radius], [_, same], _] = [0, 1, 2].map(|k| self.knots()[k].point());
        assert!(radius == same);
        let across = [point[0].clone(), point[1].clone(), zero()];
        (&length(&across) - &number(radius), unit(&across))
    }

    fn holds(&self, point: &Big3) -> bool {
        let [[low, _], _, [high, _]] = [0, 1, 2].map(|k| self.knots()[k].point());
        at_least(&point[2], &number(low)) && at_least(&number(high), &point[2])
    }
}
