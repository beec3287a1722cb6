use super::model_name;
use super::{BoreVerdict, Candidate, Consequence, Sizing};
use crate::answer::{self, Csv, Object, OutputFile, quoted};
use crate::project::Loaded;

/// The JSON object of `size`.
pub fn json(loaded: &Loaded, sizing: &Sizing) -> String {
    let body = Object::new()
        .with("bore_range_m", sizing.bore_range_m)
        .with("pole_gain_v_per_n", sizing.pole_gain_v_per_n)
        .each("bores", &sizing.bores, |bore| {
            Object::new()
                .with("name", bore.name.as_str())
                .with("bore_m", bore.bore_m)
                .with("oil_velocity_m_per_s", bore.oil_velocity_m_per_s)
                .with("verdict", verdict_name(bore.verdict))
        })
        .each("candidates", &sizing.candidates, candidate)
        .each("decisions", &sizing.decisions, |decision| {
            Object::new().with("step", decision.step).with("text", decision.text.as_str())
        })
        .each("influences", &sizing.influences, |influence| {
            Object::new()
                .with("quantity", influence.quantity)
                .with("values", influence.values)
                .with("stiffness_n_per_m", influence.stiffness_n_per_m)
                .with("length_m", influence.length_m)
        });
    answer::json("size", loaded, body)
}

/// Of its reasons those that reject it come first.
fn candidate(candidate: &Candidate) -> Object {
    let branch = &candidate.branch;
    let of = |severity| {
        let same = candidate.findings.iter().filter(move |finding| finding.severity == severity);
        same.map(|finding| finding.text.as_str()).collect::<Vec<_>>()
    };
    Object::new()
        .with("hose", candidate.option.name.as_str())
        .with("compliance", model_name(branch.model))
        .with("branch", branch_name(branch.by_gain))
        .with("bore_m", candidate.option.hoses[0].bore)
        .with("length_m", candidate.length_m())
        .with("bore_b_m", candidate.option.hoses[1].bore)
        .with("length_b_m", branch.lengths_m[1])
        .with("stiffness_n_per_m", branch.stiffness.minimum)
        .with("stiffness_maximum_n_per_m", branch.stiffness.maximum)
        .with("proportional_gain_v_per_n", branch.gain_v_per_n)
        .with("oil_velocity_m_per_s", candidate.oil_velocity_m_per_s)
        .with("surge_pressure_pa", candidate.surge_pressure_pa)
        .with("time_constant_s", candidate.time_constant_s)
        .with("steady_state_gain", candidate.steady_state_gain)
        .with("accepted", candidate.accepted())
        .each("reasons", &candidate.findings, |finding| finding.text.as_str())
        .with("rejections", of(Consequence::Rejects))
        .with("warnings", of(Consequence::Warns))
        .each("iterations", &branch.steps, |step| {
            Object::new()
                .with("proportional_gain_v_per_n", step.gain_v_per_n)
                .with("stiffness_n_per_m", step.stiffness_n_per_m)
                .with("length_m", step.length_m)
        })
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
        "accepted,hose,compliance,branch,bore_m,length_m,bore_b_m,length_b_m,stiffness_minimum_n_per_m,stiffness_maximum_n_per_m,proportional_gain_v_per_n,reasons",
    );
    for candidate in &sizing.candidates {
        let branch = &candidate.branch;
        let reasons: Vec<&str> = candidate.findings.iter().map(|finding| finding.text.as_str()).collect();
        csv.row(&[
            &candidate.accepted(),
            &quoted(&candidate.option.name),
            &model_name(branch.model),
            &branch_name(branch.by_gain),
            &candidate.option.hoses[0].bore,
            &branch.lengths_m[0],
            &candidate.option.hoses[1].bore,
            &branch.lengths_m[1],
            &branch.stiffness.minimum,
            &branch.stiffness.maximum,
            &branch.gain_v_per_n,
            &quoted(&reasons.join("; ")),
        ]);
    }
    vec![csv.file("sizing.csv")]
}
