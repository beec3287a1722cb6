//! Effects that a linear loop or the models of a linearisation do not include, as facts.

use phea_dynamics::linear::{Discretization, MovedRoot};
use phea_hydraulics::port_valves::ValveAtPoint;

use super::misfit::{MisfitConsequence, UnexplainedPart};
use super::outside_family::OutsideFamily;
use crate::family::ShutGas;
use crate::simulate::BeyondReach;

/// An effect that the project declares and a linear loop or the models of a linearisation do not
/// include, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum UncountedEffect {
    /// A region of positions whose plants are those of a piston that is blocked at null and pushes
    /// with this force, N.
    BlockedPiston {
        /// Force at the operating point, N.
        force: f64,
    },
    /// A progressive spring, counted with its stiffness at the operating point.
    ProgressiveSpring {
        /// Stiffness at the operating point, N/m.
        counted: f64,
        /// Stiffness at rest, N/m.
        at_rest: f64,
        /// Stiffness at the end of the travel, N/m.
        stiffest: f64,
    },
    /// The line of a transmission, counted in segments.
    TransmissionSegments {
        /// Segments.
        segments: u32,
        /// Frequency up to which the waves are correct to 3 %, rad/s.
        right_to: f64,
    },
    /// A transmission, for which models with one load pressure include only the spring of its oil.
    TransmissionAsSpring,
    /// Damping and mass of a series spring, which models with one load pressure omit.
    SeriesParts {
        /// True if a damping is declared.
        damping: bool,
        /// True if a mass is declared.
        mass: bool,
    },
    /// An accumulator whose setting is adjusted, counted at its setting at rest.
    FixedSetting {
        /// True if the adjustment moves gas, which adds energy.
        moves_gas: bool,
    },
    /// A telescopic piston, counted with the areas at each operating point.
    TelescopicStages {
        /// True if an operating point moves.
        moves: bool,
    },
    /// A wall without a mass of the load.
    WallWithoutMass,
    /// Waves in the lines, which the models of a linearisation omit.
    LinesInMotion {
        /// Key that declares them.
        key: &'static str,
        /// Value of the key.
        model: &'static str,
    },
    /// A pump of limited flow, counted for small motions.
    LimitedPump {
        /// Supply pressure that is counted, Pa.
        pressure: f64,
        /// Flow that the valve takes, m3/s.
        taken: f64,
        /// Flow that the pump delivers, m3/s.
        delivered: f64,
    },
    /// A pump of limited flow, which the models of a linearisation replace by a constant pressure.
    ConstantSupply,
    /// Gas of accumulators, counted at the pressures of each operating point.
    Gas {
        /// Key of the accumulator.
        key: &'static str,
        /// Forces below which and above which gas is shut off, N.
        shut_beyond: [Option<f64>; 2],
        /// Plants of the family whose gas is shut off.
        of_family: Option<ShutGas>,
    },
    /// Necks, heat and valves of accumulators, which the models of a linearisation omit.
    GasOutsideModels {
        /// True if an accumulator has a neck.
        necks: bool,
        /// True if the gas of an accumulator exchanges heat.
        heat: bool,
    },
    /// The loss at the ends of a neck, which has zero slope at zero flow.
    NeckLoss,
    /// An adjustment of accumulators, counted at fixed settings.
    Adjustment {
        /// Settings that are counted.
        settings: CountedSettings,
        /// True if the adjustment moves gas, which adds energy.
        moves_gas: bool,
    },
    /// A valve between chamber and gas, counted with the slope of its transition.
    GasValve {
        /// Transition pressure of the valve, Pa.
        transition_pressure: f64,
        /// True if `[uncertainty]` gives the setting or the transition pressure a range.
        has_range: bool,
    },
    /// An orifice between the chambers, counted with the slope of its transition.
    CrossPortOrifice {
        /// Pressure drop at rest, Pa; `None` if a volume in series takes it.
        drop: Option<f64>,
        /// Transition pressure of the orifice, Pa.
        transition_pressure: f64,
        /// Conductance that is counted, m3/(s.Pa).
        conductance: f64,
        /// True if `[uncertainty]` gives the transition pressure a range.
        has_range: bool,
    },
    /// A relief or check valve of a chamber, counted with its opening at each operating point.
    PortValve {
        /// Chamber, `A` or `B`.
        side: char,
        /// The valve at the operating point.
        valve: ValveAtPoint,
    },
    /// Dynamic pressure feedback, which the models of a linearisation omit.
    DynamicPressureFeedback,
    /// A velocity feedforward of the load, which a verdict does not include.
    FeedForward {
        /// True if the plants were measured without it; otherwise no load is declared.
        measured: bool,
        /// True if the load may move under force.
        yields: bool,
    },
    /// A velocity feedforward of the load, which the models of a linearisation omit.
    FeedForwardOutsideModels(FeedForwardObstacle),
    /// A virtual impedance, which measured plants do not include.
    ImpedanceUnmeasured {
        /// True if the load may move under force.
        yields: bool,
    },
    /// A virtual impedance, to which the specifications refer.
    Impedance {
        /// True if the load may move under force.
        yields: bool,
    },
    /// A pressure feedback, which measured plants do not include.
    PressureFeedbackUnmeasured,
    /// A pressure feedback, which the models of a linearisation omit.
    PressureFeedbackOutsideModels,
    /// A viscous friction of one direction that no plant of the family has.
    FrictionDirections {
        /// Viscous friction while the rod extends, N.s/m.
        extending: f64,
        /// Viscous friction while the rod retracts, N.s/m.
        retracting: f64,
    },
    /// A valve whose leakage is greatest on either side of null.
    LeakageHumps {
        /// Command of the lower maximum, V.
        command: f64,
        /// Leakage at that command, m3/s.
        greatest: f64,
        /// Leakage at null, m3/s.
        least: f64,
    },
    /// A valve whose edges overlap.
    Overlap {
        /// Spool positions between which no edge is open, V.
        dead_band: [f64; 2],
        /// Ratio of the flow gain within the dead band to that beyond.
        gain_ratio: f64,
    },
    /// A flow gain that differs on both sides of null; the models use the mean.
    NullSides {
        /// Flow gain for retracting and for extending the piston, m3/(s.V).
        flow_gains: [f64; 2],
        /// Flow gain of the models, m3/(s.V).
        mean: f64,
    },
    /// A part whose identified numbers do not explain its recordings.
    Misfit(UnexplainedPart, MisfitConsequence),
    /// A required step that the rig does not reach.
    BeyondReach(BeyondReach),
    /// A zero or pole that the sampling of the controller moves.
    MovedRoot {
        /// Table of the controller or prefilter.
        table: &'static str,
        /// The root as declared and as sampled.
        root: MovedRoot,
        /// Discretisation.
        discretization: Discretization,
    },
    /// The rig itself, which the family does not contain.
    OutsideFamily(OutsideFamily),
}

/// Settings of an adjusted accumulator that a verdict counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CountedSettings {
    /// Every fixed setting of a range.
    Range([f64; 2]),
    /// The settings at rest at A and at B, which differ.
    OfSides([f64; 2]),
    /// The setting at rest.
    OfRest(f64),
}

/// Reason why the models of a linearisation omit a velocity feedforward.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedForwardObstacle {
    /// The controller delays the feedforward.
    ControllerDelay,
    /// The sensor of the velocity delays the feedforward.
    SensorDelay,
    /// The models have no controller.
    NoController,
    /// The controller samples the velocity.
    Sampling,
}
