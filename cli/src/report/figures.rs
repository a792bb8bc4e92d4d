//! The figures that every run has.

use fingertip::surfaces::DynSurface;

use super::{Axis, Chart, Figure, map, solid};
use crate::observe::{Observations, Pieces};
use crate::table::{count, number, short};

/// Most slips that are marked in a chart.
const MARKED_SLIPS: usize = 200;
/// For millimetres and newton millimetres.
const MILLI: f64 = 1e3;

/// What the figures show beside what was observed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'a> {
    /// The surface, in the sensor frame.
    pub(crate) surface: &'a DynSurface<f64>,
    /// The friction coefficient, if one was given.
    pub(crate) coefficient: Option<f64>,
    /// Whether the contact model knows a spin torque.
    pub(crate) spin_torque: bool,
}

/// Map, solid, friction ratio, normal and tangential force, components of force and torque, contact position.
pub(super) fn of(observations: &Observations, shown: Shown<'_>) -> Vec<Figure> {
    let mut figures = vec![contact_map(observations)];
    figures.extend(solid::figure(shown.surface, observations));
    figures.extend([
        ratio(observations, shown.coefficient),
        split(observations),
        forces(observations),
        torques(observations, shown.spin_torque),
        position(observations),
    ]);
    figures
}

fn time_axis(observations: &Observations) -> Axis {
    let (first, last) = observations.time_range();
    Axis::linear("time / s", first, last)
}

/// The least and the greatest value of some curves.
fn range(curves: &[Pieces]) -> Option<(f64, f64)> {
    let mut values = curves.iter().flatten().flatten().map(|point| point.value);
    let first = values.next()?;
    Some(values.fold((first, first), |(low, high), value| (low.min(value), high.max(value))))
}

/// Curves in thousandths of their unit.
fn in_milli(mut curves: Vec<Pieces>) -> Vec<Pieces> {
    curves.iter_mut().flatten().flatten().for_each(|point| point.value *= MILLI);
    curves
}

fn contact_map(observations: &Observations) -> Figure {
    let points = &observations.map;
    let projection = observations.projection();
    let instants = observations.instants.kept();
    let outlines: Vec<_> = instants.iter().filter_map(|instant| instant.outline(projection)).collect();
    let drawn = map::draw("Contact points on the fingertip", projection, points.kept(), &outlines);
    let shown = points.kept().len() as u64;
    let share = if points.seen() > shown {
        format!(" {} of {} contacts, chosen at random.", count(shown), count(points.seen()))
    } else {
        format!(" {} contacts.", count(shown))
    };
    Figure {
        title: "Where it touches".to_owned(),
        svg: drawn.svg,
        keys: Vec::new(),
        caption: format!("{}{share} Colour: normal force.{}", drawn.remark, of_ellipses(outlines.len())),
        on_white: false,
    }
}

/// What is said of the ellipses on the map.
fn of_ellipses(drawn: usize) -> String {
    match drawn {
        0 => String::new(),
        1 => " The ellipse shows how sure one contact is, to scale.".to_owned(),
        _ => format!(
            " The ellipses show how sure {drawn} of the contacts are, evenly spread over the recording, to scale."
        ),
    }
}

