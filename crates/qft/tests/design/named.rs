//! Named controllers: the shortest that meets the limits, longer ones that earn their poles, and
//! the notch against its closed form.

use num_complex::Complex64;
use phea_dynamics::controller::{NamedStructure, Objective};
use phea_dynamics::portable::magnitude;
use phea_dynamics::watch::unwatched;
use phea_qft::design::{
    ControllerChoice, DesignOptions, DesignOutcome, DesignProblem, DesignStatus, PoleRange,
    SearchedStructure, StructureEnding, design,
};
use phea_qft::family::{Family, Spacing};
use phea_qft::loop_shaping::{Samples, SearchProblem, Shaping, Structure, StructureFactor};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{PlantPoint, TrackingJudgement};

use super::problems::{
    EVERYWHERE, assert_met, boxed, demand, least_gain, problem, rational, stability, uncertain,
};

/// Natural frequency and damping ratio of the resonance.
const RESONANCE_RAD_PER_S: f64 = 10.0;
const DAMPING: f64 = 0.02;

/// A plant of unit gain with this denominator after its constant 1, times k from 1 to 1.1.
fn family(denominator: [f64; 2]) -> Family {
    let plant = uncertain(&[("k", 1.0, 1.0, 1.1)], |p| {
        (vec![p[0]], vec![denominator[0].into(), denominator[1].into(), 1.0.into()])
    });
    boxed(plant, Spacing::Linear, 3)
}

/// Limit |S| <= w/corner up to 0.4 of the corner, which requires one integrator of at least this
/// gain.
fn slow_errors(corner: f64) -> Specification {
    let requirement = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[1.0, 0.0], &[corner]));
    demand(requirement, &[0.1 * corner, 0.2 * corner, 0.4 * corner], [0.0, 0.4 * corner])
}

/// Plant k/((s + 1)(s/100 + 1)).
fn lag(corner: f64) -> DesignProblem {
    problem(family([0.01, 1.01]), vec![stability(1.2, &[0.3, 1.0, 3.0, 10.0]), slow_errors(corner)])
}

/// Plant k/(s^2/w^2 + 2 D s/w + 1).
fn resonant() -> Family {
    family([RESONANCE_RAD_PER_S.powi(-2), 2.0 * DAMPING / RESONANCE_RAD_PER_S])
}

fn resonance(corner: f64) -> DesignProblem {
    problem(resonant(), vec![stability(1.5, &[0.3, 1.0, 3.0, 10.0, 30.0]), slow_errors(corner)])
}

fn any(earned_per_pole_db: f64) -> DesignOptions {
    let none = Structure { sign: 1.0, gain: [1.0, 1.0], parts: vec![] };
    let controller =
        ControllerChoice::Any { maximum_order: 4, from: None, with_pure_gain: false, earned_per_pole_db };
    DesignOptions { controller, ..least_gain(none, 1) }
}

fn outcome(problem: &DesignProblem, options: &DesignOptions) -> DesignOutcome {
    design(problem, options, &mut unwatched).unwrap()
}

fn ending(outcome: &DesignOutcome, name: NamedStructure) -> Option<StructureEnding> {
    outcome.searched().iter().find(|one| one.name == Some(name)).map(|one| one.ending)
}

/// Pure integral control gives T = k K/(s (s + 1) + k K) for the lag, whose peak is 1.2 at k K =
/// 1.12: it satisfies the limits up to a corner of 1, and with a zero at -1 beyond.
#[test]
fn any_takes_the_shortest_that_is_met() {
    let shortest = any(f64::INFINITY);
    for (corner, name) in [(0.5, NamedStructure::Integral), (5.0, NamedStructure::ProportionalIntegral)] {
        let problem = lag(corner);
        let found = outcome(&problem, &shortest);
        let design = found.design.clone().unwrap();
        assert_eq!(design.name, Some(name), "{corner}: {:?}", found.searched());
        assert_met(&problem, &design, TrackingJudgement::Spread);
        let missed = found.searched().iter().filter(|one| one.ending != StructureEnding::Met);
        assert_eq!(missed.count(), usize::from(name == NamedStructure::ProportionalIntegral));
    }
}

