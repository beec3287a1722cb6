//! Dead time of the loop in addition to its declared delay.

use phea_dynamics::scalar::Interval;
use phea_qft::family::Family;

use crate::robust::RobustProblem;

/// Dead time of the parts of a loop, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopDeadTime {
    /// Least and greatest dead time of the plants of the family that have polynomials.
    pub plant_s: [f64; 2],
    /// Dead time of the sensor.
    pub sensor_s: f64,
    /// Dead time of the controller.
    pub controller_s: f64,
}

impl LoopDeadTime {
    pub(crate) fn of(problem: &RobustProblem) -> LoopDeadTime {
        LoopDeadTime {
            plant_s: of_plants(&problem.family).unwrap_or([0.0; 2]),
            sensor_s: problem.compensation.sensor().dead_time_s(),
            controller_s: problem.compensation.feedback().dead_time_s(),
        }
    }
}

/// Dead time over the box of a family.
fn of_plants(family: &Family) -> Option<[f64; 2]> {
    let Family::Uncertain(family) = family else { return None };
    let parameters = family.plant().parameters().iter();
    let ranges: Vec<Interval> = parameters.map(|one| Interval::new(one.minimum, one.maximum)).collect();
    let enclosed = family.plant().enclosures(&ranges)?.dead_time_s;
    // no plant has less than zero
    (enclosed.low().is_finite() && enclosed.high().is_finite())
        .then(|| [enclosed.low().max(0.0), enclosed.high()])
}