/// Curves around zero, each with its class and name.
fn components(
    observations: &Observations,
    [title, said, unit]: [&str; 3],
    curves: &[Pieces],
    keys: &[(&'static str, &str)],
) -> Figure {
    let (low, high) = range(curves).unwrap_or((0.0, 1.0));
    let y = Axis::rounded(unit, low.min(0.0), high.max(0.0));
    let mut chart = Chart::new(said, time_axis(observations), y);
    chart.level("axis", 0.0);
    for ((class, _), curve) in keys.iter().zip(curves) {
        chart.curve(class, curve);
    }
    Figure {
        title: title.to_owned(),
        svg: chart.finish(),
        keys: keys.iter().map(|(class, name)| (*class, (*name).to_owned())).collect(),
        caption: "Components in the sensor frame.".to_owned(),
        on_white: false,
    }
}

fn forces(observations: &Observations) -> Figure {
    let said = ["Force on the fingertip", "Force components over time", "force / N"];
    components(observations, said, &observations.forces(), &[("a", "fx"), ("b", "fy"), ("c", "fz")])
}

fn torques(observations: &Observations, with_spin: bool) -> Figure {
    let said = ["Torque on the fingertip", "Torque components over time", "torque / mN·m"];
    let mut curves = observations.torques().to_vec();
    let mut keys = vec![("a", "tx"), ("b", "ty"), ("c", "tz")];
    if with_spin {
        curves.push(observations.spin_torques());
        keys.push(("d", "spin torque of the contact"));
    }
    let caption = if with_spin {
        "Components in the sensor frame, about its origin; the spin torque about the outward normal at the contact."
    } else {
        "Components in the sensor frame, about its origin."
    };
    let figure = components(observations, said, &in_milli(curves), &keys);
    Figure { caption: caption.to_owned(), ..figure }
}

fn position(observations: &Observations) -> Figure {
    let curves = in_milli(observations.positions().to_vec());
    let (low, high) = range(&curves).unwrap_or((0.0, 1.0));
    let mut chart = Chart::new(
        "Contact point over time",
        time_axis(observations),
        Axis::rounded("position / mm", low, high),
    );
    let keys = [("a", "x"), ("b", "y"), ("c", "z")];
    for ((class, _), curve) in keys.iter().zip(&curves) {
        chart.curve(class, curve);
    }
    Figure {
        title: "Contact position".to_owned(),
        svg: chart.finish(),
        keys: keys.map(|(class, name)| (class, name.to_owned())).to_vec(),
        caption: "The contact point in the sensor frame, only where there is a contact.".to_owned(),
        on_white: false,
    }
}

fn split(observations: &Observations) -> Figure {
    let curves = observations.split();
    let (_, high) = range(&curves).unwrap_or((0.0, 1.0));
    let mut chart = Chart::new(
        "Normal and tangential force over time",
        time_axis(observations),
        Axis::rounded("force / N", 0.0, high),
    );
    for (class, curve) in ["a", "b"].into_iter().zip(&curves) {
        chart.curve(class, curve);
    }
    Figure {
        title: "Normal and tangential force".to_owned(),
        svg: chart.finish(),
        keys: vec![("a", "normal f_n".to_owned()), ("b", "tangential |f_t|".to_owned())],
        caption: "Only where there is a contact.".to_owned(),
        on_white: false,
    }
}

fn ratio(observations: &Observations, coefficient: Option<f64>) -> Figure {
    let curve = observations.ratios();
    let greatest = observations.ratio.greatest().unwrap_or(1.0);
    // The ratio grows without bound as a contact opens: show what holds, and say what is cut.
    let usual = 1.6 * observations.ratio.quantile(0.99).unwrap_or(1.0);
    let high = greatest.min(usual.max(coefficient.map_or(0.0, |coefficient| 1.3 * coefficient)));
    let high = high.max(coefficient.map_or(0.0, |coefficient| 1.15 * coefficient));
    let y = Axis::rounded("friction ratio |f_t|/f_n", 0.0, high);
    let cut = (greatest > y.high)
        .then(|| format!(" Cut at {}; the greatest ratio is {}.", number(y.high), number(greatest)));
    let mut chart = Chart::new("Friction ratio over time", time_axis(observations), y);
    let slips = observations.slips.kept();
    chart.marks("mark", slips.iter().take(MARKED_SLIPS).map(|slip| slip.time));
    chart.curve("a", &[curve].concat());
    let mut keys = vec![("a", "|f_t|/f_n".to_owned())];
    if let Some(coefficient) = coefficient {
        chart.level("level", coefficient);
        keys.push(("e dashed", format!("friction coefficient {}", short(coefficient))));
    }
    if !slips.is_empty() {
        keys.push(("d", "slip".to_owned()));
    }
    let unmarked = observations.slips.count().saturating_sub(MARKED_SLIPS as u64);
    let more = if unmarked > 0 {
        format!(" {} later slips are not marked.", count(unmarked))
    } else {
        String::new()
    };
    Figure {
        title: "Friction ratio".to_owned(),
        svg: chart.finish(),
        keys,
        caption: format!("Only where there is a contact.{}{more}", cut.unwrap_or_default()),
        on_white: false,
    }
}
