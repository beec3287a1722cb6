//! Plants and frequencies that are evaluated.

use num_complex::Complex64;
use phea_dynamics::controller::{Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::design::{DesignProblem, Objective};
use phea_qft::family::{Extent, Family, MeasuredFamily, MeasuredPlant, UncertainFamily};
use phea_qft::loop_shaping::{
    Samples, SamplesError, SearchProblem, Shaping, Structure, StructureFactor, search_frequencies,
};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};
use phea_qft::verification::PlantPoint;

use super::random::{plants, problem, specification};

fn gain() -> Structure {
    Structure { sign: 1.0, gain: [0.01, 100.0], parts: vec![] }
}

fn with_family(family: Family, limit: f64) -> DesignProblem {
    DesignProblem {
        family,
        additional_plants: vec![],
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications: vec![specification(
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)),
            [0.0, f64::INFINITY],
        )],
        minimum_delay_margin_s: 0.0,
    }
}

/// Plant k/(s^2 + 1), without damping.
fn undamped() -> DesignProblem {
    let k = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
    let plant = UncertainPlant::record(vec![k], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![1.0.into(), 0.0.into(), 1.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let family = UncertainFamily::new(plant.unwrap(), vec![], vec![vec![4.0]], Extent::Box).unwrap();
    with_family(Family::Uncertain(family), 2.0)
}

/// Pole of an undamped plant, at which |T| is 1 for any gain.
#[test]
fn an_undamped_pole_is_sampled_next_to_its_frequency() {
    let problem = undamped();
    let samples = Samples::new(&problem, &plants(&problem), &[1.0]).unwrap();
    assert_eq!(samples.pairs(), 2);
    let shaping = Shaping::new(gain(), None, Objective::BestWorstMargin, samples).unwrap();
    let margin = shaping.margins(&[0.0])[0].margin_db;
    assert!((margin - 20.0 * 2f64.log10()).abs() < 1e-6, "{margin}");
}

#[test]
fn a_counterexample_adds_its_plant_everywhere_and_its_frequency_for_itself() {
    let problem = problem(Timing::default());
    let all = plants(&problem);
    let samples = Samples::new(&problem, &all[..5], &[1.0, 10.0]).unwrap();
    let mut shaping = Shaping::new(gain(), None, Objective::BestWorstMargin, samples).unwrap();
    let before = shaping.judge(&[0.5]);
    assert!(shaping.add(&all[9..11], 3.0).unwrap());
    assert!(!shaping.add(&all[10..11], 3.0).unwrap());
    assert_eq!(shaping.samples().plants().len(), 7);
    assert_eq!(shaping.samples().frequencies_rad_per_s(), [1.0, 3.0, 10.0]);
    assert_eq!(shaping.samples().pairs(), 7 + 2 + 7);
    // more requirements, and a structure that is evaluated at their frequencies
    assert!(shaping.judge(&[0.5]).worst_margin_db <= before.worst_margin_db);
    let found = shaping.margins(&[0.5]);
    let direct = Samples::new(&problem, &all[9..11], &[3.0]).unwrap();
    let direct = Shaping::new(gain(), None, Objective::BestWorstMargin, direct).unwrap().margins(&[0.5]);
    let at_three: Vec<_> = found.into_iter().filter(|margin| margin.frequency_rad_per_s == 3.0).collect();
    assert_eq!(at_three, direct);
}

#[test]
fn a_point_of_another_family_is_refused() {
    let problem = problem(Timing::default());
    for point in [PlantPoint::Measured(0), PlantPoint::Parameters(vec![1.0])] {
        let refused = Samples::new(&problem, std::slice::from_ref(&point), &[1.0]);
        assert_eq!(refused.err(), Some(SamplesError::Plant(point.clone())));
        assert_eq!(
            search_frequencies(&problem, std::slice::from_ref(&point), 10.0).err(),
            Some(SamplesError::Plant(point))
        );
    }
}

/// A measured plant is evaluated where it was measured.
#[test]
fn nothing_is_sampled_beyond_a_measurement() {
    let frequencies: Vec<f64> = (1..=50).map(f64::from).collect();
    let command = frequencies.iter().map(|&w| 1.0 / Complex64::new(1.0, w)).collect();
    let plant = MeasuredPlant {
        name: "lag".into(),
        frequencies_rad_per_s: frequencies,
        command,
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    let family = Family::Measured(MeasuredFamily::new(vec![plant]).unwrap());
    let problem = with_family(family, 1.2);
    let samples = Samples::new(&problem, &plants(&problem), &[0.5, 1.0, 7.5, 50.0, 51.0]).unwrap();
    assert_eq!(samples.pairs(), 3);
    let shaping = Shaping::new(gain(), None, Objective::BestWorstMargin, samples).unwrap();
    assert_eq!(shaping.margins(&[0.0]).len(), 3);
}

#[test]
fn the_grid_covers_the_bands_and_frequencies_above_their_ends() {
    let mut problem = problem(Timing::default());
    let all = plants(&problem);
    let grid = search_frequencies(&problem, &all, 20.0).unwrap();
    assert!(grid.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(grid[0] <= 0.5 / 20.0 && *grid.last().unwrap() >= 30.0 * 20.0, "{grid:?}");
    assert!([1.0, 15.0, 40.0].iter().all(|given| grid.contains(given)));
    // no gap within the dense part
    let dense = grid.windows(2).filter(|pair| pair[0] > 0.5 && pair[1] < 30.0);
    assert!(dense.clone().count() > 30);
    assert!(dense.into_iter().all(|pair| pair[1] / pair[0] < 10f64.powf(1.0 / 20.0) * (1.0 + 1e-6)));
    // a sampled loop ends at pi/T; above the last band the grid continues with this density, a
    // factor 30 further or to pi/T
    problem.timing.sample_time_s = Some(0.02);
    let sampled = search_frequencies(&problem, &all, 20.0).unwrap();
    assert_eq!(*sampled.last().unwrap(), std::f64::consts::PI / 0.02);
    problem.specifications = problem.specifications.drain(5..).collect();
    let above = |problem: &DesignProblem, ends_at: f64| {
        let grid = search_frequencies(problem, &all, 20.0).unwrap();
        assert!(grid.contains(&15.0) && (0.85..=1.0).contains(&(grid.last().unwrap() / ends_at)), "{grid:?}");
        let above = grid.windows(2).filter(|pair| pair[0] >= 15.0);
        assert!(above.clone().count() > 15);
        assert!(above.into_iter().all(|pair| pair[1] / pair[0] < 10f64.powf(1.0 / 20.0) * (1.0 + 1e-6)));
    };
    above(&problem, std::f64::consts::PI / 0.02);
    problem.timing.sample_time_s = None;
    above(&problem, 30.0 * 15.0);
}

/// The resonances of lightly damped plants are among the frequencies, but not all of them if
/// crowded.
#[test]
fn peaks_are_sampled() {
    let problem = undamped();
    let grid = search_frequencies(&problem, &plants(&problem), 7.0).unwrap();
    assert!(grid.contains(&1.0));
}

/// A structure whose fixed part is not a transfer function, and one that cannot be sampled, are
/// rejected at once.
#[test]
fn a_structure_without_a_response_is_refused() {
    let problem = undamped();
    let samples = Samples::new(&problem, &plants(&problem), &[2.0]).unwrap();
    let parts = vec![StructureFactor::Fixed(Element::RealZero { frequency: 0.0 })];
    let refused = Shaping::new(Structure { parts, ..gain() }, None, Objective::BestWorstMargin, samples);
    assert!(refused.is_err());
}
