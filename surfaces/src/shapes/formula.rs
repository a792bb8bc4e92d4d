//! A surface whose formula is known at run time only.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::{BadShape, ImplicitSurface, Term, Topology};

/// The most values that a formula may hold at once.
const DEEPEST: usize = 24;

/// A step of a [`Formula`], which takes its operands from the end of a list of values and puts its result there.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Formula, FormulaStep, Implicit};
/// use nalgebra::Vector3;
///
/// // Two balls of 10 mm, 8 mm up and down, melt into one: min(z − 8 mm, …) is written as |z| − 8 mm.
/// let steps = vec![
///     FormulaStep::Coordinate(0), FormulaStep::Power(2),
///     FormulaStep::Coordinate(1), FormulaStep::Power(2), FormulaStep::Add,
///     FormulaStep::Coordinate(2), FormulaStep::Abs, FormulaStep::Number(0.008), FormulaStep::Subtract,
///     FormulaStep::Power(2), FormulaStep::Add,
///     FormulaStep::Number(0.01 * 0.01), FormulaStep::Subtract,
/// ];
/// let tip = Implicit::new(Formula::new(steps, Vector3::zeros(), 0.019)?)?;
/// assert!(tip.contains(&Vector3::new(0.0, 0.0, 0.0179)) && !tip.contains(&Vector3::new(0.0, 0.0, 0.0181)));
/// assert!(tip.contains(&Vector3::new(0.0059, 0.0, 0.0)) && !tip.contains(&Vector3::new(0.0061, 0.0, 0.0)));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FormulaStep<T> {
    /// A coordinate \[m\]: 0 is x, 1 is y, any other z.
    Coordinate(u8),
    /// A number.
    Number(T),
    /// The sum of two values.
    Add,
    /// The first value less the second.
    Subtract,
    /// The product of two values.
    Multiply,
    /// The first value over the second.
    Divide,
    /// The smaller of two values: the union of two bodies.
    Min,
    /// The larger of two values: what two bodies have in common.
    Max,
    /// The value with the other sign.
    Negate,
    /// A whole power of the value.
    Power(i32),
    /// The square root.
    Sqrt,
    /// The absolute value.
    Abs,
    /// The exponential.
    Exp,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
}

impl<T> FormulaStep<T> {
    /// How many values it takes.
    const fn operands(&self) -> usize {
        match self {
            Self::Coordinate(_) | Self::Number(_) => 0,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Min | Self::Max => 2,
            _ => 1,
        }
    }
}

/// A surface given by a formula that a file brings: the list of its steps, in the order in which they are worked out.
/// [`Implicit`](crate::Implicit) makes a shape of it.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Formula, FormulaStep, Implicit};
/// use nalgebra::Vector3;
///
/// // x² + y² + z² − 0.013²
/// let mut steps = Vec::new();
/// for axis in 0..3 {
///     steps.extend([FormulaStep::Coordinate(axis), FormulaStep::Power(2)]);
/// }
/// steps.extend([FormulaStep::Add, FormulaStep::Add]);
/// steps.extend([FormulaStep::Number(0.013), FormulaStep::Power(2), FormulaStep::Subtract]);
/// let ball = Implicit::new(Formula::new(steps, Vector3::zeros(), 0.014)?)?;
/// assert!(ball.contains(&Vector3::new(0.0, 0.0, 0.0129)) && !ball.contains(&Vector3::new(0.0, 0.0, 0.0131)));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Formula<T: Real> {
    steps: Vec<FormulaStep<T>>,
    centre: Vector3<T>,
    radius: T,
    topology: Topology,
    steepest: Option<T>,
}

