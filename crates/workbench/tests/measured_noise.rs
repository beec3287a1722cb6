//! Measured plants with noise in every row: contents of their discs, and the number of verdicts
//! that they leave undecided.

#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use num_complex::Complex64;
use phea_dynamics::controller::Controller;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{exp, magnitude, pow};
use phea_dynamics::random::{normal, stream, uniform};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, MeasuredFamily, MeasuredPlant};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{Audit, AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict};
use phea_workbench::family::family;
use phea_workbench::project;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

const PROJECT: &str = "schema = 1\n[family]\nmeasured = [\"a.csv\"]\n";
/// Standard deviation of the noise, relative to the response.
const NOISE: f64 = 0.03;

fn function(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

/// Plants k (s/z + 1)^(m - 1 or 0)/(s^m (s/60 + 1)(s/80 + 1)), with sign and gain drawn.
fn drawn(state: &mut u64, integrators: usize) -> TransferFunction {
    let sign = if uniform(state) < 0.25 { -1.0 } else { 1.0 };
    let crossover = exp(3.5 * uniform(state));
    let (zero, size) = match integrators {
        0 => (None, 1.0 + crossover / 5.0),
        1 => (None, crossover),
        _ => (Some(crossover / (1.5 + 4.0 * uniform(state))), crossover),
    };
    let gain = zero.map_or(size, |zero: f64| size * zero);
    let numerator = zero.map_or(vec![sign * gain], |zero: f64| vec![sign * gain / zero, sign * gain]);
    let mut denominator = vec![1.0 / 4800.0, 140.0 / 4800.0, 1.0];
    denominator.extend(vec![0.0; integrators]);
    function(&numerator, &denominator)
}

/// A record of a response with this noise, with the discs of single rows.
fn record(frequencies: &[f64], noise: f64, state: &mut u64, truth: impl Fn(f64) -> Complex64) -> String {
    let radius = noise * (-0.05_f64.ln()).sqrt();
    let row = |&w: &f64| {
        let error = Complex64::new(normal(state), normal(state)) * (noise / 2.0_f64.sqrt());
        let response = truth(w) * (1.0 + error);
        format!("{w:e},{:e},{:e},{:e}\n", response.re, response.im, radius * magnitude(truth(w)))
    };
    let rows: String = frequencies.iter().map(row).collect();
    format!("frequency_rad_per_s,real,imaginary,confidence_95\n{rows}")
}

fn read(csv: &str) -> MeasuredPlant {
    let source = Memory::default().with("p.toml", PROJECT).with("a.csv", csv);
    let read = project::read(&source, "p.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    match family(&Setup::new(&read.project).unwrap(), &source).unwrap() {
        Family::Measured(family) => family.plants()[0].clone(),
        Family::Uncertain(_) => panic!("a measured plant"),
    }
}

fn unity() -> Compensation {
    Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0)).unwrap()
}

fn judged(csv: &str, limit: f64) -> Verdict {
    let family = Family::Measured(MeasuredFamily::new(vec![read(csv)]).unwrap());
    audited(&family, &unity(), limit).verdict
}

fn audited(family: &Family, compensation: &Compensation, limit: f64) -> Audit {
    let specification = Specification {
        requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)),
        frequencies_rad_per_s: vec![0.1],
        band_rad_per_s: [0.1, 300.0],
    };
    let problem = AuditProblem {
        family,
        compensation,
        specifications: &[specification],
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    audit(&problem, &mut unwatched).unwrap()
}

/// The verdict with the discs of single rows, each widened so that all rows hold at once.
fn judged_by_rows(csv: &str, limit: f64) -> Verdict {
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|number| number.parse().unwrap()).collect())
        .collect();
    let wide = ((rows.len() as f64 / 0.05).ln() / -0.05_f64.ln()).sqrt();
    let plant = MeasuredPlant {
        command: rows.iter().map(|row| Complex64::new(row[1], row[2])).collect(),
        radii: rows.iter().map(|row| wide * row[3]).collect(),
        ..read(csv)
    };
    let family = Family::Measured(MeasuredFamily::new(vec![plant]).unwrap());
    audited(&family, &unity(), limit).verdict
}

