//! Parts whose identified numbers do not explain their recordings.

use super::{Caveat, UncountedEffect, is_measured};
use crate::project::Project;
use crate::rig::ParameterOrigin;
use crate::setup::Setup;

/// Fraction of the range of a signal up to which a misfit does not change a verdict on its part.
pub const MISFIT_BOUND: f64 = 5e-3;

/// A part with a misfit.
#[derive(Clone, Debug, PartialEq)]
pub struct UnexplainedPart {
    /// Kind of the part.
    pub kind: UnexplainedKind,
    /// Table of the part in the project.
    pub table: &'static str,
    /// Fraction of the range of a recorded signal that remains unexplained.
    pub fraction: f64,
    /// Recording and range of the misfit, as the project states it.
    pub at: Option<String>,
}

/// The parts that are identified from recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnexplainedKind {
    /// The valve.
    Valve,
    /// A line.
    Line,
    /// The friction of the piston.
    Friction,
}

/// Consequence of a misfit for a verdict on the linear loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MisfitConsequence {
    /// Within the bound: a verdict on the part is unchanged.
    Within,
    /// Beyond the bound: no verdict on the part is met.
    Beyond,
    /// The viscous friction of the linear plant has another origin.
    OnlyOfRuns,
}

/// Caveats for misfits of identified parts; beyond the bound no verdict that is based on their
/// numbers is met.
pub(super) fn misfits(setup: &Setup<'_>) -> Vec<Caveat> {
    unexplained_parts(setup.project).into_iter().map(|part| part.caveat(setup)).collect()
}

/// The identified parts of a project that state a misfit.
pub fn unexplained_parts(project: &Project) -> Vec<UnexplainedPart> {
    let Some(actuator) = &project.actuator else { return Vec::new() };
    let [a, b] = [&actuator.line.a.misfit, &actuator.line.b.misfit];
    let lines = if a == b { [("line", a), ("line", &None)] } else { [("line.a", a), ("line.b", b)] };
    let friction = actuator.friction().and_then(|friction| friction.misfit.as_ref());
    let parts = [(UnexplainedKind::Valve, "valve", actuator.valve.misfit.as_ref())]
        .into_iter()
        .chain(lines.map(|(table, misfit)| (UnexplainedKind::Line, table, misfit.as_ref())))
        .chain([(UnexplainedKind::Friction, "cylinder.friction", friction)]);
    let stated = parts.filter_map(|(kind, table, misfit)| Some((kind, table, misfit?)));
    stated
        .map(|(kind, table, misfit)| UnexplainedPart {
            kind,
            table,
            fraction: misfit.fraction,
            at: misfit.at.clone(),
        })
        .collect()
}

impl UnexplainedPart {
    /// Consequence for a verdict.
    fn caveat(self, setup: &Setup<'_>) -> Caveat {
        let consequence = match self.kind {
            UnexplainedKind::Friction if !takes_viscous_of_friction(setup) => MisfitConsequence::OnlyOfRuns,
            _ if self.fraction > MISFIT_BOUND => MisfitConsequence::Beyond,
            _ => MisfitConsequence::Within,
        };
        let unproven = consequence == MisfitConsequence::Beyond;
        Caveat { effect: UncountedEffect::Misfit(self, consequence), unproven }
    }
}

/// True if the viscous friction of the linear plant follows from the identified friction: false if
/// `[linear]` or `[uncertainty]` states it, or the plants were measured.
fn takes_viscous_of_friction(setup: &Setup<'_>) -> bool {
    let Ok(rig) = setup.rig() else { return true };
    let derived = |name: &str| {
        rig.parameters.iter().any(|one| one.name == name && one.origin == ParameterOrigin::Derived)
    };
    !is_measured(setup.project) && derived("viscous_friction")
}
