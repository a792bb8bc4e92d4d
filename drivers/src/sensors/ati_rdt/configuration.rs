//! What a sensor says of itself on its page `netftapi2.xml`.

use fingertip_wrench::Real;
use fingertip_wrench::units::{ForceUnit, TorqueUnit};
use thiserror::Error;

use super::receiver::{CountsPerUnit, RdtError};

/// Why a page tells nothing that can be used.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::Configuration;
///
/// let page = "<netft><cfgcpf>1000000</cfgcpf><cfgcpt>1000000</cfgcpt><scfgfu>dyn</scfgfu></netft>";
/// let told = Configuration::parse(page).unwrap_err().to_string();
/// assert_eq!(told, "element <scfgfu> is “dyn”; known are N, lbf, klbf, kN, kgf");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ConfigurationError {
    /// An element is not there.
    #[error("the page has no element <{element}>")]
    Missing {
        /// Its name.
        element: &'static str,
    },
    /// An element cannot be read.
    #[error("element <{element}> is “{found}”, which is no number")]
    NotANumber {
        /// Its name.
        element: &'static str,
        /// What stands there, cut short.
        found: String,
    },
    /// A unit is not known.
    #[error("element <{element}> is “{found}”; known are {known}")]
    Unit {
        /// Its name.
        element: &'static str,
        /// What stands there, cut short.
        found: String,
        /// The units that are known.
        known: &'static str,
    },
    /// Counts per unit that cannot be.
    #[error(transparent)]
    Counts(#[from] RdtError),
}

/// How a sensor is set: what its numbers mean, and how quickly they come.
///
/// The page is that of the manual 9620-05-NET FT, chapter "Common Gateway Interface"; it is asked for
/// with [`REQUEST`](Self::REQUEST). Where an element stands is not relied on, only its name.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::Configuration;
///
/// // A sensor that is set to newton millimetres: a thousand counts each, a million a newton metre.
/// let page = "<netft><scfgfu>N</scfgfu><scfgtu>Nmm</scfgtu><cfgcpf>1000000</cfgcpf><cfgcpt>1000</cfgcpt>\
///     <comrdtrate>7000</comrdtrate></netft>";
/// let configuration = Configuration::parse(page)?;
/// assert_eq!(configuration.counts_per_newton, 1e6);
/// assert_eq!(configuration.counts_per_newton_metre, 1e6);
/// assert_eq!(configuration.rate, Some(7000.0));
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::ConfigurationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Counts per newton: those per force unit, converted.
    pub counts_per_newton: f64,
    /// Counts per newton metre: those per torque unit, converted.
    pub counts_per_newton_metre: f64,
    /// Records a second while streaming, if the page tells.
    pub rate: Option<f64>,
}

impl Configuration {
    /// Asks a sensor for its page, over TCP on port 80; the sensor closes the connection behind it.
    pub const REQUEST: &str = "GET /netftapi2.xml HTTP/1.0\r\n\r\n";

    /// Reads the page, with or without the head of the HTTP answer before it.
    ///
    /// # Errors
    /// [`ConfigurationError`].
    pub fn parse(page: &str) -> Result<Self, ConfigurationError> {
        let per_force = number(page, "cfgcpf")?.ok_or(ConfigurationError::Missing { element: "cfgcpf" })?;
        let per_torque = number(page, "cfgcpt")?.ok_or(ConfigurationError::Missing { element: "cfgcpt" })?;
        let force = unit(page, "scfgfu", ForceUnit::from_name, "N, lbf, klbf, kN, kgf")?.in_newtons();
        let known = "Nm, Nmm, kNm, lbf-in, lbf-ft, kgf-cm, g-cm";
        let torque = unit(page, "scfgtu", TorqueUnit::from_name, known)?.in_newton_metres();
        let rate = number(page, "comrdtrate")?.filter(|rate| *rate > 0.0);
        let counts_per_newton = per_force / force;
        let counts_per_newton_metre = per_torque / torque;
        CountsPerUnit::new(counts_per_newton, counts_per_newton_metre)?;
        Ok(Self { counts_per_newton, counts_per_newton_metre, rate })
    }

    /// A page that says this, in newtons and newton metres, with the head of the HTTP answer: what a
    /// simulated sensor serves.
    #[must_use]
    pub fn page(&self) -> String {
        let Self { counts_per_newton, counts_per_newton_metre, rate } = self;
        let rate = rate.map_or_else(String::new, |rate| format!("<comrdtrate>{rate}</comrdtrate>"));
        format!(
            "HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\nConnection: close\r\n\r\n<?xml version=\"1.0\" \
             encoding=\"iso-8859-1\"?>\n<netft><prodname>simulated fingertip</prodname><scfgfu>N</scfgfu>\
             <scfgtu>Nm</scfgtu><cfgcpf>{counts_per_newton}</cfgcpf><cfgcpt>{counts_per_newton_metre}</cfgcpt>\
             {rate}</netft>\n"
        )
    }

