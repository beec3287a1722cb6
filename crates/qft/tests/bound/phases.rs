//! Phases, tips, singular limits, and several specifications together.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::bound::{
    Bound, BoundError, BoundFunction, Feasibility, FrequencyBounds, PhaseGrid, Placement, TemplateFill,
};
use phea_qft::specification::{ClosedLoop, Limit, LimitTable, Requirement, Specification};
use phea_qft::template::{Resolution, Template, TemplatePoint};

use super::random::{Numbers, random_requirements, random_template};

fn template(responses: &[Complex64]) -> Template {
    let one = Complex64::new(1.0, 0.0);
    let point =
        |&response| TemplatePoint { member: None, values: vec![], response, load_motion: one, sensor: one };
    Template {
        frequency_rad_per_s: 1.0,
        nominal: responses[0],
        points: responses.iter().map(point).collect(),
        outlines: vec![],
        resolution: Resolution::Members,
    }
}

/// Grid refined far below the default.
const FINE: PhaseGrid = PhaseGrid { spacing_rad: 0.03, tolerance_db: 0.05, finest_rad: 1e-9 };

/// The constant plant 1.
fn unit() -> Template {
    template(&[Complex64::new(1.0, 0.0)])
}

fn function(template: &Template, requirement: Requirement) -> BoundFunction {
    BoundFunction::new(template, &requirement, TemplateFill::Points).unwrap()
}

fn specification(requirement: Requirement) -> Specification {
    Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: [1.0, 1.0] }
}

/// Bound of |T| <= W for the plant 1: it ends where a ray touches the circle of |T| = W, at
/// arcsin(1/W) from -180 degrees.
#[test]
fn the_tip_of_a_closed_bound_is_found() {
    for limit in [1.01, 1.2, 2.0, 7.0] {
        let bound =
            function(&unit(), Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)))
                .bound(&FINE);
        let within = |sign: f64| -PI + sign * portable::asin(1.0 / limit);
        let forbidden: Vec<f64> = bound
            .phases_rad
            .iter()
            .zip(&bound.forbidden)
            .filter_map(|(phase, forbidden)| (!forbidden.is_empty()).then_some(*phase))
            .collect();
        assert!((forbidden.first().unwrap() - within(-1.0)).abs() < 2e-9);
        assert!((forbidden.last().unwrap() - within(1.0)).abs() < 2e-9);
        assert!(bound.phases_rad.len() < 500, "{}", bound.phases_rad.len());
    }
}

#[test]
fn any_grid_of_phases_ends() {
    let function = function(&unit(), Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)));
    for spacing_rad in [0.0, -1.0, f64::NAN, f64::INFINITY, 10.0] {
        let phases = function.bound(&PhaseGrid::uniform(spacing_rad)).phases_rad;
        assert_eq!(phases, [-TAU, 0.0], "{spacing_rad}");
    }
    let endless = PhaseGrid { tolerance_db: 0.05, finest_rad: 0.0, ..PhaseGrid::default() };
    assert!(function.bound(&endless).phases_rad.len() < 1000);
}

/// Ends of the bound at a phase, interpolated linearly in dB between its neighbours; `None` if
/// their numbers of intervals differ.
fn interpolated_db(bound: &Bound, phase: f64) -> Option<Vec<f64>> {
    let right = bound.phases_rad.iter().position(|place| *place > phase)?;
    let (from, to) = (bound.phases_rad[right - 1], bound.phases_rad[right]);
    let fraction = (phase - from) / (to - from);
    let [left, right] = [right - 1, right].map(|place| bound.forbidden[place].intervals());
    let between = |(left, right): (&f64, &f64)| {
        if left == right {
            decibel(*left)
        } else {
            decibel(*left) * (1.0 - fraction) + decibel(*right) * fraction
        }
    };
    let ends = left.iter().flatten().zip(right.iter().flatten());
    (left.len() == right.len()).then(|| ends.map(between).collect())
}

fn decibel(gain: f64) -> f64 {
    20.0 * portable::log10(gain)
}

#[test]
fn a_bound_is_straight_between_its_phases_within_the_tolerance() {
    let mut numbers = Numbers(0x0DDB_1A5E_5BAD_5EED);
    let (mut worst, mut compared): (f64, _) = (0.0, 0);
    for _ in 0..12 {
        let template = random_template(&mut numbers);
        for requirement in random_requirements(&mut numbers, &template) {
            let function = function(&template, requirement);
            let bound = function.bound(&PhaseGrid::default());
            assert!(bound.phases_rad.is_sorted_by(|a, b| a < b));
            assert_eq!(bound.phases_rad.first().zip(bound.phases_rad.last()), Some((&-TAU, &0.0)));
            for _ in 0..100 {
                let phase = numbers.between(-TAU, 0.0);
                let exact: Vec<f64> = function
                    .forbidden(phase)
                    .intervals()
                    .iter()
                    .flatten()
                    .map(|gain| decibel(*gain))
                    .collect();
                let Some(drawn) = interpolated_db(&bound, phase) else { continue };
                assert_eq!(drawn.len(), exact.len());
                for (drawn, exact) in drawn.iter().zip(&exact).filter(|(drawn, exact)| drawn != exact) {
                    worst = worst.max((drawn - exact).abs());
                    compared += 1;
                }
            }
        }
    }
    // The tolerance is satisfied at the middle between two phases; a kink next to it may double it.
    assert!(worst < 0.11 && compared > 1000, "{worst} dB, {compared} compared");
}

