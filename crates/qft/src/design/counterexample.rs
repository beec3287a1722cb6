//! Counterexamples from an audit: plants and frequencies that the search had not evaluated.

use phea_dynamics::portable;

use crate::loop_shaping::DesignProblem;
use crate::specification::ClosedLoop;
use crate::verification::{
    Audit, DelayMargin, PlantPoint, SpecificationFinding, SpecificationMargin, TrackingJudgement, Verdict,
};

/// A plant, or the pair of a spread, and the frequency at which it violates a limit (0 and infinity
/// included), if there is one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counterexample {
    pub(super) plants: Vec<PlantPoint>,
    pub(super) frequency_rad_per_s: Option<f64>,
}

/// Thresholds for new margins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NewMargins {
    /// Distance below the reserve beyond which a margin is new, for single limits and for tracking,
    /// dB.
    pub(super) below_db: [f64; 2],
    /// Margin required to every limit, dB; if two limits are less than 1 dB apart, that fraction of
    /// it.
    pub(super) reserve_db: f64,
}

/// The plants whose margin is below the reserve by more than a tolerance (both count twice for a
/// spread, which has two limits), each once with each of its frequencies.
pub(super) fn counterexamples(
    findings: &[SpecificationFinding],
    NewMargins { below_db: [tolerance_db, of_tracking_db], reserve_db }: NewMargins,
    tracking: TrackingJudgement,
) -> Vec<Counterexample> {
    let mut found: Vec<Counterexample> = Vec::new();
    for finding in findings {
        let limits = if is_spread(finding, tracking) { 2.0 } else { 1.0 };
        let tolerance = match finding.requirement.closed_loop() {
            ClosedLoop::Tracking => limits * of_tracking_db,
            _ => tolerance_db,
        };
        let least = |case: &SpecificationMargin| {
            limits * finding.requirement.reserve_at_db(reserve_db, case.frequency_rad_per_s) - tolerance
        };
        let cases = finding.worst_margins().chain(&finding.at_design_frequencies);
        for case in cases.filter(|case| case.margin_db < least(case)) {
            let plants = case.plants().cloned().collect();
            let example = Counterexample { plants, frequency_rad_per_s: Some(case.frequency_rad_per_s) };
            if !found.contains(&example) {
                found.push(example);
            }
        }
    }
    found
}

/// Counterexamples of the audit of an additional plant, by its index.
pub(super) fn of_additional(index: usize, examples: Vec<Counterexample>) -> Vec<Counterexample> {
    let named =
        |example: Counterexample| Counterexample { plants: vec![PlantPoint::Additional(index)], ..example };
    examples.into_iter().map(named).collect()
}

/// The plant for which a family is unstable.
pub(super) fn unstable_plant(audit: &Audit) -> Vec<Counterexample> {
    match audit.stability.verdict {
        Verdict::Violated => {
            vec![Counterexample { plants: vec![audit.stability.plant.clone()], frequency_rad_per_s: None }]
        }
        Verdict::Met | Verdict::NotProven => vec![],
    }
}

/// The plant that tolerates less delay than is required, with the requirement relaxed by this much,
/// dB.
pub(super) fn too_little_delay(
    audit: &Audit,
    problem: &DesignProblem,
    relaxation_db: f64,
) -> Vec<Counterexample> {
    let eased = portable::pow(10.0, relaxation_db.max(0.0) / 20.0);
    let is_missed = |margin: &&DelayMargin| !problem.tolerates_its_delay(eased * margin.delay_s);
    let least = audit.delay_margin.iter().filter(is_missed);
    let example = |margin: &DelayMargin| Counterexample {
        plants: vec![margin.plant.clone()],
        frequency_rad_per_s: Some(margin.frequency_rad_per_s),
    };
    least.map(example).collect()
}

/// The least margin of all specifications, dB.
pub(super) fn worst_margin_db(findings: &[SpecificationFinding]) -> f64 {
    let margins = findings.iter().filter_map(|finding| finding.worst.as_ref());
    margins.map(|worst| worst.margin_db).fold(f64::INFINITY, f64::min)
}

/// The least margin of an audit, dB; `None` if a plant is not known to be stable.
pub(super) fn audited_margin_db(audit: &Audit) -> Option<f64> {
    (audit.stability.verdict == Verdict::Met).then(|| worst_margin_db(&audit.specifications))
}

/// The least margin divided by the gain in margin per dB of relaxation of every limit: 2 for a
/// spread.
pub(super) fn worst_over_rate_db(findings: &[SpecificationFinding], tracking: TrackingJudgement) -> f64 {
    let margins = findings.iter().filter_map(|finding| {
        let margin_db = finding.worst.as_ref()?.margin_db;
        Some(if is_spread(finding, tracking) { 0.5 * margin_db } else { margin_db })
    });
    margins.fold(f64::INFINITY, f64::min)
}

fn is_spread(finding: &SpecificationFinding, tracking: TrackingJudgement) -> bool {
    tracking == TrackingJudgement::Spread && finding.requirement.is_tracking()
}
