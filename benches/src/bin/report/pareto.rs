//! What nothing else beats.

/// The indices of the points that no other point beats in one coordinate without losing in the
/// other, where less is better in both, in the order of the first coordinate.
pub(crate) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|i| points[*i].0.is_finite() && points[*i].1.is_finite()).collect();
    order.sort_by(|a, b| {
        let (a, b) = (points[*a], points[*b]);
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut best = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].1 < best;
        best = best.min(points[*i].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn what_is_beaten_is_left_out() {
        let points = [(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (2.5, 2.0), (3.0, 3.0), (f64::NAN, 0.0)];
        assert_eq!(front(&points), [1, 2, 0]);
        assert_eq!(front(&[]), [0; 0]);
        // Of equal points, one.
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [0]);
    }
}
