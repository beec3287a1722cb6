//! Designs that serve a plant in addition to their family: they must equal those of a family that
//! includes this plant.

use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_dynamics::watch::unwatched;
use phea_qft::design::{Design, DesignOptions, DesignProblem, DesignStatus, design, design_again};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::specification::{ClosedLoop, Requirement};
use phea_qft::verification::{TrackingJudgement, Verdict};

use super::problems::{
    EVERYWHERE, assert_met, audited, demand, designed, high_frequency_gain, least_gain, problem, rational,
    stability, structure, uncertain,
};

/// Plant k/((s + 1)(T s + 1)) with these nominal values.
fn lagging([gain, lag]: [f64; 2]) -> UncertainPlant {
    let parameters = [("k", gain, 1.0, 4.0), ("T", lag, 0.01, 0.4)];
    uncertain(&parameters, |p| (vec![p[0]], vec![p[1], p[1] + 1.0.into(), 1.0.into()]))
}

const QUICK: [f64; 2] = [1.0, 0.01];
const LATE: [f64; 2] = [4.0, 0.2];

/// Limits |T| <= 1.3 and |S| <= 2 |s/(s + 3)|, for the fast plant and these others.
fn regulation(others: &[[f64; 2]]) -> DesignProblem {
    let frequencies = [0.1, 1.0, 10.0];
    let sensitivity = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[2.0, 0.0], &[1.0, 3.0]));
    let specifications = vec![stability(1.3, &frequencies), demand(sensitivity, &frequencies, EVERYWHERE)];
    let members = others.iter().map(|one| one.to_vec()).collect();
    let family = UncertainFamily::new(lagging(QUICK), vec![], members, Extent::Members).unwrap();
    problem(Family::Uncertain(family), specifications)
}

fn options() -> DesignOptions {
    least_gain(structure("I Z P", [0.01, 1e4], [0.01, 1e3], [0.1, 2.0]), 1)
}

fn assert_same(one: &Design, other: &Design) {
    let [one, other] = [one, other].map(high_frequency_gain);
    assert!((one.0 - other.0).abs() < 0.02 && one.1 == other.1, "{one:?} {other:?}");
}

#[test]
fn an_additional_plant_counts_as_a_member() {
    let both = regulation(&[LATE]);
    let truth = designed(&both, options());
    assert_met(&both, &truth, TrackingJudgement::Spread);

    let family_only = regulation(&[]);
    let without = designed(&family_only, options());
    assert_met(&family_only, &without, TrackingJudgement::Spread);
    // the additional plant matters: the design without it violates a limit for it
    assert_eq!(audited(&both, &without, TrackingJudgement::Spread).verdict, Verdict::Violated);

    let with_late_plant = DesignProblem { additional_plants: vec![lagging(LATE)], ..family_only };
    let found = designed(&with_late_plant, options());
    assert_met(&with_late_plant, &found, TrackingJudgement::Spread);
    assert_eq!(found.additional_audits.len(), 1);
    assert_eq!(found.additional_audits[0].verdict, Verdict::Met);
    assert_eq!(audited(&both, &found, TrackingJudgement::Spread).verdict, Verdict::Met);
    assert_same(&found, &truth);
}

#[test]
fn a_design_continues_with_an_added_plant() {
    let both = regulation(&[LATE]);
    let mut problem = regulation(&[]);
    let family_only = design(&problem, &options(), &mut unwatched).unwrap();
    let rounds = family_only.design.as_ref().unwrap().rounds.clone();
    problem.additional_plants.push(lagging(LATE));
    let outcome = design_again(&problem, &options(), family_only, &mut unwatched).unwrap();
    let found = &outcome.design.unwrap();
    assert_eq!(found.status, DesignStatus::Met);
    assert!(found.rounds.starts_with(&rounds) && found.rounds.len() > rounds.len());
    assert_eq!(audited(&both, found, TrackingJudgement::Spread).verdict, Verdict::Met);
    assert_same(found, &designed(&both, options()));
}

/// Limits that a plant and a second one cannot both satisfy have the relaxation of a family of
/// both.
#[test]
fn infeasibility_with_it_is_reported_with_the_least_relaxation() {
    let too_late = [4.0, 0.4];
    let relaxation = |design: &Design| match &design.status {
        DesignStatus::Infeasible(relaxation) => relaxation.relaxation_db,
        other => panic!("{other:?}"),
    };
    let truth = relaxation(&designed(&regulation(&[too_late]), options()));
    let with_late_plant = DesignProblem { additional_plants: vec![lagging(too_late)], ..regulation(&[]) };
    let found = designed(&with_late_plant, options());
    assert!(truth > 0.1 && (relaxation(&found) - truth).abs() < 0.03, "{} {truth}", relaxation(&found));
    assert_eq!(found.additional_audits[0].verdict, Verdict::Violated);
}
