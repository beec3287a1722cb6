//! The answer of `size`, and its table.

mod means;

use phea_engineering::rig::FlowLimit;
use phea_engineering::sizing::{
    BoreVerdict, Candidate, CommercialBore, Consequence, GainStep, Influence, SizedLoad, Sizing,
    UncertainHoseNumber,
};
use phea_hydraulics::stiffness::StiffnessModel;

use super::words::{decisions, hose_name, model_name, reason_words, uncertain_name, warnings};
use crate::answer::{Answer, Csv, OutputFile, Word, quoted, words};
use crate::quantity::Units;
use means::{OtherMeansAnswer, other_means};

/// Answer of `size`.
#[derive(Answer)]
pub(crate) struct SizeAnswer {
    /// Largest flow of a line.
    maximum_flow_m3_per_s: f64,
    /// Component that limits the largest flow.
    maximum_flow_limit: FlowLimit,
    /// Largest flow of a line that the valve passes.
    valve_flow_m3_per_s: f64,
    /// Flow of the pump, if it is stated.
    #[answer(optional)]
    pump_flow_m3_per_s: Option<f64>,
    /// Bores at the highest and at the lowest recommended oil velocity.
    #[answer(interval)]
    bore_range_m: [f64; 2],
    /// Proportional gain at which the time constant requires an infinite hydraulic stiffness.
    pole_gain_v_per_n: f64,
    /// Load in the model that is sized with.
    load: SizedLoad,
    /// Stiffness of the load at the rod, only of a load in series.
    #[answer(optional)]
    load_stiffness_n_per_m: Option<f64>,
    /// Declared effects that the procedure does not include.
    #[answer(optional)]
    warnings: Option<Vec<String>>,
    /// Bores on the market, ascending.
    bores: Vec<SizedBoreAnswer>,
    /// Hoses with their lengths and gains: accepted ones first, then those that nothing rejects,
    /// among these the stiffness model of the project first, then the shorter ones.
    candidates: Vec<CandidateAnswer>,
    /// Decisions of the procedure in order.
    decisions: Vec<SizingDecisionAnswer>,
    /// Influence of uncertain numbers on the best candidate of the stiffness model of the project.
    influences: Vec<InfluenceAnswer>,
    /// Other means with the stiffness of the best hose, if `[sizing.other_means]` requests them and
    /// a hose is accepted.
    #[answer(optional)]
    other_means: Option<OtherMeansAnswer>,
}

words! {
    /// Component that limits the largest flow.
    FlowLimit { Valve => "valve", Pump => "pump" }
}

words! {
    /// Load in the first-order model: its motion is prescribed, it yields in series with the
    /// sensor, or no stiffness holds it and the model holds it still.
    SizedLoad { Prescribed => "prescribed", Yielding { .. } => "in_series", HeldStill => "held_still" }
}

/// Bore on the market.
#[derive(Answer)]
struct SizedBoreAnswer {
    /// Dash size or product.
    name: String,
    /// Bore of the hose.
    bore_m: f64,
    /// Mean oil velocity at the largest flow.
    oil_velocity_m_per_s: f64,
    /// Verdict on the oil velocity.
    verdict: BoreVerdict,
}

words! {
    /// Verdict on the oil velocity of a bore: within the recommended range, below it, or above it
    /// and thus rejected.
    BoreVerdict { Recommended => "recommended", Slow => "slow", TooFast => "too_fast" }
}

/// Hose with its length and the proportional gain.
#[derive(Answer)]
struct CandidateAnswer {
    /// Name of the hose.
    hose: String,
    /// Stiffness model.
    compliance: StiffnessModel,
    /// Branch of the procedure.
    branch: SizingBranch,
    /// Bore of line A.
    bore_m: f64,
    /// Length of line A; zero if no hose is needed.
    length_m: f64,
    /// Bore of line B.
    bore_b_m: f64,
    /// Length of line B.
    length_b_m: f64,
    /// Least hydraulic stiffness over the stroke.
    stiffness_n_per_m: f64,
    /// Greatest hydraulic stiffness over the stroke.
    stiffness_maximum_n_per_m: f64,
    /// Proportional gain for the time constant at the least stiffness.
    proportional_gain_v_per_n: f64,
    /// Mean oil velocity at the largest flow.
    oil_velocity_m_per_s: f64,
    /// Pressure surge if the largest flow is stopped at once.
    surge_pressure_pa: f64,
    /// Time constant of the closed loop at the least and at the greatest stiffness over the stroke.
    time_constant_s: [f64; 2],
    /// Steady-state gain of the closed loop at the null flow-pressure coefficient and at the
    /// largest one.
    steady_state_gain: [f64; 2],
    /// True if nothing rejects it and every number that is needed is known.
    accepted: bool,
    /// Reasons for and against it, those that reject it first.
    reasons: Vec<String>,
    /// Reasons that reject it.
    rejections: Vec<String>,
    /// Reasons that leave it open, as a number is not known.
    not_known: Vec<String>,
    /// Reasons that only warn of it.
    warnings: Vec<String>,
    /// Trials of the gain, only of the branch by gain.
    iterations: Vec<GainTrialAnswer>,
}

words! {
    /// Stiffness model: one bulk modulus for line and chamber, or one of each volume.
    StiffnessModel by model_name [Uniform, ByVolume]
}

