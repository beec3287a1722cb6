use super::words::{decisions, hose_name, model_name, reason_words, uncertain_name};
use super::{BoreVerdict, Candidate, Consequence, OtherMeans, OtherMeansError, SizedLoad, Sizing};
use phea_engineering::rig::FlowLimit;

use crate::answer::{Csv, Object, OutputFile, quoted};

/// What `size` says to programs.
pub(crate) fn body(sizing: &Sizing) -> Object {
    let limit = match sizing.flow.limit {
        FlowLimit::Valve => "valve",
        FlowLimit::Pump => "pump",
    };
    let body = Object::new()
        .with("maximum_flow_m3_per_s", sizing.flow.line())
        .with("maximum_flow_limit", limit)
        .with("valve_flow_m3_per_s", sizing.flow.valve)
        .maybe("pump_flow_m3_per_s", sizing.flow.pump.map(|(flow, _)| flow))
        .with("bore_range_m", sizing.bore_range_m)
        .with("pole_gain_v_per_n", sizing.pole_gain_v_per_n)
        .with("load", load_name(sizing.load))
        .maybe("load_stiffness_n_per_m", sizing.load.stiffness())
        .each("bores", &sizing.bores, |bore| {
            Object::new()
                .with("name", hose_name(&bore.name))
                .with("bore_m", bore.bore_m)
                .with("oil_velocity_m_per_s", bore.oil_velocity_m_per_s)
                .with("verdict", verdict_name(bore.verdict))
        })
        .each("candidates", &sizing.candidates, candidate)
        .each("decisions", &decisions(&sizing.decisions), |(step, text)| {
            Object::new().with("step", *step).with("text", text.as_str())
        })
        .each("influences", &sizing.influences, |influence| {
            Object::new()
                .with("quantity", uncertain_name(influence.quantity))
                .with("values", influence.values)
                .with("stiffness_n_per_m", influence.stiffness_n_per_m)
                .with("length_m", influence.length_m)
        });
    body.maybe("other_means", sizing.other_means.as_ref().map(other_means))
}

/// The load that time constant and gain are of.
fn load_name(load: SizedLoad) -> &'static str {
    match load {
        SizedLoad::Prescribed => "prescribed",
        SizedLoad::Yielding { .. } => "in_series",
        SizedLoad::HeldStill => "held_still",
    }
}

/// What cannot be has its reason in place of its numbers.
fn other_means(found: &OtherMeans) -> Object {
    let absent = |reason: &OtherMeansError| Object::new().with("reason", reason.to_string());
    let pipe = found.pipe.as_ref().map_or_else(absent, |pipe| {
        Object::new().with("bore_m", pipe.bore).with("length_m", pipe.length).with("oil_m3", pipe.oil)
    });
    let gas = found.gas.as_ref().map_or_else(absent, |gas| {
        Object::new()
            .with("gas_volume_m3", gas.volume)
            .with("precharge_pressure_pa", gas.precharge)
            .with("pressure_ratio", gas.pressure_ratio)
            .with("stiffness_n_per_m", gas.stiffness)
    });
    let spring = found.spring.as_ref().map_or_else(absent, |spring| {
        let coil = spring.coil.as_ref().ok();
        Object::new()
            .with("stiffness_n_per_m", spring.stiffness)
            .with("travel_m", spring.travel)
            .with("installed_length_m", coil.map(|coil| coil.installed_length))
            .with("mass_kg", coil.map(|coil| coil.mass))
            .with("actuator_length_m", spring.actuator_length)
    });
    let out = Object::new()
        .with("stiffness_n_per_m", found.stiffness)
        .with("chambers_n_per_m", found.chambers)
        .with("actuator_length_m", found.actuator_length)
        .with("pipe", pipe)
        .with("gas", gas)
        .with("spring", spring);
    match &found.valves {
        Err(reason) => out.with("valves_reason", reason.to_string()),
        Ok(valves) => out.each("valves", valves, |valve| {
            Object::new()
                .with("stiffness_n_per_m", valve.stiffness)
                .with("damping_ratio_alone", valve.alone)
                .with("conductance_m3_per_s_pa", valve.conductance)
                .with("damping_ratio_at_most", valve.most[0])
                .with("at_conductance_m3_per_s_pa", valve.most[1])
                .with("loss_w", valve.loss)
        }),
    }
}

/// Of its reasons those that reject it come first.
fn candidate(candidate: &Candidate) -> Object {
    let branch = &candidate.branch;
    let of = |consequence| {
        let same = candidate.findings.iter().filter(move |finding| finding.consequence() == consequence);
        same.map(reason_words).collect::<Vec<_>>()
    };
    Object::new()
        .with("hose", hose_name(&candidate.option.name))
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
        .each("reasons", &candidate.findings, reason_words)
        .with("rejections", of(Consequence::Rejects))
        .with("not_known", of(Consequence::LeavesOpen))
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
        let reasons: Vec<String> = candidate.findings.iter().map(reason_words).collect();
        csv.row(&[
            &candidate.accepted(),
            &quoted(&hose_name(&candidate.option.name)),
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
    vec![OutputFile::new("sizing.csv", csv.text())]
}
