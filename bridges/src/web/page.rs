//! The page: in the style of the reports, with the view of the surface that these have.

use fingertip_calibration::page::{Figure, Page};

use crate::About;

/// The page that watches; `nonce` lets its own scripts run, and no others.
pub(super) fn page(about: &About, view: &str, nonce: &str) -> String {
    let mut page = Page::new("Fingertip, live");
    let figure = |title: &str, svg: String, keys: &[(&'static str, &str)], caption: &str| Figure {
        title: title.to_owned(),
        svg,
        keys: keys.iter().map(|(class, name)| (*class, (*name).to_owned())).collect(),
        caption: caption.to_owned(),
        on_white: false,
    };
    let style = format!("<style>{}</style>", include_str!("live.css"));
    page.figure(&figure("", format!("{style}{}", include_str!("head.html")), &[], ""));
    let mut figures = Vec::new();
    if about.has_scene && !view.is_empty() {
        let keys = [("a", "x"), ("b", "y"), ("c", "z")];
        let caption = "The arrow is the force on the fingertip, its tip at the contact; the cone is the limit of \
            friction: outside of it the contact slips. Dots are where it was, the line around it where it lies with \
            95 %. Drag to turn, or use the arrow keys; the wheel or + and − zoom; a double click resets.";
        figures.push(figure("The fingertip", view.to_owned(), &keys, caption));
    }
    figures.push(figure("Now", include_str!("table.html").to_owned(), &[], ""));
    let curve = |name: &str, label: &str| {
        format!("<canvas class=\"curve-of\" data-of=\"{name}\" role=\"img\" aria-label=\"{label}\"></canvas>")
    };
    if about.has_scene {
        let keys = [("a", "normal"), ("b", "tangential")];
        figures.push(figure("Contact force / N", curve("contact", "Curves of the contact force"), &keys, ""));
        let caption = "How far the contact is from slipping; below the line it slips.";
        figures.push(figure(
            "Slip margin / N",
            curve("margin", "Curve of the slip margin"),
            &[("a", "margin")],
            caption,
        ));
    }
    let keys = [("a", "x"), ("b", "y"), ("c", "z")];
    figures.push(figure("Force / N", curve("force", "Curves of the force"), &keys, ""));
    figures.push(figure("Torque / mN\u{a0}m", curve("torque", "Curves of the torque"), &keys, ""));
    page.figures(figures);
    let script = format!("<script>{}</script>", include_str!("live.js"));
    page.figure(&Figure { svg: script, ..Figure::default() });
    let footer = "Loads are those on the fingertip, in the sensor frame. Curves show ten seconds, with all peaks. Made by \
        fingertip ";
    let text = page.finish(&format!("{footer}{}.", env!("CARGO_PKG_VERSION")));
    text.replace("<script>", &format!("<script nonce=\"{nonce}\">"))
}

/// What the page may do: run its own scripts, and talk to where it is from.
pub(super) fn rules(nonce: &str) -> String {
    format!(
        "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'unsafe-inline'; connect-src 'self'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
}

#[cfg(test)]
mod tests {
    use super::page;
    use crate::About;

    #[test]
    fn every_script_of_the_page_has_the_nonce_and_nothing_is_fetched() {
        let about = About { has_scene: true, ..About::default() };
        let view = "<div class=\"solid\"><script>view()</script></div>";
        let html = page(&about, view, "abc");
        assert_eq!(html.matches("<script").count(), 2);
        assert_eq!(html.matches("<script nonce=\"abc\">").count(), 2);
        for fetched in ["src=", "href=", "url(", "@import", "http://", "https://"] {
            assert!(!html.contains(fetched), "{fetched}");
        }
        assert!(html.contains("aria-live") && html.contains("<table") && html.contains("<h2>Slip margin"));
        let plain = page(&About::default(), view, "abc");
        assert!(!plain.contains("<h2>Slip margin") && !plain.contains("class=\"solid\""));
    }
}
