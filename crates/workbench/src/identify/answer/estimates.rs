//! Coefficients with their intervals, for programs.

use phea_engineering::identify::{Bootstrap, Identification};

use crate::answer::Answer;

/// Value for each of the four edges of a valve.
#[derive(Answer)]
pub(super) struct ValveEdgesAnswer {
    /// Edge 3, from the supply to port A.
    supply_to_a: ValveEstimateAnswer,
    /// Edge 4, from port A to the tank.
    a_to_tank: ValveEstimateAnswer,
    /// Edge 5, from the supply to port B.
    supply_to_b: ValveEstimateAnswer,
    /// Edge 6, from port B to the tank.
    b_to_tank: ValveEstimateAnswer,
}

/// Lap of both pairs of edges, over full travel.
#[derive(Answer)]
pub(super) struct ValveLapAnswer {
    /// Lap of the edges that a positive command opens.
    positive: ValveEstimateAnswer,
    /// Lap of the edges that a negative command opens.
    negative: ValveEstimateAnswer,
}

/// Coefficient of a valve with its confidence interval.
#[derive(Answer, Clone)]
pub(super) struct ValveEstimateAnswer {
    /// Value at the minimum of the search.
    value: f64,
    /// Confidence interval of 95 % by linearisation, from low to high; null if the recordings do
    /// not determine the value.
    #[answer(interval)]
    confidence_95: Option<[f64; 2]>,
    /// Confidence interval of 95 % by the bootstrap, if one was requested, at least one of its
    /// repetitions converged and the recordings determine the value.
    #[answer(optional, interval)]
    bootstrap_95: Option<[f64; 2]>,
    /// Reason for which there is no interval.
    #[answer(optional)]
    reason: Option<&'static str>,
}

/// Extent of a bootstrap of the estimates.
#[derive(Answer)]
pub(super) struct BootstrapAnswer {
    /// Number of repetitions.
    repetitions: usize,
    /// Number of repetitions that did not converge and are left out.
    failed: usize,
    /// Rows of a block of residuals that change sign together.
    block_rows: usize,
}

/// The coefficients of which zero is a value like any other.
pub(in super::super) const EITHER_SIGN: [&str; 3] = ["null_bias", "lap.positive", "lap.negative"];

/// The coefficients with their intervals, those too that the model of the numbers has not.
pub(super) struct ValveEstimates {
    pub(super) flow: ValveEdgesAnswer,
    pub(super) leakage: ValveEdgesAnswer,
    pub(super) shape: ValveEstimateAnswer,
    pub(super) tare_flow: ValveEstimateAnswer,
    pub(super) null_bias: ValveEstimateAnswer,
    pub(super) hysteresis: ValveEstimateAnswer,
    pub(super) lap: ValveLapAnswer,
    pub(super) saturation: ValveEstimateAnswer,
    pub(super) shapes: ValveEdgesAnswer,
}

impl ValveEstimates {
    pub(super) fn of(found: &Identification) -> ValveEstimates {
        let values = found.coefficients.to_array();
        let estimate = |index: usize| {
            let interval = found.estimates[index].map(|estimate| estimate.interval);
            let resampled = found.bootstrap.as_ref().map(|bootstrap| bootstrap.intervals[index]);
            let exists = |ends: &[f64; 2]| !ends.iter().any(|end| end.is_nan());
            ValveEstimateAnswer {
                value: values[index],
                confidence_95: interval,
                bootstrap_95: interval.and(resampled).filter(exists),
                reason: interval.is_none().then_some("the data do not determine it"),
            }
        };
        let [
            flow_3,
            flow_4,
            flow_5,
            flow_6,
            leakage_3,
            leakage_4,
            leakage_5,
            leakage_6,
            shape_3,
            tare_flow,
            null_bias,
            hysteresis,
            positive,
            negative,
            saturation,
            shape_4,
            shape_5,
            shape_6,
        ] = std::array::from_fn(estimate);
        let shape = shape_3.clone();
        ValveEstimates {
            flow: edges([flow_3, flow_4, flow_5, flow_6]),
            leakage: edges([leakage_3, leakage_4, leakage_5, leakage_6]),
            shape,
            tare_flow,
            null_bias,
            hysteresis,
            lap: ValveLapAnswer { positive, negative },
            saturation,
            shapes: edges([shape_3, shape_4, shape_5, shape_6]),
        }
    }
}

fn edges(estimates: [ValveEstimateAnswer; 4]) -> ValveEdgesAnswer {
    let [supply_to_a, a_to_tank, supply_to_b, b_to_tank] = estimates;
    ValveEdgesAnswer { supply_to_a, a_to_tank, supply_to_b, b_to_tank }
}

pub(super) fn bootstrap(found: &Bootstrap) -> BootstrapAnswer {
    BootstrapAnswer { repetitions: found.repetitions, failed: found.failed, block_rows: found.block_rows }
}
