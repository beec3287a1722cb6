//! Parts whose identified numbers do not explain the recordings that they come from.

use super::{Caveat, is_measured};
use crate::project::{DeclaredMisfit, Project};
use crate::quantity::significant;
use crate::rig::ParameterOrigin;
use crate::setup::Setup;

/// Fraction of the range of a signal up to which a misfit leaves a verdict on its part as it is.
const BOUND: f64 = 5e-3;

/// A part with a misfit.
struct UnexplainedPart<'a> {
    kind: UnexplainedKind,
    /// Its table.
    table: &'static str,
    misfit: &'a DeclaredMisfit,
}

/// The parts that are identified from recordings.
#[derive(Clone, Copy, PartialEq, Eq)]
enum UnexplainedKind {
    Valve,
    Line,
    Friction,
}

/// The misfits of identified parts; beyond the bound no verdict that rests on their numbers is met.
pub(super) fn misfits(setup: &Setup<'_>) -> Vec<Caveat> {
    unexplained_parts(setup.project).iter().map(|part| part.caveat(setup)).collect()
}

/// The misfits of identified parts, for runs of the machine, on which no verdict is given.
pub fn misfits_in_runs(project: &Project) -> Vec<String> {
    let of = |part: UnexplainedPart<'_>| format!("{}: these runs do not contain it", part.statement());
    unexplained_parts(project).into_iter().map(of).collect()
}

fn unexplained_parts(project: &Project) -> Vec<UnexplainedPart<'_>> {
    let Some(actuator) = &project.actuator else { return Vec::new() };
    let [a, b] = [&actuator.line.a.misfit, &actuator.line.b.misfit];
    let lines = if a == b { [("line", a), ("line", &None)] } else { [("line.a", a), ("line.b", b)] };
    let friction = actuator.friction().and_then(|friction| friction.misfit.as_ref());
    let parts = [(UnexplainedKind::Valve, "valve", actuator.valve.misfit.as_ref())]
        .into_iter()
        .chain(lines.map(|(table, misfit)| (UnexplainedKind::Line, table, misfit.as_ref())))
        .chain([(UnexplainedKind::Friction, "cylinder.friction", friction)]);
    parts.filter_map(|(kind, table, misfit)| Some(UnexplainedPart { kind, table, misfit: misfit? })).collect()
}

impl UnexplainedPart<'_> {
    /// Statement of the misfit with its recording.
    fn statement(&self) -> String {
        let numbers = match self.kind {
            UnexplainedKind::Valve => "the coefficients of the valve leave",
            UnexplainedKind::Line => "the moduli of the line leave",
            UnexplainedKind::Friction => "the friction leaves",
        };
        let at = self.misfit.at.as_ref().map_or_else(String::new, |at| format!(", {at}"));
        format!(
            "{numbers} {} % of the range of a recorded signal unexplained ({}.misfit{at})",
            significant(100.0 * self.misfit.share, 3),
            self.table
        )
    }

    /// Consequence for a verdict.
    fn caveat(&self, setup: &Setup<'_>) -> Caveat {
        let beyond = self.misfit.share > BOUND;
        let bound = significant(100.0 * BOUND, 3);
        let judged = |part: &str| match beyond {
            true => format!("beyond {bound} % no verdict on this {part} is met"),
            false => format!("up to {bound} % a verdict on this {part} stands"),
        };
        let (consequence, unproven) = match self.kind {
            UnexplainedKind::Valve => (judged("valve"), beyond),
            UnexplainedKind::Line => (judged("line"), beyond),
            UnexplainedKind::Friction if takes_viscous_of_friction(setup) => {
                let of_plant = judged("`viscous`");
                (format!("the linear plant has `viscous` alone of it, and {of_plant}; {IN_RUNS}"), beyond)
            }
            UnexplainedKind::Friction => {
                let stands = "the linear plant has its viscous friction from elsewhere, so that a verdict on the linear loop stands";
                (format!("{stands}; {IN_RUNS}"), false)
            }
        };
        Caveat { sentence: format!("{}: {consequence}", self.statement()), unproven }
    }
}

/// Consequence of a misfit of friction for the machine.
const IN_RUNS: &str = "nonlinear runs have all of this friction, and sticking, settling and residual errors that they show do not contain its misfit";

/// True where the viscous friction of the linear plant follows from the identified friction: it is
/// not where `[linear]` or `[uncertainty]` states it, or the plants were measured.
fn takes_viscous_of_friction(setup: &Setup<'_>) -> bool {
    let Ok(rig) = setup.rig() else { return true };
    let derived = |name: &str| {
        rig.parameters.iter().any(|one| one.name == name && one.origin == ParameterOrigin::Derived)
    };
    !is_measured(setup.project) && derived("viscous_friction")
}
