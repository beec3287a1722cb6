//! An alternative whose gas, spring, pipe or valve between the chambers is sized for the stiffness
//! of the hose that `[sizing]` finds for the project as declared.

use super::{PrepareError, PreparedAlternative};
use crate::catalogue::Catalogue;
use crate::project::{Component, CrossPortKind, DeclaredActuator};
use crate::setup::Setup;
use crate::sizing::{OtherMeans, Question, size, sizing_problem};

/// Additional travel of a sized spring, as a fraction of the travel under the stall force.
const SPARE_TRAVEL: f64 = 0.1;

/// Part of an alternative that is sized in place of a hose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OtherPart {
    Gas,
    Spring,
    Valve,
    Pipe,
}

impl OtherPart {
    /// Part that this alternative has and the declared project lacks; `None` if there is none.
    pub(super) fn of(declared: &DeclaredActuator, other: &DeclaredActuator) -> Option<OtherPart> {
        let gas = |rig: &DeclaredActuator| rig.line.a.accumulator.is_some() && rig.line.a == rig.line.b;
        let spring = |rig: &DeclaredActuator| rig.series.as_ref().is_some_and(|one| one.spring().is_some());
        let laminar = |rig: &DeclaredActuator| {
            rig.cross_port.as_ref().is_some_and(|port| matches!(port.kind, CrossPortKind::Laminar { .. }))
        };
        let pipe = |rig: &DeclaredActuator| {
            rig.line.a == rig.line.b && matches!(rig.line.a.component, Component::Pipe { .. })
        };
        let parts = [
            (gas(other) && !gas(declared), OtherPart::Gas),
            (spring(other) && !spring(declared), OtherPart::Spring),
            (laminar(other) && !laminar(declared), OtherPart::Valve),
            (pipe(other) && !pipe(declared), OtherPart::Pipe),
        ];
        parts.into_iter().find(|(is_new, _)| *is_new).map(|(_, part)| part)
    }

    /// Settings that size the part for the project as declared.
    ///
    /// # Errors
    /// The reason why it cannot be sized.
    pub(super) fn settings(
        self,
        declared: &PreparedAlternative,
        other: &DeclaredActuator,
        catalogue: &Catalogue,
    ) -> Result<Vec<String>, PrepareError> {
        let setup = Setup::around(&declared.loaded.project, declared.rig.clone())?;
        let problem = sizing_problem(&setup, catalogue)?;
        let found = size(&problem, Question::Both).other_means.ok_or(PrepareError::NoOtherMeans)?;
        self.of_means(&found, other)
    }

    fn of_means(self, found: &OtherMeans, other: &DeclaredActuator) -> Result<Vec<String>, PrepareError> {
        match self {
            OtherPart::Gas => {
                let gas = found.gas?;
                Ok(vec![
                    format!("line.accumulator.gas_volume={:e}", gas.volume),
                    format!("line.accumulator.precharge_pressure={:e}", gas.precharge),
                ])
            }
            OtherPart::Spring => {
                let spring = found.spring?;
                let limited = other.series.as_ref().and_then(|one| one.spring()?.travel);
                let travel =
                    limited.map(|_| format!("series.travel={:e}", (1.0 + SPARE_TRAVEL) * spring.travel));
                Ok([format!("series.stiffness={:e}", spring.stiffness)].into_iter().chain(travel).collect())
            }
            OtherPart::Valve => {
                let [_, alone] = found.valves?;
                let conductance = alone.conductance.ok_or(PrepareError::NoValve)?;
                Ok(vec![format!("cross_port.conductance={conductance:e}")])
            }
            OtherPart::Pipe => {
                let pipe = found.pipe?;
                Ok(vec![format!("line.pipe.bore={:e}", pipe.bore), format!("line.length={:e}", pipe.length)])
            }
        }
    }
}
