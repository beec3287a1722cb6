//! The search from many starts.

use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::loop_shaping::{Aim, DescentStatus, SearchOptions, SearchResult, SearchStatus, search};

use super::formula::Formula;

fn searched(problem: &mut Formula, options: SearchOptions) -> SearchResult {
    let mut last = 0.0;
    let found = search(problem, vec![], &options, &mut |progress| {
        assert!((last..=1.0).contains(&progress.fraction), "{last} {progress:?}");
        last = progress.fraction;
        true
    });
    found.unwrap().unwrap()
}

/// Rastrigin's function, softened: 25 valleys within these bounds, the deepest one at the origin.
fn hills() -> Formula {
    fn hill(x: &f64) -> f64 {
        x * x + 1.5 * (1.0 - (2.0 * std::f64::consts::PI * x).cos())
    }
    let mut problem = Formula::new(2, |_| 0.0, |x| vec![-x.iter().map(hill).sum::<f64>()]);
    problem.bounds = vec![[-2.6, 2.4]; 2];
    problem
}

#[test]
fn the_best_of_many_valleys_is_found_from_every_seed() {
    for seed in 1..=5 {
        let found = searched(&mut hills(), SearchOptions::new(Aim::WorstMargin, seed));
        assert_eq!(found.status, SearchStatus::Ended(DescentStatus::Converged));
        assert!(found.judgement.worst_margin_db > -1e-4, "{seed} {found:?}");
        assert_eq!(found.ends.len(), 4);
    }
}

#[test]
fn equal_seeds_give_equal_bytes() {
    let found = |seed| searched(&mut hills(), SearchOptions::new(Aim::WorstMargin, seed));
    let (first, second, other) = (found(3), found(3), found(4));
    assert_eq!(format!("{first:?}"), format!("{second:?}"));
    assert_ne!(format!("{first:?}"), format!("{other:?}"));
}

/// Stable ball that contains the smaller ball allowed by the margin, as with the loops of a
/// controller. It occupies a six-thousandth of the box: no sample is expected there, and evolution
/// follows the instability.
#[test]
fn evolution_finds_a_small_stable_region() {
    fn outside(x: &[f64]) -> f64 {
        x.iter().map(|x| (x - 7.0) * (x - 7.0)).sum::<f64>() - 25.0
    }
    let mut problem = Formula::new(5, |x| x[0] + x[1], |x| vec![-outside(x) - 16.0]);
    problem.instability = outside;
    let found =
        searched(&mut problem, SearchOptions { samples: 60, ..SearchOptions::new(Aim::Objective, 2) });
    assert_eq!(found.status, SearchStatus::Ended(DescentStatus::Converged));
    assert!((found.judgement.objective_db - (14.0 - 18_f64.sqrt())).abs() < 2e-3, "{found:?}");
    assert!(found.work.judgements > 100, "{:?}", found.work);
}

#[test]
fn nothing_stable_is_reported_with_the_least_instability() {
    let mut problem = Formula::new(2, |x| x[0], |x| vec![x[0]]);
    problem.instability = |x| 2.0 + x[0] * x[0] + x[1] * x[1];
    let found = searched(&mut problem, SearchOptions::new(Aim::Objective, 1));
    let SearchStatus::NotStabilised { instability } = found.status else { panic!("{found:?}") };
    assert!(instability >= 2.0 && instability - 2.0 < 1e-3, "{instability}");
    assert!(found.ends.is_empty() && !found.judgement.stable);
}

/// Rosenbrock's valley: every descent ends at (1, 1) after many steps, and those that come near the
/// end of the first are not completed.
#[test]
fn a_descent_that_comes_near_an_end_is_not_completed() {
    let valley = |x: &[f64]| vec![-100.0 * (x[1] - x[0] * x[0]).powi(2) - (1.0 - x[0]).powi(2)];
    let mut problem = Formula::new(2, |_| 0.0, valley);
    problem.bounds = vec![[-2.0, 2.0]; 2];
    let options = |finished| SearchOptions { finished, ..SearchOptions::new(Aim::WorstMargin, 1) };
    let (one, all) = (searched(&mut problem, options(1)), searched(&mut problem, options(8)));
    assert_eq!([one.ends.len(), all.ends.len()], [1, 8]);
    assert!(all.ends.iter().all(|end| end.x == one.x), "{:?}", all.ends);
    // each joins once it is within a twentieth of the bounds, not at the bottom of the valley
    assert!(all.work.slopes < 3 * one.work.slopes, "{:?} {:?}", all.work, one.work);
}

/// Workers that take the tasks from the last to the first.
fn backwards(pieces: Vec<WorkPiece<'_>>, _: &'static str, watch: Watch<'_>) -> Result<(), Stopped> {
    pieces.into_iter().rev().try_for_each(|piece| piece(&mut *watch))
}

/// Samples and descents are independent of each other: any number of workers, in any order, finds
/// equal results and counts equal work, also if descents join.
#[test]
fn the_result_does_not_depend_on_the_workers() {
    let valley = |x: &[f64]| vec![-100.0 * (x[1] - x[0] * x[0]).powi(2) - (1.0 - x[0]).powi(2)];
    let mut joining = Formula::new(2, |_| 0.0, valley);
    joining.bounds = vec![[-2.0, 2.0]; 2];
    for problem in [hills(), joining] {
        let options = SearchOptions { scanned: 3, finished: 8, ..SearchOptions::new(Aim::WorstMargin, 1) };
        let found = |at_once: usize| {
            let workers = Workers { at_once, work: backwards };
            let options = SearchOptions { workers, ..options };
            search(&mut problem.clone(), vec![vec![0.5; 2]], &options, &mut |_| true).unwrap().unwrap()
        };
        let sequential = search(&mut problem.clone(), vec![vec![0.5; 2]], &options, &mut |_| true);
        let sequential = format!("{:?}", sequential.unwrap().unwrap());
        for at_once in [1, 2, 3, 16] {
            assert_eq!(format!("{:?}", found(at_once)), sequential, "{at_once}");
        }
    }
}

/// Starts with and without a feasible end: the feasible one wins, independent of the values of the
/// others.
#[test]
fn feasible_ends_come_first() {
    let margins = |x: &[f64]| vec![(0.5 - (x[0] - 3.0).abs()).max(-0.1 - (x[0] + 3.0).powi(2))];
    let mut problem = Formula::new(1, |x| x[0], margins);
    problem.bounds = vec![[-5.0, 5.0]];
    let found =
        searched(&mut problem, SearchOptions { finished: 8, ..SearchOptions::new(Aim::Objective, 1) });
    assert!((found.x[0] - 2.5).abs() < 2e-3, "{found:?}");
    let last = found.ends.last().unwrap();
    assert!(
        matches!(last.status, DescentStatus::Infeasible { worst_margin_db } if (worst_margin_db + 0.1).abs() < 1e-3)
    );
}
