//! Plants between the members of a family.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::atan2;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::stability::{FamilyStability, family_stability};
use phea_qft::verification::{Evidence, PlantPoint, StabilityReason, Verdict};

/// Plant 1e-3/(s^2 + d s + 1) with d = (p - 0.3)^2 + least: the members at p = 0, 0.5 and 1 do not
/// show how small d becomes.
fn dip(least: f64, extent: Extent) -> Family {
    let parameter = UncertainParameter { name: "p".into(), nominal: 1.0, minimum: 0.0, maximum: 1.0 };
    let plant = UncertainPlant::record(vec![parameter], |p| {
        let off = p[0] - 0.3.into();
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![1e-3.into()],
                denominator: vec![1.0.into(), off * off + least.into(), 1.0.into()],
            },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        }
    });
    let coordinate =
        Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 3 };
    let plant = plant.unwrap();
    let members = grid(&plant, std::slice::from_ref(&coordinate)).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, vec![coordinate], members, extent).unwrap())
}

fn audited(family: &Family, prefilter: Vec<Element>, timing: Timing) -> FamilyStability {
    let controller = Controller { prefilter: Compensator::new(prefilter), timing, ..Controller::default() };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    family_stability(family, &compensation, &mut unwatched).unwrap()
}

fn timings() -> [Timing; 3] {
    let late = Timing { delay_s: 0.5, ..Timing::default() };
    let sampled = Timing { sample_time_s: Some(0.01), ..Timing::default() };
    [Timing::default(), late, sampled]
}

#[test]
fn an_unstable_plant_between_stable_members_is_found() {
    for timing in timings() {
        let found = audited(&dip(-0.01, Extent::Box), vec![], timing).finding;
        assert_eq!((found.verdict, found.evidence), (Verdict::Violated, Evidence::Search), "{timing:?}");
        let PlantPoint::Parameters(values) = found.plant else { panic!("a plant of the box") };
        assert!((values[0] - 0.3).abs() < 0.1, "{values:?}");
        // the members are stable, and no further claim is made
        let members = audited(&dip(-0.01, Extent::Members), vec![], timing).finding;
        assert_eq!((members.verdict, members.evidence), (Verdict::Met, Evidence::Grid));
    }
}

/// The poles of s^2 + d s + 1.001 have the real part -d/2.
#[test]
fn the_largest_real_part_lies_inside() {
    let found = audited(&dip(0.02, Extent::Box), vec![], Timing::default()).finding;
    assert_eq!((found.verdict, found.evidence), (Verdict::Met, Evidence::Search));
    assert!((found.largest_real_part.unwrap() + 0.01).abs() < 1e-12);
    let PlantPoint::Parameters(values) = found.plant else { panic!("a plant of the box") };
    assert!((values[0] - 0.3).abs() < 1e-5, "{values:?}");
}

/// Plant with dead time: the smallest |1 + L| leads to the interior, 1 - 1e-3/d at the resonance,
/// after a quarter of a turn.
#[test]
fn the_closest_approach_lies_inside() {
    let timing = Timing { delay_s: std::f64::consts::FRAC_PI_2, ..Timing::default() };
    let found = audited(&dip(0.002, Extent::Box), vec![], timing);
    assert_eq!((found.finding.verdict, found.finding.largest_real_part), (Verdict::Met, None));
    let closest = found.finding.closest_approach.unwrap();
    assert!((closest.distance - 0.5).abs() < 1e-3, "{closest:?}");
    assert!((closest.frequency_rad_per_s - 1.0).abs() < 1e-3);
    assert_eq!(found.delay_margin.unwrap().delay_s, f64::INFINITY);
}

