//! Shapes to 31 digits of which [`crate::exact`] and [`crate::solids`] do not speak.

use fingertip_surfaces::numeric::twofold::Twofold;
use fingertip_surfaces::{
    Ellipsoid, Implicit, ImplicitSurface, Knot, Paraboloid, Posed, Revolution, Sphere, Superquadric, Term,
    Topology,
};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::big::{Big, Big3, cross, dot};
use crate::draw::Drawn;
use crate::exact::{Exact, length, minus, number, plus, times, unit, wide};
use crate::wrenches::Random;

/// Of a level function: its value over the length of its gradient.
fn of_level(value: Big, gradient: &Big3) -> (Big, Big3) {
    (&value / &length(gradient), unit(gradient))
}

impl<T: Real> Exact for Sphere<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let from_centre = minus(point, &wide(&self.centre()));
        (&length(&from_centre) - &number(self.radius()), unit(&from_centre))
    }
}

impl<T: Real> Exact for Ellipsoid<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let axes = wide(&self.semi_axes());
        let scaled = [0, 1, 2].map(|k| &point[k] / &axes[k]);
        let gauge = length(&scaled);
        of_level(&gauge - &Big::new(1.0), &[0, 1, 2].map(|k| &(&scaled[k] / &axes[k]) / &gauge))
    }
}

/// `z = −(x²/R₁ + y²/R₂)/2`.
impl<T: Real> Exact for Paraboloid<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let [a, b] = self.radii().map(number);
        let (x, y) = (&point[0] / &a, &point[1] / &b);
        let drop = &(&(&x * &point[0]) + &(&y * &point[1])) * &Big::new(0.5);
        of_level(&point[2] + &drop, &[x, y, Big::new(1.0)])
    }
}

/// Between two points of a profile the square of the radius is linear.
impl<T: Real> Exact for Revolution<T, [Knot<T>; 2]> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let [[z0, r0], [z1, r1]] = [0, 1].map(|k| self.knots()[k].point().map(number));
        let rise = &(&(&r1 - &r0) * &(&r1 + &r0)) / &(&z1 - &z0);
        let [x, y, z] = point;
        let squared = &(&r0 * &r0) + &(&rise * &(z - &z0));
        let excess = &(&(&(x * x) + &(y * y)) - &squared) * &Big::new(0.5);
        of_level(excess, &[x.clone(), y.clone(), &rise * &Big::new(-0.5)])
    }

    fn holds(&self, point: &Big3) -> bool {
        let [[z0, _], [z1, _]] = [0, 1].map(|k| self.knots()[k].point().map(number));
        point[2] >= z0 && point[2] <= z1
    }
}

impl<T: Real> Exact for Superquadric<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let axes = wide(&self.semi_axes());
        let [outer, inner] = self.exponents().map(|e| &Big::new(2.0) / &number(e));
        let scaled = [0, 1, 2].map(|k| &point[k].abs() / &axes[k]);
        let one = Big::new(1.0);
        // Relative to the largest, so that no power leaves the range.
        let norm = |a: &Big, b: &Big, p: &Big| {
            let most = if a > b { a } else { b };
            let rest = &(a / most).powf(p) + &(b / most).powf(p);
            most * &rest.powf(&(&one / p))
        };
        let plane = norm(&scaled[0], &scaled[1], &inner);
        let whole = norm(&plane, &scaled[2], &outer);
        let share = |part: &Big, all: &Big, p: &Big| (part / all).powf(&(p - &one));
        let along = share(&plane, &whole, &outer);
        let slopes = [
            &along * &share(&scaled[0], &plane, &inner),
            &along * &share(&scaled[1], &plane, &inner),
            share(&scaled[2], &whole, &outer),
        ];
        let gradient = [0, 1, 2].map(|k| {
            let slope = &slopes[k] / &axes[k];
            if point[k].is_positive() { slope } else { -slope }
        });
        of_level(&whole - &one, &gradient)
    }
}

/// `x⁴ + y⁴ + z⁴ + (x² + y² + z²)/2 = 1` in units of a length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quartic<T> {
    pub(crate) unit: T,
}

