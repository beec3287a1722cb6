//! Products and sums of polynomials whose coefficients are model scalars, highest power first.

use phea_dynamics::scalar::Scalar;

/// Product p q.
pub(crate) fn product<S: Scalar>(p: &[S], q: &[S]) -> Vec<S> {
    let mut result = vec![S::from(0.0); (p.len() + q.len()).saturating_sub(1)];
    for (i, &a) in p.iter().enumerate() {
        for (slot, &b) in result.iter_mut().skip(i).zip(q) {
            *slot = *slot + a * b;
        }
    }
    result
}

/// Sum p + q, aligned at the lowest power.
pub(crate) fn sum<S: Scalar>(p: &[S], q: &[S]) -> Vec<S> {
    let (longer, shorter) = if p.len() >= q.len() { (p, q) } else { (q, p) };
    let mut result = longer.to_vec();
    for (slot, &b) in result.iter_mut().skip(longer.len() - shorter.len()).zip(shorter) {
        *slot = *slot + b;
    }
    result
}

/// Scaled polynomial k p.
pub(crate) fn scaled<S: Scalar>(k: S, p: &[S]) -> Vec<S> {
    p.iter().map(|&a| k * a).collect()
}

/// Shifted polynomial s p.
pub(crate) fn shifted<S: Scalar>(p: &[S]) -> Vec<S> {
    let mut result = p.to_vec();
    result.push(S::from(0.0));
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_sums() {
        assert_eq!(product(&[1.0, 2.0], &[3.0, 4.0, 5.0]), vec![3.0, 10.0, 13.0, 10.0]);
        assert_eq!(sum(&[1.0], &[3.0, 4.0]), vec![3.0, 5.0]);
        assert_eq!(sum(&[3.0, 4.0], &[1.0]), vec![3.0, 5.0]);
        assert_eq!(shifted(&scaled(2.0, &[1.0, 3.0])), vec![2.0, 6.0, 0.0]);
    }
}
