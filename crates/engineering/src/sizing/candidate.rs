use phea_hydraulics::line::{StiffeningMember, series_modulus};
use phea_hydraulics::linear::{LinearParameters, closed_loop_steady_state_gain, closed_loop_time_constant};

use phea_hydraulics::stiffness::StiffnessModel;

use super::branch::Branch;
use super::{BoreVerdict, HoseOption, SizingProblem, bore};
use crate::quantity::{DisplayUnit, significant};

/// The consequence of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Consequence {
    /// The candidate is not accepted.
    Rejects,
    /// The candidate is not accepted until what it states is known.
    LeavesOpen,
    /// The candidate is accepted with a warning.
    Warns,
}

/// One reason for or against a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct SizingReason {
    /// Its consequence.
    pub severity: Consequence,
    /// The reason, with its numbers.
    pub text: String,
}

/// A hose, its length and its gain, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The hose.
    pub option: HoseOption,
    /// Length, stiffness and gain.
    pub branch: Branch,
    /// Oil velocity, m/s.
    pub oil_velocity_m_per_s: f64,
    /// Pressure surge when the largest flow is stopped at once, Pa.
    pub surge_pressure_pa: f64,
    /// Closed-loop time constant at the least and at the greatest stiffness over the stroke, s.
    pub time_constant_s: [f64; 2],
    /// Steady-state gain K_SS at the null flow-pressure coefficient, and at its largest where
    /// stated.
    pub steady_state_gain: [f64; 2],
    /// Reasons, those that reject first.
    pub findings: Vec<SizingReason>,
}

impl Candidate {
    /// Whether nothing rejects it, and all that must be known of it is known.
    pub fn accepted(&self) -> bool {
        self.fits() && !self.has(Consequence::LeavesOpen)
    }

    /// Whether nothing rejects it, as far as it is known.
    pub fn fits(&self) -> bool {
        !self.has(Consequence::Rejects)
    }

    fn has(&self, severity: Consequence) -> bool {
        self.findings.iter().any(|finding| finding.severity == severity)
    }

    /// Length of line A, and of each line where they are alike, m.
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
    // Nothing else can be said about a hose that does not exist.
    if candidate.length_m() > 0.0 {
        velocity(problem, &candidate, &mut findings);
        pressure(problem, &candidate, &mut findings);
        expansion(problem, option, &mut findings);
        bending(&candidate, &mut findings);
        stiffening(option, &mut findings);
        settling(problem, &candidate, &mut findings);
        null_sides(problem, &candidate, &mut findings);
    }
    findings.sort_by_key(|finding| match finding.severity {
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
        let share = (option.bore() / hose.bore) * (option.bore() / hose.bore);
        share * velocity * (problem.density * modulus).sqrt()
    });
    surges[0].max(surges[1])
}

fn rejects(findings: &mut Vec<SizingReason>, text: String) {
    findings.push(SizingReason { severity: Consequence::Rejects, text });
}

fn warns(findings: &mut Vec<SizingReason>, text: String) {
    findings.push(SizingReason { severity: Consequence::Warns, text });
}

fn velocity(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let velocity = significant(candidate.oil_velocity_m_per_s, 3);
    let [slowest, fastest] = problem.oil_velocity;
    match bore::verdict(problem, candidate.option.bore()) {
        BoreVerdict::TooFast => rejects(findings, format!("oil runs at {velocity} m/s, above {fastest} m/s")),
        BoreVerdict::Slow => {
            warns(
                findings,
                format!(
                    "oil runs at {velocity} m/s, below {slowest} m/s: a smaller bore would carry the flow"
                ),
            );
        }
        BoreVerdict::Recommended => {}
    }
}

fn length(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let [shortest, longest] = problem.hose_length;
    let [length_a, length_b] = candidate.branch.lengths_m;
    let (length, least, greatest) = (length_a, length_a.min(length_b), length_a.max(length_b));
    if length == 0.0 && candidate.branch.gain_v_per_n <= problem.pole_gain() {
        // No stiffness would suffice; the finding on the gain says so.
    } else if length == 0.0 {
        let why = match candidate.branch.model {
            StiffnessModel::Uniform => {
                "by this model the oil in the chambers alone, with the hose's modulus,"
            }
            StiffnessModel::ByVolume => "with rigid lines the actuator",
        };
        rejects(findings, format!("no hose is needed: {why} is already as compliant as this asks for"));
    } else if least < shortest {
        rejects(
            findings,
            format!("{} m a line is shorter than the acceptable {shortest} m", significant(least, 3)),
        );
    } else if greatest > longest * (1.0 + 1e-9) {
        rejects(
            findings,
            format!("{} m a line is longer than the acceptable {longest} m", significant(greatest, 3)),
        );
    }
    let both = length_a + length_b;
    if let Some(stock) = problem.stock_length.filter(|stock| both > stock * (1.0 + 1e-9)) {
        rejects(findings, format!("both lines take {} m, the stock is {stock} m", significant(both, 3)));
    }
}

