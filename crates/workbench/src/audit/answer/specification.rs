//! The specifications in the answer of an audit.

use phea_engineering::audit::{ProjectAudit, ReachedLimit, TimeFinding, TimeOutcome, WorstStep};
use phea_engineering::plant_names::{NamedPlant, PlantNames};
use phea_engineering::specification::SpecificationName;
use phea_qft::verification::{Evidence, SpecificationFinding, SpecificationMargin, Verdict};

use super::stability::{ProvenAnswer, proven};
use crate::answer::{Answer, OrReason};
use crate::audit::in_time::unexamined_words;
use crate::audit::remark::remark_sentences;
use crate::project::SpecificationKind;
use crate::specification::{RequiredStepAnswer, subject_words};

/// Finding on a specification.
#[derive(Answer)]
pub(super) enum AuditedSpecification {
    ClosedLoop(Box<SpecificationAnswer>),
    Step(Box<StepSpecificationAnswer>),
}

/// Finding on a limit of a closed loop over frequency.
#[derive(Answer)]
pub(super) struct SpecificationAnswer {
    /// Number of the specification, from 1 in the order of the file; left out if it is no limit of
    /// the file.
    #[answer(optional)]
    specification: Option<usize>,
    /// Kind of the specification.
    kind: SpecificationKind,
    /// Name of the specification, if it is not a limit of the file.
    #[answer(optional)]
    name: Option<&'static str>,
    /// Verdict on the specification.
    verdict: Verdict,
    /// Evidence for the verdict.
    evidence: Evidence,
    /// Worst margin over the band and the family; negative if the specification is violated.
    worst_margin_db: Option<f64>,
    /// Frequency of the worst margin; zero or `inf` for a limit towards it.
    frequency_rad_per_s: Option<f64>,
    /// Plant with the worst margin; of a spread the one with the greatest |T|.
    plant: Option<NamedPlant>,
    /// Plant with the least |T|, of a spread.
    #[answer(optional)]
    other_plant: Option<NamedPlant>,
    /// Reason for which there is no margin.
    #[answer(optional)]
    reason: Option<&'static str>,
    /// Magnitude of the worst plant and its limit.
    #[answer(optional)]
    reached: Option<ReachedLimitAnswer>,
    /// Worst margin inside the band, if the worst is at an end of the band: towards that end the
    /// margin may fall further.
    #[answer(optional)]
    interior: Option<SpecificationMarginAnswer>,
    #[answer(flatten)]
    proof: Option<SpecificationProofAnswer>,
    /// Steps against the requirement in time from which the limit follows.
    #[answer(optional)]
    in_time: Option<TimeFindingAnswer>,
    /// Bands in which an examined plant violates it.
    violations: Vec<ViolatedBandAnswer>,
    /// Worst margin of the family at each design frequency.
    at_design_frequencies: Vec<SpecificationMarginAnswer>,
    /// Limitations of the examination.
    remarks: Vec<String>,
}

/// Finding on a requirement on steps.
#[derive(Answer)]
pub(super) struct StepSpecificationAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Kind of the specification, `step`.
    kind: SpecificationKind,
    #[answer(flatten)]
    finding: TimeFindingAnswer,
    /// Plant of the property that is nearest to its limit or furthest beyond.
    plant: Option<NamedPlant>,
}

/// Magnitude that a closed loop reaches, and the limit that it comes nearest to or violates.
#[derive(Answer)]
struct ReachedLimitAnswer {
    /// Magnitude of the closed loop.
    magnitude: f64,
    /// Limit of the magnitude.
    limit: f64,
}

/// Proof of a specification.
#[derive(Answer)]
struct SpecificationProofAnswer {
    #[answer(flatten)]
    outcome: ProvenAnswer,
    /// Bounds of the greatest ratio of the closed loop to its limit, from low to high.
    enclosure_db: [Option<f64>; 2],
    /// Reason for which a bound is absent.
    #[answer(optional)]
    enclosure_db_reason: Option<&'static str>,
}

