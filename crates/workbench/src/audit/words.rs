//! Evidence, requirements and findings in words.

use phea_dynamics::portable;
use phea_engineering::audit::{LimitSide, ProjectAudit, ReachedLimit};
use phea_qft::specification::{ClosedLoop, Requirement};
use phea_qft::verification::{Evidence, SpecificationFinding, SpecificationMargin, Verdict};

use crate::answer::words;
use crate::document::margin_words;
use crate::quantity::{RATIO, display, significant};
use crate::verdict_words::frequency_words;

words! {
    /// Evidence for a verdict: plants and frequencies one by one, a search for the worst case over
    /// the box and the band, or a proof for every plant and frequency.
    Evidence by evidence_key [Grid, Search, Proof]
}

/// The word of the evidence in JSON.
pub(super) fn evidence_key(evidence: Evidence) -> &'static str {
    match evidence {
        Evidence::Grid => "grid",
        Evidence::Search => "search",
        Evidence::Proof => "proof",
    }
}

/// The evidence for the limits over frequency, in a sentence, and for the steps if they are part of
/// the verdict.
pub(crate) fn evidence_sentence(view: &ProjectAudit) -> String {
    let (evidence, verdict) = (view.audit.evidence, view.audit.verdict);
    let over_frequency = limits_sentence(evidence, verdict, view.names.headings().is_empty());
    match view.evidence() {
        Evidence::Search if evidence == Evidence::Proof => {
            format!(
                "Over frequency: {over_frequency} The steps in time were searched for; a search is not a proof."
            )
        }
        _ => over_frequency.to_string(),
    }
}

fn limits_sentence(evidence: Evidence, verdict: Verdict, one_plant: bool) -> &'static str {
    match evidence {
        Evidence::Proof if verdict == Verdict::Violated => {
            "Refuted by a plant of the box and a frequency of the band, which can be checked again."
        }
        Evidence::Search if one_plant => {
            "The plant was examined over the whole band, also between the frequencies of any grid; a search is not a proof."
        }
        Evidence::Grid => {
            "The plants of the family were examined one by one; nothing is claimed between them."
        }
        Evidence::Search => {
            "The worst case was searched for over the whole parameter box and band, not only on the grid; a search is not a proof."
        }
        Evidence::Proof => "Proven for every plant of the box and every frequency of the band.",
    }
}

/// The closed loop that a kind limits.
pub(crate) fn closed_loop_symbol(requirement: &Requirement) -> &'static str {
    match requirement.closed_loop() {
        ClosedLoop::RobustStability => "|L/(1+L)|",
        ClosedLoop::Sensitivity => "|1/(1+L)|",
        ClosedLoop::PlantInputDisturbance => "|P/(1+L)|",
        ClosedLoop::ControlEffort => "|G/(1+L)|",
        ClosedLoop::LoadMotion => "|Pd/(1+L)|",
        ClosedLoop::Tracking => "|F L/(1+L)|",
    }
}

/// The worst margin among the design frequencies.
pub(super) fn worst_at_design(finding: &SpecificationFinding) -> Option<&SpecificationMargin> {
    finding.at_design_frequencies.iter().min_by(|a, b| a.margin_db.total_cmp(&b.margin_db))
}

/// A sentence on a specification: its requirement, its verdict, and the place where it is worst;
/// for a stable family with the tolerance within which a margin counts as met.
pub(super) fn finding_sentence(
    name: &str,
    finding: &SpecificationFinding,
    reached: Option<&ReachedLimit>,
    stable_within_db: Option<f64>,
) -> String {
    let Some(worst) = &finding.worst else {
        return match finding.verdict {
            Verdict::Violated => format!("{name} is violated: an unstable loop satisfies no specification"),
            _ => format!("{name}: nothing could be judged"),
        };
    };
    let place = place_words(worst.frequency_rad_per_s);
    let size = significant(worst.margin_db.abs(), 3);
    let symbol = closed_loop_symbol(&finding.requirement);
    let reached = reached.map_or(String::new(), |reached| reached_words(symbol, reached));
    match finding.verdict {
        Verdict::Violated => {
            let hidden = match worst_at_design(finding) {
                Some(design) if stable_within_db.is_some_and(|room| design.margin_db >= -room) => {
                    "; at the design frequencies alone it would have passed"
                }
                _ => "",
            };
            format!("{name} is violated by {size} dB {place}{reached}{hidden}")
        }
        Verdict::Met if worst.margin_db < 5e-4 => format!("{name} is only just met, {place}"),
        Verdict::Met => format!("{name} is met, with {size} dB to spare {place}"),
        Verdict::NotProven => {
            format!("{name} is not proven; worst margin found {} {place}", margin_words(worst.margin_db))
        }
    }
}

/// `: |L/(1+L)| reaches 11.89, limit 1.3`
fn reached_words(symbol: &str, reached: &ReachedLimit) -> String {
    let (magnitude, limit) = (significant(reached.magnitude, 4), display(reached.limit, &RATIO, 4));
    match reached.side {
        LimitSide::Only => format!(": {symbol} reaches {magnitude}, limit {limit}"),
        LimitSide::Upper => format!(": {symbol} reaches {magnitude}, upper limit {limit}"),
        LimitSide::Lower => format!(": {symbol} falls to {magnitude}, lower limit {limit}"),
    }
}

/// Words of [`frequency_words`], with the frequency in Hz in addition.
pub(super) fn place_words(frequency_rad_per_s: f64) -> String {
    let words = frequency_words(frequency_rad_per_s);
    if !(frequency_rad_per_s > 0.0 && frequency_rad_per_s.is_finite()) {
        return words;
    }
    format!("{words} ({} Hz)", significant(frequency_rad_per_s / std::f64::consts::TAU, 3))
}

/// The meaning of a kind for the user of the machine.
pub(crate) fn meaning(requirement: &Requirement) -> &'static str {
    match requirement.closed_loop() {
        ClosedLoop::RobustStability => "no resonance of the closed loop above the limit",
        ClosedLoop::Sensitivity => "disturbances of the output are suppressed",
        ClosedLoop::PlantInputDisturbance => "disturbances at the input of the plant are suppressed",
        ClosedLoop::ControlEffort => "the plant is not driven harder than allowed",
        ClosedLoop::LoadMotion => "motion of the load disturbs the output no more than allowed",
        ClosedLoop::Tracking => "the output follows its reference within its limits",
    }
}

/// A number rounded to four significant digits, for a reader.
pub(super) fn rounded(value: f64) -> f64 {
    portable::rounded(value, 4)
}
