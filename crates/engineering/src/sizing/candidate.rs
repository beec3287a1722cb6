use phea_hydraulics::line::{StiffeningMember, series_modulus};
use phea_hydraulics::linear::{LinearParameters, closed_loop_steady_state_gain, closed_loop_time_constant};

use super::branch::Branch;
use super::{BoreVerdict, Consequence, HoseOption, SizingProblem, SizingReason, bore};

/// A hose, its length and its gain, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The hose.
    pub option: HoseOption,
    /// Length, stiffness and gain.
    pub branch: Branch,
    /// Oil velocity, m/s.
    pub oil_velocity_m_per_s: f64,
    /// Pressure surge if the largest flow is stopped at once, Pa.
    pub surge_pressure_pa: f64,
    /// Closed-loop time constant at the least and at the greatest stiffness over the stroke, s.
    pub time_constant_s: [f64; 2],
    /// Steady-state gain K_SS at the null flow-pressure coefficient, and at its largest if stated.
    pub steady_state_gain: [f64; 2],
    /// Reasons, rejecting ones first.
    pub findings: Vec<SizingReason>,
}

impl Candidate {
    /// True if nothing rejects the hose, and all required data of it are known.
    pub fn accepted(&self) -> bool {
        self.fits() && !self.has(Consequence::LeavesOpen)
    }

    /// True if nothing that is known rejects the hose.
    pub fn fits(&self) -> bool {
        !self.has(Consequence::Rejects)
    }

    fn has(&self, consequence: Consequence) -> bool {
        self.findings.iter().any(|finding| finding.consequence() == consequence)
    }

    /// Length of line A, and of each line if they are alike, m.
    pub fn length_m(&self) -> f64 {
        self.branch.lengths_m[0]
    }
}

/// Step i or m and the further checks that a hose must pass: velocity, stock, pressure with surge,
/// bending, settling.
pub(super) fn assess(problem: &SizingProblem, option: &HoseOption, branch: Branch) -> Candidate {
    let oil_velocity_m_per_s = bore::oil_velocity(problem, option.bore());
    let surge_pressure_pa = surge_pressure(problem, option, oil_velocity_m_per_s);
    let largest_loss =
        problem.flow_pressure_coefficient_maximum.unwrap_or(problem.linear.flow_pressure_coefficient);
    let gain = branch.gain_v_per_n;
    let time_constant = |stiffness| closed_loop_time_constant(&problem.with_stiffness(stiffness), gain);
    let steady_state_gain = |flow_pressure_coefficient| {
        closed_loop_steady_state_gain(&LinearParameters { flow_pressure_coefficient, ..problem.linear }, gain)
    };
    let mut candidate = Candidate {
        option: option.clone(),
        oil_velocity_m_per_s,
        surge_pressure_pa,
        time_constant_s: [time_constant(branch.stiffness.minimum), time_constant(branch.stiffness.maximum)],
        steady_state_gain: [problem.linear.flow_pressure_coefficient, largest_loss].map(steady_state_gain),
        branch,
        findings: Vec::new(),
    };
    let mut findings = Vec::new();
    length(problem, &candidate, &mut findings);
    practical_gain(problem, &candidate, &mut findings);
    // Further checks do not apply to a hose that does not exist.
    if candidate.length_m() > 0.0 {
        velocity(problem, &candidate, &mut findings);
        pressure(problem, &candidate, &mut findings);
        expansion(problem, option, &mut findings);
        bending(&candidate, &mut findings);
        stiffening(option, &mut findings);
        settling(problem, &candidate, &mut findings);
        null_sides(problem, &candidate, &mut findings);
    }
    findings.sort_by_key(|finding| match finding.consequence() {
        Consequence::Rejects => 0,
        Consequence::LeavesOpen => 1,
        Consequence::Warns => 2,
    });
    candidate.findings = findings;
    candidate
}

/// Pressure surge of a flow stopped at once, Pa: rho c v = v sqrt(rho beta_e), Joukowsky (1898).
fn surge_pressure(problem: &SizingProblem, option: &HoseOption, velocity: f64) -> f64 {
    let surges = option.hoses.map(|hose| {
        let wall = hose.filled().wall_modulus(StiffeningMember::Maximum);
        let modulus = series_modulus(problem.fluid_modulus, wall);
        let fraction = (option.bore() / hose.bore) * (option.bore() / hose.bore);
        fraction * velocity * (problem.density * modulus).sqrt()
    });
    surges[0].max(surges[1])
}

