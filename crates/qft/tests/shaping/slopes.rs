//! Slopes of margins and objectives against central differences.

use phea_dynamics::controller::Timing;
use phea_qft::design::{DesignProblem, Objective};
use phea_qft::loop_shaping::{Samples, SearchProblem, Shaping, Structure};

use super::random::{Draw, plants, problem, rational, structure};

const STEP: f64 = 1e-5;

fn moved(x: &[f64], index: usize, step: f64) -> Vec<f64> {
    x.iter().enumerate().map(|(at, &x)| if at == index { x + step } else { x }).collect()
}

/// Single margin: with one frequency, one specification and a uniquely worst plant, the first row
/// is the worst margin.
fn check_single(problem: &DesignProblem, draw: &mut Draw, with_prefilter: bool) {
    let structure = structure(draw);
    let x = draw.point(&structure.bounds());
    let prefilter = with_prefilter.then(|| rational(&[3.0], &[1.0, 3.0]));
    let two = &plants(problem)[3..5];
    let samples = Samples::new(problem, two, &[4.0]).unwrap();
    let prefilter = prefilter.as_ref().map(Structure::fixed_to);
    let mut shaping = Shaping::new(structure, prefilter, Objective::LeastHighFrequencyGain, samples).unwrap();
    let slopes = shaping.slopes(&x);
    let row = &slopes.margins[0];
    let judged = shaping.judge(&x);
    assert!((row.margin_db / row.rate - judged.worst_margin_db).abs() < 1e-9);
    for (index, slope) in row.slopes.iter().enumerate() {
        let mut at = |step: f64| shaping.judge(&moved(&x, index, step)).worst_margin_db * row.rate;
        let expected = (at(STEP) - at(-STEP)) / (2.0 * STEP);
        assert!((slope - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{index}: {slope} {expected}");
    }
}

#[test]
fn margins_of_each_kind_move_with_their_slopes() {
    let mut draw = Draw(21);
    let all = problem(Timing::default());
    for specification in &all.specifications {
        let problem = DesignProblem { specifications: vec![specification.clone()], ..all.clone() };
        for _ in 0..8 {
            check_single(&problem, &mut draw, false);
            if specification.requirement.is_tracking() {
                check_single(&problem, &mut draw, true);
            }
        }
    }
}

/// The least of the linear rows near a point is the worst margin of all plants and frequencies, to
/// second order.
#[test]
fn the_rows_together_predict_the_worst_margin() {
    let mut draw = Draw(22);
    let problem = problem(Timing { sample_time_s: Some(0.005), ..Timing::default() });
    let frequencies: Vec<f64> = (0..40).map(|index| 0.3 * 1.18f64.powi(index)).collect();
    let samples = Samples::new(&problem, &plants(&problem), &frequencies).unwrap();
    for _ in 0..6 {
        let structure = structure(&mut draw);
        let x = draw.point(&structure.bounds());
        let mut shaping = Shaping::new(structure, None, Objective::BestWorstMargin, samples.clone()).unwrap();
        let slopes = shaping.slopes(&x);
        assert!(slopes.margins.len() > x.len() && slopes.margins.len() <= 240, "{}", slopes.margins.len());
        let worst = |step: &[f64]| {
            let row = slopes.margins.iter().map(|row| {
                let change: f64 = row.slopes.iter().zip(step).map(|(slope, step)| slope * step).sum();
                (row.margin_db + change) / row.rate
            });
            row.fold(f64::INFINITY, f64::min)
        };
        let here = shaping.judge(&x).worst_margin_db;
        assert!((worst(&vec![0.0; x.len()]) - here).abs() < 1e-9);
        // errors of second order fall by four when the step is halved
        let direction = draw.point(&vec![[-1.0, 1.0]; x.len()]);
        let mut error = |length: f64| {
            let step: Vec<f64> = direction.iter().map(|direction| length * direction).collect();
            let there: Vec<f64> = x.iter().zip(&step).map(|(x, step)| x + step).collect();
            (shaping.judge(&there).worst_margin_db - worst(&step)).abs()
        };
        let (long, short) = (error(2e-3), error(1e-3));
        assert!(long < 1e-2 && short < 0.3 * long + 1e-9, "{long} {short}");
    }
}

/// Slopes depend only on the present samples: with an additional plant and frequency, and with
/// other limits, they equal those of a new shaping.
#[test]
fn slopes_do_not_depend_on_earlier_evaluations() {
    let mut draw = Draw(24);
    let problem = problem(Timing::default());
    let frequencies: Vec<f64> = (0..20).map(|index| 0.3 * 1.4f64.powi(index)).collect();
    let all = plants(&problem);
    let (known, new) = all.split_at(3);
    let samples = Samples::new(&problem, known, &frequencies).unwrap();
    let structure = structure(&mut draw);
    let x = draw.point(&structure.bounds());
    let fresh =
        || Shaping::new(structure.clone(), None, Objective::BestWorstMargin, samples.clone()).unwrap();
    let mut shaping = fresh();
    shaping.judge(&x);
    assert_eq!(shaping.slopes(&x), fresh().slopes(&x));
    let other = draw.point(&structure.bounds());
    assert_eq!(shaping.slopes(&other), fresh().slopes(&other));

    let before = shaping.judge(&x);
    shaping.add(&new[..1], 1.7).unwrap();
    let mut added = fresh();
    added.add(&new[..1], 1.7).unwrap();
    assert_eq!([shaping.judge(&x)], [added.judge(&x)]);
    assert_eq!(shaping.slopes(&x), added.slopes(&x));

    let mut shaping = fresh();
    shaping.judge(&x);
    let own = problem.specifications[..1].to_vec();
    let mut fewer = shaping.with_limits(structure.clone(), (own, 0.0));
    assert_ne!(fewer.judge(&x), before);
}

#[test]
fn objectives_move_with_their_slopes() {
    let mut draw = Draw(23);
    let problem = problem(Timing::default());
    let frequencies: Vec<f64> = (0..30).map(|index| 0.1 * 1.3f64.powi(index)).collect();
    let samples = Samples::new(&problem, &plants(&problem), &frequencies).unwrap();
    for objective in
        [Objective::LeastHighFrequencyGain, Objective::LeastBandwidth, Objective::BestWorstMargin]
    {
        for _ in 0..10 {
            let structure = structure(&mut draw);
            let x = draw.point(&structure.bounds());
            let mut shaping = Shaping::new(structure, None, objective, samples.clone()).unwrap();
            let slopes = shaping.slopes(&x);
            for (index, slope) in slopes.objective_slopes.iter().enumerate() {
                let mut at = |step: f64| shaping.judge(&moved(&x, index, step)).objective_db;
                let expected = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                assert!((slope - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{slope} {expected}");
            }
        }
    }
}
