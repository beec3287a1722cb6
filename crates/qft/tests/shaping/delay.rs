//! The margin to a required delay, against the actual critical delay of each loop.

use phea_dynamics::controller::{Controller, Element, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{DesignProblem, Objective};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::loop_shaping::{Samples, SearchProblem, Shaping, Structure, StructureFactor};
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::PlantPoint;

use super::random::Draw;

/// Plant k (s^2/400 + s/100 + 1)/(s (s^2/100 + d s/5 + 1)) without any specification.
fn problem(delay_s: f64) -> DesignProblem {
    let parameter = |name: &str, minimum: f64, maximum: f64| UncertainParameter {
        name: name.into(),
        nominal: minimum,
        minimum,
        maximum,
    };
    let plant = UncertainPlant::record(vec![parameter("k", 0.5, 3.0), parameter("d", 0.1, 0.6)], |p| {
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![p[0] * 0.0025.into(), p[0] * 0.01.into(), p[0]],
                denominator: vec![0.01.into(), p[1] * 0.2.into(), 1.0.into(), 0.0.into()],
            },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        }
    });
    let family = UncertainFamily::new(plant.unwrap(), vec![], vec![], Extent::Box).unwrap();
    DesignProblem {
        family: Family::Uncertain(family),
        additional_plants: vec![],
        sensor: TransferFunction::gain_only(1.0),
        timing: Timing::default(),
        specifications: vec![],
        minimum_delay_margin_s: delay_s,
    }
}

fn structure() -> Structure {
    let parts = vec![
        StructureFactor::RealPole { frequency: [2.0, 20.0] },
        StructureFactor::RealZero { frequency: [2.0, 20.0] },
        StructureFactor::Fixed(Element::RealPole { frequency: 200.0 }),
    ];
    Structure { sign: 1.0, gain: [0.3, 3.0], parts }
}

fn points() -> Vec<PlantPoint> {
    [[0.5, 0.1], [1.0, 0.3], [3.0, 0.6], [2.0, 0.2], [0.7, 0.6]]
        .map(|values| PlantPoint::Parameters(values.to_vec()))
        .to_vec()
}

/// The least delay that one of the plants tolerates; `None` if one is unstable.
fn borne(samples: &Samples, structure: &Structure, x: &[f64]) -> Option<f64> {
    let controller = Controller { feedback: structure.compensator(x), ..Controller::default() };
    let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let delays = samples.members().iter().map(|member| {
        let found = member_stability(member, &around);
        (found.status == StabilityStatus::Stable).then(|| found.critical_delay.unwrap().delay_s)
    });
    delays.collect::<Option<Vec<f64>>>().map(|delays| delays.into_iter().fold(f64::INFINITY, f64::min))
}

#[test]
fn the_margin_is_the_delay_that_the_worst_plant_tolerates() {
    let demanded = 0.05;
    let frequencies = logarithmic_grid(0.01, 1000.0, 1200).unwrap();
    let samples = Samples::new(&problem(demanded), &points(), &frequencies).unwrap();
    let mut shaping = Shaping::new(structure(), None, Objective::BestWorstMargin, samples.clone()).unwrap();
    let mut draw = Draw(31);
    let (mut met, mut missed) = (0, 0);
    for _ in 0..60 {
        let x = draw.point(&structure().bounds());
        let judged = shaping.judge(&x);
        let Some(borne) = borne(&samples, &structure(), &x) else {
            assert!(!judged.stable);
            continue;
        };
        let found = demanded * portable::pow(10.0, judged.worst_margin_db / 20.0);
        assert!(judged.stable && (found - borne).abs() < 3e-3 * borne + 2e-5, "{judged:?} {borne}");
        if borne > demanded { met += 1 } else { missed += 1 }
    }
    assert!(met > 5 && missed > 5, "{met} {missed}");
}

#[test]
fn its_slopes_are_those_of_central_differences() {
    let frequencies = logarithmic_grid(0.01, 1000.0, 60).unwrap();
    let samples = Samples::new(&problem(0.05), &points(), &frequencies).unwrap();
    let mut shaping = Shaping::new(structure(), None, Objective::BestWorstMargin, samples).unwrap();
    let mut draw = Draw(32);
    for _ in 0..20 {
        let x = draw.point(&structure().bounds());
        let judged = shaping.judge(&x).worst_margin_db;
        let slopes = shaping.slopes(&x);
        // peaks count only for the slopes
        let row = slopes.margins.iter().find(|row| (row.margin_db - judged).abs() < 1e-9).unwrap();
        for (index, slope) in row.slopes.iter().enumerate() {
            let mut at = |step: f64| {
                let mut x = x.clone();
                x[index] += step;
                shaping.judge(&x).worst_margin_db
            };
            let expected = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((slope - expected).abs() < 1e-4 * (1.0 + expected.abs()), "{index}: {slope} {expected}");
        }
    }
}

/// The resonance at 10 rad/s reaches 0.8, at which the phase tolerates some 30 ms.
#[test]
fn a_peak_below_one_is_a_row_before_it_is_a_crossover() {
    let x = [0.7f64, 5.0, 5.0].map(f64::ln);
    let frequencies = logarithmic_grid(0.01, 1000.0, 400).unwrap();
    let worst = PlantPoint::Parameters(vec![3.0, 0.1]);
    let rows = |delay_s: f64| {
        let samples = Samples::new(&problem(delay_s), std::slice::from_ref(&worst), &frequencies).unwrap();
        Shaping::new(structure(), None, Objective::BestWorstMargin, samples).unwrap().slopes(&x).margins
    };
    assert_eq!([0.0, 0.01, 0.05].map(|delay_s| rows(delay_s).len()), [0, 1, 2]);
    let long = rows(0.05);
    let per_neper = 20.0 / std::f64::consts::LN_10;
    let peak = long.iter().find(|row| (row.slopes[0] + per_neper).abs() < 1e-9).unwrap();
    assert!((peak.margin_db + 20.0 * 0.8f64.log10()).abs() < 0.2, "{peak:?}");
}
