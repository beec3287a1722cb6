//! A design for stricter limits continues from one for weaker limits.

use phea_dynamics::watch::unwatched;
use phea_qft::design::{
    ControllerChoice, DesignOptions, DesignOutcome, DesignStatus, design, design_after, design_stricter,
};
use phea_qft::verification::TrackingJudgement;

use super::problems::{assert_met, example_d, least_gain, stability, structure};

#[test]
fn structures_that_fail_weaker_limits_are_not_tested_for_stricter_ones() {
    let weaker = example_d();
    let controller = ControllerChoice::Grow { maximum_order: 3 };
    let given = structure("Z PP", [1e-2, 1e4], [0.1, 1e5], [0.1, 5.0]);
    let options = DesignOptions { controller, ..least_gain(given, 1) };
    let before = design(&weaker, &options, &mut unwatched).unwrap();
    let found = before.design.as_ref().unwrap();
    assert_eq!(found.status, DesignStatus::Met);
    let order = found.structure.order().unwrap();
    let mut stricter = weaker.clone();
    stricter.specifications[0] = stability(1.15, &weaker.specifications[0].frequencies_rad_per_s);
    let after = design_stricter(&stricter, &options, &before, &mut unwatched).unwrap();
    let anew = design_after(&stricter, &options, &before, &mut unwatched).unwrap();
    let shortest = |outcome: &DesignOutcome| {
        outcome.searched().iter().map(|structure| structure.structure.order().unwrap()).min().unwrap()
    };
    assert!(shortest(&anew) < order, "{} {order}", shortest(&anew));
    assert_eq!(shortest(&after), order);
    assert!(after.searched().len() < anew.searched().len());
    assert_met(&stricter, after.design.as_ref().unwrap(), TrackingJudgement::Spread);
}