/// Sixty measurements, with limits that are up to 6 dB or 3 dB from the true peak: none gets a
/// false verdict, and at least fifty get one. The truth is that of the poles and closed forms.
#[test]
fn noise_leaves_few_verdicts_open_and_makes_none_false() {
    let frequencies = logarithmic_grid(0.1, 300.0, 200).unwrap();
    for span_db in [12.0, 6.0] {
        let [mut resolved, mut by_rows] = [0, 0];
        for draw in 0..60 {
            let mut state = stream(29, draw);
            let plant = drawn(&mut state, draw as usize % 3);
            let closed = plant.numerator().sum(&plant.denominator());
            let is_stable = closed.roots().unwrap().iter().all(|root| root.re < 0.0);
            let ratio = |w: &f64| {
                let open = plant.at_frequency(*w);
                magnitude(open / (1.0 + open))
            };
            let peak = logarithmic_grid(0.1, 300.0, 20_000).unwrap().iter().map(ratio).fold(0.0, f64::max);
            let off_db = span_db * (uniform(&mut state) - 0.5);
            let csv = record(&frequencies, NOISE, &mut state, |w| plant.at_frequency(w));
            let limit = peak * pow(10.0, off_db / 20.0);
            let found = judged(&csv, limit);
            let truth = if is_stable && off_db > -TOLERANCE_DB { Verdict::Met } else { Verdict::Violated };
            let open = found == Verdict::NotProven;
            assert!(open || found == truth, "draw {draw}: {off_db} {found:?}");
            resolved += usize::from(!open);
            by_rows += usize::from(judged_by_rows(&csv, limit) != Verdict::NotProven);
        }
        assert!(resolved >= 50 && resolved > by_rows, "{span_db} dB: {resolved} of 60, by rows {by_rows}");
    }
}

/// A smooth response, two resonances or dips with any damping, or a double integrator.
fn response_of(state: &mut u64, kind: usize) -> impl Fn(f64) -> Complex64 + use<> {
    let delay = 0.02 * uniform(state);
    let mut drawn = |low: f64, high: f64| low * exp(uniform(state) * (high / low).ln());
    let modes: [[f64; 3]; 2] =
        std::array::from_fn(|_| [drawn(0.3, 200.0), drawn(0.005, 0.3), drawn(1.0, 3.0)]);
    move |w| {
        let s = Complex64::new(0.0, w);
        let smooth = phea_dynamics::portable::exp_complex(-s * delay) / (s / 20.0 + 1.0);
        match kind {
            0 => smooth,
            1 => smooth * (s / 3.0 + 1.0) / (s * s),
            _ => modes.iter().fold(smooth, |product, [corner, damping, which]| {
                let factor = (s / corner) * (s / corner) + 2.0 * damping * s / corner + 1.0;
                if *which < 1.7 { product / factor } else { product * factor }
            }),
        }
    }
}

/// The narrowed discs of all rows contain the true response about as often as stated: in 95 of a
/// hundred records, whether the response is smooth, has modes between its rows, or has few rows.
#[test]
fn narrowed_discs_hold_the_response() {
    let mut all = (0, 0);
    for (kind, rows, noise) in [
        (0, 200, 0.03),
        (0, 60, 0.03),
        (1, 200, 0.03),
        (1, 60, 0.01),
        (2, 200, 0.03),
        (2, 60, 0.03),
        (2, 400, 0.1),
        (2, 200, 0.003),
    ] {
        let frequencies = logarithmic_grid(0.1, 300.0, rows).unwrap();
        let (mut held, mut narrowing) = (0, 0.0);
        let records = 100;
        for number in 0..records {
            let mut state = stream(71 + kind as u64, number);
            let truth = response_of(&mut state, kind);
            let plant = read(&record(&frequencies, noise, &mut state, &truth));
            let within =
                |(row, w): (usize, &f64)| magnitude(plant.command[row] - truth(*w)) <= plant.radii[row];
            held += usize::from(frequencies.iter().enumerate().all(within));
            let wide = noise * (rows as f64 / 0.05).ln().sqrt();
            let relative = |(row, w): (usize, &f64)| plant.radii[row] / (wide * magnitude(truth(*w)));
            narrowing += frequencies.iter().enumerate().map(relative).sum::<f64>() / rows as f64;
        }
        // fewer adjacent rows, and narrower modes, reduce the discs by less
        let most = if rows == 60 { 0.9 } else { 0.8 };
        assert!(narrowing < most * records as f64, "{kind} {rows} {noise}: {narrowing}");
        all = (all.0 + held, all.1 + records as usize);
    }
    assert!(all.0 as f64 >= 0.94 * all.1 as f64, "{all:?}");
}