    /// For a receiver or client.
    ///
    /// # Errors
    /// [`RdtError::BadCounts`] for counts that `T` cannot hold, or that were changed to ones that
    /// cannot be.
    pub fn counts<T: Real>(&self) -> Result<CountsPerUnit<T>, RdtError> {
        CountsPerUnit::new(T::literal(self.counts_per_newton), T::literal(self.counts_per_newton_metre))
    }
}

/// The text of the first element of that name. The page is flat and its elements have no attributes,
/// comments or escapes that matter for numbers and units.
fn element<'a>(page: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = page;
    loop {
        let (_, behind) = rest.split_once('<')?;
        if let Some(text) = behind.strip_prefix(name).and_then(|behind| behind.strip_prefix('>')) {
            return text.split_once("</").map(|(text, _)| text.trim());
        }
        rest = behind;
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}

fn number(page: &str, name: &'static str) -> Result<Option<f64>, ConfigurationError> {
    let Some(text) = element(page, name) else { return Ok(None) };
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    match number {
        Some(number) => Ok(Some(number)),
        None => Err(ConfigurationError::NotANumber { element: name, found: shortened(text) }),
    }
}

fn unit<U>(
    page: &str,
    name: &'static str,
    from_name: impl Fn(&str) -> Option<U>,
    known: &'static str,
) -> Result<U, ConfigurationError> {
    let text = element(page, name).ok_or(ConfigurationError::Missing { element: name })?;
    from_name(text).ok_or_else(|| ConfigurationError::Unit { element: name, found: shortened(text), known })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PAGE: &str = "HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\n\r\n<?xml version=\"1.0\"?><netft>\
        <cfgnam>Mini40</cfgnam><scfgfu>lbf</scfgfu><scfgtu>lbf-in</scfgtu><cfgcpf>1000000</cfgcpf>\
        <cfgcpt> 2000000 </cfgcpt><comrdtrate>7000</comrdtrate></netft>";

    #[test]
    fn counts_are_converted_from_the_units_of_the_sensor() {
        let configuration = Configuration::parse(PAGE).unwrap();
        // A pound-force is 4.4482216152605 N, an inch 25.4 mm.
        assert!((configuration.counts_per_newton - 224_808.943_099_710_5).abs() < 1e-6);
        assert!((configuration.counts_per_newton_metre - 2e6 / 0.112_984_829_027_616_7).abs() < 1e-4);
        assert_eq!(configuration.rate, Some(7000.0));
        let wrench = configuration.counts::<f64>().unwrap().wrench(&[1_000_000, 0, 0, 2_000_000, 0, 0]);
        assert!((wrench.force().x - 4.448_221_615_260_5).abs() < 1e-12);
        assert!((wrench.torque().x - 0.112_984_829_027_616_7).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_used_is_named() {
        let said =
            |from: &str, to: &str| Configuration::parse(&PAGE.replace(from, to)).unwrap_err().to_string();
        assert!(said("<cfgcpf>", "<x>").contains("no element <cfgcpf>"));
        assert!(said("1000000", "many").contains("“many”"));
        assert!(said("lbf-in", "stone").contains("lbf-ft"));
        assert!(said("1000000", "0").contains("positive"));
        assert!(said("1000000", "NaN").contains("no number"));
        let without_rate = Configuration::parse(&PAGE.replace("comrdtrate", "x")).unwrap();
        assert_eq!(without_rate.rate, None);
    }

    #[test]
    fn a_page_says_what_it_is_made_of() {
        let configuration =
            Configuration { counts_per_newton: 1e6, counts_per_newton_metre: 12_345.5, rate: Some(500.0) };
        assert_eq!(Configuration::parse(&configuration.page()), Ok(configuration));
        let unrated = Configuration { rate: None, ..configuration };
        assert_eq!(Configuration::parse(&unrated.page()), Ok(unrated));
    }

    proptest! {
        #[test]
        fn any_text_is_a_page_or_none(text in ".{0,200}", pieces in prop::collection::vec(
            prop::sample::select(vec!["<", ">", "</", "cfgcpf", "cfgcpt", "scfgfu", "scfgtu", "N", "Nm", "1e400", "-", "7", "é"]), 0..60,
        )) {
            let _ = Configuration::parse(&text);
            let _ = Configuration::parse(&pieces.concat());
        }
    }
}
