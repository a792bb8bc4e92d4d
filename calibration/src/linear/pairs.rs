//! Products of pairs: the second-order terms of a polynomial.

use nalgebra::DVector;

/// `x0·x0, x0·x1, … x0·xn, x1·x1, …`: n(n+1)/2 products.
#[must_use]
pub fn pairs(x: &[f64]) -> DVector<f64> {
    let mut products = Vec::with_capacity(x.len() * (x.len() + 1) / 2);
    for (i, a) in x.iter().enumerate() {
        products.extend(x[i..].iter().map(|b| a * b));
    }
    DVector::from_vec(products)
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_pair_once() {
        assert_eq!(super::pairs(&[2.0, 3.0, 5.0]).as_slice(), [4.0, 6.0, 10.0, 9.0, 15.0, 25.0]);
    }
}
