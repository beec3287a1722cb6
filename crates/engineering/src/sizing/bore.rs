use std::f64::consts::PI;

use super::{HoseName, SizingProblem, SizingStep};
use phea_dynamics::order::sort_by_number;

/// Verdict of the oil velocity on a bore.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoreVerdict {
    /// The velocity is within the recommended range.
    Recommended,
    /// The oil is slower than recommended: the bore is larger and more expensive than necessary,
    /// but acceptable.
    Slow,
    /// The oil is faster than recommended: the bore is rejected.
    TooFast,
}

/// A bore on the market and the oil velocity in it.
#[derive(Clone, Debug, PartialEq)]
pub struct CommercialBore {
    /// Dash size or product.
    pub name: HoseName,
    /// Bore, m.
    pub bore_m: f64,
    /// Mean oil velocity at the largest flow, m/s.
    pub oil_velocity_m_per_s: f64,
    /// Verdict of this velocity.
    pub verdict: BoreVerdict,
}

/// Mean oil velocity in a bore, m/s.
///
/// ```text
/// v = 4 q/(pi D^2)                                                         thesis (6.17)
/// ```
pub(super) fn oil_velocity(problem: &SizingProblem, bore: f64) -> f64 {
    4.0 * problem.maximum_flow() / (PI * bore * bore)
}

pub(super) fn verdict(problem: &SizingProblem, bore: f64) -> BoreVerdict {
    let velocity = oil_velocity(problem, bore);
    let [slowest, fastest] = problem.oil_velocity;
    if velocity > fastest {
        BoreVerdict::TooFast
    } else if velocity < slowest {
        BoreVerdict::Slow
    } else {
        BoreVerdict::Recommended
    }
}

/// Bores at the highest and at the lowest recommended velocity, m.
///
/// ```text
/// D = sqrt(4 q/(pi v))                                                     thesis (6.17)
/// ```
pub(super) fn range(problem: &SizingProblem) -> [f64; 2] {
    let [slowest, fastest] = problem.oil_velocity;
    [fastest, slowest].map(|velocity| (4.0 * problem.maximum_flow() / (PI * velocity)).sqrt())
}

/// Recommended oil velocity of return and suction lines, m/s (Rabie 2009, quoted in Ledezma 2019,
/// section 6.3.1.1).
const LOW_PRESSURE_VELOCITY: [f64; 2] = [0.6, 1.2];

/// Bores of the lines without pressure: a return line carries as much as the fuller line, which is
/// more than the valve takes if the areas differ.
fn low_pressure_lines(problem: &SizingProblem) -> SizingStep {
    let [slowest, fastest] = LOW_PRESSURE_VELOCITY;
    let bores = |flow: f64| [fastest, slowest].map(|velocity| (4.0 * flow / (PI * velocity)).sqrt());
    SizingStep::LowPressureLines {
        velocity: LOW_PRESSURE_VELOCITY,
        return_flow: problem.maximum_flow(),
        return_bores: bores(problem.maximum_flow()),
        suction_bores: bores(problem.flow.taken),
    }
}

/// Every bore of market and catalogue, smallest first, and the record of steps c.2 to c.4.
pub(super) fn assess(problem: &SizingProblem, decisions: &mut Vec<SizingStep>) -> Vec<CommercialBore> {
    let offered = problem.hoses.iter().map(|option| (option.name.clone(), option.bore()));
    let on_market = problem.market_bores.iter().map(|(name, bore)| (HoseName::named(name), *bore));
    let mut bores: Vec<CommercialBore> = on_market
        .chain(offered)
        .map(|(name, bore_m)| CommercialBore {
            name,
            bore_m,
            oil_velocity_m_per_s: oil_velocity(problem, bore_m),
            verdict: verdict(problem, bore_m),
        })
        .collect();
    sort_by_number(&mut bores, |bore| bore.bore_m);
    let feasible = bores.iter().filter(|bore| bore.verdict == BoreVerdict::Recommended);
    let feasible = feasible.map(|bore| bore.name.clone()).collect();
    decisions.push(SizingStep::OilVelocity(problem.oil_velocity));
    decisions.push(low_pressure_lines(problem));
    decisions.push(SizingStep::Bores { flow: problem.flow.clone(), range: range(problem), feasible });
    bores
}
