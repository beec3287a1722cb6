//! Polynomials whose coefficients are known up to their rounding, and their Routh table.

/// Coefficients, highest power first, each with an error bound. Leading ones may be zero: roots at
/// infinity.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RoundedPolynomial {
    values: Vec<f64>,
    errors: Vec<f64>,
}

/// Test that all roots have negative real parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hurwitz {
    /// All roots have negative real parts.
    Yes,
    /// The polynomial has a root with a non-negative real part, or at infinity.
    No,
    /// The test is undecided because of the errors of the coefficients or the rounding of the
    /// table.
    Undecided,
}

impl RoundedPolynomial {
    /// Exact coefficients.
    pub(super) fn exact(values: &[f64]) -> RoundedPolynomial {
        RoundedPolynomial { values: values.to_vec(), errors: vec![0.0; values.len()] }
    }

    /// Coefficients, each with an error of at most this number of roundings of its scale.
    pub(super) fn rounded(values: &[f64], scales: &[f64], roundings: f64) -> RoundedPolynomial {
        let errors = scales.iter().map(|scale| roundings * f64::EPSILON * scale.abs()).collect();
        RoundedPolynomial { values: values.to_vec(), errors }
    }

    pub(super) fn degree(&self) -> usize {
        self.values.len().saturating_sub(1)
    }

    pub(super) fn times(&self, other: &RoundedPolynomial) -> RoundedPolynomial {
        RoundedPolynomial::sum_of_products(&[(self, other)])
    }

    /// The sum of the products of these pairs.
    pub(super) fn sum_of_products(pairs: &[(&RoundedPolynomial, &RoundedPolynomial)]) -> RoundedPolynomial {
        let degree = pairs.iter().map(|(left, right)| left.degree() + right.degree()).max().unwrap_or(0);
        let (mut values, mut errors) = (vec![0.0; degree + 1], vec![0.0; degree + 1]);
        for (left, right) in pairs {
            let offset = degree - left.degree() - right.degree();
            // each product is rounded once, as is each sum of as many products as overlap, and of
            // two such sums
            let roundings = (left.degree().min(right.degree()) + 4) as f64 * f64::EPSILON;
            for (power, (a, a_error)) in left.values.iter().zip(&left.errors).enumerate() {
                let (slack, size) = (a_error + roundings * a.abs(), a.abs() + a_error);
                let sums = values.iter_mut().zip(errors.iter_mut()).skip(offset + power);
                for ((value, error), (b, b_error)) in sums.zip(right.values.iter().zip(&right.errors)) {
                    *value += a * b;
                    *error += slack * b.abs() + size * b_error;
                }
            }
        }
        RoundedPolynomial { values, errors }
    }

    /// ```text
    /// p((s + a)/(1 + b s)) (1 + b s)^n,       a, b >= 0, n the degree
    /// ```
    pub(super) fn substituted(&self, shift: f64, tilt: f64) -> RoundedPolynomial {
        let roundings = 4.0 * self.values.len() as f64 * f64::EPSILON;
        let widened: Vec<f64> = self
            .values
            .iter()
            .zip(&self.errors)
            .map(|(value, error)| error + roundings * value.abs())
            .collect();
        RoundedPolynomial {
            values: substituted(&self.values, shift, tilt),
            errors: substituted(&widened, shift, tilt),
        }
    }

    /// Routh's table: all roots are in the left half plane if and only if its first column has one
    /// sign.
    ///
    /// ```text
    /// r_0 = c_0, c_2, c_4, ...      r_1 = c_1, c_3, ...      r_(i+1),j = r_(i-1),j+1 - (r_(i-1),0 / r_i,0) r_i,j+1
    /// ```
    ///
    /// Every entry carries an error bound. Scaling s multiplies every entry by a power of the
    /// scale, so no scaling is needed. Source: Routh (1877), as in Gantmacher, The Theory of
    /// Matrices (1959), volume 2, chapter XV.
    pub(super) fn hurwitz(&self) -> Hurwitz {
        let known = |sign: f64| self.values.iter().zip(&self.errors).any(move |(v, e)| sign * v > *e);
        let vanishes = |(value, error): (&f64, &f64)| *value == 0.0 && *error == 0.0;
        if (known(1.0) && known(-1.0)) || self.values.iter().zip(&self.errors).any(vanishes) {
            return Hurwitz::No;
        }
        let sign = if known(-1.0) { -1.0 } else { 1.0 };
        let row = |first: usize| -> Vec<(f64, f64)> {
            let entries = self.values.iter().zip(&self.errors).skip(first).step_by(2);
            entries.map(|(value, error)| (sign * value, *error)).collect()
        };
        let (mut upper, mut lower) = (row(0), row(1));
        while let Some(&(top, top_error)) = upper.first() {
            if top < -top_error {
                return Hurwitz::No;
            }
            // also true of NaN
            if !(top > top_error && top.is_finite()) {
                return Hurwitz::Undecided;
            }
            if let Some(&(pivot, pivot_error)) = lower.first() {
                let ratio = top / pivot;
                let ratio_error = (top_error + ratio.abs() * pivot_error) / (pivot.abs() - pivot_error)
                    + f64::EPSILON * ratio.abs();
                eliminate(&mut upper, &lower, ratio, ratio_error);
            } else {
                upper.clear();
            }
            std::mem::swap(&mut upper, &mut lower);
        }
        Hurwitz::Yes
    }
}

/// Replaces the upper row by the row that follows the lower one.
fn eliminate(upper: &mut Vec<(f64, f64)>, lower: &[(f64, f64)], ratio: f64, ratio_error: f64) {
    let cache = upper.len() - 1;
    for index in 0..cache {
        let (above, above_error) = upper[index + 1];
        let (beside, beside_error) = lower.get(index + 1).copied().unwrap_or((0.0, 0.0));
        let value = above - ratio * beside;
        let rounding = f64::EPSILON * (value.abs() + (ratio * beside).abs());
        let inherited = ratio.abs() * beside_error + ratio_error * (beside.abs() + beside_error);
        upper[index] = (value, above_error + inherited + rounding);
    }
    upper.truncate(cache);
}

/// The sum of c_i (s + a)^(n-i) (1 + b s)^i by Horner's rule.
fn substituted(coefficients: &[f64], shift: f64, tilt: f64) -> Vec<f64> {
    let mut sum: Vec<f64> = Vec::with_capacity(coefficients.len());
    let mut power = Vec::with_capacity(coefficients.len() + 1);
    power.push(1.0);
    for &coefficient in coefficients {
        times_linear(&mut sum, 1.0, shift);
        if sum.is_empty() {
            sum.push(0.0);
        }
        if tilt == 0.0 {
            // (1 + 0 s)^i
            sum.iter_mut().rev().take(1).for_each(|constant| *constant += coefficient);
            continue;
        }
        for (entry, factor) in sum.iter_mut().zip(&power) {
            *entry += coefficient * factor;
        }
        times_linear(&mut power, tilt, 1.0);
    }
    sum
}

/// Multiplies by (slope s + constant).
fn times_linear(polynomial: &mut Vec<f64>, slope: f64, constant: f64) {
    let mut carried = 0.0;
    for entry in polynomial.iter_mut() {
        let value = *entry;
        *entry = slope * value + constant * carried;
        carried = value;
    }
    if !polynomial.is_empty() {
        polynomial.push(constant * carried);
    }
}
