//! Roots of polynomials: many decades, clusters, multiplicity, symmetry, refusals.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial};
use phea_dynamics::portable::{cos, magnitude, pow, sin};

fn real(value: f64) -> Complex64 {
    Complex64::new(value, 0.0)
}

/// Seeded numbers in [0, 1): splitmix64.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Largest distance from a true root to the nearest found one, relative to the root, each found
/// root used once.
fn worst_error(found: &[Complex64], truth: &[Complex64]) -> f64 {
    assert_eq!(found.len(), truth.len());
    let mut open = found.to_vec();
    let mut worst = 0.0_f64;
    for root in truth {
        let distances = open.iter().map(|candidate| magnitude(candidate - root)).enumerate();
        let (index, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        open.remove(index);
        worst = worst.max(if distance == 0.0 { 0.0 } else { distance / magnitude(*root) });
    }
    worst
}

fn check(truth: &[Complex64], tolerance: f64) {
    let polynomial = Polynomial::from_roots(3.0, truth).unwrap();
    let found = polynomial.roots().unwrap();
    let error = worst_error(&found, truth);
    assert!(error <= tolerance, "error {error:e} for {truth:?}, found {found:?}");
    for root in &found {
        assert!(found.contains(&root.conj()), "{root} has no exact conjugate");
    }
}

#[test]
fn one_root_a_decade_over_ten_decades() {
    let truth: Vec<Complex64> = (-3..=6).map(|decade| real(-pow(10.0, f64::from(decade)))).collect();
    check(&truth, 1e-15);
}

#[test]
fn degree_twelve_mixed_over_nine_decades() {
    let mut truth = vec![real(-1e-3), real(-1.0), real(-1e4), real(-1e6)];
    for (re, im) in [(-0.02, 0.03), (-50.0, 2.0), (-12.0, 2938.0), (-3e4, 1e5)] {
        truth.extend([Complex64::new(re, im), Complex64::new(re, -im)]);
    }
    check(&truth, 1e-14);
}

#[test]
fn damping_of_the_hydraulic_poles_survives() {
    // ORIGIN: thesis Table 6.1, K_H = 1.5e7 N/m: the real part of the mechanical pair is 1/250 of
    // its magnitude
    let truth = [real(-2.96), real(-0.0341), Complex64::new(-11.64, 2938.0), Complex64::new(-989.1, 479.0)];
    let all: Vec<Complex64> = truth
        .iter()
        .flat_map(|root| if root.im == 0.0 { vec![*root] } else { vec![*root, root.conj()] })
        .collect();
    let found = Polynomial::from_roots(1.0, &all).unwrap().roots().unwrap();
    let mechanical = found.iter().find(|root| root.im > 2000.0).unwrap();
    assert!((mechanical.re + 11.64).abs() < 1e-12 * 2938.0);
}

#[test]
fn random_sets_over_nine_decades() {
    let mut seeded = Seeded(1);
    for _ in 0..300 {
        let count = 2 + (seeded.next() * 5.0).floor() as usize;
        let mut truth = Vec::new();
        for slot in 0..count {
            // slots are disjoint in magnitude, so that conditioning comes only from the spread
            let size = pow(10.0, -3.0 + 9.0 * (slot as f64 + 0.7 * seeded.next()) / count as f64);
            if seeded.next() < 0.5 {
                truth.push(real(if seeded.next() < 0.8 { -size } else { size }));
            } else {
                let angle = std::f64::consts::PI * (0.1 + 0.85 * seeded.next());
                let root = Complex64::new(size * cos(angle), size * sin(angle));
                truth.extend([root, root.conj()]);
            }
        }
        check(&truth, 1e-9);
    }
}

#[test]
fn wilkinson_like_spread() {
    // ORIGIN: analytic. Degree 12 is the last of the family whose roots are conditioned below 1e9.
    let truth: Vec<Complex64> = (1..=12).map(|k| real(-f64::from(k))).collect();
    check(&truth, 1e-15);
    // degree 20: every coefficient is rounded, and the roots of the rounded polynomial are those
    // found.
    // ORIGIN: other tool (mpmath with 60 digits on the same rounded coefficients)
    let truth: Vec<Complex64> = (1..=20).map(|k| real(-f64::from(k))).collect();
    let found = Polynomial::from_roots(1.0, &truth).unwrap().roots().unwrap();
    assert!((found[19].re + 20.000_000_22).abs() < 1e-8, "{}", found[19]);
    assert!((found[14].re + 14.999_626_58).abs() < 1e-8, "{}", found[14]);
}

#[test]
fn multiple_roots_come_out_as_such() {
    let pair = Complex64::new(-0.3, 0.7);
    let truth =
        [real(0.0), real(0.0), real(-1.0), real(-1.0), real(-1.0), pair, pair, pair.conj(), pair.conj()];
    let found = Polynomial::from_roots(2.0, &truth).unwrap().roots().unwrap();
    assert!(worst_error(&found, &truth) < 1e-13);
    // exactly multiple, not nearly
    assert_eq!(found[0], real(0.0));
    assert_eq!(found[1], real(0.0));
    assert_eq!(found.iter().filter(|root| **root == found[8]).count(), 3);
    assert_eq!(found.iter().filter(|root| **root == found[2]).count(), 2);
}

#[test]
fn a_double_root_far_from_the_others() {
    let truth = [real(-1e-3), real(-1e-3), real(-250.0), real(-250.0), real(-1e6)];
    check(&truth, 1e-13);
    // critically damped: b^2 = 4 c, where rounding must not make a pair of it
    let found = Polynomial::new(vec![1.0, 0.2, 0.01]).roots().unwrap();
    assert_eq!(found, [found[0], found[0]]);
    assert!((found[0].re + 0.1).abs() < 1e-16 && found[0].im == 0.0);
}

#[test]
fn distinguishable_roots_are_separated() {
    let truth = [real(-1.0), real(-1.0 - 1e-6)];
    let found = Polynomial::from_roots(1.0, &truth).unwrap().roots().unwrap();
    assert!(worst_error(&found, &truth) < 1e-9, "{found:?}");
    let truth = [Complex64::new(-1.0, 1e-6), Complex64::new(-1.0, -1e-6)];
    let found = Polynomial::from_roots(1.0, &truth).unwrap().roots().unwrap();
    assert!(worst_error(&found, &truth) < 1e-9, "{found:?}");
}

#[test]
fn roots_on_the_axes_remain_there() {
    let undamped = Polynomial::new(vec![1.0, 0.0, 25.0, 0.0, 144.0]).roots().unwrap(); // (s^2 + 9)(s^2 + 16)
    for (root, frequency) in undamped.iter().zip([3.0, 3.0, 4.0, 4.0]) {
        assert!(root.re == 0.0 && (root.im.abs() - frequency).abs() < 1e-15, "{root}");
    }
    let unity = Polynomial::new(vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).roots().unwrap();
    assert!(unity.iter().all(|root| (magnitude(*root) - 1.0).abs() < 4e-16));
}

#[test]
fn coefficients_far_from_one() {
    let truth = [real(-1e-3), Complex64::new(-2.0, 5.0), Complex64::new(-2.0, -5.0), real(-1e6)];
    for gain in [1e-200, 1e200] {
        let found = Polynomial::from_roots(gain, &truth).unwrap().roots().unwrap();
        assert!(worst_error(&found, &truth) < 1e-14);
    }
    let tiny_and_huge = [real(-1e-60), real(-1e60)];
    let found = Polynomial::from_roots(1.0, &tiny_and_huge).unwrap().roots().unwrap();
    assert!(worst_error(&found, &tiny_and_huge) < 1e-15);
}

#[test]
fn degenerate_polynomials() {
    assert_eq!(Polynomial::new(vec![0.0, 0.0]).roots(), Err(LinearError::ZeroPolynomial));
    assert_eq!(Polynomial::new(vec![]).roots(), Err(LinearError::ZeroPolynomial));
    assert_eq!(Polynomial::new(vec![5.0]).roots(), Ok(vec![]));
    assert_eq!(Polynomial::new(vec![0.0, 2.0, 1.0]).roots(), Ok(vec![real(-0.5)]));
    assert_eq!(Polynomial::new(vec![3.0, 0.0, 0.0]).roots(), Ok(vec![real(0.0), real(0.0)]));
    assert!(matches!(Polynomial::new(vec![1.0, f64::NAN]).roots(), Err(LinearError::NotFinite { .. })));
    assert!(matches!(Polynomial::new(vec![f64::INFINITY, 1.0]).roots(), Err(LinearError::NotFinite { .. })));
    let unpaired = Complex64::new(-1.0, 2.0);
    let refused = Polynomial::from_roots(1.0, &[unpaired]);
    assert_eq!(refused, Err(LinearError::MissingConjugate { root: unpaired }));
}

#[test]
fn random_coefficients_over_twenty_decades() {
    // a result whose residual is at the rounding level of the coefficients
    let mut seeded = Seeded(7);
    for _ in 0..2000 {
        let degree = (seeded.next() * 14.0).floor() as usize;
        let coefficients: Vec<f64> = (0..=degree)
            .map(|_| {
                let size = pow(10.0, (seeded.next() - 0.5) * 20.0);
                let value = (seeded.next() - 0.5) * size;
                if seeded.next() < 0.1 { 0.0 } else { value }
            })
            .collect();
        let polynomial = Polynomial::new(coefficients);
        if polynomial.is_zero() {
            continue;
        }
        let roots = polynomial.roots().unwrap();
        assert_eq!(roots.len(), polynomial.degree());
        for root in roots {
            let size = magnitude(root);
            let scale = polynomial.coefficients().iter().fold(0.0, |sum, c| sum * size + c.abs());
            assert!(magnitude(polynomial.evaluate(root)) <= 1e-13 * scale, "{root} of {polynomial:?}");
        }
    }
}

#[test]
fn algebra() {
    let (p, q) = (Polynomial::new(vec![1.0, 2.0]), Polynomial::new(vec![1.0, -2.0]));
    assert_eq!(p.product(&q).coefficients(), [1.0, 0.0, -4.0]);
    assert_eq!(p.sum(&q).coefficients(), [2.0, 0.0]);
    assert_eq!(p.sum(&q.scaled(-1.0)).coefficients(), [4.0]);
    assert_eq!(Polynomial::new(vec![2.0, 3.0, 4.0, 5.0]).derivative().coefficients(), [6.0, 6.0, 4.0]);
    assert_eq!(Polynomial::new(vec![7.0]).derivative().coefficients(), [0.0]);
    assert_eq!(p.product(&q).evaluate(Complex64::new(0.0, 2.0)), Complex64::new(-8.0, 0.0));
}

/// Roots from nearby points equal roots from unknown starts, if they are found: for random
/// polynomials with or without an integrator, whose coefficients change by up to a tenth.
#[test]
fn roots_from_a_near_start_equal_those_from_scratch() {
    let mut seeded = Seeded(11);
    let (mut found, mut all) = (0, 0);
    for case in 0..200 {
        let mut within = |low: f64, high: f64| low * pow(high / low, seeded.next());
        let mut polynomial = Polynomial::new(if case % 3 == 0 { vec![1.0, 0.0] } else { vec![1.0] });
        for _ in 0..1 + case % 5 {
            let size = within(0.1, 3000.0);
            let factor = match case % 2 {
                0 => vec![1.0 / (size * size), 2.0 * within(0.01, 0.9) / size, 1.0],
                _ => vec![1.0 / size, 1.0],
            };
            polynomial = polynomial.product(&Polynomial::new(factor));
        }
        let moved = polynomial.coefficients().iter().map(|one| one * within(0.95, 1.05)).collect();
        let (from, moved) = (polynomial.roots().unwrap(), Polynomial::new(moved));
        let expected = moved.roots().unwrap();
        all += 1;
        let Some(near) = moved.roots_near(&from) else { continue };
        found += 1;
        for (one, other) in near.iter().zip(&expected) {
            let distance = magnitude(one - other);
            assert!(distance <= 1e-13 * magnitude(*other), "case {case}: {one} is not {other}");
        }
    }
    assert!(found > 150, "{found} of {all}");
}
