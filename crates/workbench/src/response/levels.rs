use phea_dynamics::portable::{argument, log10, magnitude};
use phea_engineering::response::{FALSE_ALARM, LevelComparison, LevelDifference};

use super::Compared;
use crate::answer::{Answer, significant};
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// Rows of a table for people; all of them are in the JSON.
const SHOWN: usize = 16;

/// Comparison of two records at one operating point.
#[derive(Answer)]
pub(super) struct LevelComparisonAnswer {
    /// Name of the operating point.
    operating_point: String,
    /// Paths of both records, that of the smaller input first.
    files: [String; 2],
    /// Root mean squares of both inputs around their means, in SI.
    input_rms: [f64; 2],
    /// Probability that responses of one linear plant are reported as different, over all
    /// comparisons of the operating point.
    false_alarm_probability: f64,
    /// Number of frequencies at which the responses differ by more than noise explains.
    differences: usize,
    /// Comparison at each common frequency, the lowest first.
    frequencies: Vec<LevelDifferenceAnswer>,
    /// Result of the comparison in sentences.
    sentence: String,
}

/// Comparison of two responses at one frequency.
#[derive(Answer)]
struct LevelDifferenceAnswer {
    /// Frequency.
    frequency_rad_per_s: f64,
    /// Magnitude of the response at the larger input over that at the smaller one.
    difference_db: f64,
    /// Phase of the response at the larger input less that at the smaller one, from -180 to 180.
    difference_deg: f64,
    /// Distance between the complex responses, in their unit.
    distance: f64,
    /// Distance that noise explains, in the unit of the responses.
    explained_by_noise: f64,
    /// The distance over the magnitude of the response at the smaller input.
    relative_distance: f64,
    /// The distance that noise explains over the same magnitude.
    relative_explained_by_noise: f64,
    /// True if the distance is larger than noise explains.
    exceeds_noise: bool,
}

/// The comparison as JSON has it.
pub(super) fn compared_levels(comparison: &LevelComparison, found: &[Compared]) -> LevelComparisonAnswer {
    let at = |one: &LevelDifference| {
        let (difference_db, difference_deg) = ratio(one);
        LevelDifferenceAnswer {
            frequency_rad_per_s: one.pair.frequency,
            difference_db,
            difference_deg,
            distance: one.pair.distance(),
            explained_by_noise: one.by_noise,
            relative_distance: relative(one, one.pair.distance()),
            relative_explained_by_noise: relative(one, one.by_noise),
            exceeds_noise: one.is_found(),
        }
    };
    LevelComparisonAnswer {
        operating_point: comparison.operating_point.clone(),
        files: files(comparison, found).map(str::to_string),
        input_rms: comparison.input_rms,
        false_alarm_probability: FALSE_ALARM,
        differences: comparison.frequencies.iter().filter(|one| one.is_found()).count(),
        frequencies: comparison.frequencies.iter().map(at).collect(),
        sentence: sentences(comparison).join(" "),
    }
}

/// A section for each comparison, with the frequencies at which the responses differ.
pub(super) fn document(comparisons: &[LevelComparison], found: &[Compared]) -> Document {
    let mut out = Document::default();
    for comparison in comparisons {
        let [small, large] = files(comparison, found);
        let unit = found.get(comparison.members[0]).map_or("1", |compared| compared.member.units[0]);
        let rms = |value: f64| match unit {
            "1" => format!("{} rms", significant(value, 3)),
            unit => format!("{} {unit} rms", significant(value, 3)),
        };
        let [low, high] = comparison.input_rms.map(rms);
        let title = format!("{}: {large} (input {high}) against {small} ({low})", comparison.operating_point);
        let differences: Vec<&LevelDifference> =
            comparison.frequencies.iter().filter(|one| one.is_found()).collect();
        let every = differences.len().div_ceil(SHOWN).max(1);
        let shown = differences.iter().step_by(every).map(|one| {
            let (decibels, degrees) = ratio(one);
            [
                Cell::number_in(one.pair.frequency, 4, DisplayUnit::HERTZ),
                Cell::number_in(decibels, 3, DisplayUnit::DECIBEL),
                Cell::number_in(degrees, 3, DisplayUnit::IN_DEGREES),
                Cell::number_in(relative(one, one.pair.distance()), 2, DisplayUnit::PERCENT),
                Cell::number_in(relative(one, one.by_noise), 2, DisplayUnit::PERCENT),
            ]
        });
        let headings = [
            "frequency (Hz)",
            "difference (dB)",
            "difference (deg)",
            "distance (%)",
            "explained by noise (%)",
        ];
        match differences.is_empty() {
            true => out.heading(title),
            false => out.section(title, Table::new(headings).with(shown)),
        }
        if every > 1 {
            let all = differences.len();
            out.sentences([format!("One row in {every} is shown; there are {all} differences.")]);
        }
        out.sentences(sentences(comparison));
    }
    out
}