/// Branch of the procedure.
#[derive(Clone, Copy)]
enum SizingBranch {
    ByGain,
    ByLength,
}

words! {
    /// Branch of the procedure: the gain is given or searched for, or the length is given.
    SizingBranch { ByGain => "by_gain", ByLength => "by_length" }
}

/// Trial of a gain.
#[derive(Answer)]
struct GainTrialAnswer {
    /// Proportional gain.
    proportional_gain_v_per_n: f64,
    /// Hydraulic stiffness that the time constant requires; `inf` if no stiffness suffices.
    stiffness_n_per_m: f64,
    /// Length of line A with this stiffness; zero if no hose is needed.
    length_m: f64,
}

/// Decision of the procedure.
#[derive(Answer)]
struct SizingDecisionAnswer {
    /// Letter of the step in the flowchart of the thesis.
    step: &'static str,
    /// Sentence on the decision.
    text: String,
}

/// Influence of an uncertain number, all others being nominal.
#[derive(Answer)]
struct InfluenceAnswer {
    /// Uncertain number.
    quantity: UncertainHoseNumber,
    /// Low, nominal and high value in SI.
    values: [f64; 3],
    /// Least hydraulic stiffness over the stroke at the low, nominal and high value.
    stiffness_n_per_m: [f64; 3],
    /// Length of line A that keeps the nominal stiffness at the low, nominal and high value; zero
    /// if no hose is needed.
    length_m: [f64; 3],
}

words! {
    /// Uncertain number, with its symbol.
    UncertainHoseNumber by uncertain_name [DynamicStiffening, FluidBulkModulus, VolumetricExpansion]
}

/// Answer of `size`.
pub(crate) fn body(sizing: &Sizing, units: &Units) -> SizeAnswer {
    SizeAnswer {
        maximum_flow_m3_per_s: sizing.flow.line(),
        maximum_flow_limit: sizing.flow.limit,
        valve_flow_m3_per_s: sizing.flow.valve,
        pump_flow_m3_per_s: sizing.flow.pump.map(|(flow, _)| flow),
        bore_range_m: sizing.bore_range_m,
        pole_gain_v_per_n: sizing.pole_gain_v_per_n,
        load: sizing.load,
        load_stiffness_n_per_m: sizing.load.stiffness(),
        warnings: Some(warnings(sizing, units)).filter(|all| !all.is_empty()),
        bores: sizing.bores.iter().map(bore).collect(),
        candidates: sizing.candidates.iter().map(candidate).collect(),
        decisions: decisions(&sizing.decisions)
            .into_iter()
            .map(|(step, text)| SizingDecisionAnswer { step, text })
            .collect(),
        influences: sizing.influences.iter().map(influence).collect(),
        other_means: sizing.other_means.as_ref().map(other_means),
    }
}

fn bore(bore: &CommercialBore) -> SizedBoreAnswer {
    SizedBoreAnswer {
        name: hose_name(&bore.name),
        bore_m: bore.bore_m,
        oil_velocity_m_per_s: bore.oil_velocity_m_per_s,
        verdict: bore.verdict,
    }
}

fn candidate(candidate: &Candidate) -> CandidateAnswer {
    let branch = &candidate.branch;
    let of = |consequence| {
        let same = candidate.findings.iter().filter(move |finding| finding.consequence() == consequence);
        same.map(reason_words).collect()
    };
    CandidateAnswer {
        hose: hose_name(&candidate.option.name),
        compliance: branch.model,
        branch: sizing_branch(branch.by_gain),
        bore_m: candidate.option.hoses[0].bore,
        length_m: candidate.length_m(),
        bore_b_m: candidate.option.hoses[1].bore,
        length_b_m: branch.lengths_m[1],
        stiffness_n_per_m: branch.stiffness.minimum,
        stiffness_maximum_n_per_m: branch.stiffness.maximum,
        proportional_gain_v_per_n: branch.gain_v_per_n,
        oil_velocity_m_per_s: candidate.oil_velocity_m_per_s,
        surge_pressure_pa: candidate.surge_pressure_pa,
        time_constant_s: candidate.time_constant_s,
        steady_state_gain: candidate.steady_state_gain,
        accepted: candidate.accepted(),
        reasons: candidate.findings.iter().map(reason_words).collect(),
        rejections: of(Consequence::Rejects),
        not_known: of(Consequence::LeavesOpen),
        warnings: of(Consequence::Warns),
        iterations: branch.steps.iter().map(gain_trial).collect(),
    }
}

fn gain_trial(step: &GainStep) -> GainTrialAnswer {
    GainTrialAnswer {
        proportional_gain_v_per_n: step.gain_v_per_n,
        stiffness_n_per_m: step.stiffness_n_per_m,
        length_m: step.length_m,
    }
}

fn influence(influence: &Influence) -> InfluenceAnswer {
    InfluenceAnswer {
        quantity: influence.quantity,
        values: influence.values,
        stiffness_n_per_m: influence.stiffness_n_per_m,
        length_m: influence.length_m,
    }
}

/// Branch of the procedure that found a candidate.
fn sizing_branch(by_gain: bool) -> SizingBranch {
    if by_gain { SizingBranch::ByGain } else { SizingBranch::ByLength }
}

/// The word of that branch.
pub(super) fn branch_name(by_gain: bool) -> &'static str {
    sizing_branch(by_gain).word()
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
