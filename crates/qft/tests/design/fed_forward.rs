//! Designs whose loop feeds the rate of a disturbance forward: they must equal those of a plant
//! whose disturbance acts through that path.

use phea_dynamics::controller::Timing;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::design::DesignProblem;
use phea_qft::family::Spacing;
use phea_qft::specification::{ClosedLoop, Requirement};
use phea_qft::verification::TrackingJudgement;

use super::problems::{
    EVERYWHERE, assert_met, boxed, demand, designed, high_frequency_gain, least_gain, problem, rational,
    stability, structure, uncertain,
};

/// Plant k/D with D = 0.05 s^2 + 1.05 s + 1 and k from 1 to 2, whose disturbance acts through (K
/// k - 3) s/D; |T| <= 1.3 and
/// |Y/D| <= 4 |s/(s + 3)|.
fn regulation(gain_in_path: f64, rate_feed_forward: f64) -> DesignProblem {
    let parameters = uncertain(&[("k", 1.0, 1.0, 2.0)], |p| (vec![p[0]], vec![p[0]])).parameters().to_vec();
    let plant = UncertainPlant::record(parameters, |p| {
        let denominator = vec![0.05.into(), 1.05.into(), 1.0.into()];
        let path = vec![p[0] * gain_in_path.into() - 3.0.into(), 0.0.into()];
        PlantCoefficients {
            command: RationalCoefficients { numerator: vec![p[0]], denominator: denominator.clone() },
            disturbance: Some(RationalCoefficients { numerator: path, denominator }),
            dead_time_s: 0.0.into(),
            rate: None,
        }
    });
    let frequencies = [0.1, 1.0, 10.0];
    let motion = Requirement::at_most(ClosedLoop::LoadMotion, rational(&[4.0, 0.0], &[1.0, 3.0]));
    let specifications = vec![stability(1.3, &frequencies), demand(motion, &frequencies, EVERYWHERE)];
    DesignProblem {
        timing: Timing { rate_feed_forward, ..Timing::default() },
        ..problem(boxed(plant.unwrap(), Spacing::Linear, 3), specifications)
    }
}

#[test]
fn a_feed_forward_is_equivalent_to_its_path() {
    let options = || least_gain(structure("I Z P", [0.01, 1e4], [0.01, 1e3], [0.1, 2.0]), 1);
    let [feedback_only, path, fed] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[path, fed]| {
        let problem = regulation(path, fed);
        let design = designed(&problem, options());
        assert_met(&problem, &design, TrackingJudgement::Spread);
        assert_eq!(design.controller.timing.rate_feed_forward, fed);
        high_frequency_gain(&design)
    });
    assert!((fed.0 - path.0).abs() < 0.02 && fed.1 == path.1, "{fed:?} {path:?}");
    assert!(fed.0 < feedback_only.0 - 1.0, "{fed:?} {feedback_only:?}");
}