/// Files of a comparison, that of the smaller input first.
fn files<'a>(comparison: &LevelComparison, found: &'a [Compared]) -> [&'a str; 2] {
    comparison.members.map(|index| found.get(index).map_or("", |compared| compared.member.file.as_str()))
}

/// Response at the larger input over that at the smaller one, dB and degrees.
fn ratio(one: &LevelDifference) -> (f64, f64) {
    let [small, large] = one.pair.responses;
    let ratio = large / small;
    (20.0 * log10(magnitude(ratio)), argument(ratio).to_degrees())
}

/// A distance over the magnitude of the response at the smaller input.
fn relative(one: &LevelDifference, distance: f64) -> f64 {
    distance / magnitude(one.pair.responses[0])
}

/// The result of a comparison.
fn sentences(comparison: &LevelComparison) -> Vec<String> {
    let all = comparison.frequencies.len();
    if all == 0 {
        return vec![
            "The records have no frequency in common, and none between two close ones of the other: excite the same frequencies, or record for equally long.".to_string(),
        ];
    }
    let hertz = |one: &LevelDifference| significant(DisplayUnit::HERTZ.of(one.pair.frequency), 3);
    let percent = 100.0 * FALSE_ALARM;
    let differences = || comparison.frequencies.iter().filter(|one| one.is_found());
    let apart = |one: &LevelDifference| relative(one, one.pair.distance());
    let largest = differences().max_by(|one, other| apart(one).total_cmp(&apart(other)));
    let (Some(first), Some(last), Some(largest)) = (differences().next(), differences().next_back(), largest)
    else {
        return vec![format!(
            "At none of the {all} common frequencies do the responses differ by more than noise explains, tested at {percent} % over all of them: a linear plant explains both records. At half of the frequencies, a difference of {} dB would have been found.",
            significant(detectable(comparison), 2)
        )];
    };
    let (decibels, degrees) = ratio(largest);
    let cause = match comparison.has_two_levels() {
        true => {
            "The plant is not linear between these amplitudes, unless it changed between the records: repeat one of them to know."
        }
        false => "The inputs are of one size: the plant changed between the records.",
    };
    let count = differences().count();
    let range = match count {
        1 => String::new(),
        _ => format!(", from {} to {} Hz,", hertz(first), hertz(last)),
    };
    vec![
        format!(
            "At {count} of {all} common frequencies{range} the responses differ by more than noise explains, tested at {percent} % over all of them. The largest difference is {} dB and {} degrees at {} Hz. {cause}",
            significant(decibels, 3),
            significant(degrees, 2),
            hertz(largest),
        ),
        "Both records are members of the family, each with discs of its own. A response between the two, as at an amplitude in between, is a member only where these discs hold it: record such amplitudes too.".to_string(),
    ]
}

/// Median of the differences in magnitude that noise would explain, dB.
fn detectable(comparison: &LevelComparison) -> f64 {
    let by_noise = |one: &LevelDifference| relative(one, one.by_noise);
    let mut sizes: Vec<f64> = comparison.frequencies.iter().map(by_noise).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).map_or(f64::INFINITY, |size| 20.0 * log10(1.0 + size))
}
