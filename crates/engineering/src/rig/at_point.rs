//! The chain from a declared rig to its operating point, over any scalar.
//!
//! ```text
//! declaration, numbers -> UnsolvedRig -> supply, command, pressures -> RigAtPoint -> LinearPlant
//! ```
//!
//! Plain numbers give the [`Rig`](super::Rig), recorded ones the uncertain plant of a family. Both
//! differ only in how the pressures are found, and in the limit of an ideal valve, which chooses by
//! a value.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cross_port::DynamicFeedback;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::operating_point::{
    Balance, OperatingPoint, Settled, SettledSupply, Steady, hydraulic_force,
};
use phea_hydraulics::plant::{LinearLoad, YieldingSupply};
use phea_hydraulics::servovalve::{ChamberCoefficients, Supply};
use phea_hydraulics::two_pressure::{
    TwoPressureLinearParameters, TwoPressureModel, reduce, two_pressure_linear_parameters,
};

use super::declared::DeclaredRig;
use super::load::load_at;
use super::parameters::replaced;
use super::place::{place, spool_side};
use super::supply::{settled_supply, yielding_supply};

/// A rig whose pressures are not solved yet.
pub(crate) struct UnsolvedRig<S = f64> {
    /// Components with the supply as it is stated.
    pub(crate) components: Components<S>,
    /// Position of the piston, m.
    pub(crate) position: S,
    /// Condition for command and pressures.
    pub(crate) steady: Steady<S>,
    /// Balance of the components, whose supply is the stated one, or settles with the valve.
    pub(crate) balance: Balance<S>,
}

/// A rig at its operating point.
pub(crate) struct RigAtPoint<S = f64> {
    /// Components with the supply as it is stated.
    pub(crate) components: Components<S>,
    /// The point about which the linear models are taken.
    pub(crate) point: OperatingPoint<S>,
    /// The two-pressure model with the settled supply, nominal stiffening.
    pub(crate) model: TwoPressureModel<S>,
    /// Linearisation of the model at the point.
    pub(crate) chambers: TwoPressureLinearParameters<S>,
    /// Coefficients of the valve as it leaks, also where `chambers` has the limit of an ideal one.
    pub(crate) leaking: ChamberCoefficients<S>,
    /// Parameters of the fifth-order model: reduced from the chambers, or stated in their place.
    pub(crate) linear: LinearParameters<S>,
    /// Conductance from chamber to chamber, m3/(s Pa).
    pub(crate) leakage: S,
    /// Dynamic pressure feedback between the chambers; `None` without it.
    pub(crate) dynamic_feedback: Option<DynamicFeedback<S>>,
    /// Supply for small motions; `None` where its pressure is constant.
    pub(crate) supply: Option<YieldingSupply<S>>,
    /// Load on the force sensor.
    pub(crate) load: LinearLoad<S>,
}

impl<S: Scalar> UnsolvedRig<S> {
    /// Rig at the declared operating point, with the supply as it is stated.
    pub(crate) fn of(rig: &DeclaredRig<'_, S>) -> UnsolvedRig<S> {
        let components = rig.components();
        let (position, steady) = place(rig, &components);
        let balance = Balance::at(&components, position);
        UnsolvedRig { components, position, steady, balance }
    }

    /// The limited supply in equilibrium with valve and chambers; `None` for a constant pressure.
    pub(crate) fn settled_supply(&self) -> Option<SettledSupply<S>> {
        settled_supply(&self.components.power_unit, &self.balance, self.steady)
    }

    /// Operating point with this command and these pressures, which balance the flows: the surplus
    /// of [`Steady::Matched`], which no linear model has, is zero here.
    pub(crate) fn point(&self, settled: Settled<S>) -> OperatingPoint<S> {
        let none = S::from(0.0);
        let Settled { command, pressures } = settled;
        let [pressure_a, pressure_b] = pressures;
        OperatingPoint {
            position: self.position,
            command,
            pressure_a,
            pressure_b,
            velocity: if let Steady::Moving { velocity, .. } = self.steady { velocity } else { none },
            hydraulic_force: hydraulic_force(self.balance.areas, pressures),
            net_flow_a: none,
            net_flow_b: none,
        }
    }
}

impl<S: Scalar> RigAtPoint<S> {
    /// Rig with this supply at this operating point. The unsolved rig has its balance with the
    /// supply as it is stated; `stated` are parameters of the linear model, in the order in which
    /// they take precedence.
    pub(crate) fn of<'n>(
        rig: &DeclaredRig<'_, S>,
        unsolved: &UnsolvedRig<S>,
        supply: Supply<S>,
        point: OperatingPoint<S>,
        stated: impl Iterator<Item = (&'n str, S)>,
    ) -> RigAtPoint<S> {
        let UnsolvedRig { components, balance, .. } = unsolved;
        let pressures = [point.pressure_a, point.pressure_b];
        let friction = components.friction.viscous();
        let at_valve = Components { supply, ..*components };
        let model = TwoPressureModel::of(&at_valve, pressures, StiffeningMember::Nominal, friction);
        let side = spool_side(rig);
        let chambers = two_pressure_linear_parameters(&model, &point, side);
        let linear = replaced(&reduce(&chambers), stated);
        let settled = Settled { command: point.command, pressures };
        let settled = SettledSupply { supply, settled, taken: S::from(0.0) };
        let yielding = yielding_supply(&components.power_unit, balance, &settled, side);
        let (leakage, dynamic_feedback) = components.cross_admittance(pressures);
        RigAtPoint {
            components: *components,
            point,
            model,
            chambers,
            leaking: chambers.chambers,
            linear,
            leakage,
            dynamic_feedback,
            supply: yielding,
            load: load_at(rig, components, &point),
        }
    }
}
