//! The uncertain plant of an actuator: the linear plant of its rig over parameters of the linear
//! model and over numbers of the project.
//!
//! There is one chain from the project to the plant, that of [`Rig`]; here it runs over recorded
//! numbers. Pressures that depend on an uncertain number are recorded with it, see
//! [`phea_hydraulics::operating_point::Balance::settle`].

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cross_port::DynamicFeedback;
use phea_hydraulics::line::{LineError, StiffeningMember};
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::machine::PowerUnit;
use phea_hydraulics::operating_point::{
    Balance, OperatingPoint, Settled, SettledSupply, Steady, hydraulic_force,
};
use phea_hydraulics::plant::{
    LinearLoad, LinearPlant, LinearSeries, PlantInMotion, VelocitySensor, YieldingSupply,
};
use phea_hydraulics::servovalve::Supply;
use phea_hydraulics::two_pressure::{
    TwoPressureLinearParameters, TwoPressureModel, two_pressure_linear_parameters,
};

use super::moved::{self, MovedNumber};
use super::start::BalanceStart;
use super::visited::Visited;
use super::{NoEffect, ProjectFamilyError};
use crate::project::{DeclaredActuator, LINEAR_PARAMETERS, Project};
use crate::rig::{
    self, Numbers, Rig, components, has_gas_states, linear, load_at, place, plant, settled_supply,
    spool_side, stated, with_gas, with_supply, yielding_supply,
};
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
    let moving = rig::in_motion(&place.components, &place.point, &place.chambers, &plant)?;
    Ok(visited.rig.as_response(moving, &plant))
}

/// A rig with some of its numbers open.
pub(super) struct Open<'a> {
    pub(super) project: &'a Project,
    pub(super) declared: &'a DeclaredActuator,
    pub(super) rig: &'a Rig,
    /// Of the parameters, then of what their directions move.
    pub(super) names: &'a [String],
    pub(super) moved: &'a [MovedNumber],
    /// What the balance is solved from; by halving where it is absent.
    pub(super) start: Option<&'a BalanceStart>,
}

/// A rig at its operating point.
pub(super) struct RigAtPoint<S> {
    /// With the supply as it is stated.
    pub(super) components: Components<S>,
    pub(super) point: OperatingPoint<S>,
    pub(super) chambers: TwoPressureLinearParameters<S>,
    /// With the parameters of the linear model that `[linear]` and `[uncertainty]` state.
    pub(super) linear: LinearParameters<S>,
    /// From chamber to chamber.
    pub(super) leakage: S,
    pub(super) dynamic_feedback: Option<DynamicFeedback<S>>,
    /// `None` where the supply has a constant pressure.
    pub(super) supply: Option<YieldingSupply<S>>,
}

/// Equalities between both sides of every plant of a family.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equal {
    /// Both chambers are equal, or their parameters are stated: one load pressure describes them.
    pub(super) one_pressure: bool,
    /// Their coupling to the supply is equal, so that it does not affect the difference of their
    /// pressures.
    pub(super) edges: bool,
}