impl<T: Real> Formula<T> {
    /// From the steps, and the centre and radius \[m\] of a ball around the whole surface.
    ///
    /// # Errors
    /// [`BadShape`] unless the steps leave one value, never lack one and never hold more than 24, all numbers are
    /// finite and the radius is positive.
    pub fn new(steps: Vec<FormulaStep<T>>, centre: Vector3<T>, radius: T) -> Result<Self, BadShape> {
        BadShape::check_point("formula", "centre", centre)?;
        BadShape::check_length("formula", "radius", radius)?;
        let (mut held, mut whole) = (0_usize, true);
        for step in &steps {
            let left = held.checked_sub(step.operands());
            whole &= left.is_some_and(|left| left < DEEPEST);
            held = left.unwrap_or(0) + 1;
            whole &= !matches!(step, FormulaStep::Number(number) if !number.is_number());
        }
        let requirement = "complete, of finite numbers, with at most 24 values held at once";
        BadShape::check("formula", "steps", requirement, whole && held == 1)?;
        Ok(Self { steps, centre, radius, topology: Topology::Unknown, steepest: None })
    }

    /// The same, of which it is known that it is convex, or closed.
    #[must_use]
    pub fn with_topology(self, topology: Topology) -> Self {
        Self { topology, ..self }
    }

    /// The same, of which it is known that no gradient in the ball is longer \[value per m\]: for a formula that tells no
    /// bound itself, as a root does that is zero on the surface. [`Implicit::new`](crate::Implicit::new) refuses one that
    /// it sees exceeded.
    #[must_use]
    pub fn with_steepest(self, steepest: T) -> Self {
        Self { steepest: Some(steepest), ..self }
    }

    /// The result of the steps in a kind of number.
    fn run<N: Copy>(
        &self,
        blank: N,
        first: impl Fn(&FormulaStep<T>) -> N,
        one: impl Fn(&FormulaStep<T>, N) -> N,
        two: impl Fn(&FormulaStep<T>, N, N) -> N,
    ) -> N {
        let mut held = [blank; DEEPEST];
        let mut count = 0_usize;
        let at = |held: &[N; DEEPEST], index: usize| held.get(index).copied().unwrap_or(blank);
        for step in &self.steps {
            let operands = step.operands();
            let base = count.saturating_sub(operands);
            let value = match operands {
                0 => first(step),
                1 => one(step, at(&held, base)),
                _ => two(step, at(&held, base), at(&held, base + 1)),
            };
            if let Some(place) = held.get_mut(base) {
                *place = value;
            }
            count = base + 1;
        }
        held[0]
    }
}

/// The steps, worked out in numbers or in terms: these have no trait in common, and call the root each its own way.
macro_rules! run {
    ($formula:expr, $point:expr, $constant:expr, $root:ident) => {{
        let ([x, y, z], constant) = ($point, $constant);
        $formula.run(
            constant(T::zero()),
            |step| match step {
                FormulaStep::Coordinate(0) => x,
                FormulaStep::Coordinate(1) => y,
                FormulaStep::Number(number) => constant(*number),
                _ => z,
            },
            |step, a| match step {
                FormulaStep::Power(exponent) => a.powi(*exponent),
                FormulaStep::Sqrt => a.$root(),
                FormulaStep::Abs => a.abs(),
                FormulaStep::Exp => a.exp(),
                FormulaStep::Sin => a.sin(),
                FormulaStep::Cos => a.cos(),
                _ => -a,
            },
            |step, a, b| match step {
                FormulaStep::Subtract => a - b,
                FormulaStep::Multiply => a * b,
                FormulaStep::Divide => a / b,
                FormulaStep::Min => a.min(b),
                FormulaStep::Max => a.max(b),
                _ => a + b,
            },
        )
    }};
}

impl<T: Real> ImplicitSurface<T> for Formula<T> {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        run!(self, point, Term::constant, sqrt)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (self.centre, self.radius)
    }

    fn value(&self, point: &Vector3<T>) -> T {
        run!(self, [point.x, point.y, point.z], |number: T| number, root)
    }

    fn steepest(&self) -> Option<T> {
        self.steepest
    }

    fn topology(&self) -> Topology {
        self.topology
    }
}
