//! Plants without polynomials: a plant that hides its polynomials must give the results of the
//! plant that shows them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::analytic::{Analytic, Disc, Jet};
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{cos, exp, ln, magnitude, sin};
use phea_dynamics::random::uniform;
use phea_dynamics::uncertain_plant::responding::{RespondingPlant, RespondingPlants};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, FINE, Family, Spacing, UncertainFamily, tabulated, vertices};
use phea_qft::loop_shaping::SampleStability;
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::stability::{Instability, MemberStability, StabilityStatus, member_stability};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict, audit_specifications};

/// Plant k/((s + slow)(s^2 + 2 d w s + w^2)), with dead time.
#[derive(Clone, Copy, Debug)]
struct Hidden {
    gain: f64,
    slow: f64,
    natural: f64,
    damping: f64,
    dead_time_s: f64,
}

impl Hidden {
    fn shown(&self) -> PlantCoefficients<f64> {
        let Hidden { gain, slow, natural, damping, dead_time_s } = *self;
        let (middle, square) = (2.0 * damping * natural, natural * natural);
        let denominator = vec![1.0, middle + slow, square + middle * slow, square * slow];
        let command = RationalCoefficients { numerator: vec![gain], denominator: denominator.clone() };
        let disturbance = Some(RationalCoefficients { numerator: vec![-2.0, 0.0], denominator });
        PlantCoefficients { command, disturbance, dead_time_s, rate: None }
    }

    fn at<A: Analytic>(&self, s: A) -> [A; 2] {
        let Hidden { gain, slow, natural, damping, dead_time_s } = *self;
        let pair = s * s + s.scaled(2.0 * damping * natural) + A::from(natural * natural);
        let below = (s + A::from(slow)) * pair;
        let delayed = (-s.scaled(dead_time_s)).exponential();
        [A::from(gain) * delayed / below, s.scaled(-2.0) / below]
    }
}

impl RespondingPlant for Hidden {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        self.at(Complex64::new(0.0, frequency_rad_per_s))
    }

    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc {
        Jet::enclosed(Disc::of_frequencies(frequencies_rad_per_s), |s| self.at(s)[0])
    }

    fn slow(&self) -> PlantCoefficients<f64> {
        self.shown()
    }

    /// Lower bound v^2 - w^2 of |s^2 + ... + w^2|.
    fn roll_off(&self, v: f64) -> Option<f64> {
        (v > self.natural).then(|| self.gain.abs() / (v * (v * v - self.natural * self.natural)))
    }

    fn unstable_poles(&self) -> Option<usize> {
        Some(0)
    }

    fn range_rad_per_s(&self) -> [f64; 2] {
        [0.01 * self.slow.min(self.natural), 20.0 * self.slow.max(self.natural)]
    }

    fn echo_s(&self) -> f64 {
        self.dead_time_s
    }
}

fn hidden(state: &mut u64) -> Hidden {
    let mut spread = |low: f64, high: f64| exp(ln(low) + uniform(state) * ln(high / low));
    let (slow, natural, damping) = (spread(0.1, 100.0), spread(1.0, 300.0), spread(0.02, 1.0));
    let gain = spread(0.3, 30.0) * slow * natural * natural;
    Hidden { gain, slow, natural, damping, dead_time_s: spread(1e-4, 3.0) / natural }
}

fn compensation(state: &mut u64, natural: f64) -> Compensation {
    let gain = 0.02 * exp(7.0 * uniform(state));
    let mut elements = vec![Element::Gain(gain)];
    if uniform(state) < 0.7 {
        let corner = natural * uniform(state);
        elements.push(Element::ProportionalIntegral { proportional_gain: 1.0, integral_gain: corner });
    }
    let feedback = Compensator::new(elements);
    let timing = Timing { delay_s: 0.3 * uniform(state) / natural, ..Timing::default() };
    let controller = Controller { feedback, timing, ..Controller::default() };
    let sensor = TransferFunction::from_polynomials(
        &Polynomial::new(vec![5.0 * natural]),
        &Polynomial::new(vec![1.0, 5.0 * natural]),
    );
    Compensation::new(&controller, sensor.unwrap()).unwrap()
}

