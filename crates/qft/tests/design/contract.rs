//! What holds of every run: the same seed gives the same design, and it may be stopped at any step.

use phea_qft::design::{ControllerChoice, DesignOptions, DesignRun, DesignStatus};
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
    // the seed is what makes the starting points
    assert_ne!(first.controller, other.controller);
}

/// Structures of growing order: what is shown at any step is audited, and nothing that is met is given up for what is not.
#[test]
fn a_run_that_is_stopped_has_the_best_so_far() {
    let problem = example_d();
    let controller = ControllerChoice::Grow { maximum_order: 3 };
    let mut run = DesignRun::new(problem.clone(), DesignOptions { controller, ..complex_poles(1) });
    let (mut shown, mut steps, mut met_at) = (0, 0, None);
    while run.step().unwrap() {
        steps += 1;
        assert!((0.0..=1.0).contains(&run.progress()) && !run.stage().is_empty());
        if let Some(design) = run.design() {
            shown += 1;
            assert!(design.objective_db.is_finite() && !design.rounds.is_empty(), "{design:?}");
            let met = design.status == DesignStatus::Met;
            assert_eq!(met, design.audit.verdict == Verdict::Met);
            assert!(met_at.is_none() || met, "met at step {met_at:?}, and not at {steps}");
            met_at = met_at.or(met.then_some(steps));
        }
    }
    assert!(shown > 0 && met_at.unwrap() < steps, "{met_at:?} of {steps}");
    let design = run.design().unwrap().clone();
    assert_met(&problem, &design, TrackingJudgement::Spread);
    assert!(!run.step().unwrap() && run.design() == Some(&design), "it goes on after its end");
}
