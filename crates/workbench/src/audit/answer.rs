use phea_qft::proof::{Certificate, Proof, Standing};
use phea_qft::verification::{SpecificationFinding, Verdict, ViolatedBand, WorstCase};
use serde::Serialize;

use super::{NamedPlant, PlantNames};
use super::{ProjectAudit, ReachedLimit};
use super::{
    evidence_key, kind_key, kind_words, remark_sentences, stability_reason, verdict_key, why_not_proven,
};
use crate::answer::{self, Csv, Number, OutputFile};
use crate::project::Loaded;
use crate::trial::{self, Trial};

#[derive(Serialize)]
pub(crate) struct VerifyAnswer<'a> {
    verdict: &'static str,
    evidence: &'static str,
    tolerance_db: f64,
    stable: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stable_reason: Option<String>,
    stability: StabilityAnswer,
    #[serde(skip_serializing_if = "Option::is_none")]
    proof: Option<ProofRow>,
    delay_margin_s: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    delay_margin_s_reason: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    delay_margin: Option<DelayMarginRow>,
    members: usize,
    parameters: Vec<&'a str>,
    timing: TimingRow,
    specifications: Vec<SpecificationRow<'a>>,
    warnings: Vec<&'a str>,
}

/// What was proven besides the specifications.
#[derive(Serialize)]
struct ProofRow {
    stable: StandingRow,
    leaves: usize,
}

/// Whether a claim is proven: false where it is refuted, `null` where it is neither.
#[derive(Serialize)]
struct StandingRow {
    proven: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    proven_reason: Option<String>,
}

/// The same of a specification, with what encloses the greatest ratio of closed loop to limit.
#[derive(Serialize)]
struct SpecificationProofRow {
    #[serde(flatten)]
    standing: StandingRow,
    enclosure_db: [Number; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    enclosure_db_reason: Option<&'static str>,
}

#[derive(Serialize)]
struct TimingRow {
    sample_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sample_time_s_reason: Option<&'static str>,
    delay_s: f64,
}

#[derive(Serialize)]
struct StabilityAnswer {
    verdict: &'static str,
    evidence: &'static str,
    largest_real_part_per_s: Number,
    plant: NamedPlant,
    reason: String,
}

#[derive(Serialize)]
struct DelayMarginRow {
    frequency_rad_per_s: Number,
    plant: NamedPlant,
}

#[derive(Serialize)]
struct SpecificationRow<'a> {
    kind: &'static str,
    /// What it limits, where the kind does not say that.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    verdict: &'static str,
    evidence: &'static str,
    worst_margin_db: Number,
    frequency_rad_per_s: Number,
    plant: Option<NamedPlant>,
    #[serde(skip_serializing_if = "Option::is_none")]
    other_plant: Option<NamedPlant>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reached: Option<ReachedRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interior: Option<CaseRow>,
    #[serde(flatten)]
    proof: Option<SpecificationProofRow>,
    violations: Vec<ViolationRow>,
    at_design_frequencies: Vec<CaseRow>,
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct CaseRow {
    frequency_rad_per_s: Number,
    margin_db: Number,
    plant: NamedPlant,
    #[serde(skip_serializing_if = "Option::is_none")]
    other_plant: Option<NamedPlant>,
}

#[derive(Serialize)]
struct ReachedRow {
    magnitude: f64,
    limit: Number,
}

#[derive(Serialize)]
struct ViolationRow {
    band_rad_per_s: [Number; 2],
    #[serde(flatten)]
    worst: CaseRow,
}

fn case(names: &PlantNames, worst: &WorstCase) -> CaseRow {
    CaseRow {
        frequency_rad_per_s: Number(worst.frequency_rad_per_s),
        margin_db: Number(worst.margin_db),
        plant: names.named(&worst.plant),
        other_plant: worst.other.as_ref().map(|other| names.named(other)),
    }
}

fn specification<'a>(
    names: &PlantNames,
    name: &'a str,
    finding: &'a SpecificationFinding,
    reached: Option<ReachedLimit>,
    proof: Option<SpecificationProofRow>,
) -> SpecificationRow<'a> {
    let worst = finding.worst.as_ref();
    let violation = |band: &ViolatedBand| ViolationRow {
        band_rad_per_s: band.band_rad_per_s.map(Number),
        worst: case(names, &band.worst),
    };
    SpecificationRow {
        kind: kind_key(&finding.requirement),
        name: Some(name).filter(|name| *name != kind_words(&finding.requirement)),
        verdict: verdict_key(finding.verdict),
        evidence: evidence_key(finding.evidence),
        worst_margin_db: Number(worst.map_or(f64::NAN, |worst| worst.margin_db)),
        frequency_rad_per_s: Number(worst.map_or(f64::NAN, |worst| worst.frequency_rad_per_s)),
        plant: worst.map(|worst| names.named(&worst.plant)),
        other_plant: worst.and_then(|worst| worst.other.as_ref()).map(|other| names.named(other)),
        reason: worst.is_none().then_some("there is no margin; see remarks"),
        reached: reached
            .map(|ReachedLimit { magnitude, limit, .. }| ReachedRow { magnitude, limit: Number(limit) }),
        interior: finding.interior.as_ref().map(|worst| case(names, worst)),
        proof,
        violations: finding.violations.iter().map(violation).collect(),
        at_design_frequencies: finding.at_design_frequencies.iter().map(|worst| case(names, worst)).collect(),
        remarks: remark_sentences(finding, names),
    }
}

