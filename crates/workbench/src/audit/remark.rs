//! The omissions of the verdict on a specification, in words.

use phea_engineering::plant_names::PlantNames;
use phea_qft::verification::{PlantPoint, Remark, SpecificationFinding};

use super::words::rounded;
use crate::plant_names::plant_text;

/// The remarks of a finding, each a sentence.
pub(super) fn remark_sentences(finding: &SpecificationFinding, names: &PlantNames) -> Vec<String> {
    finding.remarks.iter().map(|remark| sentence(remark, finding, names)).collect()
}

fn sentence(remark: &Remark, finding: &SpecificationFinding, names: &PlantNames) -> String {
    match remark {
        Remark::BandEndsAtNyquist { nyquist_rad_per_s } => format!(
            "a sampled loop has no frequencies above pi/T = {} rad/s: the band ends there",
            rounded(*nyquist_rad_per_s)
        ),
        Remark::TableEnds { table_rad_per_s } => {
            let [low, high] = table_rad_per_s.map(rounded);
            format!("the table reaches from {low} to {high} rad/s: nothing is demanded beyond it")
        }
        Remark::ZeroAtNyquist { nyquist_rad_per_s } => format!(
            "at pi/T = {} rad/s prefilter or controller have a zero, so that no lower limit can be met there: end `band` below it",
            rounded(*nyquist_rad_per_s)
        ),
        Remark::NothingDemanded => "nothing is demanded within the band".to_string(),
        Remark::DesignFrequencyOutside { frequency_rad_per_s } => {
            format!("the design frequency {frequency_rad_per_s} rad/s lies outside of the band")
        }
        Remark::JudgedBySpread => spread(finding, names),
        Remark::Interpolated => {
            "measured plants: between two frequencies of the measurement the response is interpolated"
                .to_string()
        }
        Remark::WorstWithinDiscs => {
            "the margin is that of the worst plant within the discs that hold all measured responses of a file with 95 %".to_string()
        }
        Remark::OpenWithinDiscs { certain_margin_db } => format!(
            "the measurement leaves it open: of the plants within the discs that hold all measured responses of a file with 95 % the worst violates it, and nothing shows that all do (margin {certain_margin_db:.3} dB at the least for the best of them)"
        ),
        Remark::BeyondMeasurements { measured_rad_per_s } => {
            let [from, to] = measured_rad_per_s.map(rounded);
            format!("the measurements reach from {from} to {to} rad/s: nothing is known beyond")
        }
        Remark::NotSampled { frequency_rad_per_s } => {
            without_response(*frequency_rad_per_s, "a plant that cannot be sampled")
        }
        Remark::NoResponse { frequency_rad_per_s, plant } => {
            let plant = plant.as_ref().map_or("a plant".to_string(), |plant| named(names, plant));
            without_response(*frequency_rad_per_s, &plant)
        }
        Remark::UndefinedInBox { frequency_rad_per_s } => {
            let frequency = rounded(*frequency_rad_per_s);
            format!("inside the box there is a plant that cannot be judged at {frequency} rad/s")
        }
        Remark::Unstable => "the loop is unstable, so that it has no margin".to_string(),
        Remark::StabilityNotKnown => {
            "the loop is not known to be stable: its margins may not describe any response".to_string()
        }
    }
}

fn without_response(frequency_rad_per_s: f64, plant: &str) -> String {
    format!("at {} rad/s {plant} has no response that could be judged", rounded(frequency_rad_per_s))
}

/// The plants that determine the spread.
fn spread(finding: &SpecificationFinding, names: &PlantNames) -> String {
    let judged = "judged by its spread, without a prefilter";
    let worst = finding.worst.as_ref().and_then(|worst| Some((worst, worst.other.as_ref()?)));
    let Some((worst, other)) = worst else { return judged.to_string() };
    let place = match worst.frequency_rad_per_s {
        f64::INFINITY => "towards infinite frequency".to_string(),
        frequency => format!("at {} rad/s", rounded(frequency)),
    };
    let (greatest, least) = (named(names, &worst.plant), named(names, other));
    format!("{judged}: {place} {greatest} has the greatest |T|, {least} the least")
}

/// A plant by its parameters in SI units, or its name.
fn named(names: &PlantNames, plant: &PlantPoint) -> String {
    match (names, names.numbers(plant)) {
        (_, Some(numbers)) => {
            let parameters: Vec<String> =
                numbers.map(|(name, _, value)| format!("{name} = {}", rounded(value))).collect();
            format!("the plant with {}", parameters.join(", "))
        }
        (PlantNames::Measured(_), None) if matches!(plant, PlantPoint::Measured(_)) => {
            format!("the measured plant {}", plant_text(names, plant))
        }
        _ => "the plant".to_string(),
    }
}