/// Folding changes the return difference by no more than its bound, at any frequency, for any
/// folded frequency of a mode beyond pi/T; 200 loops, with a nearly tight bound if the mode
/// dominates.
#[test]
fn folding_changes_no_more_than_its_bound() {
    let mut state = 5;
    let (mut sharpest, mut counted) = (0.0_f64, 0);
    while counted < 200 {
        let plant = hidden(&mut state);
        let sample_time_s = (1.2 + 3.0 * uniform(&mut state)) * std::f64::consts::PI / plant.natural;
        let plant = Hidden { slow: 0.1 * uniform(&mut state) * plant.natural, dead_time_s: 0.0, ..plant };
        let gain = 0.3 * uniform(&mut state) / plant.gain * plant.natural * plant.natural / sample_time_s;
        let feedback = Compensator::new(vec![Element::Gain(gain)]);
        let timing = Timing { sample_time_s: Some(sample_time_s), ..Timing::default() };
        let controller = Controller { feedback, timing, ..Controller::default() };
        let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        let bound = around.responding(Arc::new(plant)).folding(&around).unwrap();
        let shown = around.member(plant.shown()).unwrap();
        let half = std::f64::consts::PI / sample_time_s;
        let mut most = 0.0_f64;
        for frequency in logarithmic_grid(1e-3 * plant.slow, half, 2000).unwrap() {
            let found = 1.0 + gain * shown.response(frequency).unwrap().plant;
            let turn = 0.5 * frequency * sample_time_s;
            let held = Complex64::new(cos(turn), -sin(turn)) * (sin(turn) / turn);
            let own = 1.0 + gain * held * plant.at(Complex64::new(0.0, frequency))[0];
            most = most.max(magnitude(found - own) / magnitude(own));
        }
        assert!(most <= bound, "{plant:?} {most} {bound}");
        sharpest = sharpest.max(most / bound);
        counted += 1;
    }
    assert!(sharpest > 0.3, "{sharpest}");
}

/// Unstable poles by enclosures, and by the turns of the characteristic function: independent
/// counts, of 400 loops, some of them with more than one unstable pair.
#[test]
fn poles_are_counted_as_those_of_the_polynomials() {
    let mut state = 11;
    let mut found = [0_usize; 3];
    for _ in 0..400 {
        let plant = hidden(&mut state);
        let around = compensation(&mut state, plant.natural);
        let shown = member_stability(&around.member(plant.shown()).unwrap(), &around);
        let own = member_stability(&around.responding(Arc::new(plant)), &around);
        match (&shown.status, &own.status) {
            (StabilityStatus::Stable, StabilityStatus::Stable) => {
                let distance = |one: &MemberStability| one.closest_approach.unwrap().distance;
                let apart = distance(&own) / distance(&shown) - 1.0;
                assert!(apart.abs() < 1e-6, "{plant:?}: {apart}");
                let delay = |one: &MemberStability| one.critical_delay.unwrap().delay_s;
                let [own, shown] = [delay(&own), delay(&shown)];
                assert!(own == shown || (own / shown - 1.0).abs() < 1e-6, "{plant:?}: {own} {shown}");
                found[0] += 1;
            }
            (
                StabilityStatus::Unstable(Instability::Poles { count }),
                StabilityStatus::Unstable(Instability::Poles { count: own }),
            ) => {
                assert_eq!(count, own, "{plant:?}");
                found[1 + usize::from(*count > 2)] += 1;
            }
            other => panic!("{plant:?}: {other:?}"),
        }
    }
    assert!(found[0] > 100 && found[1] > 100 && found[2] > 1, "{found:?}");
}

/// Poles counted by a search from a table of the plant that is accurate to 3 %. For every loop
/// whose stability such an error cannot change, the result equals that of the polynomials, if the
/// range of the plant covers the loop below and above its crossovers; otherwise no unstable loop is
/// called stable. More detailed results from the table agree.
#[test]
fn a_search_counts_poles_as_those_of_the_polynomials() {
    let mut state = 17;
    let mut found = [0_usize; 2];
    for _ in 0..600 {
        let plant = hidden(&mut state);
        let around = compensation(&mut state, plant.natural);
        let shown = around.member(plant.shown()).unwrap();
        let is_stable = member_stability(&shown, &around).status == StabilityStatus::Stable;
        let stability_of =
            |member| SampleStability::new(&around, vec![member]).is_stable(around.feedback()).unwrap();
        let range = plant.range_rad_per_s();
        let measured = around.measured(&tabulated(&plant, range, FINE));
        let of_table = member_stability(&measured, &around).status == StabilityStatus::Stable;
        assert_eq!(stability_of(measured), of_table, "{plant:?}");
        let open = |frequency: f64| {
            let response = shown.response(frequency).unwrap();
            response.plant * response.sensor * around.feedback().at_frequency(frequency)
        };
        let distance = |&frequency: &f64| magnitude(1.0 + 1.0 / open(frequency));
        let grid = logarithmic_grid(range[0] / 1e3, range[1], 4000).unwrap();
        if grid.iter().map(distance).fold(1.0, f64::min) < 0.06 {
            continue;
        }
        let integrates = !around.feedback().poles().is_empty();
        let [below, above] = range.map(|frequency| magnitude(open(frequency)));
        let own = stability_of(around.responding(Arc::new(plant)));
        if above < 0.45 && (below > 30.0 || !integrates) {
            assert_eq!(own, is_stable, "{plant:?}");
            found[usize::from(is_stable)] += 1;
        }
        assert!(is_stable || !own, "{plant:?}");
    }
    assert!(found[0] > 100 && found[1] > 100, "{found:?}");
}

