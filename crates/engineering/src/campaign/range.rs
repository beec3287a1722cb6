//! The ranges of the varied numbers, and the draws from them.

use phea_dynamics::{portable, random};

use super::project::{AcceptedRange, DISTRIBUTIONS, Distribution, Key, word_of};
use super::quantity::{self, Dimension, DisplayUnit};

/// A varied number: two ends and a distribution.
///
/// ```text
/// uniform         a + s (b - a)                                            s a share in [0, 1)
/// normal          (a + b)/2 + n (b - a)/4                                  n standard normal: a and b are two deviations away
/// log-uniform     exp(ln a + s (ln b - ln a))
/// triangular      a + (b - a) sqrt(s/2) below the middle, b - (b - a) sqrt((1 - s)/2) above
/// ```
#[derive(Clone, Debug)]
pub struct VariedRange {
    /// Path in the project, or `start.` and a state.
    pub path: String,
    /// Distribution of the draws.
    pub distribution: Distribution,
    /// Minimum, SI.
    pub minimum: f64,
    /// Maximum, SI.
    pub maximum: f64,
    /// The declaration of such a number in the project.
    pub(super) key: Key,
}

impl VariedRange {
    /// Next number from a stream of random numbers.
    pub(super) fn draw(&self, stream: &mut u64) -> f64 {
        let (low, high) = (self.minimum, self.maximum);
        let width = high - low;
        match self.distribution {
            Distribution::Uniform => low + width * random::uniform(stream),
            Distribution::Normal => 0.5 * (low + high) + 0.25 * width * random::normal(stream),
            Distribution::LogUniform => {
                let (from, to) = (portable::ln(low), portable::ln(high));
                portable::exp(from + random::uniform(stream) * (to - from))
            }
            Distribution::Triangular => match random::uniform(stream) {
                fraction if fraction < 0.5 => low + width * (0.5 * fraction).sqrt(),
                fraction => high - width * (0.5 * (1.0 - fraction)).sqrt(),
            },
        }
    }

    /// Reason why the project would not accept this number.
    pub(super) fn problem(&self, value: f64) -> Option<OutsideRange> {
        let Key { range, dimension, .. } = self.key;
        let outside = || OutsideRange { path: self.path.clone(), value, range, dimension };
        (!range.contains(value)).then(outside)
    }

    /// Unit for display of numbers of this range.
    pub fn unit(&self) -> DisplayUnit {
        quantity::fitting(self.minimum.abs().max(self.maximum.abs()), self.key.dimension)
    }

    /// Unit of its numbers in SI; empty for a pure number.
    pub fn si_unit(&self) -> &'static str {
        self.key.dimension.si_unit()
    }

    /// Word of the distribution, as in a project file.
    pub fn distribution_word(&self) -> &'static str {
        word_of(&DISTRIBUTIONS, &self.distribution)
    }
}

/// A number that the project would not accept.
#[derive(Debug, thiserror::Error)]
#[error("{path} = {} is outside its range ({})", quantity::display(*value, dimension, 6), ends(range, dimension))]
pub(super) struct OutsideRange {
    path: String,
    value: f64,
    range: AcceptedRange,
    dimension: &'static Dimension,
}

