//! Margins of the samples against those computed plant by plant.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Discretization, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::design::{DesignProblem, Objective};
use phea_qft::loop_shaping::{Samples, SearchProblem, Shaping, Structure};
use phea_qft::specification::{LoopResponse, Specification};

use super::random::{Draw, plants, problem, rational, structure};

const FREQUENCIES: [f64; 9] = [0.3, 0.5, 1.0, 3.0, 9.0, 15.0, 20.0, 60.0, 300.0];

fn response(around: &Compensation, member: &Member, frequency: f64) -> LoopResponse {
    let member = member.response(frequency).unwrap();
    let controller = around.response(frequency);
    LoopResponse {
        plant: member.plant,
        load_motion: member.load_motion,
        controller: controller.feedback,
        prefilter: controller.prefilter,
        sensor: member.sensor,
    }
}

/// The least margin of the plants at a frequency within the band, computed plant by plant.
fn plain(
    specification: &Specification,
    around: &Compensation,
    members: &[Member],
    frequency: f64,
    spread: bool,
) -> Option<f64> {
    let [from, to] = specification.band_rad_per_s;
    if frequency < from || frequency > to {
        return None;
    }
    let responses: Vec<LoopResponse> =
        members.iter().map(|member| response(around, member, frequency)).collect();
    if spread && let (Some(lower), upper) = specification.requirement.limits() {
        let closed = |at: &LoopResponse| magnitude(specification.requirement.closed_loop().response(at));
        let greatest = responses.iter().map(closed).fold(0.0, f64::max);
        let least = responses.iter().map(closed).fold(f64::INFINITY, f64::min);
        let allowed = upper.magnitude(frequency)? / lower.magnitude(frequency)?;
        return Some(20.0 * (allowed * least / greatest).log10());
    }
    let margins = responses.iter().map(|at| specification.margin_db(at, frequency));
    margins.collect::<Option<Vec<f64>>>().map(|margins| margins.into_iter().fold(f64::INFINITY, f64::min))
}

fn check(problem: &DesignProblem, structure: &Structure, x: &[f64], prefilter: Option<&TransferFunction>) {
    let general = |function: &TransferFunction| Compensator::new(vec![Element::General(function.clone())]);
    let controller = Controller {
        feedback: structure.compensator(x),
        prefilter: prefilter.map(general).unwrap_or_default(),
        timing: problem.timing,
        ..Controller::default()
    };
    let around = Compensation::new(&controller, problem.sensor.clone()).unwrap();
    let samples = Samples::new(problem, &plants(problem), &FREQUENCIES).unwrap();
    let members = samples.members().to_vec();
    let mut shaping = Shaping::new(
        structure.clone(),
        prefilter.map(Structure::fixed_to),
        Objective::BestWorstMargin,
        samples,
    )
    .unwrap();
    let found = shaping.margins(x);
    let (mut count, mut worst) = (0, f64::INFINITY);
    for frequency in FREQUENCIES {
        for (index, specification) in problem.specifications.iter().enumerate() {
            let spread = prefilter.is_none();
            let expected = plain(specification, &around, &members, frequency, spread);
            let mut found = found
                .iter()
                .filter(|margin| (margin.specification, margin.frequency_rad_per_s) == (index, frequency));
            let Some(expected) = expected else {
                assert_eq!(found.next(), None);
                continue;
            };
            count += 1;
            let least = found.map(|margin| margin.margin_db).fold(f64::INFINITY, f64::min);
            assert!((least - expected).abs() < 1e-9, "{index} at {frequency}: {least} is not {expected}");
            let tracks = specification.requirement.is_tracking();
            worst = f64::min(worst, expected / if spread && tracks { 2.0 } else { 1.0 });
        }
    }
    assert!(count > 30, "{count}");
    let judged = shaping.judge(x).worst_margin_db;
    assert!((judged - worst).abs() < 1e-9, "{judged} is not {worst}");
}

#[test]
fn margins_are_those_of_one_plant_after_the_other() {
    let mut draw = Draw(11);
    let prefilter = rational(&[3.0], &[1.0, 3.0]);
    let sampled = |discretization| Timing {
        sample_time_s: Some(0.01),
        delay_s: 0.004,
        discretization,
        ..Timing::default()
    };
    for timing in [
        Timing::default(),
        Timing { delay_s: 0.01, ..Timing::default() },
        sampled(Discretization::Tustin),
        sampled(Discretization::ZeroOrderHold),
        Timing { rate_feed_forward: -0.4, ..sampled(Discretization::Tustin) },
    ] {
        let problem = problem(timing);
        for _ in 0..5 {
            let structure = structure(&mut draw);
            let x = draw.point(&structure.bounds());
            check(&problem, &structure, &x, None);
            check(&problem, &structure, &x, Some(&prefilter));
        }
    }
}
