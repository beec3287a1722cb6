//! What is done in each stage of an audit.

use phea_dynamics::portable;

use super::super::PlantPoint;
use super::super::evaluator::FREQUENCY_TOLERANCE;
use super::super::finding::{self, Case, Part};
use super::super::frequencies::common_grid;
use super::super::minimum;
use super::super::response::decibels;
use super::super::scan::{Plant, Scan, WORTH_POLISHING};
use super::super::search::{Outcome, Task, search};
use super::super::start::{STARTS, interior_range, tasks};
use super::{SpecificationAudit, Stage, plant_at};
use crate::family::{Extent, Family};

/// Plants looked at, or peaks polished, in one step.
const PLANTS_A_STEP: usize = 32;
/// Cases of each specification whose frequencies are looked at for the whole family.
const FREQUENCIES: usize = 8;
/// By what share of themselves these frequencies lie apart at least.
const FREQUENCY_DISTANCE: f64 = 1e-3;

impl SpecificationAudit {
    pub(super) fn prepare(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.count());
        let plants: Vec<Plant> = (next..until).filter_map(|index| self.plant(index)).collect();
        self.plants.extend(plants);
        if until < self.count() {
            return Stage::Preparing(until);
        }
        let given: Vec<f64> = self
            .specifications
            .iter()
            .flat_map(|specification| specification.frequencies_rad_per_s.iter().copied())
            .collect();
        let features = self.plants.iter().map(|plant| &plant.features);
        let grid = common_grid(&self.evaluator, features, &given);
        self.scan = Scan::new(&self.evaluator, &grid);
        Stage::Looking(0)
    }

    pub(super) fn look(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.plants.len());
        for (index, plant) in self.plants.iter().enumerate().take(until).skip(next) {
            self.scan.look_at(&self.evaluator, plant, index);
        }
        if until < self.plants.len() {
            return Stage::Looking(until);
        }
        for (number, part) in self.parts.iter().enumerate() {
            for criterion in part.criteria() {
                let peaks = self.scan.peaks(criterion);
                self.peaks.extend(peaks.into_iter().map(|peak| (number, criterion, peak)));
            }
        }
        Stage::Polishing(0)
    }

    /// Polishes some peaks, as long as they can become the worst of their criterion.
    pub(super) fn polish(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.peaks.len());
        for (number, criterion, peak) in self.peaks.iter().take(until).skip(next) {
            let (Some(plant), Some(cases)) = (self.plants.get(peak.plant), self.cases.get_mut(*number))
            else {
                continue;
            };
            let own = cases.iter().filter(|case| case.criteria.contains(criterion));
            let worst = own.map(|case| case.margin_db).fold(f64::INFINITY, f64::min);
            if decibels(peak.excess / WORTH_POLISHING) > worst {
                continue;
            }
            let member = plant.member.as_ref();
            let polished =
                member.and_then(|member| self.evaluator.polished(*criterion, member, peak.bracket));
            cases.extend(polished.map(|(frequency, margin_db)| Case {
                margin_db,
                frequency,
                criteria: vec![*criterion],
                points: vec![plant.point.clone()],
                interior: true,
            }));
        }
        if until < self.peaks.len() { Stage::Polishing(until) } else { Stage::Gathering(0) }
    }

    /// Looks at the whole family where one specification is worst; with a spread, polishes the family's margin there.
    pub(super) fn gather(&mut self, number: usize) -> Stage {
        let (Some(&part), Some(cases)) = (self.parts.get(number), self.cases.get(number)) else {
            self.tasks = self.starts();
            return Stage::Searching(0);
        };
        let mut cases = cases.clone();
        self.look_at_worst(&mut cases);
        if part.spread {
            cases = self.polished_spread(part);
            self.look_at_worst(&mut cases);
        }
        if let Some(slot) = self.cases.get_mut(number) {
            *slot = cases;
        }
        Stage::Gathering(number + 1)
    }

    /// Looks at the whole family where the worst cases are.
    fn look_at_worst(&mut self, cases: &mut [Case]) {
        cases.sort_by(|left, right| left.margin_db.total_cmp(&right.margin_db));
        let mut frequencies: Vec<f64> = Vec::new();
        for case in cases.iter() {
            let apart = |other: &f64| (case.frequency / other - 1.0).abs() > FREQUENCY_DISTANCE;
            if frequencies.len() < FREQUENCIES && frequencies.iter().all(apart) {
                frequencies.push(case.frequency);
                self.scan.add_frequency(&self.evaluator, &self.plants, case.frequency);
            }
        }
    }

    /// The worst local minima of the margin of the spread, each polished over the whole family.
    fn polished_spread(&mut self, part: Part) -> Vec<Case> {
        let envelope = finding::envelope(part, &self.scan);
        let mut cases = Vec::new();
        for bracket in finding::local_minima(&envelope).into_iter().take(STARTS) {
            let mut margin = |logarithm: f64| {
                let frequency = portable::exp(logarithm);
                let worst = self.scan.family_at(&self.evaluator, &self.plants, frequency);
                part.combined(frequency, &worst).map_or(f64::INFINITY, |point| point.margin_db)
            };
            let [low, middle, high] = bracket.map(portable::ln);
            let start = (middle, margin(middle));
            let (logarithm, _) = minimum::between(margin, [low, high], start, FREQUENCY_TOLERANCE);
            let frequency = portable::exp(logarithm);
            let worst = self.scan.family_at(&self.evaluator, &self.plants, frequency);
            cases.extend(part.combined(frequency, &worst).map(|point| Case {
                margin_db: point.margin_db,
                frequency,
                criteria: point.criteria,
                points: finding::points(&self.plants, &point.plants),
                interior: true,
            }));
        }
        cases
    }

    fn starts(&self) -> Vec<(usize, Task)> {
        let Family::Uncertain(family) = &self.family else { return Vec::new() };
        if family.extent() == Extent::Members || family.coordinates().is_empty() {
            return Vec::new();
        }
        let mut starts = Vec::new();
        for (number, part) in self.parts.iter().enumerate() {
            let design = self.specifications.get(number).map(|one| one.frequencies_rad_per_s.as_slice());
            let cases = self.cases.get(number).map_or(&[][..], Vec::as_slice);
            for part in part.searched() {
                let range = interior_range(part, &self.evaluator, &self.scan);
                let seen = (&self.scan, self.plants.as_slice());
                let tasks = tasks(part, family, seen, cases, design.unwrap_or_default(), range);
                starts.extend(tasks.into_iter().map(|task| (number, task)));
            }
        }
        starts
    }

    pub(super) fn search(&mut self, next: usize) -> Stage {
        let (Some((number, task)), Family::Uncertain(family)) = (self.tasks.get(next), &self.family) else {
            return Stage::Joining(0);
        };
        let Outcome { found, undefined } = search(&self.evaluator, family, task);
        if let Some(slot @ None) = self.undefined.get_mut(*number) {
            *slot = undefined;
        }
        if let Some(found) = found {
            let inside = |[low, high]: [f64; 2]| low < found.frequency && found.frequency < high;
            if let Some(cases) = self.cases.get_mut(*number) {
                cases.push(Case {
                    margin_db: found.margin_db,
                    frequency: found.frequency,
                    criteria: task.criteria.clone(),
                    points: found.values.iter().cloned().map(PlantPoint::Parameters).collect(),
                    interior: task.range.is_some_and(inside),
                });
            }
            for values in found.values {
                let known =
                    |plant: &Plant| matches!(&plant.point, PlantPoint::Parameters(own) if *own == values);
                if !self.plants.iter().any(known) {
                    let plant = plant_at(&self.evaluator, family, &values);
                    self.scan.look_at(&self.evaluator, &plant, self.plants.len());
                    self.plants.push(plant);
                }
            }
        }
        Stage::Searching(next + 1)
    }

    /// Makes the finding of one specification.
    pub(super) fn join(&mut self, number: usize) -> Stage {
        let (Some(part), Some(specification)) =
            (self.parts.get(number).copied(), self.specifications.get(number).cloned())
        else {
            return Stage::Done;
        };
        let mut cases = self.cases.get(number).cloned().unwrap_or_default();
        self.look_at_worst(&mut cases);
        let finding = finding::Joining {
            part,
            family: &self.family,
            specification: &specification,
            evaluator: &self.evaluator,
            plants: &self.plants,
            cases: &cases,
            undefined: self.undefined.get(number).copied().flatten().or(finding::undefined(part, &self.scan)),
            tolerance_db: self.tolerance_db,
        }
        .finding(&mut self.scan);
        self.finished.push(finding);
        Stage::Joining(number + 1)
    }
}
