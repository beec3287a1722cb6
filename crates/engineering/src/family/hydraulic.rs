//! The uncertain plant of an actuator: the linear plant of its rig over parameters of the linear
//! model and over numbers of the project.
//!
//! The chain from the project to the plant is that of [`RigAtPoint`], here over recorded numbers.
//! Pressures that depend on an uncertain number are recorded with it, see
//! [`phea_hydraulics::operating_point::Balance::settle`].

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
use phea_hydraulics::line::LineError;
use phea_hydraulics::operating_point::{Balance, Settled};
use phea_hydraulics::plant::{LinearPlant, PlantInMotion};
use phea_hydraulics::servovalve::Supply;

use super::moved::{self, MovedNumber};
use super::start::BalanceStart;
use super::visited::Visited;
use super::{NoEffect, ProjectFamilyError};
use crate::project::{DeclaredActuator, LINEAR_PARAMETERS, OpenRig, Project};
use crate::rig::{DeclaredRig, Equal, Rig, RigAtPoint, UnsolvedRig, stated};
use crate::setup::Setup;

/// Records the plant with the uncertain numbers as parameters and all others at their values.
pub(super) fn uncertain_plant(
    setup: &Setup<'_>,
    parameters: Vec<UncertainParameter>,
) -> Result<UncertainPlant, ProjectFamilyError> {
    let project = setup.project;
    let visited = Visited::new(setup, &parameters)?;
    let Some(declared) = &project.actuator else { return Err(crate::rig::RigError::NoActuator.into()) };
    let recorded = UncertainPlant::record(parameters, |values| {
        visited.open(project, declared).plant(values, visited.moved, visited.equal).1.coefficients()
    })?;
    let recorded = match BalanceStart::of(&visited, project, recorded.parameters()) {
        None => recorded,
        Some(start) => {
            let open = Open { start: Some(&start), ..visited.open(project, declared) };
            let followed = UncertainPlant::record(recorded.parameters().to_vec(), |values| {
                open.plant(values, visited.moved, visited.equal).1.coefficients()
            })?;
            recorded.with_followed(&followed)
        }
    };
    let expression = recorded.expression();
    let mut all = recorded.parameters().iter().enumerate();
    let idle = all.find(|(index, _)| expression.is_some_and(|one| !one.depends_on(*index)));
    match idle {
        Some((_, UncertainParameter { name, .. })) => {
            Err(ProjectFamilyError::Path { path: name.clone(), reason: reason(name, project) })
        }
        None => Ok(recorded),
    }
}

/// The plant of one member behind lines in motion, or with delayed feed-forward; `None` where both
/// lines are lumped and nothing is fed forward with a delay.
///
/// # Errors
/// A line that its model cannot describe.
pub(super) fn in_motion(
    project: &Project,
    visited: &Visited,
    values: &[f64],
) -> Result<Option<PlantInMotion>, LineError> {
    let Some(declared) = &project.actuator else { return Ok(None) };
    let open = visited.open(project, declared);
    let (place, plant) = open.plant(values, visited.moved, visited.equal);
    let moving = place.in_motion(&plant)?;
    Ok(visited.rig.as_response(moving, &plant))
}

/// A rig with some of its numbers open.
pub(super) struct Open<'a> {
    pub(super) project: &'a Project,
    pub(super) declared: &'a DeclaredActuator,
    pub(super) rig: &'a Rig,
    /// Of the parameters, then of what their directions move.
    pub(super) names: &'a [String],
    /// The rig with these numbers open.
    pub(super) table: &'a OpenRig,
    pub(super) moved: &'a [MovedNumber],
    /// What the balance is solved from; by halving where it is absent.
    pub(super) start: Option<&'a BalanceStart>,
}

