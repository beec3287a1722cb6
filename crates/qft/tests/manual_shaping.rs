//! Elements solved for a point pass through it, unreachable points are rejected, and every change
//! can be undone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Stage, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{argument, magnitude};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::bound::Placement;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::manual_shaping::{
    DesignChart, Edit, ElementPattern, NeededCoordinate, PassError, WantedPoint, apply, pass_through,
};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::template::{TemplateOptions, template};
use phea_qft::verification::TrackingJudgement;

/// Fractions in [0, 1) from a linear congruential generator (Knuth 1997, MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }
}

const PATTERNS: [ElementPattern; 14] = [
    ElementPattern::Gain,
    ElementPattern::RealPole,
    ElementPattern::RealZero,
    ElementPattern::Lead,
    ElementPattern::Lag,
    ElementPattern::ComplexPoles,
    ElementPattern::ComplexZeros,
    ElementPattern::RollOff { damping_ratio: 0.3 },
    ElementPattern::RollOff { damping_ratio: 0.8 },
    ElementPattern::RollOff { damping_ratio: 2.5 },
    ElementPattern::ProportionalIntegral,
    ElementPattern::NotchHere { pole_damping_ratio: 0.6 },
    ElementPattern::FurtherNotch { natural_frequency: 0.5 },
    ElementPattern::FurtherNotch { natural_frequency: 1e4 },
];

fn polar(decibels: f64, degrees: f64) -> Complex64 {
    let (size, angle) = (10_f64.powf(decibels / 20.0), degrees.to_radians());
    Complex64::new(size * angle.cos(), size * angle.sin())
}

/// Response of an element in a continuous or sampled loop, as in loop and verification: together
/// with a pair of poles, without which a zero could not be sampled.
fn response(element: Element, timing: Timing, frequency: f64) -> Complex64 {
    let pair = Element::ComplexPoles { natural_frequency: 300.0, damping_ratio: 0.7 };
    let of = |elements| {
        let controller = Controller { feedback: Compensator::new(elements), timing, ..Controller::default() };
        let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        compensation.response(frequency).feedback
    };
    of(vec![pair.clone(), element]) / of(vec![pair])
}

/// Elements solved for a random point: an element either passes through it, or the point is outside
/// the stated reach.
#[test]
fn every_solved_element_passes_its_point() {
    let mut random = Random(1);
    let sampled = Timing { sample_time_s: Some(1e-3), ..Timing::default() };
    for pattern in PATTERNS {
        let (mut passed, mut refused) = (0, 0);
        for round in 0..3000 {
            let timing = if round % 2 == 0 { Timing::default() } else { sampled };
            let frequency = 10_f64.powf(random.between(0.0, 3.0));
            let [present_db, present_deg] = [random.between(-40.0, 40.0), random.between(-360.0, 0.0)];
            let [raise, turn] = [random.between(-30.0, 30.0), random.between(-179.0, 180.0)];
            let wants = if matches!(pattern, ElementPattern::Gain | ElementPattern::NotchHere { .. }) {
                0
            } else {
                round % 3
            };
            let wanted = WantedPoint {
                frequency_rad_per_s: frequency,
                magnitude_db: (wants != 1).then_some(present_db + raise),
                phase_deg: (wants != 0).then_some(present_deg + turn),
            };
            let present = polar(present_db, present_deg);
            match pass_through(pattern, &wanted, present, &timing) {
                Ok(element) => {
                    let reached = present * response(element.clone(), timing, frequency);
                    if wanted.magnitude_db.is_some() {
                        let error = 20.0 * magnitude(reached).log10() - (present_db + raise);
                        assert!(error.abs() < 1e-9, "{element:?}: {error} dB");
                    }
                    if wanted.phase_deg.is_some() {
                        let turned = reached / polar(0.0, present_deg + turn);
                        assert!(argument(turned).abs() < 1e-9, "{element:?}: {} rad", argument(turned));
                    }
                    passed += 1;
                }
                Err(PassError::Unreachable { reach, .. }) => {
                    let [low, high] = reach.turn_deg;
                    let turns = wants == 0 || (low < turn && turn < high);
                    let raises = wants == 1
                        || reach.raise_db.is_some_and(|[least, most]| least < raise && raise < most);
                    assert!(!(turns && raises), "{pattern:?} {raise} dB, {turn} degrees: {reach:?}");
                    refused += 1;
                }
                Err(PassError::Incomplete { needs, .. }) => assert_eq!(needs, NeededCoordinate::Both),
                Err(other) => panic!("{pattern:?}: {other:?}"),
            }
        }
        assert!(
            passed > 50 && (refused > 50 || pattern == ElementPattern::Gain),
            "{pattern:?} {passed} {refused}"
        );
    }
}

