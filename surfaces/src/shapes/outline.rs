//! The outline of a quadric of revolution, and its place that is nearest to a line.

use fingertip_wrench::Real;

use super::profile::Piece;
use super::sight::Sight;
use crate::numeric::quadratic::{difference_of_products, roots};
use crate::numeric::roots::bracketed_from;
use crate::numeric::vectors::{larger, smaller};

/// The outline of a piece of a quadric `x² + y² = S(z)`, `S` quadratic, seen along `(sine, 0, cosine)`:
/// the points whose normal `(x, y, −S′/2)` is across that direction. A smooth surface that a line misses
/// has its nearest point there.
///
/// On it `x = S′·cosine/(2·sine)`, so that x, z and where the outline lies in the plane across the line,
/// `ahead = z·sine − x·cosine`, are linear in a parameter τ, and `y² = Q(τ)` is quadratic. The square of
/// the distance from a line at `(A, B)` in that plane, with B ≥ 0, is
///
/// `G(τ) = (ahead(τ) − A)² + (√Q(τ) − B)²`,  `G″/2 = ahead′² + Q″/2 + B·δ/Q^(3/2)`,
///
/// where δ, a quarter of the discriminant of Q, is a constant. So G changes between convex and concave at
/// two values of τ at most on either side of the vertex of Q, known in closed form, between which no least
/// value can hide: on a convex stretch there is one at most, on a concave one it is at an end.
struct Outline<T: Real> {
    /// What is linear in τ: values at τ = 0 and how fast they change.
    x: [T; 2],
    z: [T; 2],
    slope: [T; 2],
    /// `ahead − A`.
    ahead: [T; 2],
    aside: T,
    /// `Q = squared + 2·lean·τ + bend·τ²`.
    squared: T,
    lean: T,
    bend: T,
    /// `lean² − bend·squared`.
    discriminant: T,
    /// `G″/2` without its last term.
    curvature: T,
    /// Within which τ is on the piece.
    range: [T; 2],
}

/// How to come from a parameter s to τ, to √Q, and the first and second derivatives of both. Where Q has
/// a root nearby, s is the square root of the way from there: √Q has a vertical tangent at it, and as a
/// function of τ neither digits nor a slope for Newton's method.
enum Way<T> {
    FromRoot { root: T, sign: T },
    Plain { start: T, squared: T, lean: T },
}

impl<T: Real> Outline<T> {
    /// `None` if the piece has no outline: seen along the axis where it narrows or widens.
    fn new(piece: &Piece<T>, sight: &Sight<T>) -> Option<Self> {
        let two = T::one() + T::one();
        let (sine, cosine, c) = (sight.sine, sight.cosine, piece.curvature);
        let width = piece.high - piece.low;
        // From the thinner end: near a tip all digits count.
        let (z, squared, slope, far_slope, span) = if piece.squared <= piece.squared_above {
            (piece.low, piece.squared, piece.slope, piece.slope_above, width)
        } else {
            (piece.high, piece.squared_above, piece.slope_above, piece.slope, -width)
        };
        // No circle of the piece is larger. Beyond, there is nothing to see, and digits to lose if it is thin.
        let bulge = c.abs() * width * width * T::literal(0.25);
        let most = larger(piece.squared, piece.squared_above) + bulge;
        let radius = larger(most, T::zero()).root() * (T::one() + T::EPSILON * T::literal(4.0));
        let x_at = |slope: T| if slope.is_zero() { slope } else { slope * cosine / (sine + sine) };
        // Where x comes within that radius, which way from that end.
        let comes_in = |slope_there: T, there: T| {
            let x = x_at(slope_there);
            let within = smaller(larger(x, -radius), radius);
            let way = if x == within { there } else { (within * two * sine / cosine - slope) / (c + c) };
            (within, smaller(larger(way, smaller(span, T::zero())), larger(span, T::zero())))
        };
        let ((x, way), (far_x, far_way)) = (comes_in(slope, T::zero()), comes_in(far_slope, span));
        // As a function of the height or, where that hardly changes along the outline, of x.
        let by_height = (c * cosine).abs() <= sine;
        let (x_slope, z_slope, end) = if by_height {
            (c * cosine / sine, T::one(), far_way - way)
        } else {
            (T::one(), sine / (c * cosine), far_x - x)
        };
        if !(end.abs() > T::zero() && x.is_number()) {
            return None;
        }
        let squared = squared + way * (slope + way * c);
        let slope = slope + (way + way) * c;
        let z = z + way;
        // All second-order terms have this factor, which vanishes where the line of sight is an asymptote.
        let factor = sine * sine - c * cosine * cosine;
        let bend = if by_height { c * factor / (sine * sine) } else { factor / (c * cosine * cosine) };
        let lean =
            if by_height { slope * factor / (two * sine * sine) } else { x * factor / (c * cosine * cosine) };
        let squared = squared - x * x;
        Some(Self {
            x: [x, x_slope],
            z: [z, z_slope],
            slope: [slope, (c + c) * z_slope],
            ahead: [
                z * sine - x * cosine - sight.ahead,
                if by_height { factor / sine } else { factor / (c * cosine) },
            ],
            aside: sight.aside,
            squared,
            lean,
            bend,
            discriminant: difference_of_products(lean, lean, bend, squared),
            curvature: factor * (T::one() + c) * z_slope * z_slope,
            range: [smaller(end, T::zero()), larger(end, T::zero())],
        })
    }

    fn squared_at(&self, t: T) -> T {
        self.squared + t * (self.lean + self.lean + t * self.bend)
    }

