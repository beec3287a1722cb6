//! Actuator: valve, lines, cylinder, friction and force sensor assembled, and rejected if any is
//! impossible.

use phea_dynamics::scalar::Scalar;

use crate::accumulator::{ChamberGas, GasBranch};
use crate::cross_port::{CrossFlow, CrossPort, DynamicFeedback};
use crate::cylinder::Cylinder;
use crate::fluid::Fluid;
use crate::force_sensor::ForceSensor;
use crate::friction::Friction;
use crate::line::{DynamicLine, Line, LineError, LineModel, StiffeningMember};
use crate::linkage::Linkage;
use crate::load::Load;
use crate::outward_flow::OutwardFlow;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};
use crate::power_unit::PowerUnit;
use crate::series::SeriesElement;
use crate::servovalve::{Servovalve, Supply};
use crate::stiffness::{ChamberCompliance, StiffnessModel, chamber_compliance};

/// Components of an actuator, not yet checked, over any scalar. No other type stores them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Components<S = f64> {
    /// The fluid throughout.
    pub fluid: Fluid<S>,
    /// Supply and tank pressures: those that an idle pump holds.
    pub supply: Supply<S>,
    /// Source of the supply pressure.
    pub power_unit: PowerUnit<S>,
    /// The servovalve.
    pub valve: Servovalve<S>,
    /// The line between port A and chamber A.
    pub line_a: Line<S>,
    /// The line between port B and chamber B.
    pub line_b: Line<S>,
    /// Models of lines A and B in motion. Their numbers are plain: lines in motion have no plant in
    /// recorded numbers, and none of these numbers is uncertain.
    pub line_models: [LineModel; 2],
    /// Gas at chambers A and B.
    pub gas: [Option<ChamberGas<S>>; 2],
    /// Valve between the chambers, at the cylinder.
    pub cross_port: Option<CrossPort<S>>,
    /// Parts that pass oil from the chambers to the tank.
    pub outward: OutwardFlow<S>,
    /// The cylinder.
    pub cylinder: Cylinder<S>,
    /// Friction of the cylinder.
    pub friction: Friction<S>,
    /// Sensor between rod and load.
    pub force_sensor: ForceSensor<S>,
    /// Spring between sensor and load; `None` if the sensor acts directly on the load.
    pub series: Option<SeriesElement<S>>,
    /// Linkage between rod and a load that turns; `None` if the load moves with the rod.
    pub linkage: Option<Linkage<S>>,
    /// Load on the force sensor.
    pub load: Load<S>,
    /// Ratio of the measured to the true velocity of the load: 1 + e, e being the error of the
    /// sensor's gain; `None` without an error.
    pub velocity_gain: Option<S>,
    /// Bulk modulus used for the chambers.
    pub stiffness_model: StiffnessModel,
}

impl<S: Scalar> Components<S> {
    /// Compliance of both chambers with their lines and accumulators, at chamber pressures in Pa
    /// (relevant only with entrained air or with accumulators).
    pub fn chamber_compliance(&self, pressures: [S; 2], member: StiffeningMember) -> ChamberCompliance<S> {
        let Components { fluid, line_a, line_b, cylinder, stiffness_model, .. } = self;
        let moduli = pressures.map(|pressure| fluid.modulus_at(pressure));
        let oil = chamber_compliance(*stiffness_model, moduli, cylinder, [line_a, line_b], member);
        oil.with_gas(self.gas_compliance(pressures))
    }

    /// Compliance of the gas at either chamber in m3/Pa, at chamber pressures in Pa; `None` without
    /// an accumulator, or if a shut valve excludes it.
    pub fn gas_compliance(&self, pressures: [S; 2]) -> [Option<S>; 2] {
        [0, 1].map(|side| Some(self.gas_in_use(side)?.at_rest().compliance(pressures[side])))
    }

    /// Gas at a chamber, unless a valve before it is shut at rest.
    pub fn gas_in_use(&self, side: usize) -> Option<&ChamberGas<S>> {
        self.gas[side].as_ref().filter(|gas| !gas.valve().is_some_and(|valve| valve.shut))
    }

    /// Gas at either chamber that is behind a neck or a valve or exchanges heat, at chamber
    /// pressures in Pa; `None` behind a shut valve.
    pub fn gas_branches(&self, pressures: [S; 2]) -> [Option<GasBranch<S>>; 2] {
        [0, 1].map(|side| self.gas_in_use(side)?.branch(pressures[side]))
    }

    /// Compliance of the gas of these branches at rest, without the oil of their necks, m3/Pa; zero
    /// without a branch.
    pub fn branch_compliance(&self, pressures: [S; 2]) -> [S; 2] {
        [0, 1].map(|side| {
            let branch = self.gas_in_use(side).filter(|gas| gas.is_branch());
            branch.map_or(S::from(0.0), |gas| gas.at_rest().compliance(pressures[side]))
        })
    }

    /// Flow from chamber to chamber at rest; `None` without such flow.
    pub(crate) fn cross_flow(&self) -> Option<CrossFlow<S>> {
        CrossFlow::of(self.cylinder.internal_leakage, self.cross_port.as_ref())
    }

    /// Conductance between the chambers in m3/(s Pa) at chamber pressures in Pa, and the dynamic
    /// pressure feedback of a valve between the chambers.
    pub fn cross_admittance(&self, [pressure_a, pressure_b]: [S; 2]) -> (S, Option<DynamicFeedback<S>>) {
        let steady = self.cross_flow().map_or(S::from(0.0), |flow| flow.slope(pressure_a - pressure_b));
        (steady, self.cross_port.as_ref().and_then(DynamicFeedback::of))
    }
}