fn practical_gain(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let gain = candidate.branch.gain_v_per_n;
    if gain <= problem.pole_gain() {
        rejects(
            findings,
            format!(
                "K_p = {} V/N is not above {} V/N, where even a rigid transmission is too slow",
                significant(gain, 3),
                significant(problem.pole_gain(), 3)
            ),
        );
    } else if gain < problem.minimum_gain {
        rejects(
            findings,
            format!(
                "K_p = {} V/N is below the practical {} V/N: the valve would hardly be driven",
                significant(gain, 3),
                significant(problem.minimum_gain, 3)
            ),
        );
    }
}

fn pressure(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let bar = |pressure: f64| DisplayUnit::BAR.number(pressure, 3);
    let peak = problem.supply_pressure + candidate.surge_pressure_pa;
    match candidate.option.working_pressure {
        None => {
            let text = format!(
                "no working pressure is stated: the hose must withstand {} bar with surge ({} bar supply); state `working_pressure`",
                bar(peak),
                bar(problem.supply_pressure)
            );
            findings.push(SizingReason { severity: Consequence::LeavesOpen, text });
        }
        Some(working) if working < problem.supply_pressure => {
            rejects(
                findings,
                format!(
                    "working pressure {} bar is below the supply's {} bar",
                    bar(working),
                    bar(problem.supply_pressure)
                ),
            );
        }
        Some(working) if working < peak => {
            rejects(
                findings,
                format!("working pressure {} bar is below supply and surge, {} bar", bar(working), bar(peak)),
            );
        }
        Some(_) => {}
    }
}

/// The expansion is known up to the pressure it is stated at.
fn expansion(problem: &SizingProblem, option: &HoseOption, findings: &mut Vec<SizingReason>) {
    let Some(stated) =
        option.expansion_stated_at.filter(|stated| problem.supply_pressure > stated * (1.0 + 1e-9))
    else {
        return;
    };
    let [stated, supply] =
        [stated, problem.supply_pressure].map(|pressure| DisplayUnit::BAR.number(pressure, 3));
    warns(
        findings,
        format!(
            "its expansion is stated at {stated} bar, and the supply has {supply} bar: in between it is carried on along its slope"
        ),
    );
}

fn bending(candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let Some(radius) = candidate.option.minimum_bend_radius else { return };
    let quarter_turn = std::f64::consts::FRAC_PI_2 * radius;
    let [length_a, length_b] = candidate.branch.lengths_m;
    if candidate.length_m() > 0.0 && length_a.min(length_b) < quarter_turn {
        warns(
            findings,
            format!(
                "a bend of 90 degrees at the least radius of {} mm takes {} m, more than the hose has",
                DisplayUnit::MILLIMETRE.number(radius, 3),
                significant(quarter_turn, 3)
            ),
        );
    }
}

/// A wall with its static modulus is softer than measured dynamic values of braided hoses.
fn stiffening(option: &HoseOption, findings: &mut Vec<SizingReason>) {
    if option.hoses.iter().any(|hose| hose.dynamic_stiffening.maximum <= 1.0) {
        let text = "[line] declares no `dynamic_stiffening`: the wall has its static modulus, and a stiffer one takes more hose";
        warns(findings, text.to_string());
    }
}

/// The time constant with the flow gains of both sides of null, at the least stiffness.
fn null_sides(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    if let Some(share) = problem.dead_band {
        let text = format!(
            "the edges of the valve overlap, and K_qU at null, which is sized with, is {} % of that beyond the lap: a loop of this gain is unstable \
             there. State the gain beyond the lap, `sizing.flow_gain`, and its `flow_pressure_coefficient`",
            significant(100.0 * share, 2)
        );
        rejects(findings, text);
    }
    let Some(gains) = problem.null_flow_gains else { return };
    let softest = problem.with_stiffness(candidate.branch.stiffness.minimum);
    let [below, above] = gains.map(|flow_gain| {
        closed_loop_time_constant(&LinearParameters { flow_gain, ..softest }, candidate.branch.gain_v_per_n)
    });
    let text = format!(
        "K_qU at null is {} m3/(s.V) retracting and {} extending, and its mean is sized with: the time constant is {} s and {} s",
        significant(gains[0], 3),
        significant(gains[1], 3),
        significant(below, 3),
        significant(above, 3)
    );
    warns(findings, text);
}

fn settling(problem: &SizingProblem, candidate: &Candidate, findings: &mut Vec<SizingReason>) {
    let slowest = candidate.time_constant_s.into_iter().fold(0.0, f64::max);
    if slowest > problem.time_constant * (1.0 + 1e-6) {
        warns(
            findings,
            format!(
                "the closed loop's time constant is {} s, slower than {} s",
                significant(slowest, 3),
                significant(problem.time_constant, 3)
            ),
        );
    }
    let [at_null, at_largest] = candidate.steady_state_gain;
    // Without a positive gain there is no loop; the gain itself is rejected above.
    if candidate.branch.gain_v_per_n > 0.0 && at_largest < 0.95 {
        warns(
            findings,
            format!(
                "a proportional loop reaches only {} % of the reference at null and {} % at the largest K_c: integral action is needed",
                significant(100.0 * at_null, 3),
                significant(100.0 * at_largest, 3)
            ),
        );
    }
}
