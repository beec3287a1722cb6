//! Stages of an audit.

use phea_dynamics::minimum;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, part, report_progress};

use super::super::evaluator::FREQUENCY_TOLERANCE;
use super::super::finding::{self, FoundMargin, SpecificationCriteria};
use super::super::frequencies::common_grid;
use super::super::response::decibels;
use super::super::scan::{Scan, ScannedPlant, WORTH_POLISHING};
use super::super::search::{SearchOutcome, SearchTask, search};
use super::super::start::{STARTS, interior_range, tasks};
use super::super::{PlantPoint, SpecificationFinding, SpecificationMargin};
use super::{AuditEffort, STAGE, SpecificationAudit, plant_at};
use crate::family::{Extent, Family, UncertainFamily};
use crate::plant_cache::PlantCache;

/// Number of cases of each specification whose frequencies are examined for the whole family.
const FREQUENCIES: usize = 8;
/// Number of simultaneous searches per worker if one may make others unnecessary.
const FOR_EACH_WORKER: usize = 2;
/// Least relative distance of these frequencies.
const FREQUENCY_DISTANCE: f64 = 1e-3;

impl SpecificationAudit<'_> {
    /// Places the plants within the loop, and chooses the frequencies at which all of them are
    /// examined.
    pub(super) fn prepare(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        let all = self.count();
        for index in 0..all {
            report_progress(watch, STAGE, index, all)?;
            self.plants.extend(self.plant(index));
        }
        let specifications = self.problem.specifications.iter();
        let given: Vec<f64> =
            specifications.flat_map(|one| one.frequencies_rad_per_s.iter().copied()).collect();
        let features = self.plants.iter().map(|plant| &plant.features);
        let grid = common_grid(&self.evaluator, features, &given);
        self.scan = Scan::new(&self.evaluator, &grid);
        Ok(())
    }

    /// Examines every plant over the whole band.
    pub(super) fn evaluate(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        for (index, plant) in self.plants.iter().enumerate() {
            report_progress(watch, STAGE, index, self.plants.len())?;
            self.scan.evaluate_at(&self.evaluator, plant, index);
        }
        Ok(())
    }

    /// Refines the peaks of each criterion, the highest first, as long as they can become its
    /// worst.
    pub(super) fn polish(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        for (number, (part, cases)) in self.parts.iter().zip(&mut self.cases).enumerate() {
            for criterion in part.criteria() {
                let mut worst = f64::INFINITY;
                for peak in self.scan.peaks(criterion) {
                    report_progress(watch, STAGE, number, self.parts.len())?;
                    let Some(plant) = self.plants.get(peak.plant) else { continue };
                    if decibels(peak.excess / WORTH_POLISHING) > worst {
                        continue;
                    }
                    let member = plant.member.as_ref();
                    let polished =
                        member.and_then(|member| self.evaluator.polished(criterion, member, peak.bracket));
                    let Some((frequency, margin_db)) = polished else { continue };
                    worst = worst.min(margin_db);
                    let certain = member
                        .and_then(|member| self.evaluator.certain_margin_db(criterion, member, frequency));
                    cases.push(FoundMargin {
                        margin: SpecificationMargin {
                            specification: number,
                            frequency_rad_per_s: frequency,
                            margin_db,
                            plant: plant.point.clone(),
                            other: None,
                        },
                        certain_db: certain.unwrap_or(margin_db),
                        criteria: vec![criterion],
                        interior: true,
                    });
                }
            }
        }
        Ok(())
    }

    /// Examines the whole family where each specification is worst; for a spread, refines the
    /// margin of the family there.
    pub(super) fn evaluate_worst(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        for (number, part) in self.parts.clone().into_iter().enumerate() {
            report_progress(watch, STAGE, number, self.parts.len())?;
            self.evaluate_cases(number);
            if part.spread {
                let polished = self.polished_spread(number, part);
                if let Some(cases) = self.cases.get_mut(number) {
                    *cases = polished;
                }
                self.evaluate_cases(number);
            }
        }
        Ok(())
    }

    /// Sorts the cases of a specification, the worst first, and examines the whole family at the
    /// worst.
    fn evaluate_cases(&mut self, number: usize) {
        let Some(cases) = self.cases.get_mut(number) else { return };
        sort_by_number(cases, |case| case.margin.margin_db);
        let mut frequencies: Vec<f64> = Vec::new();
        for frequency in cases.iter().map(|case| case.margin.frequency_rad_per_s) {
            let apart = |other: &f64| (frequency / other - 1.0).abs() > FREQUENCY_DISTANCE;
            if frequencies.len() < FREQUENCIES && frequencies.iter().all(apart) {
                frequencies.push(frequency);
                self.scan.add_frequency(&self.evaluator, &self.plants, frequency);
            }
        }
    }

    /// The worst local minima of the margin of the spread, each refined over the whole family.
    fn polished_spread(&mut self, number: usize, part: SpecificationCriteria) -> Vec<FoundMargin> {
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
            let point = part.combined(frequency, &worst);
            let found = point.and_then(|point| point.found(number, &self.plants));
            cases.extend(found.map(|found| FoundMargin { interior: true, ..found }));
        }
        cases
    }

    /// Searches the box from the worst cases of each specification, as far as the effort permits.
    pub(super) fn search(&mut self, effort: AuditEffort, watch: Watch<'_>) -> Result<(), Stopped> {
        let Family::Uncertain(family) = self.problem.family else { return Ok(()) };
        if effort == AuditEffort::KnownPlants {
            return Ok(());
        }
        let mut left = self.starts(family).into_iter().peekable();
        let all = left.len();
        while left.peek().is_some() {
            let fraction = (all - left.len()) as f64 / all as f64;
            let (skipped, now) = self.next_searches(effort, &mut left);
            self.skipped += skipped;
            let until = (all - left.len()) as f64 / all as f64;
            let found = self.searched(family, &now, &mut part(&mut *watch, STAGE, [fraction, until]))?;
            for ((number, task), (outcome, responses, evaluated)) in now.iter().zip(found) {
                // results of another search may make this one unnecessary
                if self.is_skipped(effort, *number) {
                    self.skipped += 1;
                    continue;
                }
                self.searches += 1;
                self.evaluator.count(responses);
                self.evaluated = [0, 1].map(|index: usize| self.evaluated[index] + evaluated[index]);
                self.take(family, (*number, task), outcome);
            }
        }
        Ok(())
    }

    /// The next simultaneous searches, with the number of those skipped before: all of them, or a
    /// few per worker if a search may make others unnecessary.
    fn next_searches(
        &self,
        effort: AuditEffort,
        left: &mut impl Iterator<Item = (usize, SearchTask)>,
    ) -> (usize, Vec<(usize, SearchTask)>) {
        let most = match effort {
            AuditEffort::UntilBelow(_) => match self.evaluator.cache.workers().at_once {
                0 | 1 => 1,
                at_once => FOR_EACH_WORKER * at_once,
            },
            AuditEffort::Complete | AuditEffort::KnownPlants => usize::MAX,
        };
        let (mut skipped, mut now) = (0, Vec::new());
        while now.len() < most
            && let Some((number, task)) = left.next()
        {
            if self.is_skipped(effort, number) {
                skipped += 1;
            } else {
                now.push((number, task));
            }
        }
        (skipped, now)
    }

    /// Ends of searches, each with its number of responses, and the numbers of plants evaluated and
    /// of plants whose factors were all needed.
    fn searched(
        &self,
        family: &UncertainFamily,
        tasks: &[(usize, SearchTask)],
        watch: Watch<'_>,
    ) -> Result<Vec<(SearchOutcome, u64, [usize; 2])>, Stopped> {
        let seed = self.evaluator.seed();
        let search = |cache: &PlantCache, task: &SearchTask, watch: Watch<'_>| {
            report_progress(watch, STAGE, 0, 1)?;
            let evaluator = seed.evaluator(cache);
            let outcome = search(&evaluator, family, task);
            Ok((outcome, evaluator.responses(), cache.evaluated()))
        };
        let tasks: Vec<&SearchTask> = tasks.iter().map(|(_, task)| task).collect();
        self.evaluator.cache.each(tasks, (STAGE, watch), search)
    }

    /// True if a violation of the specification is known that needs no search for a worse one.
    fn is_skipped(&self, effort: AuditEffort, number: usize) -> bool {
        match effort {
            AuditEffort::UntilBelow(least_db) => self.worst_known_db(number) < least_db,
            AuditEffort::Complete | AuditEffort::KnownPlants => false,
        }
    }

    /// The least known margin of a specification, dB.
    fn worst_known_db(&self, number: usize) -> f64 {
        let envelope = self.parts.get(number).map(|part| finding::envelope(*part, &self.scan));
        let of_plants = envelope.iter().flatten().map(|point| point.margin_db);
        let cases = self.cases.get(number).into_iter().flatten().map(|case| case.margin.margin_db);
        of_plants.chain(cases).fold(f64::INFINITY, f64::min)
    }

    /// Starts of searches, each with its specification.
    fn starts(&self, family: &UncertainFamily) -> Vec<(usize, SearchTask)> {
        if family.extent() == Extent::Members || family.coordinates().is_empty() {
            return Vec::new();
        }
        let mut starts = Vec::new();
        let specifications = self.problem.specifications.iter().zip(&self.cases);
        for (number, (part, (specification, cases))) in self.parts.iter().zip(specifications).enumerate() {
            for part in part.searched() {
                let range = interior_range(part, &self.evaluator, &self.scan);
                let seen = (&self.scan, self.plants.as_slice());
                let design = &specification.frequencies_rad_per_s;
                let tasks = tasks(part, family, seen, cases, design, range);
                starts.extend(tasks.into_iter().map(|task| (number, task)));
            }
        }
        starts
    }

    /// Records the result of a search for a specification.
    fn take(
        &mut self,
        family: &UncertainFamily,
        (number, task): (usize, &SearchTask),
        SearchOutcome { found, undefined }: SearchOutcome,
    ) {
        if let Some(slot @ None) = self.undefined.get_mut(number) {
            *slot = undefined;
        }
        let Some(found) = found else { return };
        let inside = |[low, high]: [f64; 2]| low < found.frequency && found.frequency < high;
        let mut points = found.values.iter().cloned().map(PlantPoint::Parameters);
        if let (Some(cases), Some(plant)) = (self.cases.get_mut(number), points.next()) {
            cases.push(FoundMargin {
                margin: SpecificationMargin {
                    specification: number,
                    frequency_rad_per_s: found.frequency,
                    margin_db: found.margin_db,
                    plant,
                    other: points.next(),
                },
                certain_db: found.margin_db,
                criteria: task.criteria.clone(),
                interior: task.range.is_some_and(inside),
            });
        }
        for values in found.values {
            let known =
                |plant: &ScannedPlant| matches!(&plant.point, PlantPoint::Parameters(own) if *own == values);
            if !self.plants.iter().any(known) {
                let plant = plant_at(&self.evaluator, family, &values);
                self.scan.evaluate_at(&self.evaluator, &plant, self.plants.len());
                self.plants.push(plant);
            }
        }
    }

    /// The findings for each specification, in order.
    pub(super) fn findings(&mut self, watch: Watch<'_>) -> Result<Vec<SpecificationFinding>, Stopped> {
        let mut findings = Vec::new();
        let specifications = self.problem.specifications.iter();
        for (number, (part, specification)) in self.parts.clone().into_iter().zip(specifications).enumerate()
        {
            report_progress(watch, STAGE, number, self.parts.len())?;
            self.evaluate_cases(number);
            let joining = finding::Joining {
                part,
                family: self.problem.family,
                index: number,
                specification,
                evaluator: &self.evaluator,
                plants: &self.plants,
                cases: self.cases.get(number).map_or(&[], Vec::as_slice),
                undefined: self
                    .undefined
                    .get(number)
                    .copied()
                    .flatten()
                    .or(finding::undefined(part, &self.scan)),
                tolerance_db: self.problem.tolerance_db,
            };
            findings.push(joining.finding(&mut self.scan));
        }
        Ok(findings)
    }
}