/// The table of a response equals that response to 0.2 %, also between its points.
#[test]
fn tables_enclose_values_between_their_points() {
    let mut state = 5;
    for _ in 0..40 {
        let plant = hidden(&mut state);
        let table = tabulated(&plant, plant.range_rad_per_s(), FINE);
        for pair in table.frequencies_rad_per_s.windows(2) {
            let between = pair[0] + uniform(&mut state) * (pair[1] - pair[0]);
            let (interpolated, _) = table.response(between).unwrap();
            let error = magnitude(interpolated / plant.at(Complex64::new(0.0, between))[0] - 1.0);
            assert!(error < 3e-3, "{plant:?} at {between}: {error}");
        }
    }
}

#[derive(Debug)]
struct HiddenBox;

fn of_values(values: &[f64]) -> Hidden {
    Hidden { gain: 40.0 * values[0], slow: 1.0, natural: values[1], damping: values[2], dead_time_s: 0.01 }
}

impl RespondingPlants for HiddenBox {
    fn at(&self, values: &[f64]) -> Option<Arc<dyn RespondingPlant>> {
        Some(Arc::new(of_values(values)))
    }
}

fn specifications() -> Vec<Specification> {
    let all = [
        Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.4)),
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.6)),
        Requirement::at_most(ClosedLoop::LoadMotion, Limit::Constant(0.05)),
    ];
    let specification = |requirement| Specification {
        requirement,
        frequencies_rad_per_s: vec![1.0, 10.0],
        band_rad_per_s: [0.0, f64::INFINITY],
    };
    all.into_iter().map(specification).collect()
}

/// The search of the box, between its corners, finds equal worst plants with and without
/// polynomials.
#[test]
fn a_box_is_searched_as_that_of_the_polynomials() {
    let parameter = |name: &str, minimum: f64, maximum: f64| UncertainParameter {
        name: name.into(),
        nominal: minimum,
        minimum,
        maximum,
    };
    let parameters = vec![parameter("k", 1.0, 3.0), parameter("w", 10.0, 25.0), parameter("d", 0.05, 0.4)];
    let shown = UncertainPlant::record(parameters.clone(), |p| {
        let middle = (p[2] * p[1]) * 2.0.into();
        let square = p[1] * p[1];
        let denominator = vec![1.0.into(), middle + 1.0.into(), square + middle, square];
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![p[0] * 40.0.into()],
                denominator: denominator.clone(),
            },
            disturbance: Some(RationalCoefficients {
                numerator: vec![(-2.0).into(), 0.0.into()],
                denominator,
            }),
            dead_time_s: 0.01.into(),
            rate: None,
        }
    });
    let without = UncertainPlant::responding(parameters, Arc::new(HiddenBox));
    let feedback =
        Compensator::new(vec![Element::ProportionalIntegral { proportional_gain: 0.4, integral_gain: 0.5 }]);
    let controller = Controller { feedback, ..Controller::default() };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let findings = [shown.unwrap(), without.unwrap()].map(|plant| {
        let along = |index| Coordinate {
            parameters: vec![index],
            opposed: vec![],
            spacing: vec![Spacing::Linear],
            points: 2,
        };
        let coordinates = vec![along(0), along(1), along(2)];
        let members = vertices(&plant, &coordinates).unwrap();
        let family = UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap();
        let (family, specifications) = (Family::Uncertain(family), specifications());
        let problem = AuditProblem {
            family: &family,
            compensation: &compensation,
            specifications: &specifications,
            tracking: TrackingJudgement::Magnitude,
            tolerance_db: TOLERANCE_DB,
        };
        audit_specifications(&problem, &mut unwatched).unwrap().0
    });
    let [shown, own] = findings;
    for (shown, own) in shown.iter().zip(&own) {
        let [one, other] = [shown, own].map(|finding| finding.worst.as_ref().unwrap());
        assert!((one.margin_db - other.margin_db).abs() < 1e-3, "{one:?} {other:?}");
        assert_eq!(shown.verdict, own.verdict);
        assert_eq!(shown.evidence, own.evidence);
    }
    assert!(shown.iter().any(|finding| finding.verdict == Verdict::Violated));
}

/// A sampled plant that hides its polynomials folds to the response of the plant that shows them.
#[test]
fn samples_are_those_of_the_polynomials() {
    let mut state = 3;
    for _ in 0..20 {
        let plant = Hidden { dead_time_s: 0.0, ..hidden(&mut state) };
        let sample_time_s = 0.3 / plant.natural.max(plant.slow);
        let timing =
            Timing { sample_time_s: Some(sample_time_s), delay_s: sample_time_s, ..Timing::default() };
        let controller = Controller { timing, ..Controller::default() };
        let around = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        let members = [around.member(plant.shown()).unwrap(), around.responding(Arc::new(plant))];
        for fraction in [1e-3, 0.03, 0.3, 0.9] {
            let frequency = fraction * around.highest_frequency_rad_per_s();
            let [shown, own] = members.each_ref().map(|member| member.response(frequency).unwrap());
            assert!(magnitude(own.plant / shown.plant - 1.0) < 3e-4, "{plant:?} at {frequency}");
            assert_eq!(own.sensor.im, 0.0);
        }
    }
}
