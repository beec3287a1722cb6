//! Performance that a loop reaches is never called impossible: limits are taken from existing
//! loops.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::magnitude;
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::{Compensation, MemberResponse};
use phea_qft::design::DesignProblem;
use phea_qft::family::Family;
use phea_qft::specification::{ClosedLoop, Limit, LimitTable, LoopResponse, Requirement, Specification};
use phea_qft::stability::family_stability;
use phea_qft::verification::Verdict;

use super::problems::{boxed, demand, impossibilities, plain, problem};

/// Numbers between two ends, from a linear congruential generator.
struct Draw(u64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// A gain with a range of a factor of two in series with an unstable pole, a zero or dead time,
/// with a controller that need not stabilise it.
fn drawn(draw: &mut Draw) -> (Family, Vec<f64>, Controller) {
    let pole = draw.between(-2.0, 2.0);
    let zero = draw.between(8.0, 60.0) * if draw.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    let lag = draw.between(5.0, 40.0);
    let dead_time_s = draw.between(-0.1, 0.1).max(0.0);
    let family = boxed(&[("k", 1.0, 0.7, 1.4)], 3, move |p| {
        let numerator = vec![p[0] * Recorded::from(-1.0 / zero), p[0]];
        plain(numerator, vec![(1.0 / lag).into(), (1.0 - pole / lag).into(), (-pole).into()], dead_time_s)
    });
    let gain = draw.between(0.0, 8.0);
    let integral = draw.between(-1.0, 1.0).max(0.0);
    let feedback = TransferFunction::from_polynomials(
        &Polynomial::new(vec![gain, gain * integral]),
        &Polynomial::new(vec![1.0 / 200.0, 1.0, 0.0]),
    );
    let sample_time_s = (draw.between(0.0, 1.0) < 0.4).then(|| draw.between(0.005, 0.05));
    let timing = Timing { sample_time_s, delay_s: draw.between(-0.02, 0.02).max(0.0), ..Timing::default() };
    let feedback = Compensator::new(vec![Element::General(feedback.unwrap())]);
    (family, vec![1.0, 0.7, 1.05, 1.4], Controller { feedback, timing, ..Controller::default() })
}

/// The responses of the members at frequencies up to pi/T.
fn responses(family: &Family, gains: &[f64], around: &Compensation) -> Vec<(f64, Vec<LoopResponse>)> {
    let Family::Uncertain(uncertain) = family else { panic!("a family over a box") };
    let one = num_complex::Complex64::new(1.0, 0.0);
    let highest = around.highest_frequency_rad_per_s().min(1e4);
    let frequencies = (0..=600).map(|index| 1e-3 * (highest * 0.999 / 1e-3).powf(f64::from(index) / 600.0));
    let of = |frequency: f64| {
        let controller = around.response(frequency).feedback;
        let member = |gain: &f64| {
            let MemberResponse { plant, load_motion, sensor } =
                around.plant_response(uncertain.plant().coefficients(&[*gain]).unwrap(), frequency).unwrap();
            LoopResponse { plant, load_motion, controller, prefilter: one, sensor }
        };
        (frequency, gains.iter().map(member).collect())
    };
    frequencies.map(of).collect()
}

/// Limits that the loop just satisfies, times a factor, each over a different band.
fn specifications(
    responses: &[(f64, Vec<LoopResponse>)],
    draw: &mut Draw,
    factor: f64,
) -> Vec<Specification> {
    let none = || Limit::Constant(1.0);
    let closed_loops = [
        ClosedLoop::RobustStability,
        ClosedLoop::Sensitivity,
        ClosedLoop::PlantInputDisturbance,
        ClosedLoop::ControlEffort,
    ];
    let first = responses.first().unwrap().0;
    let last = responses.last().unwrap().0;
    let mut band = |whole: bool| {
        let ends = [draw.between(0.0, 1.0), draw.between(0.0, 1.0)];
        let place = |fraction: f64| first * (last / first).powf(fraction);
        if whole { [0.0, f64::INFINITY] } else { [place(ends[0].min(ends[1])), place(ends[0].max(ends[1]))] }
    };
    let sizes = |requirement: &Requirement, members: &[LoopResponse]| -> Vec<f64> {
        members.iter().map(|member| magnitude(requirement.closed_loop().response(member))).collect()
    };
    let greatest = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
    let least = |all: &[f64]| all.iter().copied().fold(f64::INFINITY, f64::min);
    let table = |points: Vec<(f64, f64)>| Limit::Table(LimitTable::new(points).unwrap());
    let design: Vec<f64> = responses.iter().step_by(60).map(|(frequency, _)| *frequency).collect();
    let within = |band: [f64; 2]| -> Vec<f64> {
        design.iter().copied().filter(|w| band[0] <= *w && *w <= band[1]).collect()
    };
    let mut all: Vec<Specification> = Vec::new();
    for (number, closed_loop) in closed_loops.into_iter().enumerate() {
        let requirement = Requirement::at_most(closed_loop, none());
        let points =
            responses.iter().map(|(w, members)| (*w, factor * greatest(&sizes(&requirement, members))));
        let points: Vec<(f64, f64)> = points.collect();
        // |T| and |S| as constants everywhere, the others as tables
        let limit = if number < 2 {
            Limit::Constant(points.iter().map(|point| point.1).fold(0.0, f64::max))
        } else {
            table(points.clone())
        };
        let own = band(number < 2);
        all.push(demand(Requirement::at_most(closed_loop, limit), &within(own), own));
        let own = band(false);
        all.push(demand(Requirement::at_most(closed_loop, table(points)), &within(own), own));
    }
    let tracking = Requirement::tracking(none(), none());
    let of = |pick: &dyn Fn(&[f64]) -> f64, factor: f64| {
        let points = responses.iter().map(|(w, members)| (*w, factor * pick(&sizes(&tracking, members))));
        table(points.collect())
    };
    let requirement = Requirement::tracking(of(&least, 1.0 / factor), of(&greatest, factor));
    let own = band(false);
    all.push(demand(requirement, &within(own), own));
    all
}

#[test]
fn reached_limits_are_possible_and_half_of_them_are_not() {
    let mut draw = Draw(7);
    let (mut judged, mut impossible) = (0, 0);
    while judged < 12 {
        let (family, gains, controller) = drawn(&mut draw);
        let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        let stability = family_stability(&family, &around, &mut unwatched).unwrap();
        if stability.finding.verdict != Verdict::Met {
            continue;
        }
        judged += 1;
        let responses = responses(&family, &gains, &around);
        let bands = draw.0;
        let of = |factor: f64| DesignProblem {
            timing: controller.timing,
            ..problem(family.clone(), specifications(&responses, &mut Draw(bands), factor))
        };
        // between the points of a table the limit is linear, and the loop is not
        let reached = impossibilities(&of(1.002));
        assert_eq!(reached, [], "{controller:?}");
        impossible += usize::from(!impossibilities(&of(0.5)).is_empty());
        draw = Draw(bands + 1);
    }
    assert!(impossible > 6, "{impossible}");
}