/// The names that were searched, in order.
fn names(outcome: &DesignOutcome) -> Vec<NamedStructure> {
    outcome.searched().iter().filter_map(|one| one.name).collect()
}

/// Limits on the error that vanish with w require an integrator, so that a pure gain fails at low
/// frequency; it is searched first if this is requested.
#[test]
fn a_pure_gain_is_tested_before_structures_with_an_integrator() {
    let choice = |with_pure_gain| {
        let ControllerChoice::Any { maximum_order, from, earned_per_pole_db, .. } = any(6.0).controller
        else {
            unreachable!()
        };
        let controller = ControllerChoice::Any { maximum_order, from, earned_per_pole_db, with_pure_gain };
        DesignOptions { controller, ..any(6.0) }
    };
    let with = outcome(&lag(0.5), &choice(true));
    let gain = &with.searched()[0];
    assert_eq!((gain.name, gain.ending), (Some(NamedStructure::Proportional), StructureEnding::Missed));
    assert!(gain.binding.contains(&1), "{gain:?}");
    assert_eq!(with.design.clone().unwrap().name, Some(NamedStructure::Integral));
    let without = names(&outcome(&lag(0.5), &choice(false)));
    assert_eq!(names(&with), [vec![NamedStructure::Proportional], without].concat());
}

/// Resonance with L = K/(s P(s)), which gives T = x/(1 - x), x = k K/(2 D w): integral control
/// reaches a margin m of both limits if K = m corner and x/(1 - x) = 0.5/m, which is 0.995 dB. A
/// low pass before the resonance reaches more, and replaces integral control if it gains more than
/// a pole must earn.
#[test]
fn a_longer_structure_must_earn_its_poles() {
    let at_most = |closed_loop, limit| Requirement::at_most(closed_loop, Limit::Constant(limit));
    let everywhere = demand(at_most(ClosedLoop::Sensitivity, 2.0), &[3.0, 10.0], EVERYWHERE);
    let beyond = [5.0, f64::INFINITY];
    let beyond = demand(at_most(ClosedLoop::RobustStability, 0.5), &[5.0, 10.0, 20.0], beyond);
    let problem = problem(resonant(), vec![everywhere, beyond, slow_errors(0.1)]);
    let options = |earned_db| DesignOptions { objective: Objective::BestWorstMargin, ..any(earned_db) };
    let free_of_charge = outcome(&problem, &options(0.0));
    let reached = |name| {
        let structure_tested = free_of_charge.searched().iter().find(|one| one.name == Some(name));
        -structure_tested.unwrap().reached_db.unwrap()
    };
    let [of_i, of_pi_low_pass] = [NamedStructure::Integral, NamedStructure::PiLowPass].map(reached);
    assert!((of_i - 0.995).abs() < 0.02, "{of_i} dB");
    let gained_db = of_pi_low_pass - of_i;
    assert!(gained_db > 2.0, "{gained_db} dB");
    let less = outcome(&problem, &options(0.9 * gained_db));
    assert_eq!(less.design.clone().unwrap().name, Some(NamedStructure::PiLowPass), "{:?}", less.searched());
    let more = outcome(&problem, &options(1.1 * gained_db));
    assert_eq!(more.design.clone().unwrap().name, Some(NamedStructure::Integral), "{:?}", more.searched());
    assert_eq!(ending(&more, NamedStructure::PiLowPass), Some(StructureEnding::NotEarned));
}

/// An integrator and a resonance have |L| = K/(2 D w) at the resonance, so that |T| <= 1.5 lets K
/// reach 0.6 * 2 D w = 0.24 without a notch. A notch at the resonance lets it reach half of w.
#[test]
fn a_notch_is_at_the_resonance() {
    let problem = resonance(4.0);
    let of = |name| {
        let controller = ControllerChoice::Named { name, earned_per_pole_db: f64::INFINITY };
        outcome(&problem, &DesignOptions { controller, ..any(0.0) }).design.unwrap()
    };
    let without = of(NamedStructure::Integral);
    assert!(matches!(without.status, DesignStatus::Infeasible(_)), "{:?}", without.status);
    let design = of(NamedStructure::PiNotch);
    assert_met(&problem, &design, TrackingJudgement::Spread);
    let law = design.law.feedback.transfer_function().unwrap();
    let zero = law.zeros().iter().find(|zero| zero.im > 0.0).unwrap();
    assert!((magnitude(*zero) / RESONANCE_RAD_PER_S - 1.0).abs() < 0.1, "{zero}");
    assert!(zero.re.abs() / magnitude(*zero) < 0.2, "{zero}");
}

