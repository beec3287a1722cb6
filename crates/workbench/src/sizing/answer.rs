use serde::Serialize;

use super::model_name;
use super::{BoreVerdict, Candidate, Consequence, Sizing};
use crate::answer::{self, Csv, Number, OutputFile, quoted};
use crate::project::Loaded;

#[derive(Serialize)]
struct SizeAnswer<'a> {
    bore_range_m: [f64; 2],
    pole_gain_v_per_n: f64,
    bores: Vec<BoreRow<'a>>,
    candidates: Vec<CandidateRow<'a>>,
    decisions: Vec<DecisionRow<'a>>,
    influences: Vec<InfluenceRow<'a>>,
}

#[derive(Serialize)]
struct BoreRow<'a> {
    name: &'a str,
    bore_m: f64,
    oil_velocity_m_per_s: f64,
    verdict: &'static str,
}

#[derive(Serialize)]
struct CandidateRow<'a> {
    hose: &'a str,
    compliance: &'static str,
    branch: &'static str,
    bore_m: f64,
    length_m: Number,
    stiffness_n_per_m: Number,
    stiffness_maximum_n_per_m: Number,
    proportional_gain_v_per_n: Number,
    oil_velocity_m_per_s: f64,
    surge_pressure_pa: f64,
    time_constant_s: [Number; 2],
    steady_state_gain: [Number; 2],
    accepted: bool,
    /// Everything that speaks against it, rejections first.
    reasons: Vec<&'a str>,
    rejections: Vec<&'a str>,
    warnings: Vec<&'a str>,
    iterations: Vec<IterationRow>,
}

#[derive(Serialize)]
struct IterationRow {
    proportional_gain_v_per_n: f64,
    stiffness_n_per_m: Number,
    length_m: Number,
}

#[derive(Serialize)]
struct DecisionRow<'a> {
    step: &'a str,
    text: &'a str,
}

#[derive(Serialize)]
struct InfluenceRow<'a> {
    quantity: &'a str,
    values: [f64; 3],
    stiffness_n_per_m: [Number; 3],
    length_m: [Number; 3],
}

/// The JSON object of `size`.
pub fn json(loaded: &Loaded, sizing: &Sizing) -> String {
    let bores = sizing.bores.iter().map(|bore| BoreRow {
        name: &bore.name,
        bore_m: bore.bore_m,
        oil_velocity_m_per_s: bore.oil_velocity_m_per_s,
        verdict: verdict_name(bore.verdict),
    });
    let influences = sizing.influences.iter().map(|influence| InfluenceRow {
        quantity: influence.quantity,
        values: influence.values,
        stiffness_n_per_m: influence.stiffness_n_per_m.map(Number),
        length_m: influence.length_m.map(Number),
    });
    let decisions =
        sizing.decisions.iter().map(|decision| DecisionRow { step: decision.step, text: &decision.text });
    let body = SizeAnswer {
        bore_range_m: sizing.bore_range_m,
        pole_gain_v_per_n: sizing.pole_gain_v_per_n,
        bores: bores.collect(),
        candidates: sizing.candidates.iter().map(candidate_row).collect(),
        decisions: decisions.collect(),
        influences: influences.collect(),
    };
    answer::json("size", loaded, body)
}

fn candidate_row(candidate: &Candidate) -> CandidateRow<'_> {
    let branch = &candidate.branch;
    let iterations = branch.steps.iter().map(|step| IterationRow {
        proportional_gain_v_per_n: step.gain_v_per_n,
        stiffness_n_per_m: Number(step.stiffness_n_per_m),
        length_m: Number(step.length_m),
    });
    let of = |severity| {
        let same = candidate.findings.iter().filter(|finding| finding.severity == severity);
        same.map(|finding| finding.text.as_str()).collect()
    };
    CandidateRow {
        hose: &candidate.option.name,
        compliance: model_name(branch.model),
        branch: branch_name(branch.by_gain),
        bore_m: candidate.option.hose.bore,
        length_m: Number(branch.length_m),
        stiffness_n_per_m: Number(branch.stiffness.minimum),
        stiffness_maximum_n_per_m: Number(branch.stiffness.maximum),
        proportional_gain_v_per_n: Number(branch.gain_v_per_n),
        oil_velocity_m_per_s: candidate.oil_velocity_m_per_s,
        surge_pressure_pa: candidate.surge_pressure_pa,
        time_constant_s: candidate.time_constant_s.map(Number),
        steady_state_gain: candidate.steady_state_gain.map(Number),
        accepted: candidate.accepted(),
        reasons: candidate.findings.iter().map(|finding| finding.text.as_str()).collect(),
        rejections: of(Consequence::Rejects),
        warnings: of(Consequence::Warns),
        iterations: iterations.collect(),
    }
}

fn verdict_name(verdict: BoreVerdict) -> &'static str {
    match verdict {
        BoreVerdict::Recommended => "recommended",
        BoreVerdict::Slow => "slow",
        BoreVerdict::TooFast => "too_fast",
    }
}

pub(crate) fn branch_name(by_gain: bool) -> &'static str {
    if by_gain { "by_gain" } else { "by_length" }
}

/// The candidates as a table for other programs.
pub fn files(sizing: &Sizing) -> Vec<OutputFile> {
    let mut csv = Csv::new(
        "accepted,hose,compliance,branch,bore_m,length_m,stiffness_minimum_n_per_m,stiffness_maximum_n_per_m,proportional_gain_v_per_n,reasons",
    );
    for candidate in &sizing.candidates {
        let branch = &candidate.branch;
        let reasons: Vec<&str> = candidate.findings.iter().map(|finding| finding.text.as_str()).collect();
        csv.row(&[
            &candidate.accepted(),
            &quoted(&candidate.option.name),
            &model_name(branch.model),
            &branch_name(branch.by_gain),
            &candidate.option.hose.bore,
            &branch.length_m,
            &branch.stiffness.minimum,
            &branch.stiffness.maximum,
            &branch.gain_v_per_n,
            &quoted(&reasons.join("; ")),
        ]);
    }
    vec![csv.file("sizing.csv")]
}
