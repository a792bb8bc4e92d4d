//! Which code is compiled for the tests, by its attributes.

use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, ExprLit, Lit, Meta, Token};

use crate::workspace::OFF;

/// Whether the code below these attributes is for tests, or behind a feature that is off when they run.
pub fn is_left_out(attributes: &[Attribute]) -> bool {
    let fails = |attribute: &Attribute| attribute.parse_args().is_ok_and(|when| holds(&when) == Some(false));
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg") && (names_test(attribute) || fails(attribute))
    })
}

fn names_test(attribute: &Attribute) -> bool {
    let words = attribute.meta.require_list().map(|list| list.tokens.to_string()).unwrap_or_default();
    words.split(|c: char| !c.is_alphanumeric()).any(|word| word == "test")
}

/// Whether a condition of `cfg` holds; `None` of what is not known, such as the machine.
fn holds(when: &Meta) -> Option<bool> {
    match when {
        Meta::NameValue(pair) if pair.path.is_ident("feature") => match &pair.value {
            Expr::Lit(ExprLit { lit: Lit::Str(name), .. }) => Some(!OFF.contains(&name.value().as_str())),
            _ => None,
        },
        Meta::List(list) => {
            let inner = list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated).ok()?;
            let inner: Vec<Option<bool>> = inner.iter().map(holds).collect();
            // One of these decides; without one, what is not known leaves it open.
            let by = |decides: bool| {
                let is_open = !inner.contains(&Some(decides)) && inner.contains(&None);
                (!is_open).then_some(inner.contains(&Some(decides)) == decides)
            };
            match list.path.get_ident()?.to_string().as_str() {
                "all" => by(false),
                "any" => by(true),
                "not" => inner.first()?.map(|holds| !holds),
                _ => None,
            }
        }
        _ => None,
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
            "#[cfg(not(any(windows, feature = \"ros2\")))]",
        ] {
            assert!(!left_out(attribute), "{attribute}");
        }
    }
}