impl Open<'_> {
    /// What determines the pressures, with the settled supply.
    pub(super) fn balance<S: Scalar>(&self, values: &[S]) -> (S, Steady<S>, Balance<S>) {
        let all = self.all(values);
        let numbers = Numbers::open(self.names, &all);
        let components = components(self.declared, &numbers);
        Self::settled(&components.power_unit, self.idle(&components, &numbers))
    }

    /// The same with the supply as it is stated.
    pub(super) fn stated<S: Scalar>(&self, values: &[S]) -> (S, Steady<S>, Balance<S>) {
        let all = self.all(values);
        let numbers = Numbers::open(self.names, &all);
        self.idle(&components(self.declared, &numbers), &numbers)
    }

    /// The values of all open numbers.
    pub(super) fn all<S: Scalar>(&self, parameters: &[S]) -> Vec<S> {
        moved::values(parameters, self.moved)
    }

    fn settled<S: Scalar>(
        power_unit: &PowerUnit<S>,
        (position, steady, idle): (S, Steady<S>, Balance<S>),
    ) -> (S, Steady<S>, Balance<S>) {
        let found = settled_supply(power_unit, &idle, steady);
        let supply = found.map_or(idle.supply, |found| found.supply);
        (position, steady, Balance { supply, ..idle })
    }

    /// The same with the supply as it is stated.
    fn idle<S: Scalar>(
        &self,
        components: &Components<S>,
        numbers: &Numbers<'_, S>,
    ) -> (S, Steady<S>, Balance<S>) {
        let (position, steady) = place(self.project, components, numbers);
        (position, steady, Balance::at(components, position))
    }

    /// The rig with these values, and its plant with lumped lines as the loop sees it. What is fed
    /// forward and back and the virtual impedance are those of the declared rig.
    pub(super) fn plant<S: Scalar>(
        &self,
        values: &[S],
        moved: bool,
        equal: Equal,
    ) -> (RigAtPoint<S>, LinearPlant<S>) {
        let solved = self.solved(values, moved);
        self.plant_at(values, solved, equal)
    }

    /// The same with supply, spool and pressures at these values.
    pub(super) fn plant_at<S: Scalar>(
        &self,
        values: &[S],
        solved: (Supply<S>, Settled<S>),
        equal: Equal,
    ) -> (RigAtPoint<S>, LinearPlant<S>) {
        let place = self.place_at(values, solved);
        let all = self.all(values);
        let numbers = Numbers::open(self.names, &all);
        let load = load_at(&self.declared.load, &numbers, &place.components, &place.point);
        let load = load.map_or(LinearLoad::Prescribed, |load| load.linear());
        let plant = plant(&place.chambers, &place.linear, equal.one_pressure, place.leakage, load);
        let plant = match place.supply {
            Some(supply) if !(equal.one_pressure && equal.edges) || has_gas_states(self.declared) => {
                with_supply(plant, supply, &place.chambers)
            }
            _ => plant,
        };
        let pressures = [place.point.pressure_a, place.point.pressure_b];
        let plant = with_gas(plant, &place.components, &place.chambers, pressures);
        let velocity_sensor =
            VelocitySensor { gain: place.components.velocity_gain, ..plant.velocity_sensor };
        let force = place.point.hydraulic_force;
        let series = LinearSeries::of_components(&place.components, force);
        let dynamic_feedback = place.dynamic_feedback;
        let virtual_impedance = self.rig.virtual_impedance;
        let cylinder = &place.components.cylinder;
        let area_stiffness = cylinder.area_stiffness(place.point.position, pressures);
        let plant = LinearPlant {
            series,
            velocity_sensor,
            dynamic_feedback,
            virtual_impedance,
            area_stiffness,
            ..plant
        };
        (place, self.rig.with_inner_paths(plant))
    }

    /// The rig with these values; its pressures are those of the declared rig if nothing changes
    /// them.
    pub(super) fn place<S: Scalar>(&self, values: &[S], moved: bool) -> RigAtPoint<S> {
        let solved = self.solved(values, moved);
        self.place_at(values, solved)
    }

    /// Supply, spool and pressures at the operating point.
    pub(super) fn solved<S: Scalar>(&self, values: &[S], moved: bool) -> (Supply<S>, Settled<S>) {
        let all = self.all(values);
        let numbers = Numbers::open(self.names, &all);
        let components = components(self.declared, &numbers);
        let (position, steady, idle) = self.idle(&components, &numbers);
        let known = &self.rig.point;
        match (moved, &self.rig.supply) {
            (true, _) => {
                let (_, _, balance) = Self::settled(&components.power_unit, (position, steady, idle));
                let settled = match self.start {
                    None => balance.settle(steady),
                    Some(start) => balance.settle_from(steady, start.at(values)),
                };
                (balance.supply, settled)
            }
            (false, found) => {
                let pressure = found.map_or(idle.supply.pressure, |found| S::from(found.supply.pressure));
                let pressures = [known.pressure_a, known.pressure_b].map(S::from);
                (Supply { pressure, ..idle.supply }, Settled { command: S::from(known.command), pressures })
            }
        }
    }

    /// The rig with these values, and with supply, spool and pressures at these.
    fn place_at<S: Scalar>(&self, values: &[S], (supply, at): (Supply<S>, Settled<S>)) -> RigAtPoint<S> {
        let all = self.all(values);
        let numbers = Numbers::open(self.names, &all);
        let components = components(self.declared, &numbers);
        let (position, steady, idle) = self.idle(&components, &numbers);
        let Settled { command, pressures } = at;
        let balance = Balance { supply, ..idle };
        let none = S::from(0.0);
        let [pressure_a, pressure_b] = pressures;
        let point = OperatingPoint {
            position,
            command,
            pressure_a,
            pressure_b,
            velocity: if let Steady::Moving { velocity, .. } = steady { velocity } else { none },
            hydraulic_force: hydraulic_force(balance.areas, pressures),
            net_flow_a: none,
            net_flow_b: none,
        };
        let friction = components.friction.viscous();
        let settled_components = Components { supply, ..components };
        let model = TwoPressureModel::of(&settled_components, pressures, StiffeningMember::Nominal, friction);
        let side = spool_side(self.project, &numbers);
        let chambers = two_pressure_linear_parameters(&model, &point, side);
        let known = stated(&self.rig.parameters).map(|(name, value)| (name, S::from(value)));
        let open = self.names.iter().map(String::as_str).zip(all.iter().copied());
        let linear = linear(&chambers, known.chain(open.filter(|(name, _)| is_linear(name))));
        let settled = SettledSupply { supply, settled: at, taken: none };
        let supply = yielding_supply(&components.power_unit, &idle, &settled, side);
        let (leakage, dynamic_feedback) = components.cross_admittance(pressures);
        RigAtPoint { components, point, chambers, linear, leakage, dynamic_feedback, supply }
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
