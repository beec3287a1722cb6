use phea_dynamics::portable;
use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

/// Number of terms of a [`ChebyshevSeries`].
pub(super) const TERMS: usize = 32;

/// Smooth function of one variable as a polynomial, without branches.
///
/// ```text
/// f(u) = sum over k of c_k t^k,   t = (u - u_0)/w                     k = 0 to TERMS - 1
/// ```
///
/// The polynomial is found in Chebyshev polynomials and stored in powers, in which intervals stay
/// narrow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChebyshevSeries<S = f64> {
    /// Coefficients c_k, the lowest first.
    pub(super) coefficients: [S; TERMS],
    /// Middle u_0.
    pub(super) middle: S,
    /// Half width w.
    pub(super) half_width: S,
}

impl ChebyshevSeries {
    /// Polynomial with the values of this function at the zeros of T_n in `range`, n being the
    /// number of terms.
    pub(super) fn through<E>(
        [from, to]: [f64; 2],
        of: impl Fn(f64) -> Result<f64, E>,
    ) -> Result<ChebyshevSeries, E> {
        let (middle, half_width) = (0.5 * (from + to), 0.5 * (to - from));
        let angle = |node: usize| std::f64::consts::PI * (node as f64 + 0.5) / TERMS as f64;
        let mut values = [0.0; TERMS];
        for (node, value) in values.iter_mut().enumerate() {
            *value = of(middle + half_width * portable::cos(angle(node)))?;
        }
        let mut coefficients = [0.0; TERMS];
        for (order, coefficient) in coefficients.iter_mut().enumerate() {
            let terms = values.iter().enumerate();
            let sum: f64 = terms.map(|(node, value)| value * portable::cos(order as f64 * angle(node))).sum();
            *coefficient = if order == 0 { sum } else { 2.0 * sum } / TERMS as f64;
        }
        Ok(ChebyshevSeries { coefficients: in_powers(&coefficients), middle, half_width })
    }
}

/// Sum of Chebyshev polynomials in powers of its variable, the lowest first.
///
/// ```text
/// T_0 = 1,   T_1 = t,   T_k+1 = 2 t T_k - T_k-1
/// ```
pub(super) fn in_powers(of_chebyshev: &[f64; TERMS]) -> [f64; TERMS] {
    let (mut before, mut here) = ([0.0; TERMS], [0.0; TERMS]);
    before[0] = 1.0;
    here[1] = 1.0;
    let mut powers = [0.0; TERMS];
    for coefficient in of_chebyshev {
        let mut after = [0.0; TERMS];
        for power in 0..TERMS {
            powers[power] += coefficient * before[power];
            let shifted = if power == 0 { 0.0 } else { 2.0 * here[power - 1] };
            after[power] = shifted - before[power];
        }
        (before, here) = (here, after);
    }
    powers
}

phea_dynamics::parameters! { ChebyshevSeries { coefficients, middle, half_width } }

impl<S: Scalar> ChebyshevSeries<S> {
    /// Value, first and second derivative at u, by Horner's rule and its derivatives.
    #[inline(always)]
    pub(super) fn at(&self, u: S) -> [S; 3] {
        let zero = S::from(0.0);
        let t = (u - self.middle) / self.half_width;
        let (mut value, mut slope, mut half_curvature) = (zero, zero, zero);
        for coefficient in self.coefficients.iter().rev() {
            half_curvature = half_curvature * t + slope;
            slope = slope * t + value;
            value = value * t + *coefficient;
        }
        let curvature = S::from(2.0) * half_curvature / self.half_width.squared();
        [value, slope / self.half_width, curvature]
    }
}

/// Value and first two derivatives.
impl<S: Scalar> LocalFunction<S, 1, 3> for ChebyshevSeries<S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [u]: [T; 1], constant: impl Fn(S) -> T + Copy) -> [T; 3] {
        self.convert(&mut |parameter| constant(parameter)).at(u)
    }
}
