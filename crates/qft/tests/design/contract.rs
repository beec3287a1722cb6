//! Properties of every design: equal seeds give equal results, and a design may be stopped at any
//! time.

use phea_qft::design::{ControllerChoice, DesignOptions, DesignStatus, design};
use phea_qft::verification::{TrackingJudgement, Verdict};

use super::problems::{assert_met, designed, example_d, least_gain, structure};

fn complex_poles(seed: u64) -> DesignOptions {
    least_gain(structure("Z PP", [1e-2, 1e4], [0.1, 1e5], [0.1, 5.0]), seed)
}

#[test]
fn the_same_seed_gives_the_same_design() {
    let problem = example_d();
    let [first, second, other] = [5, 5, 6].map(|seed| designed(&problem, complex_poles(seed)));
    assert_eq!(first, second);
    // the starting points depend on the seed
    assert_ne!(first.controller, other.controller);
}

/// Structures of growing order: stopped at any point, the result is audited, and a design that
/// meets the limits is not abandoned for one that does not.
#[test]
fn a_run_that_is_stopped_has_the_best_so_far() {
    let problem = example_d();
    let controller = ControllerChoice::Grow { maximum_order: 3 };
    let options = DesignOptions { controller, ..complex_poles(1) };
    let mut steps = 0;
    let whole = design(&problem, &options, &mut |progress| {
        steps += 1;
        (0.0..=1.0).contains(&progress.fraction) && !progress.stage.is_empty()
    });
    let whole = whole.unwrap();
    assert!(!whole.stopped, "a share or a stage that is none");
    assert_met(&problem, &whole.design.unwrap(), TrackingJudgement::Spread);
    let (mut shown, mut met_at) = (0, None);
    for last in [steps / 30, steps / 10, steps / 3, steps / 2, 9 * steps / 10, 99 * steps / 100, steps - 1] {
        let mut left = last;
        let outcome = design(&problem, &options, &mut |_| {
            left -= 1;
            left > 0
        });
        let mut outcome = outcome.unwrap();
        assert!(outcome.stopped && left == 0, "it goes on after its end");
        let concludes = outcome.design.is_none();
        outcome.conclude().unwrap();
        let design = outcome.design.unwrap_or_else(|| panic!("nothing at step {last} of {steps}"));
        shown += 1;
        assert!(design.objective_db.is_finite() || concludes, "{design:?}");
        let met = design.status == DesignStatus::Met;
        assert!(concludes || met == (design.audit.verdict == Verdict::Met));
        assert!(met_at.is_none() || met, "met at step {met_at:?}, and not at {last}");
        met_at = met_at.or(met.then_some(last));
    }
    assert!(shown == 7 && met_at.is_some(), "{shown} {met_at:?}");
}