/// Band in which an examined plant violates a specification.
#[derive(Answer)]
struct ViolatedBandAnswer {
    /// Ends of the band.
    #[answer(interval)]
    band_rad_per_s: [f64; 2],
    #[answer(flatten)]
    worst: SpecificationMarginAnswer,
}

/// Margin of a specification at a frequency.
#[derive(Answer)]
pub(crate) struct SpecificationMarginAnswer {
    /// Frequency; zero or `inf` for a limit towards it.
    frequency_rad_per_s: f64,
    /// Margin; negative if the specification is violated.
    margin_db: f64,
    /// Plant with the margin; of a spread the one with the greatest |T|.
    plant: NamedPlant,
    /// Plant with the least |T|, of a spread.
    #[answer(optional)]
    other_plant: Option<NamedPlant>,
}

/// Steps of the reference against a requirement in time.
#[derive(Answer)]
struct TimeFindingAnswer {
    /// Verdict on the steps.
    verdict: OrReason<Verdict>,
    /// True if the verdict of the audit includes this one.
    part_of_verdict: bool,
    /// Required step response.
    required: RequiredStepAnswer,
    #[answer(flatten)]
    worst: Option<WorstStepsAnswer>,
}

/// Worst steps of the examined plants.
#[derive(Answer)]
struct WorstStepsAnswer {
    /// Evidence for the verdict.
    evidence: Evidence,
    /// Number of examined plants.
    plants: usize,
    /// Greatest overshoot, of the step, if one is required.
    #[answer(optional)]
    worst_overshoot_percent: Option<f64>,
    /// Plant with the greatest overshoot.
    #[answer(optional)]
    overshoot_plant: Option<NamedPlant>,
    /// Longest settling time, `inf` if a step does not settle within the computed time, if one is
    /// required.
    #[answer(optional)]
    worst_settling_time_s: Option<f64>,
    /// Plant with the longest settling time.
    #[answer(optional)]
    settling_plant: Option<NamedPlant>,
    /// Longest rise from 10 to 90 percent, `inf` if a step does not rise within the computed time,
    /// if one is required.
    #[answer(optional)]
    worst_rise_time_s: Option<f64>,
    /// Plant with the longest rise.
    #[answer(optional)]
    rise_plant: Option<NamedPlant>,
}

/// The limits on closed loops and the requirements on steps, as the file has them; what has no
/// number in it, such as a limit on rounding, comes last.
pub(super) fn in_file_order(view: &ProjectAudit) -> Vec<AuditedSpecification> {
    let mut steps = view.in_time.iter().filter(|finding| finding.requirement.limits.is_none()).peekable();
    let step = |finding| AuditedSpecification::Step(Box::new(step_specification(&view.names, finding)));
    let mut ordered = Vec::new();
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        while let Some(next) = steps.next_if(|next| next.requirement.number == ordered.len() + 1) {
            ordered.push(step(next));
        }
        ordered.push(AuditedSpecification::ClosedLoop(Box::new(specification(view, index, finding))));
    }
    ordered.extend(steps.map(step));
    ordered
}

/// A requirement on steps: the plant is that of the property that is nearest to its limit or
/// furthest beyond.
fn step_specification(names: &PlantNames, finding: &TimeFinding) -> StepSpecificationAnswer {
    StepSpecificationAnswer {
        specification: finding.requirement.number,
        kind: SpecificationKind::Step,
        finding: in_time(names, finding),
        plant: finding.nearest().map(|worst| names.named(&worst.plant)),
    }
}