impl Open<'_> {
    /// The declared rig with these values of its open numbers.
    pub(super) fn rig_with<S: Scalar>(&self, values: &[S]) -> DeclaredRig<'_, S> {
        let all = self.all(values);
        DeclaredRig::open(self.project, self.declared, self.table, self.names, &all)
    }

    /// The rig before its pressures are solved, with the supply as it is stated.
    pub(super) fn unsolved<S: Scalar>(&self, values: &[S]) -> UnsolvedRig<S> {
        UnsolvedRig::of(&self.rig_with(values))
    }

    /// The rig before its pressures are solved, its balance with the settled supply.
    pub(super) fn balanced<S: Scalar>(&self, values: &[S]) -> UnsolvedRig<S> {
        let unsolved = self.unsolved(values);
        let found = unsolved.settled_supply();
        let supply = found.map_or(unsolved.balance.supply, |found| found.supply);
        let balance = Balance { supply, ..unsolved.balance };
        UnsolvedRig { balance, ..unsolved }
    }

    /// The values of all open numbers.
    pub(super) fn all<S: Scalar>(&self, parameters: &[S]) -> Vec<S> {
        moved::values(parameters, self.moved)
    }

    /// The rig with these values, and its plant with lumped lines as the loop sees it. Its
    /// pressures are those of the declared rig if nothing changes them, and so are the virtual
    /// impedance and what is fed forward and back.
    pub(super) fn plant<S: Scalar>(
        &self,
        values: &[S],
        moved: bool,
        equal: Equal,
    ) -> (RigAtPoint<S>, LinearPlant<S>) {
        let (supply, settled) = self.solved(values, moved);
        self.plant_at(values, supply, settled, equal)
    }

    /// The rig and its plant with supply, spool and pressures at these.
    pub(super) fn plant_at<S: Scalar>(
        &self,
        values: &[S],
        supply: Supply<S>,
        settled: Settled<S>,
        equal: Equal,
    ) -> (RigAtPoint<S>, LinearPlant<S>) {
        let place = self.place_at(values, supply, settled);
        let plant = self.rig.with_inner_paths(place.plant(equal));
        (place, plant)
    }

    /// The rig with these values; its pressures are those of the declared rig if nothing changes
    /// them.
    pub(super) fn place<S: Scalar>(&self, values: &[S], moved: bool) -> RigAtPoint<S> {
        let (supply, settled) = self.solved(values, moved);
        self.place_at(values, supply, settled)
    }

    /// Supply, spool and pressures at the operating point.
    pub(super) fn solved<S: Scalar>(&self, values: &[S], moved: bool) -> (Supply<S>, Settled<S>) {
        if moved {
            let UnsolvedRig { steady, balance, .. } = self.balanced(values);
            let settled = match self.start {
                None => balance.settle(steady),
                Some(start) => balance.settle_from(steady, start.at(values)),
            };
            return (balance.supply, settled);
        }
        let (known, idle) = (&self.rig.point, self.unsolved(values).balance.supply);
        let pressure = self.rig.supply.map_or(idle.pressure, |found| S::from(found.supply.pressure));
        let pressures = [known.pressure_a, known.pressure_b].map(S::from);
        (Supply { pressure, ..idle }, Settled { command: S::from(known.command), pressures })
    }

    /// The rig with these values, and with supply, spool and pressures at these.
    fn place_at<S: Scalar>(&self, values: &[S], supply: Supply<S>, settled: Settled<S>) -> RigAtPoint<S> {
        let all = self.all(values);
        let rig = self.rig_with(values);
        let unsolved = UnsolvedRig::of(&rig);
        let known = stated(self.project).map(|(name, value)| (name, S::from(value)));
        let open = self.names.iter().map(String::as_str).zip(all.iter().copied());
        let linear = known.chain(open.filter(|(name, _)| is_linear(name)));
        RigAtPoint::of(&rig, &unsolved, supply, unsolved.point(settled), linear)
    }
}

pub(super) fn is_linear(name: &str) -> bool {
    LINEAR_PARAMETERS.iter().any(|parameter| parameter.key.name == name)
}

/// Reason why a number does not affect the plant.
fn reason(path: &str, project: &Project) -> NoEffect {
    if LINEAR_PARAMETERS.iter().any(|parameter| parameter.follows_from(path)) {
        return NoEffect::StatedInstead;
    }
    match path.starts_with("fluid.") && project.has_waves() {
        true => NoEffect::OnlyInWaves { path: path.to_string() },
        false => NoEffect::NotInModel,
    }
}