/// Ends of a range, as stated.
fn ends(range: &AcceptedRange, dimension: &Dimension) -> String {
    let show = |value: f64| quantity::display(value, dimension, 6);
    let low = if range.above_minimum { "above" } else { "at least" };
    let high = if range.below_maximum { "below" } else { "at most" };
    let ends = [
        (range.minimum > f64::MIN).then(|| format!("{low} {}", show(range.minimum))),
        (range.maximum < f64::MAX).then(|| format!("{high} {}", show(range.maximum))),
    ];
    ends.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

#[cfg(test)]
mod tests {
    use super::super::quantity::{PRESSURE, RATIO, VOLUME};
    use super::*;

    fn key(dimension: &'static Dimension, range: AcceptedRange) -> Key {
        Key {
            name: "a",
            dimension,
            range,
            usual: None,
            default: None,
            of_motion: false,
            of_load: false,
            doc: "",
        }
    }

    fn range(distribution: Distribution, minimum: f64, maximum: f64) -> VariedRange {
        VariedRange {
            path: "a".to_string(),
            distribution,
            minimum,
            maximum,
            key: key(&RATIO, AcceptedRange::ANY),
        }
    }

    /// Mean and variance of each distribution over a hundred thousand draws, within five standard
    /// errors.
    #[test]
    fn draws_have_the_moments_of_their_distribution() {
        // ORIGIN: analytic, width 2: 2^2/12, (2/4)^2, 2^2/24; of ln a in [0, ln 100]: (ln 100)^2/12
        let logarithm = portable::ln(100.0);
        let cases = [
            (Distribution::Uniform, [3.0, 5.0], 4.0, 4.0 / 12.0),
            (Distribution::Normal, [3.0, 5.0], 4.0, 0.25),
            (Distribution::Triangular, [3.0, 5.0], 4.0, 4.0 / 24.0),
            (Distribution::LogUniform, [1.0, 100.0], 0.5 * logarithm, logarithm * logarithm / 12.0),
        ];
        for (distribution, [low, high], mean, variance) in cases {
            let range = range(distribution, low, high);
            let count = 100_000_u32;
            let values: Vec<f64> = (0..count)
                .map(|index| range.draw(&mut random::stream(3, u64::from(index))))
                .map(
                    |value| {
                        if distribution == Distribution::LogUniform { portable::ln(value) } else { value }
                    },
                )
                .collect();
            let found = values.iter().sum::<f64>() / f64::from(count);
            let spread =
                values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / f64::from(count);
            let error = 5.0 / f64::from(count).sqrt();
            assert!((found - mean).abs() < error * variance.sqrt(), "{distribution:?}: mean {found}");
            assert!((spread / variance - 1.0).abs() < error * 2.0_f64.sqrt(), "{distribution:?}: {spread}");
        }
    }

    #[test]
    fn what_the_project_would_not_accept_is_a_problem() {
        let positive = AcceptedRange { minimum: 0.0, above_minimum: true, ..AcceptedRange::ANY };
        let mass = VariedRange { key: key(&RATIO, positive), ..range(Distribution::Normal, -1.0, 3.0) };
        let told = |range: &VariedRange, value: f64| range.problem(value).map(|outside| outside.to_string());
        assert_eq!(told(&mass, 0.5), None);
        assert_eq!(told(&mass, -0.5), Some("a = -0.5 is outside its range (above 0)".to_string()));
        let between =
            AcceptedRange { minimum: -1e5, maximum: 1e8, below_maximum: true, ..AcceptedRange::ANY };
        let pressure = VariedRange { key: key(&PRESSURE, between), ..range(Distribution::Normal, -1e6, 3e6) };
        let expected = "a = -46.5 bar is outside its range (at least -1 bar and below 1000 bar)";
        assert_eq!(told(&pressure, -4.65e6), Some(expected.to_string()));
    }

    #[test]
    fn a_range_is_shown_in_the_unit_of_its_larger_end() {
        let of = |dimension, minimum, maximum| {
            let key = key(dimension, AcceptedRange::ANY);
            let unit = VariedRange { key, ..range(Distribution::Uniform, minimum, maximum) }.unit();
            (unit.symbol, unit.number(maximum, 3))
        };
        assert_eq!(of(&PRESSURE, 0.0, 8.4e6), ("bar", "84.0".to_string()));
        assert_eq!(of(&VOLUME, 1.52e-4, 2.28e-4), ("mL", "228".to_string()));
        assert_eq!(of(&RATIO, 0.1, 0.2), ("1", "0.200".to_string()));
    }
}
