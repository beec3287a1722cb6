use phea_hydraulics::stiffness::StiffnessModel;

/// Consequence of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Consequence {
    /// The candidate is not accepted.
    Rejects,
    /// The candidate is not accepted until the unknown data are available.
    LeavesOpen,
    /// The candidate is accepted with a warning.
    Warns,
}

/// One reason for or against a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizingReason {
    /// The oil is faster than recommended.
    OilTooFast {
        /// Oil velocity, m/s.
        velocity: f64,
        /// Highest recommended oil velocity, m/s.
        fastest: f64,
    },
    /// The oil is slower than recommended.
    OilSlow {
        /// Oil velocity, m/s.
        velocity: f64,
        /// Lowest recommended oil velocity, m/s.
        slowest: f64,
    },
    /// Chambers and hose are compliant enough without any length of hose, by this stiffness model.
    NoHoseNeeded(StiffnessModel),
    /// A line is shorter than acceptable.
    TooShort {
        /// Length of the shorter line, m.
        length: f64,
        /// Shortest acceptable length, m.
        shortest: f64,
    },
    /// A line is longer than acceptable.
    TooLong {
        /// Length of the longer line, m.
        length: f64,
        /// Longest acceptable length, m.
        longest: f64,
    },
    /// The stock does not suffice.
    BeyondStock {
        /// Length of both lines together, m.
        both: f64,
        /// Length of the stock, m.
        stock: f64,
    },
    /// Even a rigid transmission is too slow under this gain.
    RigidTooSlow {
        /// Gain K_p, V/N.
        gain: f64,
        /// Gain at the pole of equation 6.16, V/N.
        pole_gain: f64,
    },
    /// The gain is too small to be practical.
    GainTooSmall {
        /// Gain K_p, V/N.
        gain: f64,
        /// Least practical gain, V/N.
        minimum_gain: f64,
    },
    /// The working pressure of the hose is not stated.
    PressureUnknown {
        /// Sum of supply pressure and surge, Pa.
        peak: f64,
        /// Supply pressure, Pa.
        supply: f64,
    },
    /// The working pressure is below the supply pressure.
    BelowSupply {
        /// Working pressure, Pa.
        working: f64,
        /// Supply pressure, Pa.
        supply: f64,
    },
    /// The working pressure is below the sum of supply pressure and surge.
    BelowSurge {
        /// Working pressure, Pa.
        working: f64,
        /// Sum of supply pressure and surge, Pa.
        peak: f64,
    },
    /// The supply pressure is above the pressure at which the expansion is stated.
    ExpansionExtrapolated {
        /// Pressure at which the expansion is stated, Pa.
        stated: f64,
        /// Supply pressure, Pa.
        supply: f64,
    },
    /// The hose is shorter than a bend of 90 degrees at its least radius.
    ShorterThanBend {
        /// Least bend radius, m.
        radius: f64,
        /// Length of that bend, m.
        quarter_turn: f64,
    },
    /// No dynamic stiffening is declared: the wall has its static modulus.
    StaticWall,
    /// The edges of the valve overlap, and the gain at null is used.
    DeadBand {
        /// Ratio of K_qU at null to that beyond the lap.
        fraction: f64,
    },
    /// The flow gain differs between the sides of null.
    NullSides {
        /// K_qU for retracting and for extending the piston, m3/(s V).
        flow_gains: [f64; 2],
        /// Time constant with each of them at the least stiffness, s.
        time_constants: [f64; 2],
    },
    /// The closed loop is slower than desired.
    SlowLoop {
        /// Time constant at the least or at the greatest stiffness, the longer, s.
        time_constant: f64,
        /// Desired time constant, s.
        desired: f64,
    },
    /// A proportional loop misses the reference at rest.
    SteadyStateGain {
        /// Steady-state gain K_SS at the null flow-pressure coefficient.
        at_null: f64,
        /// Steady-state gain at the largest flow-pressure coefficient.
        at_largest: f64,
    },
}

impl SizingReason {
    /// Consequence of the reason.
    pub fn consequence(&self) -> Consequence {
        match self {
            SizingReason::OilTooFast { .. }
            | SizingReason::NoHoseNeeded(_)
            | SizingReason::TooShort { .. }
            | SizingReason::TooLong { .. }
            | SizingReason::BeyondStock { .. }
            | SizingReason::RigidTooSlow { .. }
            | SizingReason::GainTooSmall { .. }
            | SizingReason::BelowSupply { .. }
            | SizingReason::BelowSurge { .. }
            | SizingReason::DeadBand { .. } => Consequence::Rejects,
            SizingReason::PressureUnknown { .. } => Consequence::LeavesOpen,
            SizingReason::OilSlow { .. }
            | SizingReason::ExpansionExtrapolated { .. }
            | SizingReason::ShorterThanBend { .. }
            | SizingReason::StaticWall
            | SizingReason::NullSides { .. }
            | SizingReason::SlowLoop { .. }
            | SizingReason::SteadyStateGain { .. } => Consequence::Warns,
        }
    }
}
