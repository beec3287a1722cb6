//! The chapter on sizing: decisions, nomograph, candidates, uncertainties.

use phea_engineering::sizing::{BoreVerdict, Candidate, Sizing, SizingError, SizingProblem};

use super::chapter::Chapter;
use crate::document::{Document, StatusMark};
use crate::figure::{
    CandidateVerdict, DisplayUnit, Figure, Nomograph, NomographBore, SizingCandidate, SizingChart,
    SizingCurve, Tornado, TornadoBar, Words,
};
use crate::quantity::Units;
use crate::sizing::{document, hose_name, model_name, uncertain_name};
use phea_hydraulics::stiffness::StiffnessModel;

pub(super) fn chapter(problem: &SizingProblem, sizing: &Sizing, units: &Units) -> Chapter {
    let hoses = match problem.hoses.len() {
        1 => "the one hose".to_string(),
        count => format!("the {count} hoses"),
    };
    let mut out = Document::default();
    out.explanation(format!("The procedure of Ledezma (2019), section 6.3, applied to {hoses} of the catalogue, once with each stiffness model; both lines alike."));
    out.append(document(sizing, figures(problem, sizing), units));
    Chapter::of("sizing", "Sizing of the hose", out)
}

/// Nomograph, lengths and, if a hose is chosen, its uncertainties.
pub(super) fn figures(problem: &SizingProblem, sizing: &Sizing) -> Vec<Figure> {
    let mut figures = vec![bores(problem, sizing), lengths(problem, sizing)];
    figures.extend(uncertain(sizing));
    figures
}

/// Replacement for the chapter: the reason why the procedure does not apply to the rig.
pub(super) fn refused(error: &SizingError) -> Chapter {
    let mut out = Document::default();
    out.verdict(StatusMark::Note, "No hose is sized", vec![error.to_string()]);
    Chapter::of("sizing", "Sizing of the hose", out)
}

fn bores(problem: &SizingProblem, sizing: &Sizing) -> Figure {
    let bore = |bore: &phea_engineering::sizing::CommercialBore| NomographBore {
        bore_m: bore.bore_m,
        label: hose_name(&bore.name),
        verdict: match bore.verdict {
            BoreVerdict::Recommended => CandidateVerdict::Accepted,
            BoreVerdict::Slow => CandidateVerdict::Warned,
            BoreVerdict::TooFast => CandidateVerdict::Rejected,
        },
    };
    let [slowest, fastest] = problem.oil_velocity;
    let [smallest, largest] = sizing.bore_range_m.map(|bore| DisplayUnit::MILLIMETRE.number(bore, 3));
    let caption = format!(
        "At {} L/min the recommended velocities of {slowest} to {fastest} m/s take a bore of {smallest} to {largest} mm. A faster bore is rejected, a slower one only causes a warning.",
        DisplayUnit::LITRE_PER_MINUTE.number(problem.maximum_flow(), 3)
    );
    let chart = Nomograph {
        bores: sizing.bores.iter().map(bore).collect(),
        design_flow_m3_per_s: problem.maximum_flow(),
        velocity_range_m_per_s: (slowest, fastest),
    };
    chart.draw(&Words::new("sizing-nomograph", "Feasible bores", caption))
}

fn lengths(problem: &SizingProblem, sizing: &Sizing) -> Figure {
    let longest = sizing
        .candidates
        .iter()
        .map(Candidate::length_m)
        .filter(|l| l.is_finite())
        .fold(problem.hose_length[1], f64::max);
    let lengths: Vec<f64> =
        (1..=60).map(|step| longest.min(3.0 * problem.hose_length[1]) * f64::from(step) / 60.0).collect();
    let mut curves = Vec::new();
    for option in &problem.hoses {
        for model in [StiffnessModel::Uniform, StiffnessModel::ByVolume] {
            let stiffness: Vec<f64> = lengths
                .iter()
                .map(|length| {
                    let proportion = option.proportion(model, problem.fluid_modulus);
                    problem
                        .stroke_stiffness(option, proportion.map(|fraction| fraction * length), model)
                        .minimum
                })
                .collect();
            curves.push(SizingCurve {
                name: format!("{}, {}", hose_name(&option.name), model_name(model)),
                lengths_m: lengths.clone(),
                gain_v_per_n: stiffness.iter().map(|value| problem.gain_for_stiffness(*value)).collect(),
                stiffness_n_per_m: stiffness,
            });
        }
    }
    let candidates = sizing
        .candidates
        .iter()
        .filter(|c| c.length_m() > 0.0 && c.length_m() <= 3.0 * problem.hose_length[1])
        .map(|candidate| SizingCandidate {
            label: String::new(),
            length_m: candidate.length_m(),
            stiffness_n_per_m: candidate.branch.stiffness.minimum,
            gain_v_per_n: candidate.branch.gain_v_per_n,
            verdict: if candidate.accepted() {
                CandidateVerdict::Accepted
            } else {
                CandidateVerdict::Rejected
            },
        });
    let chart = SizingChart {
        curves,
        candidates: candidates.collect(),
        length_range_m: Some((problem.hose_length[0], problem.hose_length[1])),
        minimum_gain_v_per_n: Some(problem.minimum_gain),
        pole_gain_v_per_n: Some(sizing.pole_gain_v_per_n),
    };
    let caption = format!(
        "Least stiffness over the stroke and the proportional gain that makes the time constant {} ms, for each length of hose per line.",
        DisplayUnit::MILLISECOND.number(problem.time_constant, 3)
    );
    chart.draw(&Words::new("sizing-length", "Length, stiffness and gain", caption))
}

fn uncertain(sizing: &Sizing) -> Option<Figure> {
    let nominal = sizing.influences.first()?.stiffness_n_per_m[1];
    let bars = sizing.influences.iter().map(|influence| TornadoBar {
        parameter: uncertain_name(influence.quantity).to_string(),
        low_setting: influence.unit.text(influence.values[0], 3),
        high_setting: influence.unit.text(influence.values[2], 3),
        low_value: influence.stiffness_n_per_m[0],
        high_value: influence.stiffness_n_per_m[2],
    });
    let chart = Tornado {
        quantity: "Hydraulic stiffness K_H".to_string(),
        unit: DisplayUnit::MEGANEWTON_PER_METRE,
        nominal,
        bars: bars.collect(),
    };
    let caption = "Least stiffness over the stroke of the chosen hose.";
    Some(chart.draw(&Words::new("sizing-sensitivity", "Influence on the stiffness", caption)))
}
