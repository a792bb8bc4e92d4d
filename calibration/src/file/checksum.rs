//! The checksum of a calibration: over what it says, not over how it is laid out.

use toml::Value;

/// FNV-1a, 64 bits (Fowler, Noll & Vo): guards against accidents, not against forgery.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Appends one line per leaf, `path=type:value`, tables in the order of their keys, floats as the
/// 16 hexadecimal digits of their bits.
fn canonical(path: &str, value: &Value, text: &mut String) {
    let leaf = match value {
        Value::Table(table) => {
            let mut keys: Vec<_> = table.keys().collect();
            keys.sort_unstable();
            for key in keys {
                canonical(&format!("{path}.{key}"), &table[key], text);
            }
            return;
        }
        Value::Array(array) => {
            for (index, entry) in array.iter().enumerate() {
                canonical(&format!("{path}[{index}]"), entry, text);
            }
            format!("list:{}", array.len())
        }
        Value::Float(x) => format!("float:{:016x}", x.to_bits()),
        Value::Integer(i) => format!("int:{i}"),
        Value::Boolean(b) => format!("bool:{b}"),
        // Escaped, so that no text can look like another line.
        Value::String(s) => format!("text:{s:?}"),
        Value::Datetime(d) => format!("date:{d}"),
    };
    text.push_str(path);
    text.push('=');
    text.push_str(&leaf);
    text.push('\n');
}

/// The checksum of a table, `fnv1a64:` and 16 hexadecimal digits. Layout, comments, the order of
/// the keys and the way numbers are written do not change it; any value does.
pub(super) fn checksum(contents: &Value) -> String {
    let mut text = String::new();
    canonical("", contents, &mut text);
    format!("fnv1a64:{:016x}", fnv1a(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::{checksum, fnv1a};

    #[test]
    fn hash_gives_the_published_vectors() {
        // From the FNV reference: the empty string, "a", "foobar".
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn layout_does_not_change_it_and_values_do() {
        let of = |text: &str| checksum(&toml::Value::Table(text.parse().unwrap()));
        let plain = of("a = 1.5\nb = [1.0, 2.0]\n");
        assert_eq!(plain, of("# note\nb = [ 1.0,\n 2.000 ]\na = 15e-1\n"));
        assert_ne!(plain, of("a = 1.5\nb = [2.0, 1.0]\n"));
        assert_ne!(plain, of("a = 1.5000000000000002\nb = [1.0, 2.0]\n"));
        assert_ne!(of("a = 0.0"), of("a = -0.0"));
        assert_ne!(of("a = []"), of("b = []"));
        assert_ne!(of("a = \"x\\n.b=int:1\""), of("a = \"x\"\nb = 1"));
    }
}