fn standing(view: &ProjectAudit, proof: &Proof, standing: &Standing) -> StandingRow {
    StandingRow {
        proven: match standing {
            Standing::Proven => Some(true),
            Standing::Refuted => Some(false),
            Standing::NotProven(_) => None,
        },
        proven_reason: why_not_proven(view, proof, standing),
    }
}

fn specification_proof(view: &ProjectAudit, index: usize) -> Option<SpecificationProofRow> {
    let proof = view.proof.as_ref()?;
    let own = proof.specifications.get(index)?;
    let ends = [own.least_db, own.most_db];
    Some(SpecificationProofRow {
        standing: standing(view, proof, &own.standing),
        enclosure_db: ends.map(|end| Number(end.unwrap_or(f64::NAN))),
        enclosure_db_reason: ends.contains(&None).then_some("it was not found; see proven_reason"),
    })
}

/// The JSON object of `verify`.
pub fn json(loaded: &Loaded, view: &ProjectAudit) -> String {
    answer::json("verify", loaded, body(view))
}

#[derive(Serialize)]
struct OnMachine<'a> {
    #[serde(flatten)]
    audit: VerifyAnswer<'a>,
    machine: trial::TrialAnswer<'a>,
}

/// The JSON object of `verify --on-machine`.
pub(crate) fn json_on_machine(loaded: &Loaded, view: &ProjectAudit, trial: &Trial) -> String {
    answer::json("verify", loaded, OnMachine { audit: body(view), machine: trial::body(trial) })
}

/// What an audit says in JSON, beside what every object carries.
pub(crate) fn body(view: &ProjectAudit) -> VerifyAnswer<'_> {
    let (audit, names) = (&view.audit, &view.names);
    let stability = &audit.stability;
    let margin = audit.delay_margin.as_ref();
    VerifyAnswer {
        verdict: verdict_key(audit.verdict),
        evidence: evidence_key(audit.evidence),
        tolerance_db: audit.tolerance_db,
        stable: match stability.verdict {
            Verdict::Met => Some(true),
            Verdict::Violated => Some(false),
            Verdict::NotProven => None,
        },
        stable_reason: (stability.verdict == Verdict::NotProven).then(|| stability_reason(stability)),
        stability: StabilityAnswer {
            verdict: verdict_key(stability.verdict),
            evidence: evidence_key(stability.evidence),
            largest_real_part_per_s: Number(stability.largest_real_part.unwrap_or(f64::NAN)),
            plant: names.named(&stability.plant),
            reason: stability_reason(stability),
        },
        proof: view.proof.as_ref().map(|proof| ProofRow {
            stable: standing(view, proof, &proof.stability),
            leaves: proof.certificate.as_ref().map_or(0, Certificate::leaves),
        }),
        delay_margin_s: Number(margin.map_or(f64::NAN, |margin| margin.delay_s)),
        delay_margin_s_reason: margin
            .is_none()
            .then_some("there is none: not every plant is known to be stable"),
        delay_margin: margin.map(|margin| DelayMarginRow {
            frequency_rad_per_s: Number(margin.frequency_rad_per_s),
            plant: names.named(&margin.plant),
        }),
        members: view.members,
        parameters: names.headings(),
        timing: TimingRow {
            sample_time_s: view.sample_time_s,
            sample_time_s_reason: view.sample_time_s.is_none().then_some("the controller is continuous"),
            delay_s: view.delay_s,
        },
        specifications: audit
            .specifications
            .iter()
            .zip(&view.reached)
            .zip(&view.specification_names)
            .enumerate()
            .map(|(index, ((finding, reached), name))| {
                specification(names, name, finding, *reached, specification_proof(view, index))
            })
            .collect(),
        warnings: view.caveats.iter().map(|caveat| caveat.sentence.as_str()).collect(),
    }
}

/// The family's worst margins over frequency as a table for other programs.
pub fn files(view: &ProjectAudit) -> Vec<OutputFile> {
    let mut csv = Csv::new("specification,kind,frequency_rad_per_s,worst_margin_db");
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for (frequency, margin) in &finding.envelope {
            csv.row(&[&index, &kind_key(&finding.requirement), frequency, margin]);
        }
    }
    vec![csv.file("margins.csv")]
}
