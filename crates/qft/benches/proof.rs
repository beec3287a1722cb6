//! Leaves and seconds of a proof against the margin and against the number of uncertain parameters,
//! compared with plain interval arithmetic: `taskset -c 0 cargo bench -p phea-qft --bench proof`.
//!
//! The claim is |L/(1 + L)| <= r |W| from 1 to 10,000 rad/s for the controller that phea designs
//! for the rig of the thesis. r is the greatest ratio reached, times the margin. Interval
//! arithmetic evaluates the same polynomials on a box of frequencies and parameters, and halves the
//! box across its widest side until |V| <= |U| on each part. A claim not proven when its boxes are
//! used up counts as not proven. The table is written to `benches/peers/proof_leaves.csv` with
//! `-- --save`; times are printed and never asserted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::scalar::Interval;
use phea_dynamics::uncertain_plant::{PlantCoefficients, UncertainParameter, UncertainPlant};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
use phea_qft::proof::{Claim, FrequencyPanel, ProofOptions, check, prove};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};

#[path = "../tests/rig.rs"]
#[allow(clippy::panic, reason = "a wrong number of parameters is a mistake of this program")]
mod rig;

use rig::force;

type Failure = Box<dyn std::error::Error>;

const LIMIT: f64 = 1.3;
const BAND_RAD_PER_S: [f64; 2] = [1.0, 1e4];
/// Number of boxes that interval arithmetic may evaluate.
const BOXES_MAXIMUM: usize = 3_000_000;

/// Name, least and greatest value of each parameter: those of Table 6.3 first, then mass and
/// stiffness of the load cell. The least value is nominal.
const PARAMETERS: [(&str, f64, f64); 8] = [
    ("viscous_friction", 100.0, 3e4),
    ("flow_gain", 3.23e-5, 5.61e-5),
    ("flow_pressure_coefficient", 6.42e-13, 7e-11),
    ("hydraulic_stiffness", 2.24e6, 4.11e6),
    ("valve_natural_frequency", 879.0, 1319.0),
    ("valve_damping_ratio", 0.72, 1.08),
    ("mass", 12.0, 14.0),
    ("sensor_stiffness", 1.9e7, 2.1e7),
];

/// Margins of the first series, with all parameters of Table 6.3, dB.
const MARGINS_DB: [f64; 7] = [3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003];
/// The margin of the second series, dB.
const MARGIN_DB: f64 = 0.5;

/// Controller G: numerator and denominator.
const CONTROLLER: [&[f64]; 2] = [&[0.7217, 1567.86, 37200.8], &[1.0, 624.8, 1.077485e6, 0.0]];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Effort of one method: leaves and seconds, or the fraction of the box proven before the budget
/// was used up.
struct Effort {
    leaves: usize,
    seconds: f64,
    shown: f64,
}

fn run() -> Result<(), Failure> {
    let mut table =
        "series,parameters,margin_db,leaves,prove_s,check_s,interval_boxes,interval_s,interval_shown\n"
            .to_string();
    let by_margin = MARGINS_DB.iter().map(|&margin_db| ("margin", 6, margin_db));
    let by_parameters = (1..=PARAMETERS.len()).map(|count| ("parameters", count, MARGIN_DB));
    println!(
        "series, parameters, margin: leaves, seconds to prove and to check; boxes and seconds of interval arithmetic"
    );
    for (series, count, margin_db) in by_margin.chain(by_parameters) {
        let (proved, check_s, ratio) = proved(count, margin_db)?;
        let peer = bisected(count, ratio)?;
        let row = format!(
            "{series},{count},{margin_db},{},{:.3},{:.3},{},{:.3},{:.4}",
            proved.leaves, proved.seconds, check_s, peer.leaves, peer.seconds, peer.shown
        );
        println!("{row}");
        writeln!(table, "{row}")?;
    }
    if std::env::args().any(|word| word == "--save") {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/peers/proof_leaves.csv");
        std::fs::write(file, table)?;
    }
    Ok(())
}

/// The plant with the first parameters uncertain, the others at their nominal values.
fn family(uncertain: usize) -> Result<Family, Failure> {
    let parameters = PARAMETERS.iter().enumerate().map(|(index, &(name, minimum, maximum))| {
        let maximum = if index < uncertain { maximum } else { minimum };
        UncertainParameter { name: name.into(), nominal: minimum, minimum, maximum }
    });
    let plant = UncertainPlant::record(parameters.collect(), |p: &[Recorded<'_>]| PlantCoefficients {
        command: force(p),
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })?;
    let along = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points: 2,
    };
    let coordinates: Vec<Coordinate> = (0..uncertain).map(along).collect();
    let members = vertices(&plant, &coordinates)?;
    Ok(Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box)?))
}

fn rational(coefficients: [&[f64]; 2]) -> Result<TransferFunction, Failure> {
    let [numerator, denominator] = coefficients.map(|own| Polynomial::new(own.to_vec()));
    Ok(TransferFunction::from_polynomials(&numerator, &denominator)?)
}