    /// Where Q is zero; a constant is so nowhere.
    fn zeros(&self) -> Option<[T; 2]> {
        let changes = self.discriminant > T::zero() || self.bend > T::zero();
        changes.then(|| roots(self.bend, self.lean, self.squared)).flatten()
    }

    /// Ascending values of τ between which Q has one sign and is monotonic, and G is convex or concave.
    fn stretches(&self) -> [T; 7] {
        let [low, high] = self.range;
        let inflection = (-self.aside * self.discriminant / self.curvature).cube_root();
        let inflections = roots(self.bend, self.lean, self.squared - inflection * inflection);
        let [a, b] = self.zeros().unwrap_or([low, high]);
        let [c, d] = inflections.filter(|_| inflection > T::zero()).unwrap_or([low, high]);
        let vertex = -self.lean / self.bend;
        let mut all = [low, a, b, c, d, vertex, high].map(|t| smaller(larger(t, low), high));
        all.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
        all
    }

    /// The way to look along a stretch on which Q is positive, and from where to where.
    fn way(&self, low: T, high: T) -> (Way<T>, [T; 2]) {
        let middle = low + (high - low) * T::literal(0.5);
        if let Some([a, b]) = self.zeros() {
            let root = if (middle - a).abs() < (b - middle).abs() { a } else { b };
            if (middle - root).abs() <= T::literal(4.0) * (high - low) {
                let sign = T::one().copysign(middle - root);
                let parameter = |t: T| larger((t - root) * sign, T::zero()).root();
                let [a, b] = [low, high].map(parameter);
                return (Way::FromRoot { root, sign }, if a <= b { [a, b] } else { [b, a] });
            }
        }
        let start = if self.squared_at(low) <= self.squared_at(high) { low } else { high };
        let way = Way::Plain { start, squared: self.squared_at(start), lean: self.lean + start * self.bend };
        (way, [low - start, high - start])
    }

    /// τ and √Q, with their first and second derivatives.
    fn along(&self, way: &Way<T>, s: T) -> [[T; 3]; 2] {
        let tiny = T::LEAST_NORMAL;
        match *way {
            Way::FromRoot { root, sign } => {
                // Q = s²·W, W = 2√δ + bend·s² on the side where Q is positive.
                let rise = self.discriminant.max(T::zero()).root();
                let bent = self.bend * s * s;
                let w = larger(rise + rise + bent, tiny);
                let y = w.root();
                let second = self.bend * s * (T::literal(6.0) * rise + bent + bent) / (w * y);
                let two = sign + sign;
                [[root + sign * s * s, two * s, two], [s * y, (w + bent) / y, second]]
            }
            Way::Plain { start, squared, lean } => {
                let y = larger(squared + s * (lean + lean + s * self.bend), tiny).root();
                let second = -self.discriminant / (y * y * y);
                [[start + s, T::one(), T::zero()], [y, (lean + s * self.bend) / y, second]]
            }
        }
    }

    /// Half of the slope of G, zero if that is within rounding, and half of its second derivative.
    fn slope(&self, way: &Way<T>, s: T) -> (T, T) {
        let [[t, t1, t2], [y, y1, y2]] = self.along(way, s);
        let [ahead, rate] = self.ahead;
        let (ahead, aside) = (ahead + rate * t, y - self.aside);
        let value = ahead * rate * t1 + aside * y1;
        let size = T::one() + ahead.abs() + self.aside;
        let noise = T::EPSILON * size * ((rate * t1).abs() + y1.abs());
        let bend = rate * rate * t1 * t1 + ahead * rate * t2 + y1 * y1 + aside * y2;
        (if value.abs() <= noise { T::zero() } else { value }, bend)
    }

    fn look_at(&self, way: &Way<T>, s: T, sight: &mut Sight<T>) {
        let [[t, ..], [y, ..]] = self.along(way, s);
        let at = |[start, rate]: [T; 2]| start + rate * t;
        sight.keep_on_side(at(self.x), y, at(self.z), at(self.slope));
    }
}

impl<T: Real> Sight<T> {
    /// Looks at all places of a piece of the side that may be nearest, but for its ends if the solid ends
    /// there.
    pub(super) fn side(&mut self, piece: &Piece<T>) {
        // Where two outlines meet, that rounding may keep apart.
        let radius = larger(piece.squared, T::zero()).root();
        let x = if piece.slope.is_zero() {
            T::zero()
        } else {
            piece.slope * self.cosine / (self.sine + self.sine)
        };
        let x = smaller(larger(x, -radius), radius);
        self.keep_on_side(x, ((radius - x) * (radius + x)).root(), piece.low, piece.slope);
        let Some(outline) = Outline::new(piece, self) else { return };
        let stretches = outline.stretches();
        for (low, high) in stretches.into_iter().zip(stretches.into_iter().skip(1)) {
            let middle = low + (high - low) * T::literal(0.5);
            let squared = outline.squared_at(middle);
            if !(low < high && squared > T::zero()) {
                continue;
            }
            let (way, [first, last]) = outline.way(low, high);
            let convex = outline.curvature * squared * squared.root() + outline.aside * outline.discriminant
                >= T::zero();
            if convex {
                let slope = |s: T| outline.slope(&way, s);
                let ((at_first, bend), (at_last, _)) = (slope(first), slope(last));
                // Of a line through the axis G may fall from a root of Q on, where in s it has no slope.
                let falls = at_first < T::zero() || (at_first.is_zero() && bend < T::zero());
                if falls && at_last > T::zero() {
                    let start = first + (last - first) * T::literal(0.5);
                    let s = bracketed_from(start, first, last, T::zero(), slope);
                    outline.look_at(&way, s, self);
                    continue;
                }
            }
            outline.look_at(&way, first, self);
            outline.look_at(&way, last, self);
        }
    }
}