/// Gain |L| reaches one, at 1e-3/d, only near p = 0.3.
#[test]
fn a_crossover_that_no_member_has_is_found() {
    let found = audited(&dip(0.0008, Extent::Box), vec![], Timing::default());
    let margin = found.delay_margin.unwrap();
    // |L| = 1 at (1 - w^2)^2 + (d w)^2 = 1e-6; the higher of both crossovers has less phase margin
    let (d, level) = (0.0008, 1e-6_f64);
    let half = 1.0 - d * d / 2.0;
    let w = (half + (half * half - 1.0 + level).sqrt()).sqrt();
    let lag = std::f64::consts::PI - atan2(d * w, 1.0 - w * w);
    assert!((margin.delay_s / (lag / w) - 1.0).abs() < 1e-6, "{margin:?} {}", lag / w);
    assert!((margin.frequency_rad_per_s / w - 1.0).abs() < 1e-6);
    let PlantPoint::Parameters(values) = margin.plant else { panic!("a plant of the box") };
    assert!((values[0] - 0.3).abs() < 1e-3, "{values:?}");
}

/// Plant k e^(-s T)/s with uncertain k and T: the margin is the least pi/(2 k) - T over the
/// corners.
#[test]
fn an_uncertain_dead_time_counts() {
    let parameter = |name: &str, minimum, maximum| UncertainParameter {
        name: name.into(),
        nominal: minimum,
        minimum,
        maximum,
    };
    let parameters = vec![parameter("k", 0.5, 1.2), parameter("T", 0.1, 0.9)];
    let plant = UncertainPlant::record(parameters, |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
        disturbance: None,
        dead_time_s: p[1],
        rate: None,
    });
    let coordinate = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points: 1,
    };
    let coordinates = vec![coordinate(0), coordinate(1)];
    // no member but the nominal plant: only the search finds the corner
    let family = UncertainFamily::new(plant.unwrap(), coordinates, vec![], Extent::Box).unwrap();
    let margin = audited(&Family::Uncertain(family), vec![], Timing::default()).delay_margin.unwrap();
    assert!((margin.delay_s - (std::f64::consts::FRAC_PI_2 / 1.2 - 0.9)).abs() < 1e-12, "{margin:?}");
    assert_eq!(margin.plant, PlantPoint::Parameters(vec![1.2, 0.9]));
}

/// Plant k/s, which tolerates pi/(2 k). The gain k has a peak of 1 at p = 0.35 and one of 1.05 just
/// beyond a jump at 0.47, narrower than the steps of a search from anywhere else.
#[test]
fn the_worst_value_beyond_a_jump_is_found() {
    let parameter = UncertainParameter { name: "p".into(), nominal: 0.35, minimum: 0.0, maximum: 0.6 };
    let plant = UncertainPlant::record(vec![parameter], |p| {
        let [off, away] = [p[0] - 0.35.into(), p[0] - 0.4775.into()];
        let before = (off * off).times(-4.0) + 1.0.into();
        let slower = (away * away).times(1270.0) + 1.0.into();
        let chosen = |one, other| Scalar::select(p[0].less_than(0.47.into()), one, other);
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![chosen(before, 1.05.into())],
                denominator: vec![chosen(1.0.into(), slower), 0.0.into()],
            },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        }
    });
    let coordinate =
        Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
    let members = [0.0, 0.35, 0.47 - 1e-9, 0.47 + 1e-9, 0.6].map(|p| vec![p]).to_vec();
    let family = UncertainFamily::new(plant.unwrap(), vec![coordinate], members, Extent::Box).unwrap();
    let margin = audited(&Family::Uncertain(family), vec![], Timing::default()).delay_margin.unwrap();
    assert!((margin.delay_s - std::f64::consts::FRAC_PI_2 / 1.05).abs() < 1e-9, "{margin:?}");
}

#[test]
fn an_unstable_prefilter_makes_the_whole_unstable() {
    let unstable = TransferFunction::from_factors(-1.0, vec![], vec![Complex64::new(1.0, 0.0)]).unwrap();
    let found = audited(&dip(0.1, Extent::Box), vec![Element::General(unstable)], Timing::default());
    assert_eq!((found.finding.verdict, found.delay_margin), (Verdict::Violated, None));
    assert_eq!(found.finding.reason, StabilityReason::UnstablePrefilter);
}

/// Repeated audits give identical bits.
#[test]
fn the_audit_is_repeatable() {
    for timing in timings() {
        let family = dip(0.02, Extent::Box);
        assert_eq!(audited(&family, vec![], timing), audited(&family, vec![], timing));
    }
}