/// Limit |S| <= 800, which forbids a disc of a fourteenth of a degree around each plant, far below
/// the spacing of the grid.
#[test]
fn no_small_island_is_overlooked() {
    let plants = [(1.0, 0.0), (0.2, 1.3), (2.0, -0.7), (1.0, 2.9)].map(|(magnitude, angle): (f64, f64)| {
        Complex64::new(magnitude * portable::cos(angle), magnitude * portable::sin(angle))
    });
    let grid = PhaseGrid::uniform(5.0_f64.to_radians());
    for requirement in [
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(800.0)),
        Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(800.0)),
        Requirement::tracking(Limit::Constant(1.0), Limit::Constant(2000.0)),
    ] {
        let bound = function(&template(&plants), requirement).bound(&grid);
        for plant in plants {
            let island = -plants[0] / plant; // where 1 + L = 0
            let is_hit = bound.phases_rad.iter().zip(&bound.forbidden).any(|(phase, forbidden)| {
                let off = portable::sin(phase - portable::argument(island));
                off.abs() < 2e-3 && forbidden.contains(portable::magnitude(island))
            });
            assert!(is_hit, "{island}");
        }
    }
}

/// Limits at -180 degrees with the plant 1: g/|1 - g| <= W between W/(W + 1) and W/(W - 1), 1/|1 -
/// g| <= W between 1 - 1/W and 1 + 1/W.
#[test]
fn limits_at_and_near_one_lose_no_digit() {
    let at = |requirement| function(&unit(), requirement).forbidden(-PI).intervals().to_vec();
    let close = |found: f64, expected: f64| {
        assert!(found == expected || (found / expected - 1.0).abs() < 4e-15, "{found}, {expected}");
    };
    let tiny = [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3];
    for limit in tiny.into_iter().flat_map(|off| [1.0 + off, 1.0 - off]) {
        for requirement in [
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)),
            Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(limit)),
        ] {
            let found = at(requirement);
            assert_eq!(found.len(), 1);
            close(found[0][0], limit / (limit + 1.0));
            close(found[0][1], if limit > 1.0 { limit / (limit - 1.0) } else { f64::INFINITY });
        }
        for requirement in [
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(limit)),
            Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(limit)),
            Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(limit)),
        ] {
            let found = at(requirement);
            assert_eq!(found.len(), 1);
            close(found[0][0], if limit > 1.0 { (limit - 1.0) / limit } else { 0.0 });
            close(found[0][1], (limit + 1.0) / limit);
        }
    }
}

/// Limit |G/(1 + L)| <= W with W |P| = 1: the quadratic becomes a line, and the bound -|q|/(2 cos)
/// and above.
#[test]
fn a_control_effort_at_the_gain_of_a_plant_is_a_half_plane() {
    for gain in [3.0, 0.7, 1e-6, 1e9] {
        let template = template(&[Complex64::new(gain, 0.0)]);
        let function =
            function(&template, Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(1.0 / gain)));
        for off in [0.0, 0.5, 1.2] {
            let found = function.forbidden(-PI + off);
            let [[low, high]] = *found.intervals() else { panic!("{found:?}") };
            assert!((low * 2.0 * portable::cos(off) - 1.0).abs() < 1e-14 && high > 1e14);
        }
        assert!(function.forbidden(-1.0).is_empty());
    }
}

