//! Where the searches inside the box begin.

use super::PlantPoint;
use super::audit::STARTS;
use super::evaluator::Evaluator;
use super::finding::{Case, EnvelopePoint, Part, envelope, local_minima};
use super::scan::{Plant, Scan};
use super::search::Task;
use crate::family::UncertainFamily;

/// Frequencies further apart than by this factor count as different.
const FREQUENCY_RATIO: f64 = 1.1;

/// Between which finite frequencies a search may move.
pub(super) fn interior_range(part: Part, evaluator: &Evaluator, scan: &Scan) -> Option<[f64; 2]> {
    let demanded = |frequency: &f64| {
        let mut bands = evaluator.criteria.iter().skip(part.first).take(part.count);
        *frequency > 0.0 && *frequency < f64::INFINITY && bands.all(|criterion| criterion.demands(*frequency))
    };
    let mut frequencies = scan.envelope().map(|(frequency, _)| frequency).filter(demanded);
    let first = frequencies.next()?;
    let last = frequencies.last()?;
    Some([first, last])
}

/// Searches for one specification: at each design frequency and each end of the band, from its worst local minima, from the
/// plants with the worst peaks, and from the middle of the box.
pub(super) fn tasks(
    part: Part,
    family: &UncertainFamily,
    (scan, plants): (&Scan, &[Plant]),
    cases: &[Case],
    design_frequencies: &[f64],
    range: Option<[f64; 2]>,
) -> Vec<Task> {
    let envelope = envelope(part, scan);
    let shares = |index: &usize| match plants.get(*index).map(|plant| &plant.point) {
        Some(PlantPoint::Parameters(values)) => family.shares(values),
        _ => vec![0.5; family.coordinates().len()],
    };
    let from = |point: &EnvelopePoint, range: Option<[f64; 2]>| Task {
        criteria: point.criteria.clone(),
        shares: point.plants.iter().map(shares).collect(),
        frequency: point.frequency,
        range,
    };
    let ends = [envelope.first(), envelope.last()].into_iter().flatten().map(|point| point.frequency);
    let fixed: Vec<f64> = ends.chain(design_frequencies.iter().copied()).collect();
    let mut tasks: Vec<Task> = envelope
        .iter()
        .filter(|point| fixed.contains(&point.frequency))
        .map(|point| from(point, None))
        .collect();
    let Some(range) = range else { return tasks };
    let minima: Vec<f64> = local_minima(&envelope).iter().take(STARTS).map(|bracket| bracket[1]).collect();
    let mut starts: Vec<Task> = Vec::new();
    for point in envelope.iter().filter(|point| minima.contains(&point.frequency)) {
        starts.push(from(point, Some(range)));
        let middle = vec![0.5; family.coordinates().len()];
        starts.push(Task { shares: vec![middle; point.plants.len()], ..from(point, Some(range)) });
    }
    for case in diverse(cases) {
        let values = |point: &PlantPoint| match point {
            PlantPoint::Parameters(values) => Some(family.shares(values)),
            PlantPoint::Measured(_) => None,
        };
        let shares: Vec<Vec<f64>> = case.points.iter().filter_map(values).collect();
        let nearest = envelope.iter().find(|point| point.frequency >= case.frequency);
        starts.extend(nearest.map(|point| Task {
            criteria: point.criteria.clone(),
            shares,
            frequency: case.frequency,
            range: Some(range),
        }));
    }
    starts.dedup();
    tasks.extend(starts);
    tasks
}

/// The worst cases, each with a plant of its own, after the first few each with a frequency of its own.
fn diverse(cases: &[Case]) -> Vec<&Case> {
    let apart = |case: &Case, other: &&Case| {
        let ratio = case.frequency / other.frequency;
        !(1.0 / FREQUENCY_RATIO..=FREQUENCY_RATIO).contains(&ratio)
    };
    let mut chosen: Vec<&Case> = Vec::new();
    for case in cases {
        let new_plant = chosen.iter().all(|other| other.points != case.points);
        let wanted = chosen.len() < STARTS || chosen.iter().all(|other| apart(case, other));
        if new_plant && wanted && chosen.len() < 2 * STARTS {
            chosen.push(case);
        }
    }
    chosen
}
