//! Corners of the box and some plants inside it on the nonlinear rig: a required step is compared
//! with them too, since the contribution of friction and limits to a step is not largest where the
//! linear step is worst.

use phea_dynamics::portable;
use phea_dynamics::watch::Watch;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::verification::PlantPoint;

use super::reason::TrialMachine;
use super::rigs::{TrialRig, rig_with};
use super::run::{PredictedMachine, TrialRun};
use super::{STAGE, TrialError};
use crate::audit::ProjectAudit;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::side_by_side::side_by_side;
use crate::source::Source;

/// Number of coordinates of a box all of whose corners are simulated; of a larger one as many
/// corners.
const ALL_OF: usize = 4;
/// Coordinates whose ends, multiplied, give that of a further coordinate beyond these: the
/// generators of a fractional factorial design of 16 runs.
const GENERATORS: [usize; 11] =
    [0b0111, 0b1011, 0b1101, 0b1110, 0b1111, 0b0011, 0b0101, 0b0110, 0b1001, 0b1010, 0b1100];

/// Number of iterations to the golden ratio, each of which at least halves its error.
const ITERATIONS: usize = 60;
/// Total number of simulated plants, and least number of them inside the box.
const ALL: usize = 16;
const LEAST_INSIDE: usize = 4;

/// Runs of the corners and of the plants inside that have a rig, if a step is required; empty
/// without a box.
pub(super) fn runs_of_corners(
    source: &dyn Source,
    setup: &Setup<'_>,
    (problem, view): (&RobustProblem, &ProjectAudit),
    watch: Watch<'_>,
) -> Result<Vec<TrialRun>, TrialError> {
    let rigs = rigs(setup, problem, view)?;
    let runs_of = |rig: &TrialRig, watch: Watch<'_>| -> Result<Option<Vec<TrialRun>>, TrialError> {
        let machine = PredictedMachine::of(rig, problem)?.at_corner();
        let Some(driven) = machine.driven(source, watch)? else { return Ok(None) };
        let judged = machine.judged(&driven, problem, view).into_iter();
        Ok(Some(judged.filter(|run| !run.requirements.is_empty()).collect()))
    };
    let each =
        side_by_side(rigs.len(), STAGE, watch, |index, watch| runs_of(&rigs[index], watch).transpose())?;
    let runs = each.into_iter().collect::<Result<Vec<Vec<TrialRun>>, TrialError>>()?;
    Ok(runs.concat())
}

/// Run of each size whose steps are furthest from their requirement.
pub(super) fn worst_of(runs: &[TrialRun]) -> Vec<TrialRun> {
    let mut worst: Vec<TrialRun> = Vec::new();
    for run in runs {
        match worst.iter_mut().find(|known| known.size == run.size) {
            Some(known) if run.excess() > known.excess() => *known = run.clone(),
            Some(_) => {}
            None => worst.push(run.clone()),
        }
    }
    worst
}

fn rigs(
    setup: &Setup<'_>,
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> Result<Vec<TrialRig>, TrialError> {
    let Family::Uncertain(family) = &problem.family else { return Ok(vec![]) };
    let (corners, inside) = (corners(family), inside(family));
    let machine = TrialMachine::WorstOfBox { corners: corners.len(), inside: inside.len() };
    let rig = setup.rig()?;
    let of = |values: Vec<f64>| {
        let plant = PlantPoint::Parameters(values.clone());
        let (names, numbers): (Vec<&str>, Vec<f64>) =
            view.names.numbers(&plant)?.map(|(name, _, value)| (name, value)).unzip();
        Some(TrialRig {
            machine: machine.clone(),
            named: Some(view.names.named(&plant)),
            quarter_wave_rad_per_s: None,
            project: rig_with(setup, rig, &names, &numbers).ok()?,
            plant: family.plant().member(&values),
            is_declared: false,
        })
    };
    Ok(corners.into_iter().chain(inside).filter_map(of).collect())
}

/// Plants inside a box, evenly spread: coordinate i of plant k is at the fractional part of
///
/// ```text
/// 1/2 + k/g^(i + 1),      g^(d + 1) = g + 1    for d coordinates
/// ```
///
/// (Roberts 2018, an additive sequence by the generalised golden ratio.)
fn inside(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let corners = corners(family).len();
    if corners == 0 {
        return vec![];
    }
    let dimension = family.coordinates().len();
    let steps = golden_steps(dimension);
    let fractions =
        |plant: usize| -> Vec<f64> { steps.iter().map(|step| (0.5 + plant as f64 * step).fract()).collect() };
    let count = ALL.saturating_sub(corners).max(LEAST_INSIDE);
    (1..=count).map(|plant| family.values(&fractions(plant))).collect()
}

/// Powers 1/g, 1/g^2 ... for this number of coordinates.
fn golden_steps(dimension: usize) -> Vec<f64> {
    let mut golden = 2.0;
    for _ in 0..ITERATIONS {
        golden = portable::exp(portable::ln(1.0 + golden) / (dimension as f64 + 1.0));
    }
    std::iter::successors(Some(1.0 / golden), |step| Some(step / golden)).take(dimension).collect()
}

/// All corners of a box of few coordinates, or sixteen in which every two coordinates have all
/// pairs of ends equally often.
fn corners(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let dimension = family.coordinates().len();
    if family.extent() != Extent::Box || dimension == 0 {
        return vec![];
    }
    let count = 1_usize << dimension.min(ALL_OF);
    let fractions = |corner: usize| (0..dimension).map(|index| end(corner, index)).collect::<Vec<f64>>();
    (0..count).map(|corner| family.values(&fractions(corner))).collect()
}

/// End of a coordinate at a corner, as a fraction of the box.
fn end(corner: usize, coordinate: usize) -> f64 {
    let is_high = match coordinate.checked_sub(ALL_OF) {
        None => (corner >> coordinate) & 1 == 1,
        Some(further) => {
            let generator = GENERATORS[further % GENERATORS.len()];
            (corner & generator).count_ones() % 2 == 1
        }
    };
    if is_high { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ORIGIN: analytic, g is the golden ratio of one coordinate and the plastic number of two.
    #[test]
    fn plants_inside_are_spread_by_the_golden_ratio() {
        let [one] = golden_steps(1)[..] else { panic!() };
        assert!((one - (5.0_f64.sqrt() - 1.0) / 2.0).abs() < 1e-15);
        let two = golden_steps(2);
        assert!((1.0 / two[0] - 1.324717957244746).abs() < 1e-14);
        assert!((two[1] - two[0] * two[0]).abs() < 1e-15);
    }

    /// ORIGIN: analytic, an orthogonal array of strength two: among 16 corners, each pair of ends
    /// of two coordinates occurs 4 times.
    #[test]
    fn every_pair_of_ends_is_taken_equally_often() {
        for one in 0..ALL_OF + GENERATORS.len() {
            for other in 0..one {
                for ends in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
                    let is_taken = |corner: &usize| [end(*corner, one), end(*corner, other)] == ends;
                    assert_eq!((0..16).filter(is_taken).count(), 4, "{one} {other} {ends:?}");
                }
            }
        }
    }
}