impl<T: Real> ImplicitSurface<T> for Quartic<T> {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        let [x, y, z] = point.map(|x| (x / self.unit).square());
        let quartic = x.square() + y.square() + z.square();
        (quartic + (x + y + z) * T::literal(0.5) - T::one()) * T::literal(0.5)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), self.unit * T::literal(1.21))
    }

    fn steepest(&self) -> Option<T> {
        Some(T::literal(4.2) / self.unit)
    }

    /// With twice the digits of double precision.
    fn value_left(&self, point: &Vector3<T>) -> T {
        let [x, y, z] = [point.x, point.y, point.z].map(|x| {
            let square = Twofold::new(x.to_f64()).over(self.unit.to_f64()).squared();
            square.squared().plus(square.times(Twofold::new(0.5)))
        });
        let value = x.plus(y).plus(z).minus(Twofold::new(1.0));
        T::literal(0.5 * value.value())
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

impl<T: Real> Exact for Implicit<T, Quartic<T>> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let length = number(self.inner().unit);
        let q = [0, 1, 2].map(|k| &point[k] / &length);
        let squares = [0, 1, 2].map(|k| &q[k] * &q[k]);
        let [mut value, half] = [Big::new(-1.0), Big::new(0.5)];
        for square in &squares {
            value = &value + &(&(square * square) + &(&half * square));
        }
        let slope = |k: usize| &(&q[k] * &(&(&squares[k] * &Big::new(4.0)) + &Big::new(1.0))) / &length;
        of_level(value, &[slope(0), slope(1), slope(2)])
    }
}

/// The columns of the rotation of a pose, their cross products (which are those of the inverse's transpose, times the
/// determinant), the determinant, and the origin.
struct Pose {
    columns: [Big3; 3],
    across: [Big3; 3],
    determinant: Big,
    origin: Big3,
}

impl Pose {
    fn of<T: Real, S>(posed: &Posed<T, S>) -> Self {
        let pose = posed.sensor_from_shape();
        let columns = [0, 1, 2].map(|k| wide(&pose.rotation().column(k).into_owned()));
        let across = [0, 1, 2].map(|k| cross(&columns[(k + 1) % 3], &columns[(k + 2) % 3]));
        let determinant = dot(&columns[0], &across[0]);
        Self { columns, across, determinant, origin: wide(&pose.origin()) }
    }

    fn inside(&self, point: &Big3) -> Big3 {
        let away = minus(point, &self.origin);
        [0, 1, 2].map(|k| dot(&self.columns[k], &away))
    }

    fn outside(&self, point: &Big3) -> Big3 {
        let turned = combined(&self.across, point);
        plus(&self.origin, &[0, 1, 2].map(|k| &turned[k] / &self.determinant))
    }

    /// The load that has its contact inside where this one has it: `Rᵀf`, and the inverse of `R` times its determinant for
    /// the torque.
    fn load_inside(&self, force: &Big3, torque: &Big3) -> [Big3; 2] {
        let about = minus(torque, &cross(&self.origin, force));
        [(&self.columns, force), (&self.across, &about)].map(|(rows, v)| [0, 1, 2].map(|k| dot(&rows[k], v)))
    }
}

fn combined(vectors: &[Big3; 3], shares: &Big3) -> Big3 {
    let part = |k: usize| times(&vectors[k], &shares[k]);
    plus(&plus(&part(0), &part(1)), &part(2))
}

/// The shape of the points that the transpose of the rotation takes to the shape within.
impl<T: Real, S: Exact> Exact for Posed<T, S> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let pose = Pose::of(self);
        let (height, normal) = self.inner().height_and_normal(&pose.inside(point));
        (height, unit(&combined(&pose.columns, &normal)))
    }

    fn aside(&self) -> f64 {
        self.sensor_from_shape().origin().map(Real::to_f64).norm()
    }

    fn holds(&self, point: &Big3) -> bool {
        self.inner().holds(&Pose::of(self).inside(point))
    }

    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let pose = Pose::of(self);
        let [f, m] = pose.load_inside(force, torque);
        self.inner().elsewhere(&f, &m).map(|point| pose.outside(&point))
    }

    fn through_end(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        let pose = Pose::of(self);
        let [f, m] = pose.load_inside(force, torque);
        let [point, normal] = self.inner().through_end(&f, &m)?;
        Some([pose.outside(&point), unit(&combined(&pose.columns, &normal))])
    }
}

impl<T: Real> Drawn for Implicit<T, Quartic<T>> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let away = random.direction();
        let quartic = away.map(|x| x.powi(4)).sum();
        // q s² + s/2 = 1 for the square of the distance.
        let squared = 2.0 / (0.5 + (0.25_f64 + 4.0 * quartic).sqrt());
        let point = away * (squared.sqrt() * size);
        let normal = (point / size).map(|x| 4.0 * x.powi(3) + x).normalize();
        (Self::new(Quartic { unit: T::literal(size) }).unwrap(), point, normal)
    }
}
