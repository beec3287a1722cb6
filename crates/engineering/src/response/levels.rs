use phea_dynamics::spectrum::{ResponsePair, pairs};

use super::ResponseMember;

/// Probability that a linear plant is reported as not linear, over all comparisons of an operating
/// point at once.
pub const FALSE_ALARM: f64 = 0.05;

/// Ratio of two inputs above which their amplitudes count as different.
const SAME_AMPLITUDE: f64 = 1.1;

/// Two records at one operating point, compared frequency by frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelComparison {
    /// Name of the operating point in the project.
    pub operating_point: String,
    /// Indices of the members, the one with the smaller input first.
    pub members: [usize; 2],
    /// Root mean squares of their inputs, SI.
    pub input_rms: [f64; 2],
    /// Common frequencies, the lowest first.
    pub frequencies: Vec<LevelDifference>,
}

/// The responses of two records at a frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelDifference {
    /// Both responses, that of the smaller input first.
    pub pair: ResponsePair,
    /// Distance that noise explains, in the unit of the responses.
    pub by_noise: f64,
}

impl LevelDifference {
    /// True if noise does not explain the distance.
    pub fn is_found(&self) -> bool {
        self.pair.distance() > self.by_noise
    }
}

impl LevelComparison {
    /// True if the inputs differ in amplitude, so that a difference may be due to it.
    pub fn has_two_levels(&self) -> bool {
        self.input_rms[1] > SAME_AMPLITUDE * self.input_rms[0]
    }
}

/// Compares all pairs of records at one operating point.
///
/// ```text
/// |G_1 - G_2|^2 > F(2, 2 q) (sigma_1^2 + sigma_2^2) at p = 0.05/m
/// ```
///
/// where m is the number of comparisons at this operating point, over all frequencies and pairs of
/// records (Bonferroni): a linear plant that did not change is reported in at most 5 % of cases.
pub fn compare_levels(members: &[ResponseMember]) -> Vec<LevelComparison> {
    let mut comparisons: Vec<LevelComparison> = Vec::new();
    for (index, member) in members.iter().enumerate() {
        let earlier = members.iter().enumerate().take(index);
        comparisons
            .extend(earlier.filter_map(|(before, other)| comparison([before, index], [other, member])));
    }
    let counts: Vec<usize> =
        comparisons.iter().map(|one| count_of(&comparisons, &one.operating_point)).collect();
    for (comparison, count) in comparisons.iter_mut().zip(counts) {
        let probability = FALSE_ALARM / count.max(1) as f64;
        for one in &mut comparison.frequencies {
            one.by_noise = one.pair.distance_by_chance(probability);
        }
    }
    comparisons
}

/// Number of comparisons at an operating point.
fn count_of(comparisons: &[LevelComparison], operating_point: &str) -> usize {
    let at_point = comparisons.iter().filter(|one| one.operating_point == operating_point);
    at_point.map(|one| one.frequencies.len()).sum()
}

/// Comparison of two members at one operating point, with equal signals.
fn comparison(indices: [usize; 2], members: [&ResponseMember; 2]) -> Option<LevelComparison> {
    let [one, other] = members;
    let operating_point = one.operating_point.clone()?;
    if other.operating_point.as_ref() != Some(&operating_point) || one.signals != other.signals {
        return None;
    }
    let is_smaller_first = one.input_rms <= other.input_rms;
    let ([first, second], [small, large]) = match is_smaller_first {
        true => (indices, members),
        false => ([indices[1], indices[0]], [other, one]),
    };
    let pairs = pairs(&small.points, &large.points);
    let frequencies = pairs.into_iter().map(|pair| LevelDifference { pair, by_noise: f64::INFINITY });
    Some(LevelComparison {
        operating_point,
        members: [first, second],
        input_rms: [small.input_rms, large.input_rms],
        frequencies: frequencies.collect(),
    })
}