fn velocity(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let velocity = candidate.oil_velocity_m_per_s;
    let [slowest, fastest] = problem.oil_velocity;
    match bore::verdict(problem, candidate.option.bore()) {
        BoreVerdict::TooFast => findings.push(SizingReason::OilTooFast { velocity, fastest }),
        BoreVerdict::Slow => findings.push(SizingReason::OilSlow { velocity, slowest }),
        BoreVerdict::Recommended => {}
    }
}

fn length(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let [shortest, longest] = problem.hose_length;
    let [length_a, length_b] = candidate.branch.lengths_m;
    let (length, least, greatest) = (length_a, length_a.min(length_b), length_a.max(length_b));
    if length == 0.0 && candidate.branch.gain_v_per_n <= problem.pole_gain() {
        // No stiffness would suffice; the finding on the gain reports this.
    } else if length == 0.0 {
        findings.push(SizingReason::NoHoseNeeded(candidate.branch.model));
    } else if least < shortest {
        findings.push(SizingReason::TooShort { length: least, shortest });
    } else if greatest > longest * (1.0 + 1e-9) {
        findings.push(SizingReason::TooLong { length: greatest, longest });
    }
    let both = length_a + length_b;
    if let Some(stock) = problem.stock_length.filter(|stock| both > stock * (1.0 + 1e-9)) {
        findings.push(SizingReason::BeyondStock { both, stock });
    }
}

fn practical_gain(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let gain = candidate.branch.gain_v_per_n;
    let (pole_gain, minimum_gain) = (problem.pole_gain(), problem.minimum_gain);
    if gain <= pole_gain {
        findings.push(SizingReason::RigidTooSlow { gain, pole_gain });
    } else if gain < minimum_gain {
        findings.push(SizingReason::GainTooSmall { gain, minimum_gain });
    }
}

fn pressure(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let supply = problem.supply_pressure;
    let peak = supply + candidate.surge_pressure_pa;
    match candidate.option.working_pressure {
        None => findings.push(SizingReason::PressureUnknown { peak, supply }),
        Some(working) if working < supply => findings.push(SizingReason::BelowSupply { working, supply }),
        Some(working) if working < peak => findings.push(SizingReason::BelowSurge { working, peak }),
        Some(_) => {}
    }
}

/// Checks that the expansion is known up to the supply pressure.
fn expansion(problem: &SizingProblem, option: &HoseOption, findings: &mut Vec<SizingReason>) {
    let supply = problem.supply_pressure;
    if let Some(stated) = option.expansion_stated_at.filter(|stated| supply > stated * (1.0 + 1e-9)) {
        findings.push(SizingReason::ExpansionExtrapolated { stated, supply });
    }
}

fn bending(candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let Some(radius) = candidate.option.minimum_bend_radius else { return };
    let quarter_turn = std::f64::consts::FRAC_PI_2 * radius;
    let [length_a, length_b] = candidate.branch.lengths_m;
    if candidate.length_m() > 0.0 && length_a.min(length_b) < quarter_turn {
        findings.push(SizingReason::ShorterThanBend { radius, quarter_turn });
    }
}

/// Checks the wall: with its static modulus it is softer than measured dynamic values of braided
/// hoses.
fn stiffening(option: &HoseOption, findings: &mut Vec<SizingReason>) {
    if option.hoses.iter().any(|hose| hose.dynamic_stiffening.maximum <= 1.0) {
        findings.push(SizingReason::StaticWall);
    }
}

/// Checks the time constant with the flow gains of both sides of null, at the least stiffness.
fn null_sides(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    findings.extend(problem.dead_band.map(|fraction| SizingReason::DeadBand { fraction }));
    let Some(flow_gains) = problem.null_flow_gains else { return };
    let softest = problem.with_stiffness(candidate.branch.stiffness.minimum);
    let time_constants = flow_gains.map(|flow_gain| {
        closed_loop_time_constant(&LinearParameters { flow_gain, ..softest }, candidate.branch.gain_v_per_n)
    });
    findings.push(SizingReason::NullSides { flow_gains, time_constants });
}

fn settling(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let slowest = candidate.time_constant_s.into_iter().fold(0.0, f64::max);
    if slowest > problem.time_constant * (1.0 + 1e-6) {
        findings.push(SizingReason::SlowLoop { time_constant: slowest, desired: problem.time_constant });
    }
    let [at_null, at_largest] = candidate.steady_state_gain;
    // There is no loop without a positive gain; the gain itself is rejected above.
    if candidate.branch.gain_v_per_n > 0.0 && at_largest < 0.95 {
        findings.push(SizingReason::SteadyStateGain { at_null, at_largest });
    }
}
