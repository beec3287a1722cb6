//! Sizing of high-volumetric-expansion hoses: the procedure of Ledezma (2019), section 6.3, over a
//! whole catalogue.
//!
//! A first-order force response with time constant tau_d under a proportional gain K_p requires one
//! hydraulic stiffness; a hose of bore D and length L_ho gives one. [`size`] follows both branches
//! of the flowchart (by gain, by length) for every hose and for both stiffness models, and records
//! each decision with its numbers.

mod bore;
mod branch;
mod candidate;
mod of_project;
mod other_means;
mod problem;
mod reason;
mod sensitivity;
mod step;

pub use bore::{BoreVerdict, CommercialBore};
pub use branch::{Branch, GainStep};
pub use candidate::Candidate;
pub(crate) use of_project::own_hoses;
pub use of_project::{SizingError, sizing_problem};
pub use other_means::{
    CoilUnknown, OtherMeans, OtherMeansError, OtherMeansProblem, SizedGas, SizedPipe, SizedSpring, SizedValve,
};
pub use problem::{
    HoseName, HoseOption, SizedLoad, SizingProblem, SoonerRequirement, TimeConstantOrigin, UnlikeLines,
};
pub use reason::{Consequence, SizingReason};
pub use sensitivity::{Influence, UncertainHoseNumber, sensitivity};
pub use step::{SizedSystem, SizingStep};

use phea_hydraulics::port_valves::ValveAtPoint;
use phea_hydraulics::stiffness::StiffnessModel;

use crate::rig::LargestFlow;

/// Question that is resolved for every hose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// Both branches: the gain is searched for, and the stock length is evaluated.
    Both,
    /// Length for this gain K_p, V/N.
    Gain(f64),
    /// Gain for this length of each line, m.
    Length(f64),
}

/// The outcome of the procedure.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizing {
    /// Every bore considered, with its oil velocity.
    pub bores: Vec<CommercialBore>,
    /// Largest flows of the lines, and their limitation.
    pub flow: LargestFlow,
    /// Bores from equation 6.17 at the highest and at the lowest recommended velocity, m.
    pub bore_range_m: [f64; 2],
    /// Gain at which equation 6.16 requires an infinitely stiff transmission, V/N.
    pub pole_gain_v_per_n: f64,
    /// Load for the time constant.
    pub load: SizedLoad,
    /// The stiffness model of the project.
    pub model: StiffnessModel,
    /// Every candidate: accepted ones first, then those that nothing rejects, among these the
    /// project's model first, then the shorter ones.
    pub candidates: Vec<Candidate>,
    /// The decisions in order.
    pub decisions: Vec<SizingStep>,
    /// Influence of the uncertainties on the best candidate of the project's stiffness model.
    pub influences: Vec<Influence>,
    /// Relief and check valves that act within the pressure of the supply, each with its chamber;
    /// the procedure does not include them.
    pub port_valves: Vec<(char, ValveAtPoint)>,
    /// Other means with equal stiffness; `None` if not requested, and without an accepted hose.
    pub other_means: Option<OtherMeans>,
}

/// Sizes every hose of the problem.
pub fn size(problem: &SizingProblem, question: Question) -> Sizing {
    let mut decisions = problem.decisions();
    let bores = bore::assess(problem, &mut decisions);
    if question == Question::Both {
        decisions.push(problem.search_decision());
    }
    let mut candidates = Vec::new();
    for option in &problem.hoses {
        for model in [StiffnessModel::Uniform, StiffnessModel::ByVolume] {
            for branch in branch::branches(problem, option, model, question) {
                decisions.push(SizingStep::Branch(option.name.clone(), branch.clone()));
                candidates.push(candidate::assess(problem, option, branch));
            }
        }
    }
    // Lengths that differ by the search's rounding are one length; ties are in the order of the
    // catalogue.
    let micrometres = |candidate: &Candidate| (candidate.length_m() * 1e6).round();
    let other_model = |candidate: &Candidate| candidate.branch.model != problem.model;
    candidates.sort_by(|one, other| {
        let accepted = other.accepted().cmp(&one.accepted());
        let declared = other_model(one).cmp(&other_model(other));
        let fits = other.fits().cmp(&one.fits());
        accepted.then(fits).then(declared).then(micrometres(one).total_cmp(&micrometres(other)))
    });
    let mut sizing = Sizing {
        load: problem.load,
        model: problem.model,
        flow: problem.flow.clone(),
        bores,
        bore_range_m: bore::range(problem),
        pole_gain_v_per_n: problem.pole_gain(),
        candidates,
        decisions,
        influences: vec![],
        port_valves: problem.port_valves.clone(),
        other_means: None,
    };
    sizing.influences = sizing.best().map(|candidate| sensitivity(problem, candidate)).unwrap_or_default();
    let best = sizing.best().map(|best| (best.branch.stiffness.minimum, best.option.hoses[0].bore));
    sizing.other_means = problem
        .other_means
        .as_ref()
        .zip(best)
        .map(|(requested, (stiffness, bore))| requested.solve(stiffness, bore));
    sizing
}

impl Sizing {
    /// Result of the sizing: the first candidate of the project's stiffness model that nothing
    /// rejects; it is accepted if all required data are known for any hose that fits.
    pub fn best(&self) -> Option<&Candidate> {
        self.best_of(self.model)
    }

    /// The stiffness model that the project does not declare.
    pub fn other_model(&self) -> StiffnessModel {
        match self.model {
            StiffnessModel::Uniform => StiffnessModel::ByVolume,
            StiffnessModel::ByVolume => StiffnessModel::Uniform,
        }
    }

    /// The first candidate of a stiffness model that nothing rejects.
    pub fn best_of(&self, model: StiffnessModel) -> Option<&Candidate> {
        self.candidates.iter().find(|candidate| candidate.fits() && candidate.branch.model == model)
    }
}
