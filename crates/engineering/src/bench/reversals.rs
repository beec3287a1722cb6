//! Hysteresis and threshold from the flow over small reversals of the command.

use phea_dynamics::least_squares::{Linearised, Settings, minimise, uncertainty};
use phea_dynamics::scalar::{Dual, Scalar};
use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_hydraulics::servovalve::{SlowSpool, SpoolImperfection};

use super::command_path::least_judged;
use crate::estimate::{Estimate, NORMAL_95};
use crate::project::Reversals;

/// Hysteresis and threshold, V, each with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReversalReading {
    /// Greatest difference of two commands with equal flow over the cycle, including the threshold.
    pub hysteresis: Estimate,
    /// Change of command that a reversal needs before the spool moves.
    pub threshold: Estimate,
    /// Command of full opening, V.
    pub nominal_voltage: f64,
}

/// Number of variables: threshold, rest of the hysteresis, and the flow as a function of the
/// opening up to its third power.
const VARIABLES: usize = 6;

/// Fraction of the nominal voltage below which neither can be distinguished from zero.
const LEAST: f64 = 1e-6;

/// Fewest rows with a flow.
const FEWEST_ROWS: usize = 50;

/// Hysteresis and threshold from the rows of command, V, and flow, m3/s; `None` if the meter is at
/// rest in nearly all rows.
///
/// ```text
/// q = c_0 + c_1 y + c_2 y^2 + c_3 y^3        y the opening by the memories of the spool, from the first command on
/// ```
///
/// Threshold and width are those whose opening explains the flow best: far from null the flow is a
/// smooth function of only the opening, so that all differences between the two directions are
/// memory.
pub(super) fn read(
    rows: &[(f64, f64)],
    reversals: &Reversals,
    nominal_voltage: f64,
    watch: Watch<'_>,
) -> Result<Option<ReversalReading>, Stopped> {
    let least = least_judged(reversals) * nominal_voltage;
    let counts: Vec<bool> = rows.iter().map(|(command, flow)| *command >= least && *flow > 0.0).collect();
    let count = counts.iter().filter(|counts| **counts).count();
    let greatest = rows.iter().map(|(_, flow)| *flow).fold(0.0, f64::max);
    if count < FEWEST_ROWS || greatest <= 0.0 {
        return Ok(None);
    }
    let amplitude = reversals.amplitude * nominal_voltage;
    let mut evaluate = |x: &[f64]| -> Result<Option<Linearised>, Stopped> {
        report_progress(watch, "reversals", 0, 1)?;
        Ok(Some(linearised(rows, &counts, x, (amplitude, greatest))))
    };
    let lower = LEAST * nominal_voltage;
    let upper = reversals.size * nominal_voltage;
    let bounds = [[lower, upper], [lower, upper], [-10.0, 10.0], [-10.0, 10.0], [-10.0, 10.0], [-10.0, 10.0]];
    let start = [0.2 * upper, 0.2 * upper, 0.0, 1.0, 0.0, 0.0];
    let settings = Settings { robust_beyond: f64::INFINITY, tolerance: 1e-14, ..Settings::default() };
    let found = minimise(&start, &bounds, settings, &mut evaluate)?;
    let groups: Vec<usize> = (0..found.linearised.residuals.len()).collect();
    let told = uncertainty(&found.linearised, &groups, VARIABLES, f64::INFINITY);
    let [Some(threshold), Some(rest)] = [0, 1].map(|index| found.variables.get(index).copied()) else {
        return Ok(None);
    };
    let deviation = |index: usize| told.deviations.get(index).copied().unwrap_or(f64::INFINITY);
    let correlation = told.correlations.get(1).copied().unwrap_or(0.0);
    let [of_threshold, of_rest] = [deviation(0), deviation(1)];
    let together =
        of_threshold * of_threshold + of_rest * of_rest + 2.0 * correlation * of_threshold * of_rest;
    let around = |value: f64, deviation: f64| {
        let half = NORMAL_95 * deviation;
        Estimate { value, interval: [(value - half).max(0.0), value + half] }
    };
    Ok(Some(ReversalReading {
        threshold: around(threshold, of_threshold),
        hysteresis: around(threshold + rest, together.max(0.0).sqrt()),
        nominal_voltage,
    }))
}

/// Residuals of the flow divided by the greatest one, with derivatives.
fn linearised(
    rows: &[(f64, f64)],
    counts: &[bool],
    variables: &[f64],
    (amplitude, greatest): (f64, f64),
) -> Linearised {
    type ReversalSensitive = Dual<VARIABLES>;
    let at = |index: usize| ReversalSensitive::variable(variables.get(index).copied().unwrap_or(0.0), index);
    let [threshold, rest, c0, c1, c2, c3] = [at(0), at(1), at(2), at(3), at(4), at(5)];
    let spool = SpoolImperfection {
        null_bias: ReversalSensitive::from(0.0),
        hysteresis_width: Some(threshold + rest),
        threshold: Some(threshold),
        rate_limit: None,
    };
    let mut memory = SlowSpool::at(ReversalSensitive::from(0.0));
    let mut found = Linearised { residuals: Vec::new(), jacobian: Vec::new() };
    for ((command, flow), counts) in rows.iter().zip(counts) {
        let y = spool.slow_opening(&mut memory, ReversalSensitive::from(*command)).times(1.0 / amplitude);
        if *counts {
            let residual = c0 + y * (c1 + y * (c2 + y * c3)) - ReversalSensitive::from(flow / greatest);
            found.residuals.push(residual.value());
            found.jacobian.extend(residual.gradient());
        }
    }
    found
}
