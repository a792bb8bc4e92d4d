//! Matrices of NumPy: `.npy` files of real numbers.

use nalgebra::DMatrix;

use super::PlainError;

/// Reads a matrix of 4- or 8-byte floats, in either byte order and either storage order. The format is that of NumPy's
/// `numpy.lib.format`, versions 1 to 3: a magic text, the length of a header, the header as a dictionary of Python, numbers.
pub(super) fn matrix(bytes: &[u8]) -> Result<DMatrix<f64>, PlainError> {
    let bad = |what: &str| PlainError::Npy { what: what.to_owned() };
    let rest =
        bytes.strip_prefix(b"\x93NUMPY").ok_or_else(|| bad("it does not begin as a .npy file does"))?;
    let cut = || bad("it ends in its header");
    let (version, rest) = rest.split_at_checked(2).ok_or_else(cut)?;
    let (length, rest) = match version {
        [1, _] => {
            let (length, rest) = rest.split_first_chunk::<2>().ok_or_else(cut)?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        [2 | 3, _] => {
            let (length, rest) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
            (u32::from_le_bytes(*length) as usize, rest)
        }
        _ => return Err(bad("its version is not 1, 2 or 3")),
    };
    let (header, numbers) = rest.split_at_checked(length).ok_or_else(cut)?;
    let header = core::str::from_utf8(header).map_err(|_| bad("its header is no text"))?;
    let entry = |key: &str| -> Option<&str> {
        let (_, behind) = header.split_once(&format!("'{key}':"))?;
        Some(behind.trim_start())
    };
    let kind =
        entry("descr").and_then(|text| text.strip_prefix('\'')?.split_once('\'')).map(|(kind, _)| kind);
    let by_column = entry("fortran_order").is_some_and(|text| text.starts_with("True"));
    let shape =
        entry("shape").and_then(|text| text.strip_prefix('(')?.split_once(')')).map(|(shape, _)| shape);
    let sizes: Option<Vec<usize>> = shape.and_then(|shape| {
        let parts = shape.split(',').map(str::trim).filter(|part| !part.is_empty());
        parts.map(|part| part.parse().ok()).collect()
    });
    let Some([rows, columns]) = sizes.as_deref() else {
        return Err(bad("it holds no matrix of two dimensions"));
    };
    let values = match kind {
        Some("<f8" | "|f8") => values::<8>(numbers, f64::from_le_bytes),
        Some(">f8") => values::<8>(numbers, f64::from_be_bytes),
        Some("<f4") => values::<4>(numbers, |bytes| f32::from_le_bytes(bytes).into()),
        Some(">f4") => values::<4>(numbers, |bytes| f32::from_be_bytes(bytes).into()),
        _ => return Err(bad("its numbers are not floats of 4 or 8 bytes; save it with dtype float64")),
    };
    if rows.checked_mul(*columns) != Some(values.len()) {
        return Err(bad("it has not as many numbers as its shape says"));
    }
    Ok(if by_column {
        DMatrix::from_column_slice(*rows, *columns, &values)
    } else {
        DMatrix::from_row_slice(*rows, *columns, &values)
    })
}

fn values<const SIZE: usize>(bytes: &[u8], number: impl Fn([u8; SIZE]) -> f64) -> Vec<f64> {
    bytes.as_chunks::<SIZE>().0.iter().map(|chunk| number(*chunk)).collect()
}

#[cfg(test)]
mod tests {
    use super::matrix;

    /// As NumPy writes it: the header padded to a multiple of 64.
    fn file(header: &str, numbers: &[u8]) -> Vec<u8> {
        let mut text = header.to_owned();
        while !(10 + text.len() + 1).is_multiple_of(64) {
            text.push(' ');
        }
        text.push('\n');
        let length = u16::try_from(text.len()).unwrap().to_le_bytes();
        [b"\x93NUMPY\x01\x00", &length[..], text.as_bytes(), numbers].concat()
    }

    #[test]
    fn every_order_gives_the_same_matrix() {
        let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.5];
        let columns = [1.0, 4.0, 2.0, 5.0, 3.0, 6.5];
        let header = |kind: &str, fortran: &str| {
            format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': (2, 3), }}")
        };
        let eight = |list: [f64; 6]| list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
        let four: Vec<u8> = rows.iter().flat_map(|x| (*x as f32).to_be_bytes()).collect();
        let of_rows = matrix(&file(&header("<f8", "False"), &eight(rows))).unwrap();
        assert_eq!((of_rows.shape(), of_rows[(1, 2)], of_rows[(0, 1)]), ((2, 3), 6.5, 2.0));
        assert_eq!(matrix(&file(&header("<f8", "True"), &eight(columns))).unwrap(), of_rows);
        assert_eq!(matrix(&file(&header(">f4", "False"), &four)).unwrap(), of_rows);
    }

    #[test]
    fn what_is_no_matrix_is_refused_with_its_reason() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
        let good = file(header, &[0; 48]);
        for cut in 0..good.len() {
            assert!(matrix(&good[..cut]).is_err(), "{cut}");
        }
        let said = |header: &str| matrix(&file(header, &[0; 48])).unwrap_err().to_string();
        assert!(said(&header.replace("<f8", "<i4")).contains("dtype float64"));
        assert!(said(&header.replace("(2, 3)", "(6,)")).contains("two dimensions"));
        assert!(said(&header.replace("(2, 3)", "(2, 4)")).contains("as its shape says"));
        assert!(said(&header.replace("(2, 3)", "(99999999999, 99999999999)")).contains("as its shape says"));
        assert!(matrix(b"1,2,3").unwrap_err().to_string().contains("does not begin"));
    }
}