/// The leaves of the upper claim, seconds to prove everything and to check it, and the claimed
/// ratio.
fn proved(uncertain: usize, margin_db: f64) -> Result<(Effort, f64, f64), Failure> {
    let family = family(uncertain)?;
    let law = Element::General(rational(CONTROLLER)?);
    let controller = Controller {
        feedback: Compensator::new(vec![law]),
        timing: Timing::default(),
        ..Controller::default()
    };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
    let specifications = [Specification {
        requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(LIMIT)),
        frequencies_rad_per_s: vec![],
        band_rad_per_s: BAND_RAD_PER_S,
    }];
    let problem = AuditProblem {
        family: &family,
        compensation: &compensation,
        specifications: &specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    let found = audit(&problem, &mut unwatched)?;
    let options =
        ProofOptions { width_db: margin_db, leaves_maximum: BOXES_MAXIMUM, ..ProofOptions::default() };
    let begun = Instant::now();
    let certificate = prove(&problem, &found, options, &mut unwatched)?.certificate.ok_or("not stated")?;
    let seconds = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    check(&certificate).map_err(|(claim, why)| format!("claim {claim}: {why}"))?;
    let check_s = begun.elapsed().as_secs_f64();
    let limited = certificate.claims.iter().find_map(|claim| match claim {
        Claim::Limited { ratio, boxes, .. } => {
            Some((*ratio, boxes.iter().flatten().map(FrequencyPanel::leaves).sum()))
        }
        _ => None,
    });
    let (ratio, leaves) = limited.ok_or("nothing is limited from above")?;
    Ok((Effort { leaves, seconds, shown: 1.0 }, check_s, ratio))
}

/// A part of the box: the logarithm of the frequency, then the parameters.
type Part = Vec<[f64; 2]>;

/// Halves the box until interval arithmetic proves |L/(1 + L)| <= ratio LIMIT on each part.
fn bisected(uncertain: usize, ratio: f64) -> Result<Effort, Failure> {
    let [numerator, denominator] = CONTROLLER;
    let mut whole: Part = vec![BAND_RAD_PER_S.map(portable::ln)];
    whole.extend(PARAMETERS.iter().take(uncertain).map(|&(_, low, high)| [low, high]));
    let begun = Instant::now();
    let mut pending = vec![(whole.clone(), 1.0)];
    let (mut boxes, mut leaves, mut shown) = (0, 0, 0.0);
    while let Some((part, fraction)) = pending.pop() {
        boxes += 1;
        if boxes > BOXES_MAXIMUM {
            break;
        }
        if satisfies(&part, [numerator, denominator], ratio * LIMIT) {
            leaves += 1;
            shown += fraction;
            continue;
        }
        let width = |axis: usize| (part[axis][1] - part[axis][0]) / (whole[axis][1] - whole[axis][0]);
        let widest = (0..part.len()).max_by(|&a, &b| width(a).total_cmp(&width(b))).ok_or("no axis")?;
        let middle = 0.5 * (part[widest][0] + part[widest][1]);
        let (mut lower, mut upper) = (part.clone(), part);
        lower[widest][1] = middle;
        upper[widest][0] = middle;
        pending.extend([(upper, 0.5 * fraction), (lower, 0.5 * fraction)]);
    }
    Ok(Effort { leaves, seconds: begun.elapsed().as_secs_f64(), shown })
}

/// True if |V| <= |U| on a part, by intervals.
fn satisfies(part: &[[f64; 2]], [numerator, denominator]: [&[f64]; 2], limit: f64) -> bool {
    let own: Vec<Interval> = PARAMETERS
        .iter()
        .enumerate()
        .map(|(index, &(_, low, _))| {
            part.get(index + 1).map_or(Interval::from(low), |&[low, high]| Interval::new(low, high))
        })
        .collect();
    let [low, high] = part[0].map(portable::exp);
    let frequency = Interval::new(low.next_down(), high.next_up());
    let plant = force(&own);
    let of = |coefficients: &[f64]| -> Vec<Interval> {
        coefficients.iter().copied().map(Interval::from).collect()
    };
    let n = product(at(&plant.numerator, frequency), at(&of(numerator), frequency));
    let c = product(at(&plant.denominator, frequency), at(&of(denominator), frequency));
    let limit = Interval::from(limit);
    let u = [limit * (n[0] + c[0]), limit * (n[1] + c[1])];
    let square = |z: [Interval; 2]| z[0].square() + z[1].square();
    square(u).low() >= square(n).high()
}

/// A polynomial at s = j w: its even and its odd powers by Horner's rule in -w^2.
fn at(coefficients: &[Interval], frequency: Interval) -> [Interval; 2] {
    let square = -frequency.square();
    let of = |skip: usize| {
        let own: Vec<Interval> = coefficients.iter().rev().skip(skip).step_by(2).copied().collect();
        own.iter().rev().fold(Interval::from(0.0), |sum, one| sum * square + *one)
    };
    [of(0), of(1) * frequency]
}

fn product(a: [Interval; 2], b: [Interval; 2]) -> [Interval; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}