/// Points on the boundary of an element's reach, at 10 rad/s from L = 1: rejected there, solved
/// slightly inside.
#[test]
fn the_ends_of_the_reachable_range_are_as_stated() {
    let at = |pattern, magnitude_db: f64, phase_deg: f64| {
        let wanted = WantedPoint {
            frequency_rad_per_s: 10.0,
            magnitude_db: Some(magnitude_db),
            phase_deg: Some(phase_deg),
        };
        pass_through(pattern, &wanted, Complex64::new(1.0, 0.0), &Timing::default())
    };
    let lift = -20.0 * 60_f64.to_radians().cos().log10();
    let near_notch = ElementPattern::FurtherNotch { natural_frequency: 20.0 };
    for (pattern, edge_db, inward_db, edge_deg, inward_deg) in [
        (ElementPattern::Lead, lift, 0.01_f64, 60.0, 0.0),
        (ElementPattern::Lag, -lift, -0.01, -60.0, 0.0),
        (ElementPattern::ComplexPoles, -lift, 0.01, -60.0, 0.0),
        (ElementPattern::ComplexPoles, -40.0, 0.0, -180.0, 0.01),
        (ElementPattern::ComplexZeros, lift, -0.01, 60.0, 0.0),
        (ElementPattern::ProportionalIntegral, 3.0, 0.0, -90.0, 0.01),
        (ElementPattern::ProportionalIntegral, 3.0, 0.0, 0.0, -0.01),
        (near_notch, -lift, -0.01, -60.0, 0.0),
    ] {
        let outside = at(pattern, edge_db - inward_db, edge_deg - inward_deg);
        assert!(matches!(outside, Err(PassError::Unreachable { .. })), "{pattern:?}: {outside:?}");
        let inside = at(pattern, edge_db + inward_db, edge_deg + inward_deg);
        assert!(inside.is_ok(), "{pattern:?}: {inside:?}");
    }
}

/// A first-order element reaches one curve: both coordinates are accepted only on it.
#[test]
fn a_real_pole_reaches_its_curve_and_reports_it() {
    let wanted = |magnitude_db| WantedPoint {
        frequency_rad_per_s: 10.0,
        magnitude_db: Some(magnitude_db),
        phase_deg: Some(-45.0),
    };
    let solved = |magnitude_db| {
        let one = Complex64::new(1.0, 0.0);
        pass_through(ElementPattern::RealPole, &wanted(magnitude_db), one, &Timing::default())
    };
    let Ok(Element::RealPole { frequency }) = solved(-10.0 * 2_f64.log10()) else { panic!() };
    assert!((frequency - 10.0).abs() < 1e-12);
    let Err(PassError::Unreachable { turn_deg, raise_db, reach, .. }) = solved(-6.0) else { panic!() };
    assert_eq!(turn_deg, Some(-45.0));
    assert!((raise_db.unwrap() + 6.0).abs() < 1e-12);
    let raise = reach.raise_db.unwrap();
    assert!(raise.map(|end| (end + 10.0 * 2_f64.log10()).abs() < 1e-12) == [true; 2], "{raise:?}");
}

/// Plant k/(s + a), k from 1 to 4 and a from 1 to 3.
fn box_family() -> Family {
    let range =
        |name: &str, maximum| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 1.0, maximum };
    let plant = UncertainPlant::record(vec![range("k", 4.0), range("a", 3.0)], |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), p[1]] },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })
    .unwrap();
    let along = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points: 4,
    };
    let coordinates = vec![along(0), along(1)];
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