impl Components {
    /// Components with the setting of every adjustment there, for slow motions: an open valve is
    /// the gas at its chamber, a shut one no gas.
    pub fn at_setting(&self, setting: f64) -> Components {
        let gas = self.gas.map(|gas| Some(ChamberGas::Sealed(gas?.at_setting(setting)?)));
        Components { gas, ..*self }
    }

    /// Pressure in Pa midway between supply and tank.
    fn mean_pressure(&self) -> f64 {
        0.5 * (self.supply.pressure + self.supply.tank_pressure)
    }

    /// Lines A and B by their models of motion; `None` if both are lumped.
    ///
    /// # Errors
    /// A line that its model does not fit.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::actuator::Components;
    /// use phea_hydraulics::line::{END_SHARE, LineModel, StiffeningMember};
    /// # use phea_hydraulics::{reference_rig::{components, hose_line}, stiffness::StiffnessModel};
    /// let lumped = components(hose_line(), StiffnessModel::ByVolume);
    /// assert_eq!(lumped.lines_in_motion(StiffeningMember::Nominal), Ok(None));
    /// let waves = LineModel::TransmissionLine { end_share: END_SHARE };
    /// let moving = Components { line_models: [waves, LineModel::Lumped], ..lumped };
    /// let [line_a, line_b] = moving.lines_in_motion(StiffeningMember::Nominal)?.unwrap();
    /// assert_eq!((line_a.delays().len(), line_b.delays().len()), (2, 0));
    /// # Ok::<(), phea_hydraulics::line::LineError>(())
    /// ```
    pub fn lines_in_motion(&self, member: StiffeningMember) -> Result<Option<[DynamicLine; 2]>, LineError> {
        if self.line_models == [LineModel::Lumped; 2] {
            return Ok(None);
        }
        let of = |line, model| DynamicLine::new(line, &self.fluid, self.mean_pressure(), member, model);
        let [model_a, model_b] = &self.line_models;
        Ok(Some([of(&self.line_a, model_a)?, of(&self.line_b, model_b)?]))
    }
}

/// Error for components that do not make an actuator: every impossible parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct ActuatorError {
    /// All impossible parameters, in the order of the components.
    pub problems: Vec<ParameterError>,
}

/// Actuator whose components are all possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator(Components);

impl Actuator {
    /// Assembles the components unchanged; nothing is repaired.
    ///
    /// # Errors
    /// Every parameter outside physics, by its path (`valve.flow_coefficients.supply_to_a`), with
    /// the requirement. A line and dead volumes of zero on one side are rejected too: a chamber
    /// with the piston at its end would have no volume.
    pub fn new(components: Components) -> Result<Actuator, ActuatorError> {
        let Components { fluid, supply, valve, line_a, line_b, cylinder, friction, force_sensor, .. } =
            components;
        let mut problems = Problems::default();
        problems.component("fluid", fluid.problems());
        problems.component("supply", supply.problems());
        problems.component("supply", components.power_unit.problems());
        problems.component("valve", valve.problems());
        problems.component("line.a", line_a.problems());
        problems.component("line.b", line_b.problems());
        for (gas, path) in components.gas.iter().zip(["line.a.accumulator", "line.b.accumulator"]) {
            problems.component(path, gas.map_or(Vec::new(), |gas| gas.problems()));
        }
        problems.component("cross_port", components.cross_port.map_or(Vec::new(), |port| port.problems()));
        problems.all(components.outward.problems());
        problems.component("cylinder", cylinder.problems());
        problems.component("cylinder.friction", friction.problems());
        problems.component("force_sensor", force_sensor.problems());
        problems.component("series", components.series.map_or(Vec::new(), |series| series.problems()));
        problems.component("linkage", components.linkage.map_or(Vec::new(), |linkage| linkage.problems()));
        problems.component("load", components.load.problems());
        if let Some(gain) = components.velocity_gain {
            problems.positive("velocity_sensor.gain", gain);
        }
        let not_empty = ParameterRequirement::ChamberNotEmpty;
        let volume_a = cylinder.dead_volume_a + line_a.volume();
        let volume_b = cylinder.dead_volume_b + line_b.volume();
        problems.require("cylinder.dead_volume_a", volume_a, volume_a > 0.0, not_empty);
        problems.require("cylinder.dead_volume_b", volume_b, volume_b > 0.0, not_empty);
        match problems.into_vec() {
            problems if problems.is_empty() => Ok(Actuator(components)),
            problems => Err(ActuatorError { problems }),
        }
    }

    /// The components.
    pub fn components(&self) -> &Components {
        &self.0
    }

    /// Pressure in Pa at which the fluid's modulus is evaluated without an operating point: midway
    /// between supply and tank, the pressure in the chambers of an idle symmetric actuator.
    pub fn mean_pressure(&self) -> f64 {
        self.0.mean_pressure()
    }

    /// Compliance of both chambers with their lines and accumulators, at chamber pressures in Pa
    /// (relevant only with entrained air or with accumulators).
    pub fn chamber_compliance(&self, pressures: [f64; 2], member: StiffeningMember) -> ChamberCompliance {
        self.0.chamber_compliance(pressures, member)
    }
}