fn specification(view: &ProjectAudit, index: usize, finding: &SpecificationFinding) -> SpecificationAnswer {
    let names = &view.names;
    let worst = finding.worst.as_ref();
    let other = worst.and_then(|worst| worst.other.as_ref());
    let is_other = |name: &&SpecificationName| !matches!(name, SpecificationName::ClosedLoop(_));
    let name = view.specification_names.get(index).filter(is_other);
    let reached = view.reached.get(index).copied().flatten();
    let violations = finding.violations.iter().map(|band| ViolatedBandAnswer {
        band_rad_per_s: band.band_rad_per_s,
        worst: margin(names, &band.worst),
    });
    SpecificationAnswer {
        specification: view.number_of(index),
        kind: SpecificationKind::ClosedLoop(finding.requirement.closed_loop()),
        name: name.map(|name| subject_words(*name)),
        verdict: finding.verdict,
        evidence: finding.evidence,
        worst_margin_db: worst.map(|worst| worst.margin_db),
        frequency_rad_per_s: worst.map(|worst| worst.frequency_rad_per_s),
        plant: worst.map(|worst| names.named(&worst.plant)),
        other_plant: other.map(|other| names.named(other)),
        reason: worst.is_none().then_some("there is no margin; see remarks"),
        reached: reached.map(|ReachedLimit { magnitude, limit, .. }| ReachedLimitAnswer { magnitude, limit }),
        interior: finding.interior.as_ref().map(|worst| margin(names, worst)),
        proof: specification_proof(view, index),
        in_time: view.in_time_of(index).map(|finding| in_time(names, finding)),
        violations: violations.collect(),
        at_design_frequencies: finding
            .at_design_frequencies
            .iter()
            .map(|worst| margin(names, worst))
            .collect(),
        remarks: remark_sentences(finding, names),
    }
}

/// A margin with its plant.
pub(crate) fn margin(names: &PlantNames, worst: &SpecificationMargin) -> SpecificationMarginAnswer {
    SpecificationMarginAnswer {
        frequency_rad_per_s: worst.frequency_rad_per_s,
        margin_db: worst.margin_db,
        plant: names.named(&worst.plant),
        other_plant: worst.other.as_ref().map(|other| names.named(other)),
    }
}

/// The requirement in time that the limits follow from, and the worst steps.
fn in_time(names: &PlantNames, finding: &TimeFinding) -> TimeFindingAnswer {
    let (worst, reason) = match &finding.outcome {
        TimeOutcome::Searched { plants, overshoot, settling, rise } => {
            (Some(worst_steps(names, *plants, [overshoot, settling, rise])), String::new())
        }
        TimeOutcome::NotExamined(why) => (None, unexamined_words(why)),
    };
    TimeFindingAnswer {
        verdict: OrReason::new(finding.verdict(), reason),
        part_of_verdict: finding.requirement.follows,
        required: (&finding.requirement.step_limits).into(),
        worst,
    }
}

fn worst_steps(names: &PlantNames, plants: usize, worst: [&Option<WorstStep>; 3]) -> WorstStepsAnswer {
    let [overshoot, settling, rise] = worst.map(Option::as_ref);
    let value = |worst: Option<&WorstStep>| worst.map(|worst| worst.value);
    let plant = |worst: Option<&WorstStep>| worst.map(|worst| names.named(&worst.plant));
    WorstStepsAnswer {
        evidence: Evidence::Search,
        plants,
        worst_overshoot_percent: value(overshoot),
        overshoot_plant: plant(overshoot),
        worst_settling_time_s: value(settling),
        settling_plant: plant(settling),
        worst_rise_time_s: value(rise),
        rise_plant: plant(rise),
    }
}

/// The proof of a specification, with bounds of the greatest ratio of closed loop to limit.
fn specification_proof(view: &ProjectAudit, index: usize) -> Option<SpecificationProofAnswer> {
    let proof = view.proof.as_ref()?;
    let own = proof.specifications.get(index)?;
    let ends = [own.least_db, own.most_db];
    Some(SpecificationProofAnswer {
        outcome: proven(view, proof, &own.claim_status),
        enclosure_db: ends,
        enclosure_db_reason: ends.contains(&None).then_some("it was not found; see proven_reason"),
    })
}