fn loop_of(elements: Vec<Element>) -> Compensation {
    let controller = Controller { feedback: Compensator::new(elements), ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

/// Two independent evaluations of a loop agree: a plant with a negative margin means a forbidden
/// loop, and after the required change of gain no margin is negative.
#[test]
fn the_required_change_brings_a_margin_to_zero() {
    let family = box_family();
    let specification = |requirement| Specification {
        requirement,
        frequencies_rad_per_s: vec![2.0],
        band_rad_per_s: [2.0, 2.0],
    };
    let specifications = [
        specification(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2))),
        specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5))),
        specification(Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(3.0))),
    ];
    let built = template(&family, &loop_of(vec![]), 2.0, &TemplateOptions::default()).unwrap();
    let chart = DesignChart::new(&family, vec![built.template], &specifications).unwrap();
    let mut random = Random(3);
    let (mut violated, mut moved) = (0, 0);
    for _ in 0..300 {
        let gain = Element::Gain(10_f64.powf(random.between(-1.0, 1.5)));
        let lag = Element::ComplexPoles {
            natural_frequency: 10_f64.powf(random.between(-0.5, 2.0)),
            damping_ratio: random.between(0.2, 1.5),
        };
        let elements = vec![gain, lag];
        let margins = chart.margins(&loop_of(elements.clone()), TrackingJudgement::Spread);
        assert_eq!(margins.len(), 3);
        assert!(margins.windows(2).all(|pair| pair[0].worst.margin_db <= pair[1].worst.margin_db));
        for margin in margins {
            let Placement::Forbidden { nearest_db, .. } = margin.placement else {
                assert!(margin.worst.margin_db > -1e-9, "{margin:?}");
                continue;
            };
            violated += usize::from(margin.worst.margin_db < 0.0);
            let Some(change) = nearest_db else { continue };
            let scaled = [elements.clone(), vec![Element::Gain(10_f64.powf(change / 20.0))]].concat();
            let again = chart.margins(&loop_of(scaled), TrackingJudgement::Spread);
            let again =
                again.iter().find(|one| one.worst.specification == margin.worst.specification).unwrap();
            assert!(again.worst.margin_db > -1e-9, "{margin:?} {again:?}");
            moved += 1;
        }
    }
    assert!(violated > 100 && moved > 100, "{violated} {moved}");
}

fn random_edit(random: &mut Random, count: usize) -> Edit {
    let [one, other] = [0, 1].map(|_| 10_f64.powf(random.between(-1.0, 3.0)));
    let element = match random.below(4) {
        0 => Element::Integrator,
        1 => Element::RealPole { frequency: one },
        2 => Element::LeadLag { zero_frequency: one, pole_frequency: other },
        _ => Element::Gain(one),
    };
    let enabled = random.next() < 0.7;
    match random.below(6) {
        0 if count > 0 => Edit::Remove(random.below(count)),
        1 if count > 0 => Edit::Replace(random.below(count), element),
        2 if count > 0 => Edit::Enable(random.below(count), enabled),
        3 if count > 0 => Edit::Move { from: random.below(count), to: random.below(count) },
        4 => Edit::ScaleGain(random.between(0.1, 10.0)),
        _ => Edit::Add { at: random.below(count + 1), stage: Stage { element, enabled } },
    }
}

/// A hundred random sequences of edits: at each step the response equals the product of the
/// elements' responses.
#[test]
fn edited_elements_multiply() {
    let mut random = Random(2);
    for _ in 0..100 {
        let mut state = Compensator::new(vec![Element::Gain(2.0), Element::Integrator]);
        for _ in 0..random.below(40) {
            state = apply(&state, &random_edit(&mut random, state.stages.len())).unwrap();
            let product = state
                .stages
                .iter()
                .filter(|stage| stage.enabled)
                .fold(Complex64::new(1.0, 0.0), |product, stage| {
                    product * stage.element.transfer_function().unwrap().at_frequency(3.0)
                });
            let whole = state.transfer_function().unwrap().at_frequency(3.0);
            assert!(magnitude(whole - product) <= 1e-12 * magnitude(product));
        }
    }
}