/// A structure with a notch equals its closed form at every frequency, and the margins of a loop
/// change with its numbers according to their slopes.
#[test]
fn a_notch_is_its_closed_form() {
    let notch = StructureFactor::Notch {
        natural_frequency: [1.0, 100.0],
        damping_ratio: [0.1, 3.0],
        depth: [0.01, 1.0],
    };
    let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts: vec![notch] };
    let [gain, frequency, damping, depth] = [0.5_f64, 12.0, 0.4, 0.1];
    let x = [gain, frequency, damping, depth].map(f64::ln);
    let law = structure.compensator(&x).transfer_function().unwrap();
    for w in [0.0, 3.0, 11.0, 12.0, 13.0, 400.0] {
        let s = Complex64::new(0.0, w / frequency);
        let closed = gain * (s * s + 2.0 * depth * damping * s + 1.0) / (s * s + 2.0 * damping * s + 1.0);
        assert!(magnitude(law.at_frequency(w) - closed) < 1e-12, "{w}: {}", law.at_frequency(w));
    }
    assert!((magnitude(law.at_frequency(frequency)) - gain * depth).abs() < 1e-12);

    let problem = resonance(2.0);
    let plants = [1.0, 1.1].map(|gain| PlantPoint::Parameters(vec![gain]));
    let samples = Samples::new(&problem, &plants, &[0.4, 8.0, 14.0]).unwrap();
    let mut shaping = Shaping::new(structure, None, Objective::LeastHighFrequencyGain, samples).unwrap();
    let rows = shaping.slopes(&x).margins;
    assert!(!rows.is_empty());
    let margins = |shaping: &mut Shaping, x: &[f64]| {
        shaping.slopes(x).margins.into_iter().map(|row| row.margin_db).collect::<Vec<f64>>()
    };
    const STEP: f64 = 1e-6;
    for number in 0..x.len() {
        let [above, below] = [STEP, -STEP].map(|step| {
            let mut moved = x;
            moved[number] += step;
            margins(&mut shaping, &moved)
        });
        for ((row, above), below) in rows.iter().zip(above).zip(below) {
            let slope = (above - below) / (2.0 * STEP);
            assert!(
                (row.slopes[number] - slope).abs() < 1e-4 * (1.0 + slope.abs()),
                "{number}: {row:?} {slope}"
            );
        }
    }
}

/// Poles of a structure with its numbers at the ends of their ranges, none of which is beyond the
/// bound: a pair has two real poles if its damping ratio is more than 1, one of them above its
/// natural frequency.
#[test]
fn no_pole_exceeds_the_permitted_frequency() {
    let fastest_rad_per_s = 40.0;
    // no controller of these orders satisfies it, so that all of them are searched
    let hard = problem(resonant(), vec![stability(1.001, &[0.3, 1.0, 3.0, 10.0, 30.0]), slow_errors(60.0)]);
    let poles = PoleRange { least_damping_ratio: 0.3, fastest_rad_per_s };
    let controller = ControllerChoice::Grow { maximum_order: 4 };
    let found = outcome(&hard, &DesignOptions { poles, controller, ..any(6.0) });
    let has_pair = |one: &SearchedStructure| {
        one.structure.parts.iter().any(|part| matches!(part, StructureFactor::PolePair { .. }))
    };
    assert!(found.searched().iter().any(has_pair), "{:?}", found.searched());
    for structure_tested in found.searched() {
        let highest: Vec<f64> = structure_tested.structure.bounds().iter().map(|range| range[1]).collect();
        let law = structure_tested.structure.compensator(&highest).transfer_function().unwrap();
        let sizes = law.poles().iter().map(|pole| magnitude(*pole));
        assert!(sizes.fold(0.0, f64::max) <= fastest_rad_per_s * (1.0 + 1e-9), "{structure_tested:?}");
    }
}
