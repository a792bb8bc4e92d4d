//! Numbers of a shape as lines for the terminal.

use nalgebra::Vector3;

/// How well a direction is known, about two axes \[rad\].
pub(crate) fn tilt(deviations: Option<&[f64]>) -> Option<String> {
    let [a, b] = *deviations? else { return None };
    Some(format!(" (± {:.3} {:.3}°)", a.to_degrees(), b.to_degrees()))
}

/// A length and the deviation or interval of it.
pub(crate) fn length(name: &str, metres: f64, deviation: Option<&f64>) -> String {
    let spread = deviation.map_or_else(String::new, |s| format!(" ± {:.4}", 1e3 * s));
    format!("{name:<15} {:.4}{spread} mm", 1e3 * metres)
}

/// A place, and how well each of its coordinates is known.
pub(crate) fn point(name: &str, metres: &Vector3<f64>, deviations: Option<&[f64]>) -> String {
    let v = metres * 1e3;
    let spread = deviations.map_or_else(String::new, |list| {
        let list: Vec<String> = list.iter().map(|s| format!("{:.4}", 1e3 * s)).collect();
        format!(" (± {})", list.join(" "))
    });
    format!("{name:<15} {:+.4} {:+.4} {:+.4} mm{spread}", v.x, v.y, v.z)
}
