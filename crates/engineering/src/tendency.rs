//! Tendency of one signal of a recording to rise or fall with another.

/// Correlation of two signals of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tendency {
    /// Correlation coefficient r, from -1 to 1.
    pub(crate) correlation: f64,
    /// Number of rows in which both were recorded.
    pub(crate) rows: usize,
}

/// Least |r| of a tendency.
const LEAST: f64 = 0.1;
/// Least |t| of r, in standard deviations.
const SIGNIFICANT: f64 = 5.0;
/// Fewest rows of a tendency.
const FEWEST_ROWS: usize = 10;
/// Least fraction of a signal's variance that deviates from a straight line over time.
const NOT_STRAIGHT: f64 = 0.05;

impl Tendency {
    /// Tendency of two unmodified signals. `None` if one of them does not move, or in too few rows.
    pub(crate) fn of(one: &[f64], other: &[f64]) -> Option<Tendency> {
        let both = recorded(one, other);
        let rows = both.len();
        let mean = |index: usize| both.iter().filter_map(|pair| pair.get(index)).sum::<f64>() / rows as f64;
        Tendency::about(&both, [mean(0), mean(1)])
    }

    /// Tendency about zero instead of the means, for signals whose zero is known.
    pub(crate) fn about_zero(one: &[f64], other: &[f64]) -> Option<Tendency> {
        Tendency::about(&recorded(one, other), [0.0, 0.0])
    }

    fn about(both: &[[f64; 2]], means: [f64; 2]) -> Option<Tendency> {
        let rows = both.len();
        let product = |first: usize, second: usize| -> f64 {
            let off = |pair: &[f64; 2], index: usize| {
                pair.get(index).zip(means.get(index)).map_or(0.0, |(value, mean)| value - mean)
            };
            both.iter().map(|pair| off(pair, first) * off(pair, second)).sum()
        };
        let correlation = product(0, 1) / (product(0, 0) * product(1, 1)).sqrt();
        (rows >= FEWEST_ROWS && correlation.is_finite()).then_some(Tendency { correlation, rows })
    }

    /// Partial correlation, from which a drift of both that is a straight line over time is
    /// removed:
    ///
    /// ```text
    /// r = (r_xy - r_xt r_yt)/sqrt((1 - r_xt^2) (1 - r_yt^2))
    /// ```
    ///
    /// `None` if a signal is little else than such a line.
    pub(crate) fn without_drift(one: &[f64], other: &[f64], times: &[f64]) -> Option<Tendency> {
        let both = Tendency::of(one, other)?;
        let [one, other] = [one, other].map(|signal| Tendency::of(signal, times));
        let (one, other) = (one?.correlation, other?.correlation);
        let [left, other_left] = [one, other].map(|drift| 1.0 - drift * drift);
        let correlation = (both.correlation - one * other) / (left * other_left).sqrt();
        let is_straight = left < NOT_STRAIGHT || other_left < NOT_STRAIGHT;
        (!is_straight).then_some(Tendency { correlation: correlation.clamp(-1.0, 1.0), ..both })
    }

    /// Number of standard deviations by which r differs from zero.
    fn significance(&self) -> f64 {
        let r = self.correlation;
        r * (self.rows.saturating_sub(2) as f64 / (1.0 - r * r).max(f64::EPSILON)).sqrt()
    }

    /// True if one signal falls while the other rises, beyond doubt.
    pub(crate) fn is_opposite(&self) -> bool {
        self.correlation < -LEAST && self.significance() < -SIGNIFICANT
    }

    /// True if both rise together, beyond doubt.
    pub(crate) fn is_alike(&self) -> bool {
        self.correlation > LEAST && self.significance() > SIGNIFICANT
    }
}

/// Rows in which both signals have a value.
fn recorded(one: &[f64], other: &[f64]) -> Vec<[f64; 2]> {
    let both = one.iter().zip(other).map(|(one, other)| [*one, *other]);
    both.filter(|pair| pair.iter().all(|value| value.is_finite())).collect()
}
