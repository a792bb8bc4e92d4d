//! Which code is compiled for the tests, by its attributes.

use syn::punctuated::Punctuated;
use syn::{Attribute, Meta, Token};

use crate::workspace::OFF;

/// Whether the code below these attributes is for tests, or behind a feature that is off when they run.
pub fn is_left_out(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let is_test =
            attribute.path().is_ident("test") || (attribute.path().is_ident("cfg") && names_test(attribute));
        is_test
            || (attribute.path().is_ident("cfg") && attribute.parse_args().is_ok_and(|when| !holds(&when)))
    })
}

fn names_test(attribute: &Attribute) -> bool {
    let words = attribute.meta.require_list().map(|list| list.tokens.to_string()).unwrap_or_default();
    words.split(|c: char| !c.is_alphanumeric()).any(|word| word == "test")
}

/// Whether a condition of `cfg` holds; what is not known of the machine is taken to hold, and its opposite too.
fn holds(when: &Meta) -> bool {
    let inner = |when: &Meta| -> Vec<Meta> {
        let list = when
            .require_list()
            .and_then(|list| list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated));
        list.map(|list| list.into_iter().collect()).unwrap_or_default()
    };
    let is_of_features = |when: &Meta| !features(when).is_empty();
    match when.path() {
        path if path.is_ident("feature") => {
            features(when).iter().all(|feature| !OFF.contains(&feature.as_str()))
        }
        path if path.is_ident("all") => inner(when).iter().all(holds),
        path if path.is_ident("any") => inner(when).iter().any(holds),
        path if path.is_ident("not") => inner(when).iter().all(|when| !(is_of_features(when) && holds(when))),
        _ => true,
    }
}

/// The features that a condition names.
fn features(when: &Meta) -> Vec<String> {
    match when {
        Meta::NameValue(pair) if pair.path.is_ident("feature") => match &pair.value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(name), .. }) => vec![name.value()],
            _ => Vec::new(),
        },
        Meta::List(list) => list
            .parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
            .map(|inner| inner.iter().flat_map(features).collect())
            .unwrap_or_default(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_out(attribute: &str) -> bool {
        let function: syn::ItemFn = syn::parse_str(&format!("{attribute} fn f() {{}}")).unwrap();
        is_left_out(&function.attrs)
    }

    #[test]
    fn tests_and_features_that_are_off_are_left_out() {
        for attribute in [
            "#[test]",
            "#[cfg(test)]",
            "#[cfg(any(test, feature = \"testing\"))]",
            "#[cfg(all(test, target_os = \"linux\"))]",
            "#[cfg(feature = \"ros2\")]",
            "#[cfg(any(feature = \"foxglove\", feature = \"ros2\"))]",
            "#[cfg(all(feature = \"std\", feature = \"web\"))]",
            "#[cfg(not(feature = \"std\"))]",
        ] {
            assert!(left_out(attribute), "{attribute}");
        }
    }

    #[test]
    fn what_may_be_compiled_is_kept() {
        for attribute in [
            "",
            "#[inline]",
            "#[cfg(feature = \"std\")]",
            "#[cfg(not(feature = \"ros2\"))]",
            "#[cfg(not(any(feature = \"foxglove\", feature = \"ros2\")))]",
            "#[cfg(any(feature = \"ros2\", feature = \"std\"))]",
            "#[cfg(unix)]",
            "#[cfg(not(windows))]",
        ] {
            assert!(!left_out(attribute), "{attribute}");
        }
    }
}