/// Extreme limits: an infinite one forbids nothing, a limit of zero forbids everything, and an
/// identical pair of plants has no spread.
#[test]
fn limits_at_the_ends_of_their_range() {
    let constant = Limit::Constant;
    let forbidden = |requirement| function(&unit(), requirement).forbidden(-2.0);
    assert!(forbidden(Requirement::at_most(ClosedLoop::RobustStability, constant(f64::INFINITY))).is_empty());
    assert!(forbidden(Requirement::tracking(constant(0.0), constant(1.0))).is_empty());
    assert!(forbidden(Requirement::tracking(constant(1.0), constant(1.0))).is_empty());
    assert!(forbidden(Requirement::tracking(constant(2.0), constant(1.0))).is_everything());
    assert!(forbidden(Requirement::at_most(ClosedLoop::RobustStability, constant(0.0))).is_everything());
    assert!(forbidden(Requirement::at_most(ClosedLoop::Sensitivity, constant(0.0))).is_everything());
    let refused = |template: &Template, limit| {
        BoundFunction::new(
            template,
            &Requirement::at_most(ClosedLoop::Sensitivity, limit),
            TemplateFill::Points,
        )
        .unwrap_err()
    };
    let table = Limit::Table(LimitTable::new(vec![(2.0, 1.0)]).unwrap());
    assert_eq!(refused(&unit(), table), BoundError::NoLimit { frequency_rad_per_s: 1.0 });
    assert!(matches!(refused(&unit(), constant(f64::NAN)), BoundError::Limit { .. }));
    assert!(matches!(refused(&unit(), constant(-1.0)), BoundError::Limit { .. }));
    let zero = Complex64::new(0.0, 0.0);
    let one = Complex64::new(1.0, 0.0);
    assert!(matches!(refused(&template(&[zero]), constant(1.0)), BoundError::Nominal { .. }));
    assert!(matches!(refused(&template(&[one, zero]), constant(1.0)), BoundError::Response { index: 1, .. }));
    let none = Template { points: vec![], ..unit() };
    assert!(matches!(refused(&none, constant(1.0)), BoundError::NoPlants { .. }));
}

/// Limits |S| <= W and |T| <= W with W < 1: both reach their limits where |L| = 1 and
/// 2 |cos(phi/2)| = 1/W; nearer to -180 degrees no gain remains.
#[test]
fn specifications_that_collide_are_named_with_their_phases() {
    let limit = Limit::Constant(0.9);
    let bounds = FrequencyBounds::new(
        &unit(),
        &[
            Specification {
                frequencies_rad_per_s: vec![2.0],
                ..specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.0)))
            },
            specification(Requirement::at_most(ClosedLoop::RobustStability, limit.clone())),
            specification(Requirement::at_most(ClosedLoop::Sensitivity, limit)),
        ],
        TemplateFill::Points,
    )
    .unwrap();
    let combined = bounds.combined(&FINE);
    let Feasibility::Somewhere { collisions } = &combined.feasibility else {
        panic!("{:?}", combined.feasibility)
    };
    let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
    let first = 2.0 * portable::acos(1.0 / 1.8);
    assert_eq!(collision.specifications, [2, 1]);
    assert!(
        (collision.phases_rad[1] + first).abs() < 2e-9
            && (collision.phases_rad[0] + TAU - first).abs() < 2e-9
    );
    let middle = combined.union.phases_rad.iter().position(|phase| phase + PI >= 0.0).unwrap();
    let forbidding = |gain: f64| -> Vec<usize> {
        let parts = combined.parts.iter().filter(|part| part.bound.forbidden[middle].contains(gain));
        parts.map(|part| part.specification).collect()
    };
    assert_eq!(forbidding(1.0), [1, 2]);
    assert_eq!(forbidding(3.0), [1]);
    assert_eq!(forbidding(0.1), [2]);
}

/// A specification that forbids every gain is named as the only one.
#[test]
fn a_specification_that_forbids_everything_is_named_as_the_only_cause() {
    let impossible = specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.0)));
    let margin = specification(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)));
    let bounds = FrequencyBounds::new(&unit(), &[margin, impossible], TemplateFill::Points).unwrap();
    let Feasibility::Nowhere { collisions } = bounds.combined(&PhaseGrid::default()).feasibility else {
        panic!()
    };
    assert_eq!(collisions.len(), 1);
    assert_eq!((collisions[0].specifications.as_slice(), collisions[0].phases_rad), (&[1][..], [-TAU, 0.0]));
}

/// Limit |T| <= 2, which forbids (2/3, 2) at -180 degrees.
#[test]
fn a_loop_is_placed_with_its_distance_in_db() {
    let bounds = FrequencyBounds::new(
        &unit(),
        &[specification(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(2.0)))],
        TemplateFill::Points,
    )
    .unwrap();
    let at = |re: f64| bounds.placement(Complex64::new(re, 0.0));
    let Placement::Forbidden { by, nearest_db: Some(nearest_db) } = at(-1.0) else { panic!() };
    assert_eq!(by, [0]);
    assert!((nearest_db - decibel(2.0 / 3.0)).abs() < 1e-12);
    let Placement::Forbidden { nearest_db: Some(nearest_db), .. } = at(-1.5) else { panic!() };
    assert!((nearest_db - decibel(2.0 / 1.5)).abs() < 1e-12);
    let Placement::Allowed { slack_db } = at(-4.0) else { panic!() };
    assert!((slack_db - decibel(2.0)).abs() < 1e-12);
    assert_eq!(at(4.0), Placement::Allowed { slack_db: f64::INFINITY });
    assert_eq!(at(0.0), Placement::Allowed { slack_db: f64::INFINITY });
}
